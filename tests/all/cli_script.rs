//! Changes of a running motion from the command line: their order, errors
//! before the run, and the same effect as the calls on the motion.

use crate::cli_support::{json, refusal, rubscope, text, words};
use rubscope::cli::script::{RequestedChange, RequestedScript, parse};
use rubscope_solver::motion::{self, Motion};
use rubscope_solver::scene::{Allowed, ContactLaw, KEYS, Key, ModelSize, Scene, SolverKind, Value};

fn parsed(options: &[&str]) -> Result<Vec<(f64, RequestedChange)>, String> {
    let options: Vec<String> = options.iter().map(ToString::to_string).collect();
    parse(&options).map_err(|error| error.to_string())
}

fn script(options: &[&str], scene: &Scene) -> Result<RequestedScript, String> {
    RequestedScript::resolve(&parsed(options)?, &scene.checked().unwrap())
        .map_err(|error| error.to_string())
}

fn explicit() -> Scene {
    let mut scene = Scene::base();
    scene.solver.step_s = 1e-6;
    scene
}

fn event() -> Scene {
    let mut scene = Scene::base();
    scene.solver.kind = SolverKind::Event;
    scene
}

#[test]
fn changes_are_put_in_order_of_time_and_keep_their_order_at_one_instant() {
    let options = [
        "0.02:pulse",
        "1e-2:operation.pulse_n = -5e3",
        "0:operation.speed_rad_s=480",
        "0.010:pulse",
        "-0:solver.contact=bilateral",
    ];
    let told: Vec<String> =
        parsed(&options).unwrap().iter().map(|(t, change)| format!("{t} {change}")).collect();
    assert_eq!(
        told,
        [
            "0 operation.speed_rad_s=480",
            "0 solver.contact=bilateral",
            "0.01 operation.pulse_n=-5e3",
            "0.01 pulse",
            "0.02 pulse"
        ]
    );
}

#[test]
fn other_forms_are_refused_with_the_form_that_is_allowed() {
    for text in ["", "pulse", "0.01", "0.01:", "0.01:fire", "soon:pulse", "0.01 pulse"] {
        let said = parsed(&["0.01:pulse", text]).unwrap_err();
        let start = format!("--at = {text}: allowed is TIME:PATH=VALUE or TIME:pulse");
        assert!(said.starts_with(&start), "{said}");
    }
}

#[test]
fn what_cannot_be_done_is_refused_in_one_line() {
    let live = "allowed is pulse, or a key that a running explicit motion takes: bladed_disk.";
    let rotor = "allowed is pulse, or a key that a running event motion takes: \
                 operation.speed_rad_s, operation.speed_ramp_rad_s2";
    for (scene, text, said) in [
        (explicit(), "0.2:pulse", "allowed is a time from 0 to solver.end_s = 0.1"),
        (explicit(), "-1:pulse", "allowed is a time from 0 to solver.end_s = 0.1"),
        (explicit(), "NaN:pulse", "allowed is a time from 0 to solver.end_s = 0.1"),
        (explicit(), "0:bladed_disk.blades=22", live),
        (explicit(), "0:casing.radius_m=0.6", live),
        (explicit(), "0:solver.end_s=1", live),
        (explicit(), "0:initial.u_c_m=0", live),
        (explicit(), "0:title=x", live),
        (event(), "0:casing.damping_ratio=0.01", rotor),
        (event(), "0:operation.pulse_n=1", rotor),
    ] {
        let refused = script(&[text], &scene).unwrap_err();
        let start = format!("--at = {text}: {said}");
        assert!(refused.starts_with(&start) && refused.lines().count() == 1, "{refused}");
    }
    for (scene, text, said) in [
        (explicit(), "0:casing.colour=1", "unknown key casing.colour; allowed: "),
        (event(), "0:casing.colour=1", "unknown key casing.colour; allowed: "),
        (explicit(), "0:casing.damping_ratio=-1", "casing.damping_ratio = -1: allowed is a n"),
        (event(), "0:operation.speed_rad_s=fast", "operation.speed_rad_s = fast: allowed is"),
        (explicit(), "0:solver.contact=glue", "solver.contact = \"glue\": allowed is one of"),
        (explicit(), "0:operation.speed_rad_s=9e5", "solver.step_s = 1e-6: allowed is at most"),
    ] {
        let refused = script(&[text], &scene).unwrap_err();
        assert!(refused.starts_with(&format!("--at {text}: {said}")), "{refused}");
    }
    // Each change is checked on the scene that those before it left.
    let both = ["0.01:excitation.amplitude_nm=1", "0.02:operation.speed_rad_s=1e5"];
    assert!(script(&both, &explicit()).is_ok());
    let stiff = "0:bladed_disk.stiffness_nm_per_rad=1e12";
    let said = script(&[stiff, "0.02:pulse"], &explicit()).unwrap_err();
    assert!(said.contains("solver.step_s = 1e-6: allowed is above 0 and below"), "{said}");
}

