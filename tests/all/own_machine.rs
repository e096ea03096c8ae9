//! The stage of docs/your-machine.md: its scene is what its table says, and locks where runs do.

use std::f64::consts::TAU;
use std::path::Path;

use rubscope::tui::{App, Marker, Theme};
use rubscope_solver::scene::Scene;

use crate::cli_support::{program, text};

/// The worked example of docs/your-machine.md: `stage.toml` from its table, by its command.
pub fn stage(folder: &Path) {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/your-machine.md");
    let page = std::fs::read_to_string(page).unwrap();
    let table = page.split_once("<<'END'\n").unwrap().1.split_once("END\n").unwrap().0;
    std::fs::write(folder.join("modes.csv"), table).unwrap();
    let command = page.lines().find_map(|line| line.strip_prefix("rubscope new ")).unwrap();
    let words = std::iter::once("new").chain(command.split(' '));
    assert!(program().current_dir(folder).args(words).output().unwrap().status.success());
}

#[test]
fn a_stage_of_blades_that_stiffen_is_what_its_table_says_and_locks_where_runs_do() {
    let folder = tempfile::tempdir().unwrap();
    stage(folder.path());
    let file = folder.path().join("stage.toml").to_str().unwrap().to_string();
    let mut scene = Scene::load(&file).unwrap();
    let table = std::fs::read_to_string(folder.path().join("modes.csv")).unwrap();
    for row in table.lines().skip(1) {
        let cells: Vec<String> = row.split(';').map(|cell| cell.replace(',', ".")).collect();
        scene.set("operation.nodal_diameters", &cells[1]).unwrap();
        let (machine, hertz) = (scene.machine(), cells[2].parse::<f64>().unwrap());
        let speed = cells[4].parse().unwrap_or(0.0) * (TAU / 60.0);
        let omega = if cells[0] == "disk" { machine.at(speed).omega_bd } else { machine.omega_c };
        assert!((omega / (TAU * hertz) - 1.0).abs() < 1e-12, "{row}");
    }
    let survey: serde_json::Value =
        serde_json::from_str(&text(&["survey", &file, "--range", "7000rpm:12000rpm", "--json"]))
            .unwrap();
    // What is guessed is not counted.
    let said = text(&["survey", &file, "--range", "7000:12000", "--rpm", "--nd", "9"]);
    let said = said.lines().take(4).collect::<Vec<_>>().join(" ");
    let guessed = "; with guessed modes waves of 9 nodal diameters could, too.";
    assert!(said.contains(guessed) && !said.contains("and 9 nodal"), "{said}");
    // Verdicts of runs of many pulses, of which some lock where a lock is possible.
    for (diameters, rpm, locks) in
        [(4, 9500, true), (5, 7200, false), (5, 11800, true), (6, 11800, false)]
    {
        let found = survey["rows"][diameters]["locks_in_range"].as_array().unwrap();
        let speed = f64::from(rpm) * (TAU / 60.0);
        let inside = found.iter().any(|span| {
            let [from, to] = [0, 1].map(|end| span[end].as_f64().unwrap());
            (from..=to).contains(&speed)
        });
        assert_eq!(inside, locks, "{diameters} at {rpm} rpm");
        let nd = diameters.to_string();
        let locked = (0..12).any(|k| {
            let pulse = format!("{}", 7e5 * 1.12_f64.powi(k));
            let at = format!("{rpm}rpm");
            let words = ["run", &file, "--nd", &nd, "--speed", &at, "--pulse", &pulse];
            let run = text(&[&words[..], &["--no-sensitivity", "--json"]].concat());
            run.contains("\"verdict\": \"locked\"") || run.contains("\"verdict\":\"locked\"")
        });
        assert_eq!(locked, locks, "{diameters} at {rpm} rpm");
    }
}

#[test]
fn the_explorer_keeps_the_speeds_of_a_new_machine_and_their_unit() {
    let folder = tempfile::tempdir().unwrap();
    stage(folder.path());
    let scene = Scene::load(folder.path().join("stage.toml").to_str().unwrap()).unwrap();
    let app = App::new(scene.checked().unwrap(), Theme::Mono, Marker::Ascii);
    let ends = app.order().range.unwrap().map(|end| end * 60.0 / TAU);
    assert!((ends[0] - 7000.0).abs() < 1e-6 && (ends[1] - 12000.0).abs() < 1e-6, "{ends:?}");
    assert!(app.appearance.rpm);
}
