//! `rubscope precision`: errors at the instants that were really reached, rows
//! of another contact law, and errors of zero.

#![expect(clippy::unwrap_used, reason = "a test states what must hold")]

mod cli_support;

use cli_support::{refusal, rubscope};
use serde_json::Value;

/// The JSON of a comparison that must succeed, each row run once.
fn compare(arguments: &[&str]) -> Value {
    let output = rubscope(
        &[&["precision", "--json", "--repeat", "1", "--finest", "1e-6"], arguments].concat(),
    );
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn rows(report: &Value) -> &Vec<Value> {
    report["rows"].as_array().unwrap()
}

#[test]
fn the_reference_is_taken_at_the_instant_a_run_really_reached() {
    // No blade touches; what is left is the error of central differences in
    // free flight, second order in the step. The end is no multiple of a step.
    let report = compare(&["--pulse", "1000", "--end", "0.0030037"]);
    assert_eq!(report["reference"]["impact_count"], 0);
    for (step, right) in [(1e-6, 4.03e-8), (1e-5, 4.06e-6)] {
        let of_step = || rows(&report).iter().filter(|row| row["step_s"] == step);
        assert_eq!(of_step().count(), 6, "two laws, three model sizes");
        for row in of_step() {
            let error = row["error_final"].as_f64().unwrap();
            assert!((error / right - 1.0).abs() < 5e-3, "{error:e} with {row}");
        }
    }
}

#[test]
fn a_run_that_stopped_early_has_no_error_at_the_end() {
    // The wave leaves the casing at 19.9 ms, by every solver.
    let report = compare(&["half-n", "--end", "0.02"]);
    assert_eq!(report["reference"]["verdict"], "failed");
    assert_eq!(report["reference"]["error_halved"], Value::Null);
    assert!(rows(&report).len() > 8);
    for row in rows(&report) {
        assert_eq!(row["error_final"], Value::Null, "{row}");
    }
    // A step longer than the run cannot take part in it.
    let report = compare(&["--pulse", "1000", "--end", "5e-6"]);
    assert!(rows(&report).iter().all(|row| row["step_s"] != 1e-5), "{report}");
}

#[test]
fn a_finest_step_without_meaning_is_refused() {
    for text in ["0", "NaN"] {
        let said = refusal(&["precision", "--finest", text]);
        assert_eq!(said, format!("rubscope: --finest = {text}: allowed is a time step above 0"));
    }
}
