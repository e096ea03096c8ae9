//! The dependencies are what `deny.toml` allows, checked without cargo-deny:
//! licences, crates in two versions, sources; and no crate needs a newer compiler
//! than this one says.

use std::collections::{BTreeMap, BTreeSet};
use std::iter::Peekable;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

/// What a command of cargo prints about all dependencies; about those for this
/// machine only, where cargo has no others and no network.
fn told(command: &str, everywhere: &[&str], here: &[&str]) -> Option<String> {
    let ask = |more: &[&str]| {
        let mut cargo = Command::new(option_env!("CARGO").unwrap_or("cargo"));
        cargo.args([command, "--locked", "--all-features"]).args(more);
        let output = cargo.current_dir(env!("CARGO_MANIFEST_DIR")).output().ok()?;
        output.status.success().then(|| String::from_utf8(output.stdout).unwrap())
    };
    let found = ask(everywhere).or_else(|| ask(&[here, &["--offline"]].concat()));
    if found.is_none() {
        eprintln!("skipped: cargo cannot tell the dependencies here");
    }
    found
}

/// Every package, with its licence and source.
fn metadata() -> Option<Value> {
    let version = Command::new("rustc").arg("-vV").output().ok()?;
    let version = String::from_utf8(version.stdout).ok()?;
    let host = version.lines().find_map(|line| line.strip_prefix("host: "))?;
    let format = ["--format-version", "1"];
    let here = [&format[..], &["--filter-platform", host]].concat();
    let found = told("metadata", &format, &here)?;
    Some(serde_json::from_str(&found).unwrap())
}

fn deny() -> toml::Table {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("deny.toml");
    std::fs::read_to_string(path).unwrap().parse().unwrap()
}

fn word<'a>(package: &'a Value, key: &str) -> &'a str {
    package[key].as_str().unwrap_or_default()
}

/// Whether one of the choices of a licence expression is allowed.
fn licensed(expression: &str, allowed: &[&str]) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let mut words = spaced.split_whitespace().peekable();
    any(&mut words, allowed) && words.next().is_none()
}

fn any<'a>(words: &mut Peekable<impl Iterator<Item = &'a str>>, allowed: &[&str]) -> bool {
    let mut good = all(words, allowed);
    while words.next_if_eq(&"OR").is_some() {
        good |= all(words, allowed);
    }
    good
}

fn all<'a>(words: &mut Peekable<impl Iterator<Item = &'a str>>, allowed: &[&str]) -> bool {
    let mut good = true;
    loop {
        good &= match words.next() {
            Some("(") => {
                let inner = any(words, allowed);
                inner && words.next() == Some(")")
            }
            Some(name) if words.next_if_eq(&"WITH").is_some() => {
                let whole = format!("{name} WITH {}", words.next().unwrap_or_default());
                allowed.contains(&whole.as_str())
            }
            name => name.is_some_and(|name| allowed.contains(&name)),
        };
        if words.next_if_eq(&"AND").is_none() {
            return good;
        }
    }
}

#[test]
fn licence_expressions_are_read_as_they_are_meant() {
    let allowed = ["MIT", "Apache-2.0 WITH LLVM-exception"];
    for (expression, good) in [
        ("MIT", true),
        ("GPL-3.0", false),
        ("GPL-3.0 OR MIT", true),
        ("GPL-3.0/MIT", true),
        ("GPL-3.0 AND MIT", false),
        ("(MIT OR GPL-3.0) AND MIT", true),
        ("(MIT OR GPL-3.0) AND Zlib", false),
        ("MIT OR GPL-3.0 AND Zlib", true),
        ("Apache-2.0", false),
        ("Apache-2.0 WITH LLVM-exception", true),
        ("", false),
        ("MIT OR", true),
        ("MIT GPL-3.0", false),
    ] {
        assert_eq!(licensed(expression, &allowed), good, "{expression}");
    }
}

#[test]
fn every_dependency_has_an_allowed_licence_and_source_and_needs_no_newer_compiler() {
    let Some(metadata) = metadata() else { return };
    let deny = deny();
    let allowed = deny["licenses"]["allow"].as_array().unwrap();
    let allowed: Vec<&str> = allowed.iter().filter_map(toml::Value::as_str).collect();
    let number = |version: &str| -> Vec<u32> {
        version.split('.').map(|part| part.parse().unwrap()).collect()
    };
    let ours = number(env!("CARGO_PKG_RUST_VERSION"));
    for package in metadata["packages"].as_array().unwrap() {
        let name = word(package, "name");
        assert!(licensed(word(package, "license"), &allowed), "{name}: {}", package["license"]);
        let registry = word(package, "source").starts_with("registry+");
        assert!(
            registry || ["rubscope", "rubscope-solver"].contains(&name),
            "{name} is from {}",
            package["source"]
        );
        if let Some(version) = package["rust_version"].as_str() {
            assert!(number(version)[..2] <= ours[..2], "{name} needs Rust {version}");
        }
    }
}

#[test]
fn no_dependency_is_there_twice_without_a_reason() {
    let list = ["--prefix", "none", "--edges", "normal,build,dev"];
    let everywhere = [&list[..], &["--target", "all"]].concat();
    let Some(tree) = told("tree", &everywhere, &list) else { return };
    let mut versions: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for line in tree.lines() {
        let mut words = line.split(' ');
        if let (Some(name), Some(version)) = (words.next(), words.next()) {
            versions.entry(name).or_default().insert(version);
        }
    }
    assert!(versions.contains_key("rubscope") && versions.len() > 100, "{tree}");
    versions.retain(|_, versions| versions.len() > 1);
    let deny = deny();
    let skipped = deny["bans"]["skip"].as_array().unwrap();
    assert!(skipped.iter().all(|entry| entry["reason"].as_str().is_some_and(|r| !r.is_empty())));
    let skipped: Vec<&str> = skipped.iter().filter_map(|entry| entry["crate"].as_str()).collect();
    versions.retain(|name, _| !skipped.contains(name));
    assert!(versions.is_empty(), "{versions:?}: update one, or say why in deny.toml");
}
