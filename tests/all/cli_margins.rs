//! `rubscope margins` for people and files: the text and the table say what the library
//! gives, and the command of a target shows it.

use rubscope::report::{CommandLine, Sheet, margins as report};
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::study::margins::{MOST_TIMES, Margins, Target, acting};

use crate::cli_support::rubscope;
use crate::{close, scene};

/// Margins with all that can be in them.
pub fn full(scene: &CheckedScene) -> Margins {
    let mut margins = Margins::of(scene);
    let target = Target::parse("omega_lock=450", "casing.damping_ratio").unwrap();
    margins.target = target.solve(scene, &|| true);
    margins
}

/// The sheet of margins.
pub fn sheet(margins: &Margins) -> Sheet<'_> {
    report::sheet(margins, CommandLine::new("margins", &margins.scene))
}

pub fn text(margins: &Margins) -> String {
    let mut out = Vec::new();
    sheet(margins).write_text(true, &mut out).unwrap();
    String::from_utf8(out).unwrap()
}

/// A number with its unit, read by another way than it was written.
fn read(words: &str, unit: &str) -> f64 {
    let (number, rest) = words.trim().split_once(' ').unwrap();
    let prefix = rest.strip_suffix(unit).unwrap_or_else(|| panic!("{words} in {unit}"));
    let exponent = match prefix {
        "" => 0,
        "k" => 3,
        "M" => 6,
        "G" => 9,
        "m" => -3,
        "u" => -6,
        "n" => -9,
        other => panic!("{other}"),
    };
    number.parse::<f64>().unwrap() * 10_f64.powi(exponent)
}

/// Columns of a row of the text: two spaces or more are between them.
fn cells(line: &str) -> Vec<&str> {
    line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect()
}

#[test]
fn rows_of_the_text_are_the_limits() {
    for name in ["paper-nd3", "rocking"] {
        let margins = full(&scene(name, &[]));
        let text = text(&margins);
        assert!(text.starts_with(&margins.scene.title), "{text}");
        for limit in &margins.limits {
            let lobes = limit.lobes.map_or(String::new(), |lobes| format!("m={lobes} "));
            let start = format!("{} {lobes}", limit.name);
            let row = text.lines().find(|line| line.starts_with(&start)).unwrap();
            let cells = cells(row);
            let Some(value) = limit.value else {
                assert_eq!(cells[1..], ["-", "-"]);
                let note = limit.note.as_ref().unwrap();
                let said = format!("{}: none, as {note}.", limit.name);
                assert!(text.replace('\n', " ").contains(&said), "{said}: {text}");
                continue;
            };
            close(read(cells[1], limit.quantity.unit()), value, 5.1e-6);
            // The change from the scene to the limit, as in the sentence above the table.
            let change = limit.present.filter(|present| *present != 0.0);
            match change.map(|present| (value / present - 1.0, cells[2].strip_suffix(" x"))) {
                Some((change, _)) if change > MOST_TIMES => assert_eq!(cells[2], "> 100 x"),
                Some((change, Some(factor))) => {
                    close(factor.parse().unwrap(), 1.0 + change, 5.1e-4)
                }
                Some((change, None)) => {
                    let percent: f64 = cells[2].strip_suffix(" %").unwrap().parse().unwrap();
                    assert!(cells[2].starts_with(['+', '-']), "{row}");
                    assert!((percent - 100.0 * change).abs() < 0.51, "{row}");
                }
                None => assert_eq!(cells[2], "-"),
            }
            let strongest = limit.sensitivities.strongest(3);
            assert_eq!(cells.len() - 3, strongest.len(), "{row}");
            for (cell, (_, by)) in cells[3..].iter().zip(strongest) {
                let percent = cell.split(' ').nth(1).unwrap();
                close(percent.parse().unwrap(), by, 0.051);
            }
        }
    }
}

