//! The table of docs/commands.md on adaptive maps: each row is computed, in full
//! and adaptively, with the options it names.

use serde_json::Value;

use crate::cli_support::program;

/// A row of the table: options, what they solve with, runs, cells, and cells
/// that differ.
struct Row {
    solver: String,
    options: Vec<String>,
    runs: u64,
    cells: u64,
    differ: u64,
}

/// The number at the start of a text.
fn leading(text: &str) -> u64 {
    text.split(|c: char| !c.is_ascii_digit()).next().unwrap().parse().unwrap()
}

fn rows() -> Vec<Row> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/commands.md");
    let text = std::fs::read_to_string(path).unwrap();
    let table = text.split("| cells | solver, law, model, zeta_c | options |").nth(1).unwrap();
    let row = |line: &str| {
        let columns: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [size, solver, options, runs, differ] = columns[..] else { unreachable!("{line}") };
        let (across, down) = size.split_once(" x ").unwrap();
        let mut all = vec!["--speed".into(), format!("0:500:{across}")];
        all.extend(["--pulse".into(), format!("0:1e6:{down}")]);
        let given = options.strip_prefix('`').and_then(|text| text.strip_suffix('`'));
        assert!(given.is_some() || options.starts_with("none"), "{line}");
        all.extend(given.unwrap_or_default().split_whitespace().map(String::from));
        let (runs, cells) = runs.split_once(" of ").unwrap();
        let [runs, cells, differ] = [runs, cells, differ].map(leading);
        Row { solver: solver.to_string(), options: all, runs, cells, differ }
    };
    table.lines().skip(2).take_while(|line| line.starts_with('|')).map(row).collect()
}

fn map(options: &[String], more: &[&str]) -> Value {
    let output = program()
        .args(["map", "--json", "--no-sensitivity"])
        .args(options)
        .args(more)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn verdicts(map: &Value) -> Vec<&Value> {
    map["verdict"].as_array().unwrap().iter().flat_map(|row| row.as_array().unwrap()).collect()
}

/// Other processors round sines differently, and some of these cells are
/// chaotic: so runs may differ by a twentieth and five cells.
fn near(found: u64, told: u64) -> bool {
    found.abs_diff(told) <= 5 + told / 20
}

fn check(row: &Row) {
    let (full, adaptive) = (map(&row.options, &[]), map(&row.options, &["--adaptive"]));
    let (full_cells, cells) = (verdicts(&full), verdicts(&adaptive));
    let differ = full_cells.iter().zip(&cells).filter(|(a, b)| a != b).count() as u64;
    let runs = adaptive["runs"].as_u64().unwrap();
    assert_eq!(cells.len() as u64, row.cells, "{:?}", row.options);
    let (by, zeta) = (&full["scene"]["solver"], &full["scene"]["casing"]["damping_ratio"]);
    let words = ["kind", "contact", "model"].map(|key| by[key].as_str().unwrap());
    assert_eq!(row.solver, format!("{}, {zeta}", words.join(", ")));
    assert_eq!(full["runs"].as_u64(), Some(row.cells));
    assert!(near(runs, row.runs), "{:?}: {runs} runs, the document says {}", row.options, row.runs);
    assert!(near(differ, row.differ), "{:?}: {differ} cells differ", row.options);
    if row.options.iter().any(|option| option == "event") && row.differ < 20 {
        // "all the cells that lock": the adaptive map has none of them.
        let locked = |cells: &[&Value]| cells.iter().filter(|cell| **cell == "locked").count();
        assert_eq!((locked(&full_cells) as u64, locked(&cells)), (differ, 0), "{:?}", row.options);
    }
}

#[test]
fn the_first_row_of_the_table_is_what_the_program_does() {
    let rows = rows();
    assert_eq!(rows.len(), 6);
    check(&rows[0]);
}

#[test]
#[ignore = "80,000 cells, for release builds: cargo test --release -- --ignored"]
fn every_row_of_the_table_is_what_the_program_does() {
    rows().iter().for_each(check);
}
