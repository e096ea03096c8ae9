//! Work that is told not to go on: it stops soon, and what is continued later
//! comes to the same bits as what was never stopped, for every built-in scene.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use rubscope_solver::motion::{Motion, run_to_verdict};
use rubscope_solver::scene::{BUILTIN, CheckedScene, ModelSize, Scene, SolverKind};

use crate::plain::scenes::scene;

/// The scene by every solver that knows it.
fn ways(scene: &Scene) -> Vec<CheckedScene> {
    let mut ways = vec![scene.clone(), scene.as_reference()];
    let mut full = scene.clone();
    full.solver.kind = SolverKind::Explicit;
    full.solver.model = ModelSize::Full;
    full.solver.step_s = 1e-6;
    ways.push(full);
    ways.iter().filter_map(|scene| scene.checked().ok()).collect()
}

#[test]
fn a_motion_that_is_stopped_again_and_again_reaches_the_same_bits() {
    let mut pauses = 0;
    for name in BUILTIN.iter().map(|scene| scene.name) {
        let mut scene = Scene::builtin(name).unwrap();
        scene.solver.end_s = scene.solver.end_s.min(0.03);
        for scene in ways(&scene) {
            let (mut plain, mut paused) = (Motion::new(&scene), Motion::new(&scene));
            let straight = plain.advance(scene.solver.end_s);
            let asked = AtomicU64::new(0);
            // Two of three questions are answered with yes.
            let go_on = || !(asked.fetch_add(1, Relaxed) + 1).is_multiple_of(3);
            let broken = loop {
                match paused.advance_while(scene.solver.end_s, &go_on) {
                    Ok(true) => break Ok(()),
                    Ok(false) => {
                        pauses += 1;
                        // Looking must not change it either.
                        let _ = (paused.checks(), paused.multipliers(), paused.blade_gaps());
                    }
                    Err(failure) => break Err(failure),
                }
            };
            assert_eq!(straight, broken, "{name}");
            assert_eq!(plain.state(), paused.state(), "{name} {:?}", scene.solver);
            assert_eq!(plain.contacts().impacts, paused.contacts().impacts, "{name}");
            assert_eq!(plain.contacts().impact_count, paused.contacts().impact_count, "{name}");
            assert_eq!(plain.events(), paused.events(), "{name}");
            assert_eq!(plain.steps_taken(), paused.steps_taken(), "{name} {:?}", scene.solver);
            assert_eq!(plain.steps_skipped(), paused.steps_skipped(), "{name}");
        }
    }
    assert!(pauses > 300, "{pauses}");
}

#[test]
fn a_solver_asks_within_a_bound_of_steps_or_looks() {
    // A pulse leaves no flight to skip: every step is taken.
    for (model, steps_a_question) in
        [(ModelSize::Rigid, 2049), (ModelSize::Modal, 1025), (ModelSize::Full, 171)]
    {
        let mut scene = scene(&[("operation.pulse_n", "1"), ("operation.pulse_s", "1")]);
        scene.solver.model = model;
        let mut motion = Motion::new(&scene.checked().unwrap());
        let asked = AtomicU64::new(0);
        let go_on = || {
            asked.fetch_add(1, Relaxed);
            true
        };
        assert_eq!(motion.advance_while(0.01, &go_on), Ok(true));
        let steps = motion.steps_taken().unwrap();
        assert_eq!(motion.steps_skipped(), Some(0), "{model:?}");
        assert!(
            steps >= 10_000 && asked.load(Relaxed) >= steps / steps_a_question,
            "{model:?} {asked:?}"
        );
    }
}

#[test]
fn a_verdict_that_is_not_waited_for_is_none() {
    for name in ["paper-nd3", "undamped", "slip"] {
        let mut scene = Scene::builtin(name).unwrap();
        scene.solver.end_s = 1e3;
        scene.solver.step_s = 1e-6;
        let scene = scene.as_reference().checked().unwrap();
        let left = AtomicU64::new(20);
        let go_on = || left.fetch_sub(1, Relaxed) > 1;
        assert_eq!(run_to_verdict(&scene, &go_on), None, "{name}");
        assert_eq!(left.load(Relaxed), 0, "{name}: it asks no more after a no");
    }
}
