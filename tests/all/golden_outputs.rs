//! What 150 commands print, six digits of each number, in `tests/golden/outputs.json`: the answers of
//! `hbm`, `margins`, `survey`, `check`, `map` and `precision`.
//!
//! A case is a command and its answer; `RUBSCOPE_GOLDEN=write cargo test golden` puts what the
//! program prints in the place of `null`. Numbers that depend on the machine's speed or say how a
//! run was done are left out, and those that are round-off.

use rayon::prelude::*;
use serde_json::{Map, Value, json};

use crate::cli_support::{text, words};

/// Fields that are another number in each run or tell how it was done, and those that are round-off.
const LEFT_OUT: [&str; 10] = [
    "wall_s",
    "certainty_s",
    "search_s",
    "ns_per_step",
    "program",
    "runs",
    "steps",
    "steps_skipped",
    "error",
    "residual",
];
/// Numbers below this are round-off in every unit that is printed.
const ROUND_OFF: f64 = 1e-15;

fn rounded(value: Value) -> Value {
    match value {
        Value::Number(number) if number.is_f64() => {
            let digits = format!("{:.5e}", number.as_f64().unwrap());
            json!(digits.parse::<f64>().unwrap())
        }
        Value::Array(items) => items.into_iter().map(rounded).collect(),
        Value::Object(fields) => {
            let kept = fields.into_iter().filter(|(name, _)| !LEFT_OUT.contains(&name.as_str()));
            Value::Object(kept.map(|(name, value)| (name, rounded(value))).collect::<Map<_, _>>())
        }
        other => other,
    }
}

/// What a command prints: JSON, or its lines.
fn answer(command: &str) -> Value {
    let text = text(&words(command));
    match serde_json::from_str(&text) {
        Ok(value) => rounded(value),
        Err(_) => text.lines().collect(),
    }
}

/// The first place in which two answers differ.
fn difference(path: &str, expected: &Value, seen: &Value) -> Option<String> {
    let differ = || Some(format!("{path}: {seen}, expected {expected}"));
    match (expected, seen) {
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
            let most = ROUND_OFF + 1.1e-5 * a.abs().max(b.abs());
            if (a - b).abs() <= most { None } else { differ() }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            let mut pairs = a.iter().zip(b).enumerate();
            pairs.find_map(|(place, (a, b))| difference(&format!("{path}[{place}]"), a, b))
        }
        (Value::Object(a), Value::Object(b)) => {
            // A scene may have a key that came later.
            let is_new = |name: &&String| !a.contains_key(*name) && !path.contains(".scene.");
            let more = b.keys().find(is_new);
            if let Some(name) = more {
                return Some(format!("{path}.{name} is new"));
            }
            a.iter().find_map(|(name, value)| {
                let path = format!("{path}.{name}");
                b.get(name).map_or(Some(format!("{path} is gone")), |b| difference(&path, value, b))
            })
        }
        _ if expected == seen => None,
        _ => differ(),
    }
}

#[test]
fn the_golden_outputs() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/outputs.json");
    let mut cases: Map<String, Value> =
        serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
    if std::env::var("RUBSCOPE_GOLDEN").is_ok_and(|word| word == "write") {
        for (command, expected) in &mut cases {
            let known = std::mem::take(expected);
            *expected = if known.is_null() { answer(command) } else { rounded(known) };
        }
        let lines: Vec<String> =
            cases.iter().map(|(command, answer)| format!("{}:{answer}", json!(command))).collect();
        std::fs::write(file, format!("{{\n{}\n}}\n", lines.join(",\n"))).unwrap();
    }
    assert!(cases.len() >= 150);
    let wrong: Vec<String> = cases
        .iter()
        .par_bridge()
        .filter_map(|(command, expected)| difference(command, expected, &answer(command)))
        .collect();
    assert!(wrong.is_empty(), "{} differ:\n{}", wrong.len(), wrong.join("\n"));
}
