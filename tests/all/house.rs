//! CONTRIBUTING.md draws the house; the code is built so, and the files that it
//! names exist.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Whether both packages are here: a package by itself has not the folder of the other.
fn is_checkout() -> bool {
    root().join("solver/src").is_dir()
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
    if !is_checkout() {
        return;
    }
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
    if !is_checkout() {
        return;
    }
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
    if !is_checkout() {
        return;
    }
    // A folder of `motion`, and what none of its lines may name.
    let apart = [
        ("explicit", &["motion::event", "Events"][..]),
        ("event", &["motion::explicit", "Explicit::"]),
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

/// The paths that a use names, one for each name in its braces.
fn expanded(path: &str) -> Vec<String> {
    let Some((before, rest)) = path.split_once('{') else { return vec![path.to_string()] };
    let inside = rest.rsplit_once('}').unwrap().0;
    let (mut names, mut depth) = (vec![String::new()], 0);
    for c in inside.chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        match c {
            ',' if depth == 0 => names.push(String::new()),
            c => names.last_mut().unwrap().push(c),
        }
    }
    names.retain(|name| !name.is_empty());
    names.iter().flat_map(|name| expanded(&format!("{before}{name}"))).collect()
}

/// The code of a file without tests and comments, with one space between words.
fn code_of(text: &str) -> String {
    let [own_tests, shared] = ["#[cfg(test)]\nmod", "#[cfg(test)]\npub mod"];
    let code = text.split(own_tests).flat_map(|part| part.split(shared)).next().unwrap();
    let lines = code.lines().map(|line| line.split("//").next().unwrap());
    lines.flat_map(str::split_whitespace).flat_map(|word| [word, " "]).collect()
}

/// The paths in a folder of `src` that a file there names, as paths of modules. Names that it only
/// hands on are no uses.
fn named_in(folder: &str, own: &str, code: &str) -> Vec<String> {
    let children = code.split("mod ").skip(1).filter_map(|rest| rest.split_once(';'));
    let starts: Vec<_> = children.map(|(child, _)| format!("{child}::")).collect();
    let starts = starts.iter().map(String::as_str).chain(["super::", folder]);
    let mut found = Vec::new();
    for (at, _) in starts.flat_map(|start| code.match_indices(start)) {
        let before = &code[..at];
        if before.ends_with(|c: char| c.is_alphanumeric() || "_:".contains(c))
            || before.ends_with("pub use ")
        {
            continue;
        }
        let is_use = code[..at].ends_with("use ");
        let end = match is_use {
            true => code[at..].find(';'),
            false => code[at..].find(|c: char| !c.is_alphanumeric() && c != '_' && c != ':'),
        };
        let path = code[at..at + end.unwrap()].replace(' ', "");
        for path in expanded(&path) {
            let up = path.matches("super::").count();
            let mut base: Vec<&str> = own.split('/').filter(|part| !part.is_empty()).collect();
            match path.starts_with("crate") {
                true => base.clear(),
                false => base.truncate(base.len().saturating_sub(up)),
            }
            let rest = path.replace(folder, "").replace("super::", "");
            base.extend(rest.split("::"));
            found.push(base.join("/"));
        }
    }
    found
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    for (folder, least) in [("tui", 400), ("sheet", 80), ("cli", 40)] {
        assert_no_circle(folder, least);
    }
}

/// Asserts that no files of a folder of `src`, which use `least` others, use each other in a circle.
fn assert_no_circle(name: &str, least: usize) {
    let (folder, inside) = (root().join("src").join(name), format!("crate::{name}::"));
    let files: BTreeMap<String, String> = sources(&folder)
        .iter()
        .map(|file| {
            let path = file.strip_prefix(&folder).unwrap().to_str().unwrap();
            let own = path.trim_end_matches(".rs").trim_end_matches("mod").trim_end_matches('/');
            (own.to_string(), code_of(&fs::read_to_string(file).unwrap()))
        })
        .filter(|(own, _)| !own.ends_with("tests"))
        .collect();
    // Names that a file hands on, and their places.
    let mut handed: Vec<[String; 2]> = Vec::new();
    for (own, code) in &files {
        for used in code.split("pub use ").skip(1).filter_map(|rest| rest.split(';').next()) {
            for path in expanded(&used.replace(' ', "")) {
                let place = |path: &str| format!("{own}/{}", path.replace("::", "/"));
                let both = [path.rsplit("::").next().unwrap(), &path];
                handed.push(both.map(|path| place(path).trim_start_matches('/').into()));
            }
        }
    }
    let is_of = |path: &str, part: &str| path == part || path.starts_with(&format!("{part}/"));
    // The file of a path is that of its longest part.
    let file_of = |path: &str| {
        let place = handed.iter().find(|[name, _]| is_of(path, name)).map_or(path, |of| &of[1]);
        let parts = files.keys().filter(|file| file.is_empty() || is_of(place, file));
        parts.max_by_key(|file| file.len()).unwrap().clone()
    };
    let uses = |(own, code): (&String, &String)| {
        let named = named_in(&inside, own, code);
        let others = named.iter().map(|path| file_of(path)).filter(|other| other != own);
        (own.clone(), others.collect::<BTreeSet<_>>())
    };
    let mut left: BTreeMap<String, BTreeSet<String>> = files.iter().map(uses).collect();
    assert!(left.values().map(BTreeSet::len).sum::<usize>() > least);
    // A file that uses none of the files left is in no circle of them.
    while let Some(last) = left.iter().find(|(_, uses)| uses.is_empty()).map(|(own, _)| own.clone())
    {
        left.remove(&last);
        left.values_mut().for_each(|uses| _ = uses.remove(&last));
    }
    assert!(left.is_empty(), "{left:#?}");
}

#[test]
fn the_map_of_the_tests_names_modules_that_there_are() {
    if !is_checkout() {
        return;
    }
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