#[test]
fn the_command_of_a_target_shows_the_limit_there() {
    let scene = scene("paper-nd3", &[("title", "it's mine")]);
    let said_by = |command: &str| {
        let words = command.replace("'title=it'\\''s mine'", "title=mine");
        let output = rubscope(&words.split(' ').skip(1).collect::<Vec<_>>());
        assert!(output.status.success(), "{command}");
        String::from_utf8(output.stdout).unwrap()
    };
    let has = |said: &str, number: f64| {
        let outside = |c: char| !c.is_ascii_digit();
        let words = said.split_whitespace().map(|word| word.trim_matches(outside));
        let numbers = words.filter_map(|word| word.parse::<f64>().ok());
        numbers.into_iter().any(|said| (said / number - 1.0).abs() < 1e-5)
    };
    for (target, by, shown) in [
        ("omega_lock=450", "casing.damping_ratio", 450.0),
        ("omega_c=310", "casing.modal_mass_kg", 310.0),
        ("coincidence=402", "bladed_disk.stiffness_nm_per_rad", 402.0),
        ("omega_adhesive=307", "casing.damping_ratio", 307.0),
        ("coincidence_difference=203", "casing.modal_mass_kg", 203.0),
        ("push_b=66", "casing.damping_ratio", 66.0),
        ("torque=0.0123", "clearance", 0.0123),
    ] {
        let mut margins = Margins::of(&scene);
        let before = text(&margins).split_once("Computed in ").unwrap().0.to_string();
        margins.target = Target::parse(target, by).unwrap().solve(&scene, &|| true);
        let text = text(&margins);
        let command = text.lines().find_map(|line| line.strip_prefix("Check it: ")).unwrap();
        let said = said_by(command);
        assert!(has(&said, shown) && !has(&before, shown), "{target}: {command}\n{said}");
    }
    // A pulse a little beyond the smallest touches, one a little below does not.
    let mut margins = Margins::of(&scene);
    let target = Target::parse("touching_pulse=5000", "clearance").unwrap();
    margins.target = target.solve(&scene, &|| true);
    let told = text(&margins);
    let command = told.lines().find_map(|line| line.strip_prefix("Check it: ")).unwrap();
    assert!(
        command.contains("operation.pulse_n=5005.0") && !said_by(command).contains("No impact")
    );
    assert!(
        said_by(&command.replace("pulse_n=5005", "pulse_n=4995")).contains("No impact"),
        "{command}"
    );
    // One that no value of the parameter gives.
    let mut margins = Margins::of(&scene);
    let target = Target::parse("omega_lock=200", "casing.damping_ratio").unwrap();
    margins.target = target.solve(&scene, &|| true);
    let text = text(&margins).replace('\n', " ");
    assert!(text.contains("No value of casing.damping_ratio from 0 to "), "{text}");
    assert!(text.contains("puts omega_lock at 200 rad/s: it goes from 292.8"), "{text}");
    assert!(!text.contains("Check it"), "{text}");
}

#[test]
fn the_table_has_every_number() {
    let margins = full(&scene("paper-nd3", &[("operation.speed_rad_s", "-430")]));
    let mut out = Vec::new();
    report::table(&margins).write_csv(&mut out).unwrap();
    let mut reader = csv::Reader::from_reader(out.as_slice());
    let names: Vec<String> = reader.headers().unwrap().iter().map(String::from).collect();
    assert_eq!(names[..5], ["name", "quantity", "value", "present", "margin"]);
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), margins.limits.len());
    let json = serde_json::to_value(&margins).unwrap();
    for (place, (row, limit)) in rows.iter().zip(&margins.limits).enumerate() {
        let word = |name: &str| json["limits"][place][name].as_str().unwrap_or("").to_string();
        let lobes = limit.lobes.map_or(String::new(), |lobes| format!(" m={lobes}"));
        assert_eq!([&row[0], &row[1]], [word("name") + &lobes, word("quantity")]);
        let number = |column: usize| row[column].parse::<f64>().ok();
        let margin = limit.margin.filter(|margin| *margin <= MOST_TIMES);
        assert_eq!([number(2), number(3), number(4)], [limit.value, limit.present, margin]);
        for (column, path) in names.iter().enumerate().skip(5) {
            assert_eq!(number(column), limit.sensitivities.by(path), "{path}");
        }
    }
    assert_eq!(names.len(), 5 + acting(&margins.scene).count());
}
