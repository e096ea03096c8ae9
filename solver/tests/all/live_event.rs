//! Live changes of the event solver against the plain stepper at decreasing
//! steps: their difference must vanish in proportion to the step.

use crate::plain::Plain;
use crate::plain::scenes::{in_corner, scene};
use rubscope_solver::motion::{ActiveSet, Motion};
use rubscope_solver::scene::{Scene, SolverKind};

/// Steps that divide every instant below.
const STEPS: [f64; 4] = [4e-6, 1e-6, 2.5e-7, 1e-7];

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

/// Slope of the logarithms of errors over those of the steps, by least squares.
fn slope(errors: &[f64]) -> f64 {
    let points: Vec<(f64, f64)> = STEPS.iter().zip(errors).map(|(h, e)| (h.ln(), e.ln())).collect();
    let count = points.len() as f64;
    let (mx, my) = points.iter().fold((0.0, 0.0), |(x, y), (a, b)| (x + a / count, y + b / count));
    let (xy, xx) = points
        .iter()
        .fold((0.0, 0.0), |(xy, xx), (a, b)| (xy + (a - mx) * (b - my), xx + (a - mx) * (a - mx)));
    xy / xx
}

/// Casing and blades converge with the first power of the step, to this error
/// of the slope: little in smooth contact, more where the instants of impacts
/// fall anywhere in a step.
fn converges(scene: &Scene, acts: &[(f64, Act)], end: f64, tolerance: f64) -> Motion {
    let motion = exact(scene, acts, end);
    let (state, clearance) = (motion.state(), scene.machine().clearance());
    let runs = STEPS.map(|step| stepped(scene, acts, end, step));
    let apart = runs.each_ref().map(|run| {
        let u = run.u();
        (u[0] - state.u[0]).hypot(u[1] - state.u[1]) / clearance
    });
    let what = format!("{:?} {acts:?} until {end}", scene.solver.model);
    // Two gaps closed say where the casing is, with no step in it but through
    // the blades.
    let pinned = matches!(motion.contacts().active_set, ActiveSet::Corner(..))
        && runs.iter().all(|run| run.multipliers().len() == 2 && run.in_contact());
    let found = slope(&apart);
    if pinned {
        assert!(apart[3] < 1e-8, "{what}: {apart:?}");
    } else {
        assert!((found - 1.0).abs() < tolerance, "{what}: slope {found} of {apart:?}");
        assert!(apart[3] < 5e-3, "{what}: {apart:?}");
    }
    if scene.solver.model == rubscope_solver::scene::ModelSize::Modal {
        let turned = runs.each_ref().map(|run| {
            let alpha = run.modal();
            (alpha[0] - state.alpha[0]).hypot(alpha[1] - state.alpha[1]) / run.widest
        });
        let found = slope(&turned);
        // The scheme uses the moment arm of an impact one step late: a tenth at
        // the longest step.
        assert!((found - 1.0).abs() < tolerance + 0.05, "{what}: blades {found} of {turned:?}");
        assert!(turned[3] < 0.02, "{what}: blades {turned:?}");
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
        converges(&scene, &[(1e-4, Speed(300.0, -1e5))], 1e-3, 0.3);
        converges(&scene, &[(1e-4, Speed(-300.0, 0.0))], 1e-3, 0.3);
        // Twice within the pulse: the second cuts the first.
        converges(&scene, &[(2e-5, Fire)], 1e-3, 0.3);
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
        let scene = sliding(scene, 0.0);
        let changes = [(520.0, 0.0), (480.0, 0.0), (500.0, 2e4), (500.0, -2e4)];
        for (speed, ramp) in changes {
            let motion = converges(&scene, &[(2e-4, Speed(speed, ramp))], 4e-4, 0.05);
            assert_eq!(motion.contacts().active_set, ActiveSet::Side(0));
        }
        for speed in [-500.0, 0.0] {
            converges(&scene, &[(2e-4, Speed(speed, 0.0))], 4e-4, 0.4);
        }
    });
}

#[test]
fn fired_while_sliding() {
    each(|scene| {
        // A second pulse at the end of the first, and one during it.
        for force in [300.0, -300.0] {
            let pressed = sliding(scene.clone(), force);
            converges(&pressed, &[(2e-4, Fire)], 4e-4, 0.1);
            converges(&pressed, &[(5e-5, Fire)], 4e-4, 0.2);
        }
    });
}

#[test]
fn locked() {
    each(|scene| {
        let scene = in_corner(scene);
        for (speed, ramp, tolerance) in [
            (520.0, 0.0, 0.05),
            (500.0, 2e4, 0.05),
            (500.0, -2e4, 0.05),
            (350.0, 0.0, 0.1),
            (0.0, 0.0, 0.2),
            (-500.0, 0.0, 0.5),
        ] {
            converges(&scene, &[(1e-3, Speed(speed, ramp))], 2e-3, tolerance);
        }
    });
}

#[test]
fn fired_while_locked() {
    each(|scene| {
        // The first pulse acts on the corner too; it holds, or closes again
        // well before the second.
        for force in [20.0, -300.0, 150.0] {
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
