//! `rubscope run`: verdicts, JSON, history files, exit status.

use crate::cli_support::{json, refusal, rubscope, text};
use rubscope_solver::motion::simulate;
use rubscope_solver::scene::Scene;

/// A quick scene: few steps, a decay.
const QUICK: [&str; 6] = ["--contact", "unilateral", "--pulse", "20000", "--end", "0.002"];

fn quick(more: &[&'static str]) -> Vec<&'static str> {
    [&["run"], QUICK.as_slice(), more].concat()
}

#[test]
fn the_summary_tells_a_lock_and_a_pull_apart() {
    let text = text(&["run"]);
    assert!(text.contains("Steps with a pulling multiplier: 2."), "{text}");
    let [state, history] = [
        "Blades 12 and 19 hold the casing's wave; both push.",
        "Contact that only pushes would not catch it: decay.",
    ];
    assert!(text.contains(&format!("Verdict: locked. {state}\n{history}\n")), "{text}");
    let report = json(&["run", "--json"]);
    let told = ["state", "history"].map(|name| report["outcome"][name].as_str().unwrap());
    assert_eq!(told, [state, history]);
    let text = self::text(&["run", "adhesive", "--end", "0.005"]);
    assert!(text.contains("Verdict: adhesive. "), "{text}");
    assert!(
        text.contains("Blade 19 pushes the wave and blade 12 pulls it: no real contact can."),
        "{text}"
    );
}

#[test]
fn a_run_that_breaks_down_is_told_and_ends_with_status_1() {
    // The bilateral scheme predicts a penetration deeper than the clearance here.
    let wild = ["run", "--step", "1e-6", "--pulse", "1e6", "--json"];
    let output = rubscope(&wild);
    assert_eq!(output.status.code(), Some(1));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["outcome"]["verdict"], "failed");
    assert!(report["outcome"]["message"].as_str().unwrap().contains("failed at t = "));
    assert!(output.stderr.is_empty());
}

#[test]
fn a_speed_that_was_changed_since_is_not_named_as_that_of_the_lock() {
    let history = |args: &[&str]| json(&[&["run", "--no-sensitivity", "--json"], args].concat());
    let caught = history(&["long-tip"])["outcome"]["history"].clone();
    assert!(caught.as_str().unwrap().starts_with("Caught in a run-up at 294.1"), "{caught}");
    for (scene, end, at, words) in [
        ("long-tip", "1", "0.5:operation.speed_rad_s=400", "394"),
        ("paper-nd3", "0.1", "0.05:operation.speed_ramp_rad_s2=400", "Caught"),
        ("run-down", "0.2", "0.1:operation.speed_rad_s=600", "620"),
    ] {
        let outcome = history(&[scene, "--end", end, "--at", at])["outcome"].clone();
        let told = format!("{} {}", outcome["state"], outcome["history"]);
        assert!(!told.contains(words), "{scene}: {told}");
    }
}

#[test]
fn a_history_has_the_asked_number_of_samples_and_reads_back() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("history.csv");
    let file = path.to_str().unwrap();
    let output = rubscope(&[&quick(&["--samples", "21", "--gaps", "--out"])[..], &[file]].concat());
    assert!(output.status.success());
    let mut reader = csv::Reader::from_path(&path).unwrap();
    let names: Vec<String> = reader.headers().unwrap().iter().map(String::from).collect();
    assert_eq!(names[..5], ["t_s", "theta_rad", "speed_rad_s", "u_c_m", "u_s_m"]);
    assert_eq!(names.len(), 11 + 22);
    assert_eq!(names.last().unwrap(), "gap_22_m");
    let rows: Vec<Vec<f64>> = reader
        .records()
        .map(|record| record.unwrap().iter().map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 21);
    assert_eq!(rows[0][0], 0.0);
    // A step may end up to one step before the sample's instant.
    assert!((rows[20][0] - 0.002).abs() <= 1.01e-7);
    for row in &rows {
        let smallest = row[11..].iter().copied().fold(f64::INFINITY, f64::min);
        assert_eq!(row[7], smallest);
        assert!(smallest > -1e-15, "an accepted state does not penetrate");
    }
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
}