#[test]
fn a_key_acts_live_just_where_the_motion_takes_it() {
    // Another value of a key, allowed in the default scene.
    let other = |key: &Key, scene: &Scene| match ((key.get)(scene), key.allowed) {
        (Value::Real(x), _) => (if x == 0.0 { 1e-6 } else { 1.01 * x }).to_string(),
        (Value::Whole(n), _) => (n + 1).to_string(),
        (Value::Text(word), Allowed::OneOf(words)) => {
            (*words.iter().find(|other| **other != word).unwrap()).to_string()
        }
        (_, Allowed::Numbers { .. }) => "[1e-6]".to_string(),
        (_, Allowed::Modes(_)) => "[{ nodal_diameters = 7 }]".to_string(),
        _ => "map".to_string(),
    };
    for model in [ModelSize::Modal, ModelSize::Full] {
        let mut scene = explicit();
        scene.solver.model = model;
        for key in KEYS {
            let value = other(key, &scene);
            let mut changed = scene.clone();
            changed.set(key.path, &value).unwrap();
            assert_ne!(changed, scene, "{}", key.path);
            let takes = motion::Change::is_live(&scene, &changed);
            let text = format!("0.01:{}={value}", key.path);
            match script(&[&text], &scene) {
                Ok(script) => {
                    let changes = script.changes();
                    let (_, last) = changes.changes().last().unwrap();
                    let adopted = motion::Change::Parameters(changed.checked().unwrap().into());
                    assert!(takes && *last == adopted, "{text}");
                }
                // Accepted without effect: keys that a running motion does not use.
                Err(_) if takes && changed.checked().is_ok() => assert!(
                    ["title", "note", "view.charts", "view.begin_s", "solver.end_s"]
                        .contains(&key.path)
                        || key.path.starts_with("initial.")
                        || key.path.ends_with(".modes"),
                    "{text}"
                ),
                Err(_) => {}
            }
        }
    }
}

/// The motion of a scene moved to `end` by a script.
fn moved(scene: &Scene, script: &RequestedScript, end: f64) -> Motion {
    let mut motion = Motion::new(&scene.checked().unwrap());
    for (t_s, change) in script.changes().changes() {
        motion.advance(*t_s).unwrap();
        motion.apply(change);
    }
    motion.advance(end).unwrap();
    motion
}

#[test]
fn the_event_solver_turns_its_rotor_and_fires_to_the_bit() {
    let scene = event();
    let options = [
        "0.003:pulse",
        "0.001:operation.speed_rad_s=430",
        "0.001:operation.speed_ramp_rad_s2=-400",
        "0.004:operation.speed_ramp_rad_s2=-400",
    ];
    let by_script = moved(&scene, &script(&options, &scene).unwrap(), 0.01);
    let mut by_hand = Motion::new(&scene.checked().unwrap());
    by_hand.advance(0.001).unwrap();
    by_hand.set_speed(430.0, 0.0);
    by_hand.set_speed(430.0, -400.0);
    by_hand.advance(0.003).unwrap();
    by_hand.fire();
    by_hand.advance(0.01).unwrap();
    assert_eq!(by_script.state(), by_hand.state());
    // The same ramp again was no change: the speed continued to fall.
    assert_eq!(by_script.rotor().speed(0.01), 430.0 - 400.0 * 0.009);
    // The same speed again is one.
    let again = ["0.001:operation.speed_ramp_rad_s2=-400", "0.005:operation.speed_rad_s=500"];
    let again = moved(&scene, &script(&again, &scene).unwrap(), 0.01);
    assert_eq!(again.rotor().speed(0.01), 500.0 - 400.0 * 0.005);
}

