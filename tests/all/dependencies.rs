//! The dependencies are what `deny.toml` allows, checked without cargo-deny:
//! licences, crates in two versions, sources; and no crate needs a newer compiler
//! than this one says.

use std::collections::{BTreeMap, BTreeSet};
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

/// Whether a licence expression is allowed. Of every part of an AND one choice must be, which
/// is never laxer than what the expression means.
fn licensed(expression: &str, allowed: &[&str]) -> bool {
    let plain = expression.replace('/', " OR ").replace(['(', ')'], "");
    plain.split(" AND ").all(|part| part.split(" OR ").any(|name| allowed.contains(&name.trim())))
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
