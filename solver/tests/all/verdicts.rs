//! A verdict reached early is the verdict of the whole run, with any excitation. A new kind of
//! scene is a part of `any_scene`.

use crate::plain::scenes::{in_corner, scene, taken_scene};
use crate::random::{each_case, one_of, scale, within};
use fastrand::Rng;

use rubscope_solver::motion::{
    ActiveSet, Checks, FailureReason, LAST_PART, Motion, Verdict, VerdictReached, judge_end,
    run_to_verdict, to_the_end, verdict_of,
};
use rubscope_solver::scene::{ContactLaw, ModelSize, Scene, SolverKind};

/// A scene of any solver, law and model that decays, bounces, slips or locks, with
/// excitation, ramps, pulses that end late, and starts in a corner.
fn any_scene(rng: &mut Rng) -> Scene {
    let kinds = [
        (SolverKind::Event, ContactLaw::Unilateral, ModelSize::Rigid),
        (SolverKind::Event, ContactLaw::Unilateral, ModelSize::Modal),
        (SolverKind::Explicit, ContactLaw::Unilateral, ModelSize::Rigid),
        (SolverKind::Explicit, ContactLaw::Unilateral, ModelSize::Modal),
        (SolverKind::Explicit, ContactLaw::Bilateral, ModelSize::Modal),
        (SolverKind::Explicit, ContactLaw::Unilateral, ModelSize::Full),
        (SolverKind::Explicit, ContactLaw::Bilateral, ModelSize::Full),
    ];
    let mut scene = Scene::base();
    let (blades, diameters) = one_of(rng, &[(22, 3), (22, 4), (12, 2), (5, 2), (22, 11)]);
    (scene.bladed_disk.blades, scene.operation.nodal_diameters) = (blades, diameters);
    scene.casing.damping_ratio = if rng.bool() { 0.0 } else { within(rng, 0.0..0.06) };
    scene.bladed_disk.damping_ratio = if rng.bool() { 0.0 } else { within(rng, 0.001..0.06) };
    scene.operation.speed_rad_s = within(rng, 250.0..600.0);
    let rarely = |rng: &mut Rng, range, usual| match rng.u8(0..4) {
        0 => within(rng, range),
        _ => usual,
    };
    scene.operation.speed_ramp_rad_s2 = rarely(rng, -4e3..4e3, 0.0);
    scene.operation.pulse_n = if rng.u8(0..4) == 0 { 0.0 } else { scale(rng, 3e3..1.6e6) };
    scene.operation.pulse_s = rarely(rng, 1e-3..3e-2, 50e-6);
    (scene.solver.kind, scene.solver.contact, scene.solver.model) = one_of(rng, &kinds);
    if scene.solver.kind == SolverKind::Explicit && scene.solver.model == ModelSize::Modal {
        // A torque close to a resonance of the blades, or none.
        let driven = rng.u8(0..3) == 0;
        scene.excitation.amplitude_nm = if driven { within(rng, 0.5..50.0) } else { 0.0 };
        scene.excitation.order = diameters;
    }
    let polygon = scene.machine().polygon;
    if rng.u8(0..3) == 0 && polygon.has_corners() {
        // At rest in a corner, or turning a little faster or slower.
        let (side, part) = (rng.u32(0..22), within(rng, 0.95..1.05));
        let (a, b) = (polygon.direction(side), polygon.direction(side + 1));
        let scale = -polygon.clearance / (1.0 + a.0 * b.0 + a.1 * b.1) * (1.0 - 1e-13);
        let (x, y) = (scale * (a.0 + b.0), scale * (a.1 + b.1));
        let nu: f64 = part * scene.machine().nu(scene.operation.speed_rad_s);
        (scene.initial.u_c_m, scene.initial.u_s_m) = (x, y);
        (scene.initial.v_c_m_s, scene.initial.v_s_m_s) = (-nu * y, nu * x);
    }
    scene.solver.step_s = 2e-6;
    scene.solver.end_s = within(rng, 0.01..0.06);
    scene
}

