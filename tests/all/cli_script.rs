//! Changes of a running motion from the command line: which keys act, and the same effect as
//! the calls on the motion. Refusals are in `tests/transcripts/refusals.txt`.

use rubscope::cli::script::{RequestedChange, RequestedScript, parse};
use rubscope_solver::motion::{self, Motion};
use rubscope_solver::scene::{Allowed, KEYS, Key, ModelSize, Scene, SolverKind, Value};

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
