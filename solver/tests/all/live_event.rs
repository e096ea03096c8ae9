//! Live changes of the event solver against the plain stepper at decreasing steps: their
//! difference must vanish in proportion to the step. A case is a start, what is changed when,
//! an end, and how far the order may be from one; a new one is a row of its test.

use crate::plain::Plain;
use crate::plain::scenes::{in_corner, scene};
use rubscope_solver::motion::{ActiveSet, Motion};
use rubscope_solver::scene::{ModelSize, Scene, SolverKind};

/// Steps that divide every instant below.
const STEPS: [f64; 3] = [4e-6, 1e-6, 2.5e-7];

/// A change of a motion.
#[derive(Clone, Copy, Debug)]
enum Act {
    Fire,
    Speed(f64, f64),
}
use Act::{Fire, Speed};

/// The event solver's motion of a scene at `end`, with these changes.
fn exact(scene: &Scene, acts: &[(f64, Act)], end: f64) -> Motion {
    let mut event = scene.clone();
    event.solver.kind = SolverKind::Event;
    let mut motion = Motion::new(&event.checked().unwrap());
    for (t, act) in acts {
        assert!(motion.advance(*t).is_ok());
        match *act {
            Fire => motion.fire(),
            Speed(speed, ramp) => motion.set_speed(speed, ramp),
        }
    }
    assert!(motion.advance(end).is_ok());
    motion
}

/// The plain stepper's, at one step.
fn stepped(scene: &Scene, acts: &[(f64, Act)], end: f64, step: f64) -> Plain {
    let mut coarse = scene.clone();
    coarse.solver.step_s = step;
    let mut plain = Plain::new(&coarse);
    for (t, act) in acts {
        assert!(plain.advance(*t).is_ok());
        match *act {
            Fire => plain.fire(scene.operation.pulse_n, scene.operation.pulse_s),
            Speed(speed, ramp) => plain.set_speed(speed, ramp),
        }
    }
    assert!(plain.advance(end).is_ok());
    plain
}

/// Mean order of the errors over the steps, each a quarter of the one before.
fn order(errors: &[f64; 3]) -> f64 {
    (errors[0] / errors[2]).log2() / 4.0
}

/// Casing and blades converge with the first power of the step, to this error of the order:
/// little in smooth contact, more where the instants of impacts fall anywhere in a step.
fn converges(scene: &Scene, acts: &[(f64, Act)], end: f64, tolerance: f64) -> Motion {
    let motion = exact(scene, acts, end);
    let (state, clearance) = (motion.state(), scene.machine().clearance());
    let runs = STEPS.map(|step| stepped(scene, acts, end, step));
    let apart = |at: &dyn Fn(&Plain) -> [f64; 2], there: [f64; 2], size: f64| {
        runs.each_ref().map(|run| (at(run)[0] - there[0]).hypot(at(run)[1] - there[1]) / size)
    };
    let casing = apart(&|run| run.u(), state.u, clearance);
    let what = format!("{:?} {acts:?} until {end}: {casing:?}", scene.solver.model);
    // Two gaps closed say where the casing is, with no step in it but through the blades.
    let pinned = matches!(motion.contacts().active_set, ActiveSet::Corner(..))
        && runs.iter().all(|run| run.multipliers().len() == 2 && run.in_contact());
    if pinned {
        assert!(casing[2] < 3e-8, "{what}");
    } else {
        assert!((order(&casing) - 1.0).abs() < tolerance && casing[2] < 0.0125, "{what}");
    }
    if scene.solver.model == ModelSize::Modal {
        let blades = apart(&|run| run.modal(), state.alpha, runs[2].widest);
        // The scheme uses the moment arm of an impact one step late: a tenth at
        // the longest step.
        let close = (order(&blades) - 1.0).abs() < tolerance + 0.05;
        assert!(close && blades[2] < 0.05, "{what}: blades {blades:?}");
    }
    motion
}

fn each(run: impl Fn(Scene)) {
    for model in ["rigid", "modal"] {
        run(scene(&[("solver.model", model)]));
    }
}

#[test]
fn in_flight() {
    each(|scene| {
        converges(&scene, &[(1e-3, Speed(450.0, 0.0)), (3e-3, Fire)], 4e-3, 0.3);
        converges(&scene, &[(1e-4, Speed(-300.0, -1e5))], 1e-3, 0.3);
        // Twice within the pulse: the second cuts the first.
        converges(&scene, &[(2e-5, Fire), (4e-5, Speed(0.0, 0.0)), (4e-5, Fire)], 1e-3, 0.3);
    });
}

/// Turning with the middle of side 0 against the casing.
fn sliding(mut scene: Scene, force: f64) -> Scene {
    let (clearance, nu) = (scene.machine().clearance(), 1500.0);
    scene.initial.u_c_m = -clearance;
    scene.initial.v_s_m_s = -nu * clearance;
    (scene.operation.pulse_n, scene.operation.pulse_s) = (force, 1e-4);
    scene
}

#[test]
fn sliding_along_a_side() {
    each(|scene| {
        let free = sliding(scene.clone(), 0.0);
        for (speed, ramp) in [(520.0, 0.0), (500.0, -2e4)] {
            let motion = converges(&free, &[(2e-4, Speed(speed, ramp))], 4e-4, 0.05);
            assert_eq!(motion.contacts().active_set, ActiveSet::Side(0));
        }
        // A second pulse at the end of the first, and one during it.
        for (force, at) in [(300.0, 2e-4), (-300.0, 5e-5)] {
            converges(&sliding(scene.clone(), force), &[(at, Fire)], 4e-4, 0.2);
        }
    });
}

#[test]
fn locked() {
    each(|scene| {
        let still = in_corner(scene.clone());
        for (speed, ramp, tolerance) in [(500.0, 2e4, 0.05), (350.0, 0.0, 0.1), (0.0, 0.0, 0.2)] {
            converges(&still, &[(1e-3, Speed(speed, ramp))], 2e-3, tolerance);
        }
        // The first pulse acts on the corner too; it holds, or closes again
        // well before the second.
        for force in [20.0, -300.0] {
            let mut scene = in_corner(scene.clone());
            (scene.operation.pulse_n, scene.operation.pulse_s) = (force, 1e-4);
            let locked = exact(&scene, &[], 0.006).contacts().active_set;
            assert!(matches!(locked, ActiveSet::Corner(..)), "{force}: {locked:?}");
            converges(&scene, &[(0.006, Fire)], 0.0064, 0.3);
        }
    });
}

#[test]
fn other_parameters_are_refused_and_nothing_changes() {
    let mut event = scene(&[("solver.kind", "event")]);
    let mut motion = Motion::new(&event.checked().unwrap());
    assert!(motion.advance(2.5e-4).is_ok());
    let before = motion.state();
    event.casing.damping_ratio = 0.3;
    motion.set_parameters(&event.checked().unwrap());
    assert_eq!(motion.state(), before);
}
