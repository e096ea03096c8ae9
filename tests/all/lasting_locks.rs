//! What the program says of a lock that pushes hold and that grows, of impacts that accumulate,
//! and of a push that blades share in several ways.

use crate::cli_support::rubscope;
use serde_json::Value;
use std::f64::consts::TAU;

/// A lock that grows at every speed, held from the start.
const GROWS: [&str; 13] = [
    "--contact",
    "unilateral",
    "--set",
    "bladed_disk.radial_coupling=-0.15",
    "--set",
    "contact.friction=0.4",
    "--set",
    "casing.tangential_ratio=0.2",
    "--set",
    "bladed_disk.damping_ratio=0.001",
    "--speed",
    "800",
    "--pulse=0",
];

fn text(arguments: &[&[&str]]) -> String {
    let output = rubscope(&arguments.concat());
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{errors}");
    String::from_utf8(output.stdout).unwrap()
}

fn json(arguments: &[&[&str]]) -> Value {
    serde_json::from_str(&text(&[&arguments.concat(), &["--json"]])).unwrap()
}

#[test]
fn no_answer_names_a_limit_of_a_lock_that_grows_everywhere() {
    let stiff = ["--set", "bladed_disk.centrifugal_stiffening=0.01"];
    for more in [&[][..], &stiff] {
        let margins = text(&[&["margins", "--no-search"], &GROWS, more]);
        assert!(margins.contains("omega_lock: none, as a lock flutters"), "{margins}");
        assert!(margins.contains("flutter_speed: at every speed."), "{margins}");
        assert!(!margins.contains("e-6") && !margins.contains("e6"), "{margins}");
        let whirl = text(&[&["hbm", "--whirl"], &GROWS, more]);
        assert!(whirl.contains("no lock holds at any speed"), "{whirl}");
        assert!(whirl.contains("blades and casing as one flutter at every speed."), "{whirl}");
        assert!(!whirl.contains(", lock "), "{whirl}");
        let point = &json(&[&["hbm"], &GROWS, more])["points"][0];
        assert_eq!((&point["admissible"], &point["stable"]), (&true.into(), &false.into()));
        assert!((point["growth_1_s"].as_f64().unwrap() - 9.0).abs() < 1.0, "{point}");
        let survey = json(&[&["survey"], &GROWS, more]);
        let row = &survey["rows"][3];
        let has = |name: &str| row["limits"].as_array().unwrap().iter().any(|l| l["name"] == name);
        assert!(!has("omega_lock") && has("flutter_speed"), "{row}");
        let check = text(&[&["check"], &GROWS, more]);
        assert!(check.contains("No lock: a lock"), "{check}");
    }
}

/// Returns a run that begins in a corner of blades at rest, and is held there as they bend.
pub fn held_and_grows() -> Vec<String> {
    // Between the sides 15 and 16 of 22.
    let (corner, half) = (15.5 * TAU / 22.0, 0.5 * TAU / 22.0);
    let reach = (1.0 - 1e-12) * 1e-4 / half.cos();
    let [x, y] = [corner.cos(), corner.sin()].map(|part| -reach * part);
    let turn = 3.0 * 800.0;
    let start = [
        "bladed_disk.radial_coupling=-0.01".to_string(),
        "bladed_disk.damping_ratio=0.0001".to_string(),
        format!("initial.u_c_m={x}"),
        format!("initial.u_s_m={y}"),
        format!("initial.v_c_m_s={}", -turn * y),
        format!("initial.v_s_m_s={}", turn * x),
    ];
    let fixed = ["run", "--end", "0.02", "--step", "1e-6", "--no-sensitivity", "--json"];
    let fixed = fixed.iter().chain(GROWS.iter()).map(ToString::to_string);
    fixed.chain(start.into_iter().flat_map(|set| ["--set".to_string(), set])).collect()
}

#[test]
fn a_run_that_ends_in_a_lock_that_grows_says_so() {
    let run = held_and_grows();
    let mut run: Vec<&str> = run.iter().map(String::as_str).collect();
    let report: Value = serde_json::from_str(&text(&[&run])).unwrap();
    assert_eq!(report["outcome"]["verdict"], "locked", "{}", report["outcome"]);
    let growth = report["outcome"]["growth_1_s"].as_f64().unwrap();
    assert!((growth - 1.00757).abs() < 1e-5, "{growth}");
    run.retain(|argument| *argument != "--json");
    let said = text(&[&run]);
    assert!(said.contains("But this lock is unstable: it grows by 1.01 1/s"), "{said}");
}

#[test]
fn impacts_of_a_lock_accumulate_and_those_of_a_bounce_do_not() {
    let locked = ["run", "paper-nd3", "--contact", "unilateral", "--no-sensitivity"];
    for solver in ["explicit", "event"] {
        let report = json(&[&locked, &["--solver", solver]]);
        if report["outcome"]["verdict"] == "locked" {
            let at = report["impacts_accumulate_at_s"].as_f64().unwrap();
            assert_eq!(at, report["outcome"]["lock_time_s"].as_f64().unwrap());
            let said = text(&[&locked, &["--solver", solver]]);
            assert!(said.contains("At least ") && said.contains("They accumulate at "), "{said}");
        }
    }
    let bounce = json(&[&["run", "grazing", "--no-sensitivity"]]);
    assert!(bounce["impact_count"] == 1 && bounce["impacts_accumulate_at_s"].is_null());
}

#[test]
fn the_even_share_of_a_push_is_named_as_one_answer_of_several() {
    let run = |model: &'static str, diameters: &'static str, friction: &'static str| {
        let several = ["run", "--model", model, "--nd", diameters, "--set", friction];
        let rest = ["--contact", "unilateral", "--end", "1ms", "--no-sensitivity"];
        [several.to_vec(), rest.to_vec()].concat()
    };
    let several = run("full", "2", "contact.friction=0.3");
    let note = &json(&[&several])["notes"][0];
    assert!(note.as_str().unwrap().contains("one answer of several"), "{note}");
    assert!(text(&[&several]).contains("takes the even share"));
    for other in [
        run("full", "3", "contact.friction=0.3"),
        run("modal", "2", "contact.friction=0.3"),
        run("full", "2", "contact.friction=0"),
    ] {
        assert!(json(&[&other])["notes"].is_null(), "{other:?}");
    }
}
