//! The page of the theory, docs/theory.md: its numbers are those of the program,
//! every number of its text stands in docs/numbers.csv, its formulas survive Markdown, and
//! the sections that the source cites exist.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use rubscope_solver::harmonic::{Kind, equilibria, equilibrium};
use rubscope_solver::model::Machine;
use rubscope_solver::motion::{Events, Solver};
use rubscope_solver::scene::Scene;
use serde_json::Value;

use crate::cli_support::rubscope;

fn page() -> String {
    std::fs::read_to_string(root().join("docs/theory.md")).unwrap()
}

/// The numbers of the page, with the commands that print them or the items of the library.
const NUMBERS: &str = "docs/numbers.csv";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_path_buf()
}

/// The rows of the numbers: those that a command prints, or those from items of the library.
fn rows(of_commands: bool) -> Vec<csv::StringRecord> {
    let mut file = csv::Reader::from_path(root().join(NUMBERS)).unwrap();
    let rows = file.records().map(Result::unwrap);
    rows.filter(|row| row[5].starts_with("rubscope ") == of_commands).collect()
}

/// The tolerance of a row: zero where it has none.
fn tolerance(row: &csv::StringRecord) -> f64 {
    if row[3].is_empty() { 0.0 } else { row[3].parse().unwrap() }
}

#[test]
fn every_command_gives_the_number_of_its_row() {
    let mut printed: HashMap<String, Value> = HashMap::new();
    let rows = rows(true);
    assert!(rows.len() > 100);
    for row in &rows {
        let [_, _, value, _, _, command, pointer] = row.iter().collect::<Vec<_>>()[..] else {
            panic!("{row:?}");
        };
        let report = printed.entry(command.to_string()).or_insert_with(|| {
            // A run is checked for tiny changes, by four more, where a row asks for that.
            let asks = |row: &csv::StringRecord| row[5] == *command && row[6].contains("sensitive");
            let runs = command.starts_with("rubscope run") && !rows.iter().any(asks);
            let more = ["--json"].into_iter().chain(runs.then_some("--no-sensitivity"));
            let words: Vec<&str> = command.split(' ').skip(1).chain(more).collect();
            // Some of these runs fail, and have numbers all the same.
            serde_json::from_slice(&rubscope(&words).stdout).unwrap()
        });
        let found = report.pointer(pointer).unwrap_or_else(|| panic!("{row:?}"));
        let stated = serde_json::from_str(value).unwrap_or_else(|_| Value::from(value));
        match (stated.as_f64(), found.as_f64()) {
            (Some(stated), Some(found)) => {
                assert!((found - stated).abs() <= tolerance(row), "{row:?}: {found:e}");
            }
            _ => assert_eq!(*found, stated, "{row:?}"),
        }
    }
}

#[test]
fn closed_forms_are_those_of_the_library() {
    let rows = rows(false);
    assert!(rows.len() > 15);
    for row in rows {
        assert!(row[5].starts_with("library: "), "{row:?}");
        let (value, found): (f64, _) = (row[2].parse().unwrap(), closed_form(&row[0]));
        assert!((found - value).abs() <= tolerance(&row), "{row:?}: {found:e}");
    }
}

fn machine(diameters: u32, zeta_casing: f64) -> Machine {
    let mut scene = Scene::base();
    scene.operation.nodal_diameters = diameters;
    scene.casing.damping_ratio = zeta_casing;
    scene.machine()
}

/// Returns what a row from the library states, computed.
fn closed_form(id: &str) -> f64 {
    let paper = machine(3, 0.05);
    let (delta, nu) = (paper.polygon.delta, paper.nu(500.0));
    match id {
        "delta-3" => delta,
        "delta-4" => machine(4, 0.05).polygon.delta,
        "half-side" => paper.polygon.half_side(),
        "stable-step" => 2.0 / paper.omega_c,
        "coupling" => {
            let arm = paper.nodal_diameters * paper.polygon.half_side();
            paper.casing_mass * arm * arm / paper.blade_modal_mass
        }
        "blade-shift" => {
            let states = equilibria(&machine(3, 0.0), 388.3147, false).unwrap();
            let corner = states.iter().find(|state| state.kind == Kind::Corner).unwrap();
            let shifts = corner.eigenvalues_per_s.iter().map(|v| v.im.abs() - paper.omega_bd);
            shifts.fold(0.0, |most, shift| shift.abs().max(most))
        }
        "scheme-closed-a" => scheme(&paper, 500.0, 1e-7)[0],
        "scheme-closed-b" => scheme(&paper, 500.0, 1e-7)[1],
        "scheme-closed-1e-6" => scheme(&machine(3, 0.0), 500.0, 1e-6)[0],
        "largest-step" => delta / nu,
        "run-down" => {
            let scene = Scene::builtin("run-down").unwrap();
            let mut event = Events::new(&scene.checked().unwrap()).unwrap();
            event.advance(0.06).unwrap();
            let ended = event.contacts().longest_hold.unwrap().until;
            event.rotor().speed(ended)
        }
        "saddle-place" => {
            let side = equilibrium(&paper, Kind::Side, 0, 500.0, true).unwrap().unwrap();
            // Side 0 has the phase zero, and y is the imaginary part of z.
            side.z_m[1]
        }
        "pull-a" | "pull-b" => {
            let [a, b] = paper.locked_multipliers(500.0).unwrap();
            let push = if id == "pull-a" { -b } else { -a };
            push * (2.0 * delta).sin() / paper.casing_mass
        }
        "kept" => (2.0 * delta).cos(),
        "literal-disk" => Scene::base().bladed_disk.damping_ratio / paper.blade_inertia,
        "literal-casing" => Scene::base().casing.damping_ratio / paper.casing_mass,
        _ => panic!("no closed form is known for {id}"),
    }
}

