//! The times in the documents: every row of a table with a column `bench` names a
//! benchmark that is there, so that it can be measured again. The times themselves
//! belong to a machine.

use std::collections::BTreeMap;

use super::{documents, read, top};

/// The benchmark and the time of every row, document by document.
fn rows(name: &str) -> Vec<(String, String)> {
    let document = read(name);
    let mut found = Vec::new();
    for header in document.text.lines().filter(|line| line.ends_with("| bench |")) {
        let names: Vec<&str> = header.trim_matches('|').split('|').map(str::trim).collect();
        let time = names.iter().position(|name| *name == "time").unwrap();
        for row in document.table(header) {
            found.push((row.last().unwrap().trim_matches('`').to_string(), row[time].clone()));
        }
    }
    found
}

/// The sources of benchmarks: a group and a name in one of them is one.
fn sources() -> Vec<String> {
    let files = std::fs::read_dir(top().join("benches")).unwrap();
    let files = files.map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
    files.map(|path| std::fs::read_to_string(path).unwrap()).collect()
}

#[test]
fn every_time_in_the_documents_has_a_benchmark_of_its_name() {
    let sources = sources();
    let is_there = |bench: &str| {
        let (group, name) = bench.split_once('/').unwrap();
        sources.iter().any(|source| {
            let group = match group {
                "program" => source.contains("\"benches\" / \"program\""),
                group => source.contains(&format!("benchmark_group(\"{group}\")")),
            };
            group && source.contains(&format!("\"{name}\""))
        })
    };
    assert!(!is_there("explicit/the moon") && !is_there("moon/slip, rigid"));
    let mut count = 0;
    for document in documents() {
        for (bench, time) in rows(&document.name) {
            assert!(is_there(&bench), "{}: no benchmark {bench}", document.name);
            let unit = time.split_once(' ').map(|(_, unit)| unit);
            assert!(matches!(unit, Some("ns" | "us" | "ms" | "s")), "{bench}: {time}");
            count += 1;
        }
    }
    assert!(count > 20, "{count}");
}

#[test]
fn the_readme_has_the_times_of_the_page_on_validation() {
    let known: BTreeMap<_, _> = rows("docs/validation.md").into_iter().collect();
    let told = rows("README.md");
    assert_eq!(told.len(), 3);
    for (bench, time) in told {
        assert_eq!(known.get(&bench), Some(&time), "{bench}");
    }
}
