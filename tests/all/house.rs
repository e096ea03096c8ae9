//! CONTRIBUTING.md draws the house; the code is built so, and the files that it
//! names exist.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn contributing() -> String {
    fs::read_to_string(root().join("CONTRIBUTING.md")).unwrap()
}

/// The row of each part of the library in the picture, from the top.
fn rows() -> BTreeMap<String, usize> {
    let text = contributing();
    let picture = text.split("```text\n").nth(1).unwrap().split("```").next().unwrap();
    let mut rows = BTreeMap::new();
    for (row, line) in picture.lines().enumerate() {
        let names = line
            .split_whitespace()
            .filter_map(|word| word.strip_suffix('/').or_else(|| word.strip_suffix(".rs")));
        for name in names {
            assert!(rows.insert(name.to_string(), row).is_none(), "{name} is drawn twice");
        }
    }
    rows
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|end| end == "rs") {
            found.push(path);
        }
    }
    found
}

/// The parts that a line of code names; a comment names none.
fn named(line: &str) -> impl Iterator<Item = &str> {
    let code = line.split("//").next().unwrap_or_default();
    let after = ["crate::", "rubscope_solver::"].map(|root| code.split(root).skip(1));
    after.into_iter().flatten().map(|rest| {
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
        &rest[..end.unwrap_or(rest.len())]
    })
}

/// The folders of the sources of both packages.
fn packages() -> [PathBuf; 2] {
    ["src", "solver/src"].map(|folder| root().join(folder))
}

#[test]
fn every_part_uses_only_what_is_drawn_below_it() {
    let rows = rows();
    let mut wrong = Vec::new();
    let mut uses = 0;
    for (package, file) in packages()
        .iter()
        .flat_map(|package| sources(package).into_iter().map(move |f| (package, f)))
    {
        let inside = file.strip_prefix(package).unwrap();
        let first = inside.components().next().unwrap().as_os_str().to_str().unwrap();
        let part = first.trim_end_matches(".rs");
        if ["main", "lib"].contains(&part) {
            continue;
        }
        let row = *rows.get(part).unwrap_or_else(|| panic!("{part} is not in the picture"));
        for line in fs::read_to_string(&file).unwrap().lines() {
            for name in named(line).filter(|&name| name != part) {
                uses += 1;
                let below = rows.get(name).is_some_and(|&other| other > row);
                if !below {
                    wrong.push(format!("{}: {}", inside.display(), line.trim()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "not below:\n{}", wrong.join("\n"));
    assert!(uses > 100, "only {uses} uses were found");
}

#[test]
fn every_file_that_is_named_exists() {
    let text = contributing();
    let mut seen = 0;
    for word in text.split('`').skip(1).step_by(2) {
        let path = word.split([':', ' ']).next().unwrap_or_default();
        let inside = ["src/", "tests/", "presets/", "assets/", "solver/", "benches/", "fuzz/"]
            .iter()
            .any(|folder| path.starts_with(folder));
        // In capitals: a name that the reader chooses.
        // The package leaves out what only a checkout needs.
        let left_out =
            (path.starts_with("fuzz/") || path.ends_with(".sh")) && !root().join(".ci").exists();
        if inside && !path.contains("NAME") && !left_out {
            seen += 1;
            assert!(root().join(path).exists(), "{path}");
        }
    }
    assert!(seen > 20, "only {seen} files are named");
}

#[test]
fn no_solver_knows_its_sibling() {
    // A folder of `motion`, and what none of its lines may name.
    let apart = [
        ("explicit", &["motion::event", "LinearEvents", "ExactEvents"][..]),
        ("event", &["motion::explicit", "Explicit<"]),
        ("event/exact", &["linear::", "LinearEvents"]),
        ("event/linear", &["exact::"]),
        ("explicit/disk", &["leap::", "beyond::", "Leaps", "Beyond"]),
    ];
    for (folder, forbidden) in apart {
        let files = sources(&root().join("solver/src/motion").join(folder));
        assert!(files.len() > 5, "{folder}");
        for file in files {
            for line in fs::read_to_string(&file).unwrap().lines() {
                let code = line.split("//").next().unwrap_or_default();
                let found = forbidden.iter().find(|name| code.contains(**name));
                assert_eq!(found, None, "{}: {line}", file.display());
            }
        }
    }
}

/// The parts of the state of the explorer, by their fields.
fn parts_of_the_state() -> Vec<String> {
    let text = fs::read_to_string(root().join("src/tui/app/mod.rs")).unwrap();
    let fields = text.split("pub struct App {").nth(1).unwrap().split('}').next().unwrap();
    let name = |line: &str| Some(line.trim().strip_prefix("pub ")?.split_once(':')?.0.to_string());
    fields.lines().filter_map(name).collect()
}

#[test]
fn no_part_of_the_explorer_names_a_field_of_another() {
    let parts = parts_of_the_state();
    assert!((8..15).contains(&parts.len()), "{parts:?}");
    // What every part reads, and what is no value of its own file.
    let common = ["scene", "machine", "status"];
    let homes: BTreeMap<&str, &[&str]> = BTreeMap::from([
        ("knobs", ["knobs.rs", "sweep.rs"].as_slice()),
        ("play", &["play.rs"]),
        ("run", &["run.rs", "verdict.rs"]),
        ("layout", &["layout.rs"]),
        ("reading", &["reading.rs"]),
        ("map", &["map.rs"]),
        ("dialogue", &["dialogue.rs"]),
        ("files", &["files.rs", "scenes.rs"]),
        ("lessons", &["lesson.rs"]),
        ("mouse", &["mouse.rs"]),
        ("appearance", &[]),
    ]);
    let (mut wrong, mut own) = (Vec::new(), 0);
    for part in parts.iter().filter(|part| !common.contains(&part.as_str())) {
        let homes = homes.get(part.as_str()).unwrap_or_else(|| panic!("where is {part}?"));
        for file in sources(&root().join("src/tui/app")) {
            let name = file.file_name().unwrap().to_str().unwrap();
            let text = fs::read_to_string(&file).unwrap();
            // Tests look at any part; the head of the state puts the parts together.
            let code = text.split("#[cfg(test)]").next().unwrap();
            let code: String = code.split_whitespace().collect();
            for reach in code.split(&format!("self.{part}.")).skip(1) {
                let end = reach.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap();
                match reach[end..].starts_with('(') {
                    true => {}
                    false if name == "mod.rs" || homes.contains(&name) => own += 1,
                    false => wrong.push(format!("{name}: {part}.{}", &reach[..end])),
                }
            }
        }
    }
    assert!(wrong.is_empty(), "fields of another part:\n{}", wrong.join("\n"));
    assert!(own > 50, "only {own} fields were found");
}

#[test]
fn the_map_of_the_tests_names_modules_that_there_are() {
    let read = |path: &str| fs::read_to_string(root().join(path)).unwrap();
    let main = read("solver/tests/all/main.rs");
    let both = main.clone() + &read("tests/all/main.rs");
    let rows = || main.lines().filter(|line| line.starts_with("//! |") && line.contains('`'));
    assert!(rows().count() > 8);
    for name in rows().flat_map(|row| row.split('`').skip(1).step_by(2)) {
        assert!(both.contains(&format!("\nmod {name};\n")), "{name}");
    }
    // Every module about a solver stands in it.
    let solvers = main.lines().filter_map(|line| line.strip_prefix("mod ")?.strip_suffix(';'));
    for name in solvers.filter(|name| name.starts_with("explicit") || name.starts_with("event")) {
        assert!(rows().any(|row| row.contains(&format!("`{name}`"))), "{name}");
    }
}