/// Multipliers of a lock in the explicit scheme at this step, by the page's
/// `K'` and `D'`.
fn scheme(machine: &Machine, speed: f64, step: f64) -> [f64; 2] {
    let turn = machine.nu(speed) * step;
    let stiff = machine.casing_stiffness
        - 4.0 * machine.casing_mass * (0.5 * turn).sin().powi(2) / (step * step);
    let drag = machine.casing_damping * turn.sin() / step;
    let (sin, cos) = turn.sin_cos();
    let (stiff, drag) = (stiff * cos + drag * sin, drag * cos - stiff * sin);
    let (sin, cos) = machine.polygon.delta.sin_cos();
    let scale = machine.clearance() / (2.0 * cos);
    [scale * (stiff / cos - drag / sin), scale * (stiff / cos + drag / sin)]
}

/// Numbers with three digits or more, without leading and, in whole numbers,
/// final zeros: the number, and half a unit of its last digit.
fn numbers(text: &str) -> Vec<(String, f64, f64)> {
    let mut found = Vec::new();
    let characters: Vec<char> = text.chars().collect();
    let is = |at: usize, test: fn(&char) -> bool| characters.get(at).is_some_and(test);
    let mut at = 0;
    while at < characters.len() {
        let start = at;
        while is(at, |c| c.is_ascii_alphanumeric() || *c == '.')
            || (at > start
                && is(at - 1, |c| *c == 'e')
                && is(at, |c| *c == '-')
                && is(start, char::is_ascii_digit))
        {
            at += 1;
        }
        if at == start {
            at += 1;
            continue;
        }
        let word: String = characters[start..at].iter().collect();
        let word = word.trim_end_matches('.');
        let Ok(number) = word.parse::<f64>() else { continue };
        let (mantissa, exponent) = word.split_once('e').unwrap_or((word, "0"));
        let (whole, decimals) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let all = format!("{whole}{decimals}");
        let digits = if decimals.is_empty() { all.trim_end_matches('0') } else { &all };
        if digits.trim_start_matches('0').len() >= 3 {
            let power = exponent.parse::<i32>().unwrap() - i32::try_from(decimals.len()).unwrap();
            found.push((word.to_string(), number, 0.5 * 10f64.powi(power)));
        }
    }
    found
}

#[test]
fn every_number_of_the_text_is_in_the_file() {
    let page = page();
    let text = page.split_once("\n## 13 ").unwrap().0;
    let file = std::fs::read_to_string(root().join(NUMBERS)).unwrap().replace(',', " ");
    // Values in their unit, in milli, micro, kilo or mega; `half` a unit is that of
    // the text.
    let known: Vec<f64> = numbers(&file).into_iter().map(|(_, number, _)| number).collect();
    let stands = |number: f64, half: f64| {
        let units = [1.0, 1e-3, 1e-6, 1e3, 1e6];
        units.iter().any(|unit| known.iter().any(|k| (k / unit - number).abs() <= 1.000_001 * half))
    };
    let (_, text) = text.split_once("\n## 1 ").unwrap();
    let missing: Vec<String> = numbers(text)
        .into_iter()
        .filter(|&(_, number, half)| !stands(number, half))
        .map(|(word, ..)| word)
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
    assert!(numbers(text).len() > 70);
}

#[test]
fn formulas_survive_markdown() {
    let page = page();
    let mut blocks = 0;
    for (place, part) in page.split("```").enumerate() {
        if place % 2 == 1 {
            blocks += 1;
            assert!(part.starts_with("math\n"), "{part}");
            assert_eq!(part.matches('{').count(), part.matches('}').count(), "{part}");
            assert_eq!(part.matches("\\left").count(), part.matches("\\right").count(), "{part}");
            continue;
        }
        for paragraph in part.split("\n\n") {
            assert!(paragraph.matches('$').count().is_multiple_of(2), "{paragraph}");
            for formula in paragraph.split('$').skip(1).step_by(2) {
                // Markdown takes a backslash before punctuation for itself, and a
                // formula neither starts nor ends with a space.
                let mut pairs = formula.chars().zip(formula.chars().skip(1));
                let eaten = pairs.any(|(a, b)| a == '\\' && b.is_ascii_punctuation());
                assert!(!eaten && formula.trim() == formula, "{formula}");
                // A star or an underscore after punctuation may begin emphasis.
                let emphasis = ["*", "'_", ")_", "}_", "|"];
                assert!(!emphasis.iter().any(|it| formula.contains(it)), "{formula}");
            }
        }
    }
    assert!(blocks > 25);
    assert!(!page.contains("\\operatorname"), "GitHub refuses it");
}
