//! `rubscope precision`: errors at the times that were really reached, the reference of each
//! model size, and errors of zero.

use crate::cli_support::{refusal, rubscope};
use crate::scene_support::HALF_N;
use serde_json::Value;

/// The JSON of a comparison that must succeed, each row run once.
fn compare(arguments: &[&str]) -> Value {
    compare_to("1e-6", arguments)
}

/// As `compare`, down to a finest step.
fn compare_to(finest: &str, arguments: &[&str]) -> Value {
    let output = rubscope(
        &[&["precision", "--json", "--repeat", "1", "--finest", finest], arguments].concat(),
    );
    let told = String::from_utf8_lossy(&output.stderr);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    // Without anything to compare with it has failed, and says why.
    let failed = report["reference"]["method"] == "none";
    assert_eq!(output.status.code(), Some(i32::from(failed)), "{told}");
    assert_eq!(told.contains("rubscope: nothing to compare with: "), failed, "{told}");
    report
}

/// The readable output of a comparison.
fn text(arguments: &[&str]) -> String {
    let command = ["precision", "--repeat", "1", "--finest", "1e-6"];
    String::from_utf8(rubscope(&[&command, arguments].concat()).stdout).unwrap()
}

/// The files of a comparison: CSV and SVG.
fn files(arguments: &[&str]) -> (String, String) {
    let directory = tempfile::tempdir().unwrap();
    let written = |name: &str| {
        let path = directory.path().join(name);
        let command = ["precision", "--repeat", "1", "--finest", "1e-6", "--out"];
        let output = rubscope(&[&command[..], &[path.to_str().unwrap()], arguments].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        std::fs::read_to_string(&path).unwrap()
    };
    (written("rows.csv"), written("rows.svg"))
}

fn rows(report: &Value) -> &Vec<Value> {
    report["rows"].as_array().unwrap()
}

#[test]
fn the_reference_is_taken_at_the_instant_a_run_really_reached() {
    // No blade touches; the only error is that of central differences in free
    // flight, second order in the step. The end is no multiple of a step.
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
    let half_n = format!("{HALF_N} --end 0.02");
    let half_n: Vec<&str> = half_n.split_whitespace().collect();
    let report = compare(&half_n);
    assert_eq!(report["reference"]["verdict"], "failed");
    assert_eq!(report["reference"]["error"], Value::Null);
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

#[test]
fn an_error_of_zero_is_called_zero_and_stays_off_the_logarithmic_axis() {
    // No contact: the event solver gives the same bits at every tolerance.
    let free = ["--pulse", "1000", "--end", "0.003"];
    let report = compare(&free);
    let exact = rows(&report).iter().filter(|row| row["error_final"] == 0.0).count();
    assert_eq!(exact, 8, "the event solver's rows");
    let printed = text(&free);
    assert!(!printed.contains("e-16"), "{printed}");
    let (_, picture) = files(&free);
    assert!(picture.contains("error 0, off this scale") && !picture.contains("1e-16"), "{picture}");
    assert!(picture.contains("explicit bilateral modal, other law"), "{picture}");
    // If no row can be on such an axis, the picture is the text.
    let still = ["--pulse", "0", "--end", "0.003"];
    let printed = text(&still);
    assert!(!printed.contains("inf"), "{printed}");
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("still.svg");
    let command = ["precision", "--repeat", "1", "--finest", "1e-6", "--out"];
    let output = rubscope(&[&command[..], &[path.to_str().unwrap()], &still].concat());
    assert!(output.status.success());
    assert!(std::fs::read_to_string(path).unwrap().contains("Reference: "));
}

#[test]
fn a_wrong_verdict_under_the_same_law_is_called_wrong() {
    // Slip, where a step of 1e-5 s locks by either law.
    let text = text(&["slip", "--model", "rigid", "--end", "0.05"]);
    let ending = |start: &str| {
        let line = text.lines().find(|line| line.starts_with(start)).unwrap();
        line.split_whitespace().skip(10).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(ending("explicit  unilateral  rigid          1e-5"), "locked wrong", "{text}");
    assert_eq!(ending("explicit  bilateral   rigid          1e-6"), "locked other law");
    assert!(text.contains("explicit  bilateral   rigid          1e-6           - "), "{text}");
    assert_eq!(ending("explicit  unilateral  rigid          1e-6"), "slip");
    assert!(text.contains("\ntaken, skipped: "), "{text}");
}

#[test]
fn steps_taken_and_skipped_are_all_steps_and_the_time_is_that_of_the_taken_ones() {
    let report = compare(&["--end", "0.003"]);
    let number = |row: &Value, name: &str| row[name].as_f64();
    for row in rows(&report) {
        let Some(step) = number(row, "step_s") else {
            assert!(row["steps"].is_null() && row["steps_skipped"].is_null(), "{row}");
            assert!(row["ns_per_step"].is_null(), "{row}");
            continue;
        };
        let [taken, skipped] = ["steps", "steps_skipped"].map(|name| number(row, name).unwrap());
        if row["verdict"] != "failed" {
            assert_eq!(taken + skipped, (0.003 / step).round(), "{row}");
        }
        let each = 1e9 * number(row, "wall_s").unwrap() / taken;
        let told = number(row, "ns_per_step").unwrap();
        assert!((told / each - 1.0).abs() < 1e-12, "{row}");
    }
}

/// On a lining the error is of second order in the step.
#[test]
fn what_the_event_solver_does_not_know_is_measured_against_the_finest_step() {
    let lining = ["soft-lining", "--end", "0.01"];
    let report = compare_to("1e-7", &lining);
    let reference = &report["reference"];
    assert_eq!(reference["method"], "finest_step");
    assert_eq!(
        (&reference["solver"], &reference["contact"]),
        (&"explicit".into(), &"smooth".into())
    );
    assert_eq!((&reference["step_s"], &reference["sensitive"]), (&1e-7.into(), &false.into()));
    let known = reference["error"].as_f64().unwrap();
    for model in ["rigid", "modal", "full"] {
        let errors: Vec<f64> = rows(&report)
            .iter()
            .filter(|row| row["model"] == model && row["plain"] == false)
            .map(|row| row["error_final"].as_f64().unwrap())
            .collect();
        // Steps of 1e-5, 1e-6, 5e-7 and 1e-7 s, the last of them the reference.
        assert_eq!((errors.len(), errors[3]), (4, 0.0), "{report}");
        assert!((errors[0] / errors[1]).log10() > 1.8, "{errors:?}");
        assert!(errors[2] > known, "{errors:?} {known}");
    }
    // The scene as it is, by every step.
    let plain: Vec<_> = rows(&report).iter().filter(|row| row["plain"] == true).collect();
    assert_eq!((plain.len(), &plain[0]["steps_skipped"]), (1, &0.into()), "{plain:?}");
    assert!(
        rows(&report).iter().all(|row| row["contact"] == "smooth" && row["other_law"] == false)
    );
    let text = text(&lining);
    assert!(text.contains("smooth, modal model, the finest step, 1e-6 s: locked"), "{text}");
    assert!(text.contains("Twice its step moves its end by "), "{text}");
    let (table, picture) = files(&lining);
    assert!(table.lines().count() == 8 && picture.contains("explicit smooth full"), "{table}");
}

#[test]
fn each_model_size_has_a_reference_of_its_own() {
    // The rigid disk decays where the moving blades whirl for good: no error.
    let report = compare(&["rub", "--end", "0.3"]);
    assert_eq!(
        (&report["reference"]["method"], &report["reference"]["model"]),
        (&"events".into(), &"modal".into())
    );
    for row in
        rows(&report).iter().filter(|row| row["model"] == "rigid" && row["contact"] == "unilateral")
    {
        assert_eq!(
            (&row["verdict"], &row["verdict_right"]),
            (&"decay".into(), &true.into()),
            "{row}"
        );
    }
    // Single blades have the explicit solver, whose finest step is compared with itself.
    let mut full = rows(&report).iter().filter(|row| row["model"] == "full");
    assert_eq!(full.next_back().unwrap()["error_final"], 0.0);
}

#[test]
fn a_run_too_long_for_a_reference_is_refused() {
    let said = refusal(&["precision", "coincidence", "--end", "1e4", "--step", "1e-4"]);
    let start = "rubscope: solver.end_s = 10000: allowed is fewer than 3e6 steps";
    assert!(said.starts_with(start), "{said}");
}

#[test]
fn a_sensitive_scene_has_no_errors_at_the_end() {
    // It locks at other times with a pulse larger by one part in a billion.
    let scene = ["--model", "rigid", "--nd", "5", "--set", "bladed_disk.blades=12"];
    let run = ["--zeta-casing", "0", "--pulse", "5280.215591911308", "--end", "0.114584672293341"];
    let sensitive = [&scene[..], &run].concat();
    let report = compare(&sensitive);
    assert_eq!(report["reference"]["sensitive"], true);
    assert!(rows(&report).iter().all(|row| row["error_final"].is_null()), "{report}");
    assert!(rows(&report).iter().any(|row| row["error_impact_time_s"].is_number()), "{report}");
    assert!(text(&sensitive).contains("This scene is sensitive"));
}
