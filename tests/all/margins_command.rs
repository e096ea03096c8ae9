//! `rubscope margins`: the nearest changes of the verdict, what it refuses, and what it says
//! of odd scenes.

use serde_json::Value;

use crate::cli_support::{json, program, refusal, text};
use crate::margins::close;

const DAMPING: &str = "casing.damping_ratio";

#[test]
fn the_answer_does_not_depend_on_threads() {
    let arguments = ["margins", "--json", "--end", "0.02"];
    let answers = ["1", "3"].map(|threads| {
        let mut program = program();
        let out = program.args(arguments).env("RAYON_NUM_THREADS", threads).output().unwrap();
        let mut answer: Value = serde_json::from_slice(&out.stdout).unwrap();
        // What it took differs.
        answer["cost"] = Value::Null;
        answer
    });
    assert_eq!(answers[0], answers[1]);
}

#[test]
fn what_has_no_meaning_is_refused_in_one_line() {
    for (arguments, start) in [
        (
            &["--target", "omega=1", "--by", DAMPING][..],
            "rubscope: target omega=1: allowed is NAME=VALUE",
        ),
        (
            &["--target", "omega_c=inf", "--by", DAMPING],
            "rubscope: target omega_c=inf: allowed is NAME=VALUE",
        ),
        (
            &["--target", "omega_c=1", "--by", "solver.kind"],
            "rubscope: parameter solver.kind: allowed is one of clearance,",
        ),
        (&["--target", "omega_c=1"], "rubscope: "),
        (&["--out", "a.txt"], "rubscope: --out = a.txt"),
    ] {
        let told = refusal(&[&["margins"], arguments].concat());
        assert!(told.starts_with(start), "{told}");
    }
}

#[test]
fn odd_scenes_have_reasons_instead_of_values() {
    for (arguments, name, reason) in [
        (&["--nd", "0"][..], "omega_c", "no wave turns without nodal diameters"),
        (&["--nd", "11"], "omega_lock", "11 nodal diameters make no corner of blades"),
        (&["--nd", "11"], "push_a", "11 nodal diameters make no corner of blades"),
        (
            &["--set", "initial.u_c_m=1e-5"],
            "touching_pulse",
            "only for a casing that starts at rest",
        ),
        (
            &["--set", "operation.pulse_s=0"],
            "touching_pulse",
            "no pulse of this length touches within the run",
        ),
        (&["long-tip"], "touching_pulse", "a tip touches without a pulse"),
        (
            &["long-tip", "--set", "bladed_disk.longest_tip_m=1e-5"],
            "touching_pulse",
            "of equal tips in a round casing only",
        ),
    ] {
        let mut all = vec!["margins", "--json", "--no-search"];
        all.extend(arguments);
        let answer = json(&all);
        let limits = answer["limits"].as_array().unwrap();
        let limit = limits.iter().find(|limit| limit["name"] == name).unwrap();
        assert_eq!(limit["note"], reason, "{arguments:?}");
        assert_eq!((&limit["value"], &limit["margin"]), (&Value::Null, &Value::Null));
    }
}

#[test]
fn the_answer_begins_with_the_nearest_changes_of_the_verdict() {
    let said = |arguments: &[&str]| text(&[&["margins"], arguments].concat());
    let text = said(&["--speed", "480"]);
    let place = |words: &str| text.find(words).unwrap_or_else(|| panic!("no {words} in {text}"));
    let bilateral = place(
        "480 rad/s, bilateral law: locked; a casing out of round by 0.2 um (4 lobes; 0.2 % of",
    );
    let pushes = place("480 rad/s, pushes only, by events: decay; ");
    assert!(bilateral < pushes && pushes < place("omega_c  "), "{text}");
    assert!(
        text.replace('\n', " ").contains("no pulse tried from 0 to 2 times this one"),
        "{text}"
    );
    assert!(text.contains("\nspeed [rad/s]") && text.contains("\nclearance [um]"), "{text}");
    let rpm = said(&["--speed", "480 rad/s", "--rpm"]);
    assert!(
        rpm.contains("4584 rpm, bilateral law: locked") && rpm.contains("\nspeed [rpm]"),
        "{rpm}"
    );
    let without = said(&["--speed", "480", "--no-search"]);
    assert!(!without.contains("nearest") && without.contains("omega_c  "), "{without}");
    let answer = json(&["margins", "--speed", "480", "--json"]);
    let verdicts = [&answer, &answer["pushes_only"]].map(|law| {
        let changes = law["changes"].as_array().unwrap();
        assert_eq!(changes.len(), 5, "{law}");
        (law["contact"].as_str().unwrap(), law["verdict"].as_str().unwrap())
    });
    assert_eq!(verdicts, [("bilateral", "locked"), ("unilateral", "decay")]);
    let speed = &answer["changes"][0];
    assert_eq!((&speed["path"], &speed["above"]), (&"operation.speed_rad_s".into(), &Value::Null));
    close(speed["below"]["value"].as_f64(), 411.933_517, 1e-3, "the speed of the lock");
    assert_eq!(speed["below"]["verdict"], "adhesive");
    let bare = json(&["margins", "--speed", "480", "--no-search", "--json"]);
    assert!(bare["changes"].is_null() && bare["verdict"].is_null(), "{bare}");
}