#[test]
fn a_verdict_reached_early_is_that_of_the_whole_run() {
    each_case(60, |rng| {
        let scene = taken_scene(rng, any_scene);
        let early = run_to_verdict(&scene.checked().unwrap(), &to_the_end).unwrap();
        let mut motion = Motion::new(&scene.checked().unwrap());
        let _ = motion.advance(scene.solver.end_s);
        let verdict = verdict_of(&motion, LAST_PART * scene.solver.end_s);
        let whole = VerdictReached::of(&motion, verdict);
        assert_eq!(early.verdict, whole.verdict);
        // A lock that was decided has no more impacts. Strides that looks cut elsewhere round
        // otherwise, which changes the count of a long rocking motion.
        if scene.solver.kind == SolverKind::Event {
            assert_eq!(early.impact_count, whole.impact_count);
        }
    });
}

/// A verdict that is certain holds at any later time, too.
#[test]
fn what_is_settled_stays_so() {
    each_case(60, |rng| {
        let scene = taken_scene(rng, any_scene);
        let end = scene.solver.end_s;
        let mut motion = Motion::new(&scene.checked().unwrap());
        let mut settled = None;
        for part in 1..=40 {
            if motion.advance(end * f64::from(part) / 40.0).is_err() {
                assert_eq!(settled, None);
                break;
            }
            let now = motion.final_verdict();
            if settled.is_some() {
                assert_eq!(now, settled, "at {} of 40", part);
            }
            settled = now;
        }
    });
}

#[test]
fn an_end_outside_the_model_is_a_failure() {
    let mut motion = Motion::new(&Scene::base().checked().unwrap());
    motion.advance(1e-3).unwrap();
    let judged = |angle_rad| {
        let checks = Checks { max_blade_angle_rad: angle_rad, ..motion.checks() };
        judge_end(&motion, &checks, 1e-4)
    };
    assert_eq!(judged(0.1), (verdict_of(&motion, 1e-4), None));
    let (verdict, failure) = judged(0.797);
    assert_eq!(verdict, Verdict::Failed);
    assert_eq!(failure.unwrap().reason, FailureReason::BladeAngle { angle_rad: 0.797 });
}

/// Blades of the event solver in the corner of sides 0 and 1.
fn cornered(model: &str, ramp: &str) -> Motion {
    let ramp = [("operation.speed_ramp_rad_s2", ramp), ("solver.model", model)];
    let mut scene = in_corner(scene(&ramp));
    scene.solver.kind = SolverKind::Event;
    Motion::new(&scene.checked().unwrap())
}

#[test]
fn a_lock_is_for_good_at_constant_speed_only() {
    for model in ["rigid", "modal"] {
        let locked = |ramp| {
            let mut motion = cornered(model, ramp);
            assert!(motion.advance(2e-3).is_ok());
            assert!(
                matches!(motion.contacts().active_set, ActiveSet::Corner(..)),
                "{model} {ramp}"
            );
            motion.final_verdict()
        };
        assert_eq!(locked("0"), Some(Verdict::Locked), "{model}");
        assert_eq!(locked("-3e3"), None, "{model}");
    }
}

#[test]
fn a_corner_held_for_a_casing_period_is_a_rest() {
    for (periods, rested) in [(0.5, false), (1.5, true)] {
        let mut motion = cornered("rigid", "0");
        let period = std::f64::consts::TAU / motion.machine().omega_c;
        assert!(motion.advance(periods * period).is_ok());
        motion.set_speed(0.0, 0.0);
        assert!(motion.advance((periods + 0.1) * period).is_ok());
        assert_eq!(motion.contacts().active_set, ActiveSet::Nothing);
        assert_eq!(VerdictReached::of(&motion, Verdict::Bounce).rested, rested, "{periods}");
    }
}

#[test]
fn a_corner_that_the_first_swing_of_its_blades_opens_is_no_lock() {
    // Undamped blades just below the lowest speed at which the corner holds them.
    for (model, speed) in [("modal", "413.13737"), ("full", "413.14212")] {
        let blades = [
            ("bladed_disk.stiffness_nm_per_rad", "1e4"),
            ("bladed_disk.coupling_nm_per_rad", "0"),
            ("bladed_disk.inertia_kg_m2", "1e-3"),
            ("bladed_disk.damping_ratio", "0"),
        ];
        let run = [
            ("solver.model", model),
            ("solver.contact", "unilateral"),
            ("solver.end_s", "0.02"),
            ("operation.speed_rad_s", speed),
        ];
        let settled = run_to_verdict(
            &in_corner(scene(&[blades, run].concat())).checked().unwrap(),
            &to_the_end,
        )
        .unwrap();
        assert_eq!(settled.verdict, Verdict::Slip, "{model}: {settled:?}");
    }
}
