//! What the program says of a lock that pushes hold and that grows, of impacts that accumulate,
//! and of a push that blades share in several ways.

use crate::cli_support::rubscope;
use serde_json::Value;

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
        assert!(!whirl.contains("lock-in"), "{whirl}");
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

#[test]
fn a_run_that_ends_in_a_lock_that_grows_says_so() {
    let point = &json(&[&["hbm"], &GROWS])["points"][0];
    // In the corner that the two blades hold, turning with the wave.
    let number = |path: &str| point[path].as_f64().unwrap();
    let [x, y] = ["u_cc_m", "u_sc_m"].map(number);
    let turn = 3.0 * 800.0;
    let angles = &point["groups"];
    let start = [
        format!("initial.u_c_m={}", x * (1.0 - 1e-9)),
        format!("initial.u_s_m={}", y * (1.0 - 1e-9)),
        format!("initial.v_c_m_s={}", -turn * y),
        format!("initial.v_s_m_s={}", turn * x),
    ];
    assert!(angles[0]["alpha_rad"].is_f64());
    let set: Vec<&str> = start.iter().flat_map(|set| ["--set", set.as_str()]).collect();
    let run = [&["run"][..], &GROWS, &set, &["--end", "0.02", "--step", "1e-6"]].concat();
    let report = json(&[&run]);
    assert_eq!(report["outcome"]["verdict"], "locked", "{}", report["outcome"]);
    assert!((report["outcome"]["growth_1_s"].as_f64().unwrap() - 9.0).abs() < 0.1);
    let said = text(&[&run]);
    assert!(said.contains("Held, but this lock is unstable: it grows by 9"), "{said}");
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
    let several =
        ["run", "--model", "full", "--nd", "2", "--contact", "unilateral", "--end", "1ms"];
    let rubs = ["--set", "contact.friction=0.3", "--no-sensitivity"];
    let report = json(&[&several, &rubs]);
    assert!(report["notes"][0].as_str().unwrap().contains("one answer of several"));
    assert!(text(&[&several, &rubs]).contains("takes the even share"));
    for other in [&["--nd", "3"][..], &["--model", "modal"], &["--set", "contact.friction=0"]] {
        let report = json(&[&several, &rubs, other]);
        assert!(report["notes"].is_null(), "{other:?}");
    }
}