/// Every report in JSON names the program and the command that gives it again.
#[test]
fn reports_say_where_they_come_from() {
    for arguments in [
        &["run", "slip", "--end", "1e-3", "--at", "5e-4:pulse", "--json"][..],
        &["hbm", "--speed", "300:500:3", "--undamped", "--form", "blade", "--json"],
        &["hbm", "--speed", "300:500:3", "--damped", "--form", "printed", "--json"],
        &["hbm", "--speed", "-430", "--slip", "--json"],
        &["map", "--speed", "400:500:2", "--pulse", "1e4:2e4:2", "--end", "1e-3", "--json"],
        &["map", "slip", "--speed", "430", "--end", "1e-3", "--json"],
        &["map", "--set", "title=mine", "--set", "view.charts=map,gaps", "--end", "1e-3", "--json"],
        &["precision", "--end", "1e-3", "--repeat", "1", "--finest", "1e-6", "--json"],
        &["margins", "slip", "--end", "1e-2", "--no-search", "--json"],
        &["margins", "--target", "omega_lock=350", "--by", "casing.damping_ratio", "--json"],
    ] {
        let report = json(arguments);
        let program = &report["program"];
        assert_eq!(program["name"], "rubscope");
        assert_eq!(program["version"], env!("CARGO_PKG_VERSION"));
        assert_eq!(program["commit"], env!("RUBSCOPE_COMMIT"));
        assert!(report["scene"]["operation"]["pulse_n"].is_number());
        let command = program["command"].as_str().unwrap();
        let words: Vec<&str> = command.split(' ').skip(1).collect();
        assert_eq!(timeless(json(&words)), timeless(report.clone()), "{command}");
    }
}

/// A report without the times it took.
fn timeless(mut report: serde_json::Value) -> serde_json::Value {
    fn clear(value: &mut serde_json::Value) {
        if let Some(object) = value.as_object_mut() {
            for name in ["wall_s", "certainty_s", "search_wall_s", "ns_per_step"] {
                object.remove(name);
            }
            object.values_mut().for_each(clear);
        }
        value.as_array_mut().into_iter().flatten().for_each(clear);
    }
    clear(&mut report);
    report
}

#[test]
fn history_options_without_a_file_are_refused() {
    assert!(refusal(&["run", "--gaps"]).contains("--out <FILE>"));
    assert!(refusal(&["run", "--out", "a.csv", "--samples", "1"]).contains("2..=1000000"));
}

#[test]
fn every_penetration_above_round_off_is_told() {
    let mut scene = Scene::base();
    scene.solver.end_s = 1e-4;
    let mut report = simulate(&scene.checked().unwrap());
    for (part, is_told) in [(0.0, false), (1e-14, false), (1e-12, true), (5e-3, true)] {
        report.checks.max_penetration_m = part * scene.machine().clearance();
        let text = crate::told(&report);
        let line = text.lines().find(|line| line.starts_with("Deepest penetration:")).unwrap();
        assert_eq!(line.ends_with(" of the clearance."), is_told, "{part}: {line}");
    }
}

#[test]
fn a_plain_run_takes_every_step_and_comes_to_the_same_end() {
    let [default, plain] = [&["--json"][..], &["--json", "--plain"]].map(|more| json(&quick(more)));
    let steps = |report: &serde_json::Value, name: &str| report["solver"][name].as_u64().unwrap();
    assert!(steps(&default, "steps_skipped") > 0 && steps(&plain, "steps_skipped") == 0);
    assert_eq!(steps(&plain, "steps"), steps(&default, "steps") + steps(&default, "steps_skipped"));
    assert_eq!(default["outcome"]["verdict"], plain["outcome"]["verdict"]);
    assert!(plain["command"].as_str().is_none_or(|command| command.contains("--plain")));
    let refused = refusal(&["run", "slip", "--solver", "event", "--plain"]);
    assert!(refused.contains("--plain: of --solver explicit only"), "{refused}");
}

#[test]
fn a_lock_says_at_which_speed_a_run_up_caught_it_and_how_round_the_casing_must_be() {
    let told = |arguments: &[&str]| json(&[arguments, &["--json"]].concat());
    let run = told(&["run", "long-tip", "--no-sensitivity"]);
    let operation = &run["scene"]["operation"];
    let [speed, ramp] = ["speed_rad_s", "speed_ramp_rad_s2"].map(|key| operation[key].as_f64());
    let since = run["outcome"]["lock_time_s"].as_f64().unwrap();
    let caught = speed.unwrap() + ramp.unwrap() * since;
    assert!((caught - 294.1).abs() < 0.05, "{caught}");
    assert_eq!(run["outcome"]["history"], "Caught in a run-up at 294.1 rad/s.");
    let run = told(&["run", "rocking", "--no-sensitivity"]);
    let needed = "It needs a casing round to 0.64 um (0.64 % of the clearance). Tips may be off by 2.1 um (2.1 %).";
    assert_eq!(run["outcome"]["history"], needed);
    let margins = told(&["margins", "rocking", "--no-search"]);
    let limits = margins["limits"].as_array().unwrap().iter();
    let round = limits.filter(|limit| limit["name"] == "roundness");
    let least = round.map(|limit| limit["value"].as_f64().unwrap()).fold(f64::INFINITY, f64::min);
    assert!((least - 0.64e-6).abs() < 0.005e-6, "{least}");
}