#[test]
fn json_names_each_change() {
    let options = ["0.02:pulse", "0.01:operation.speed_rad_s=480", "0:solver.contact=bilateral"];
    let told = serde_json::to_value(script(&options, &explicit()).unwrap()).unwrap();
    assert_eq!(
        told,
        serde_json::json!([
            { "t_s": 0.0, "path": "solver.contact", "value": "bilateral" },
            { "t_s": 0.01, "path": "operation.speed_rad_s", "value": 480.0 },
            { "t_s": 0.02, "pulse": true }
        ])
    );
}

#[test]
fn the_option_is_checked_before_the_simulation() {
    // So many steps that a debug build would need minutes.
    let long = ["run", "slip", "--solver", "explicit", "--step", "1e-9", "--end", "10"];
    for (options, said) in [
        (&["--at", "11:pulse"][..], "--at = 11:pulse: allowed is a time from 0 to solver.end_s ="),
        (&["--at", "pulse"], "--at = pulse: allowed is TIME:PATH=VALUE or TIME:pulse"),
        (&["--at", "1:pulse", "--at", "2:x=1"], "--at 2:x=1: unknown key x; allowed: schema"),
    ] {
        let refused = refusal(&[&long[..], options].concat());
        assert!(refused.starts_with(&format!("rubscope: {said}")), "{refused}");
    }
}

#[test]
fn the_speed_that_is_told_is_that_of_the_end() {
    let told = |more: &str| text(&words(&format!("run --end 0.002 --no-sensitivity {more}")));
    assert!(told("").contains("Rotor speed: 500 rad/s"));
    for solver in ["explicit", "event"] {
        let change = format!("--solver {solver} --at 0.001:operation.speed_rad_s=300");
        let text = told(&change);
        assert!(text.contains("Rotor speed at the end: 300 rad/s, 1.02432 of Omega_c"), "{text}");
        let text = told(&format!("{change} --at 0.001:operation.speed_ramp_rad_s2=-1e4"));
        assert!(text.contains("Rotor speed at the end: 290 rad/s"), "{text}");
    }
}

#[test]
fn a_run_without_changes_says_nothing_of_them() {
    let report = json(&["run", "--end", "1e-4", "--json"]);
    assert_eq!(report["schema"], "rubscope.run/1");
    assert!(report.get("changes").is_none());
    assert!(!text(&["run", "--end", "1e-4"]).contains("hanged"));
}

#[test]
fn a_change_that_would_leave_the_papers_model_or_return_to_it_is_refused_with_the_reason() {
    let mut scene = explicit();
    scene.solver.contact = ContactLaw::Unilateral;
    let said = script(&["0.001:bladed_disk.radial_coupling=0.1"], &scene).unwrap_err();
    assert!(said.contains("a running motion does not leave it"), "{said}");
    assert!(!said.contains("bladed_disk.radial_coupling, "), "{said}");
    scene.bladed_disk.radial_coupling = 0.1;
    let said = script(&["0.001:bladed_disk.radial_coupling=0"], &scene).unwrap_err();
    assert!(said.contains("a running motion does not return to it"), "{said}");
    // What the reasons name is taken.
    script(&["0.001:bladed_disk.radial_coupling=1e-9"], &scene).unwrap();
    scene.bladed_disk.radial_coupling = 1e-9;
    script(&["0.001:bladed_disk.radial_coupling=0.1"], &scene).unwrap();
}

#[test]
fn a_live_change_is_judged_by_the_running_state() {
    // The initial place is inside the clearance of 400 rad/s, and outside that of 480.
    let started = words(
        "run run-down --solver explicit --step 1e-6 --end 0.03 --no-sensitivity --json \
         --set operation.speed_ramp_rad_s2=0 --set initial.u_c_m=2.2e-5 \
         --set initial.u_s_m=7.5e-5 --set casing.clearance_loss_m_s2=1e-10",
    );
    let report = json(&[&started[..], &["--at", "0.01:operation.speed_rad_s=480"]].concat());
    assert_ne!(report["outcome"]["verdict"], "failed");
    let residual = report["checks"]["energy_residual_j"].as_f64().unwrap();
    assert!(residual.abs() < 1e-3, "{residual}");
    // At the start the running state is the initial one.
    let early = rubscope(&[&started[..], &["--at", "0:operation.speed_rad_s=480"]].concat());
    assert!(String::from_utf8_lossy(&early.stderr).contains("initial.u_c_m"));
}
