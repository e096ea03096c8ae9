//! Changes of a running motion from the command line: which keys act, and the same effect as
//! the calls on the motion. Refusals are in `tests/transcripts`.

use rubscope::cli::script::RequestedScript;
use rubscope_solver::motion::{self};
use rubscope_solver::scene::{Allowed, KEYS, Key, ModelSize, Scene, Value};

fn script(options: &[&str], scene: &Scene) -> Result<RequestedScript, String> {
    let options: Vec<String> = options.iter().map(ToString::to_string).collect();
    let script = RequestedScript::of(&options, &scene.checked().unwrap());
    script.map_err(|error| error.to_string())
}

fn explicit() -> Scene {
    let mut scene = Scene::base();
    scene.solver.step_s = 1e-6;
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
                    let (_, last) = script.changes.changes().last().unwrap();
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
