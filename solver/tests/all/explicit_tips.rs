//! Rigid contact of blades that bend and rub, by the explicit solver, against numbers of
//! another code: pulses, whirl, single blades, growth, energy. A case is some keys and the
//! coordinates, or pushes, that code gives.

use crate::tips_support::{END, KAPPA, MU, PULSE, SPEED, STEP, TAU, coordinates, scene};
use rubscope_solver::motion::{FailureReason, Motion, RunReport, Verdict};
use rubscope_solver::scene::Scene;

fn run(scene: &Scene) -> RunReport {
    crate::run_once(&scene.checked().unwrap())
}

/// Largest error of a coordinate, as a part of the largest of its kind.
fn error(found: [f64; 4], expected: [f64; 4]) -> f64 {
    let size = |k: usize| expected[k & 2].hypot(expected[(k & 2) + 1]);
    (0..4).map(|k| (found[k] - expected[k]).abs() / size(k)).fold(0.0, f64::max)
}

#[test]
fn a_pulse_from_rest_ends_where_the_events_say() {
    // Full angles, at 3 ms; numbers.csv has the linearised ones.
    let expected = [-7.401_886_021e-5, -1.518_040_483e-5, 1.246_510_047e-4, -3.855_786_340e-5];
    let [coarse, fine] = [2e-7, 4e-9].map(|step| {
        error(coordinates(&scene(&[(KAPPA, 0.1), (MU, 0.15), (END, 3e-3), (STEP, step)])), expected)
    });
    assert!(fine < 3e-4 && fine < 0.5 * coarse, "{coarse} {fine}");
}

#[test]
fn single_blades_are_hit_as_the_events_say() {
    let mut scene = scene(&[(KAPPA, 0.1), (MU, 0.15), (END, 2e-3), (STEP, 1e-8)]);
    scene.set("solver.model", "full").unwrap();
    let report = run(&scene);
    assert_eq!(report.impact_count, 2);
    for (hit, (t, blade)) in
        report.impacts.iter().zip([(2.282_193_119e-4, 19), (2.634_858_602e-4, 4)])
    {
        // Two steps of the scheme, and its error.
        assert!((hit.t_s - t).abs() < 4e-8, "{}", hit.t_s);
        assert_eq!(hit.blades, [blade]);
    }
    let [u_c, u_s, ..] = coordinates(&scene);
    assert!((u_c / -1.695_076_787e-5 - 1.0).abs() < 5e-4, "{u_c}");
    assert!((u_s / -1.571_865_816e-5 - 1.0).abs() < 5e-4, "{u_s}");
    let mut motion = Motion::new(&scene.checked().unwrap());
    motion.advance(2e-3).unwrap();
    let angle = motion.blade_angles()[18];
    assert!((angle / -8.815_562_815e-4 - 1.0).abs() < 5e-4, "{angle}");
}

/// The whirl after a pulse: its frequency, and the mean push and `|a|` over the last
/// part.
fn whirl(changes: &[(&str, f64)]) -> (f64, f64, f64) {
    let scene = scene(changes).checked().unwrap();
    let mut motion = Motion::new(&scene);
    motion.advance(0.45).unwrap();
    motion.take_mean_forces();
    let (mut turned, mut last, mut angles) = (0.0, None, 0.0);
    for look in 0..=500 {
        motion.advance(0.45 + 1e-4 * f64::from(look)).unwrap();
        let state = motion.state();
        let angle = state.u[1].atan2(state.u[0]);
        let full = std::f64::consts::TAU;
        let half = std::f64::consts::PI;
        turned += last.map_or(0.0, |before: f64| (angle - before + half).rem_euclid(full) - half);
        last = Some(angle);
        angles += state.alpha[0].hypot(state.alpha[1]);
    }
    let push: f64 = motion.take_mean_forces().iter().map(|(_, force)| -force).sum();
    assert_eq!(motion.lasting(0.05), Verdict::Whirl);
    (turned / 0.05, push, angles / 501.0)
}

#[test]
fn whirl_is_that_of_the_polygon() {
    for (changes, omega, push, angle) in [
        (vec![(KAPPA, 0.3), (SPEED, 450.0), (PULSE, 1e5)], 1_089.050_407, 183.189_019, 7.9071e-4),
        (
            vec![(KAPPA, -0.15), (MU, 0.3), (SPEED, 300.0), (PULSE, 3e5)],
            1_202.525_345,
            181.306_383,
            5.010_28e-4,
        ),
    ] {
        let changes = [&changes[..], &[(STEP, 2e-7), (END, 0.5)]].concat();
        let found = whirl(&changes);
        // The scheme's error, full angles, and a window of parts of a passing.
        assert!((found.0 / omega - 1.0).abs() < 2e-3, "{changes:?}: {found:?}");
        assert!((found.1 / push - 1.0).abs() < 2e-2, "{changes:?}: {found:?}");
        assert!((found.2 / angle - 1.0).abs() < 5e-3, "{changes:?}: {found:?}");
    }
}

#[test]
fn growth_without_bound_is_divergent_and_says_why() {
    // Friction on the ring far beyond the slope of a corner runs away backward.
    for (model, tau) in [("modal", 1.0 / 3.0), ("rigid", 1.0)] {
        let changes =
            [(MU, 0.5), (TAU, tau), (SPEED, 300.0), (PULSE, 1e5), (STEP, 1e-7), (END, 0.02)];
        let mut scene = scene(&changes);
        scene.set("solver.model", model).unwrap();
        let report = run(&scene);
        let mut motion = Motion::new(&scene.checked().unwrap());
        let stopped = motion.advance(0.02).unwrap_err();
        let expected = match stopped.reason {
            FailureReason::BladeAngle { .. } | FailureReason::LongStep { .. } => "modal",
            FailureReason::CasingSpeed { .. } => "rigid",
            _ => "no growth",
        };
        assert_eq!(expected, model, "{stopped}");
        assert_eq!(report.outcome.verdict, Verdict::Divergent);
        assert_eq!(report.outcome.message, Some(stopped.as_growth()));
    }
}

#[test]
fn energy_is_accounted_for_to_first_order_and_never_created() {
    for (changes, full) in [
        (vec![(KAPPA, 0.3), (MU, 0.1), (TAU, 0.3), (SPEED, 450.0), (PULSE, 1e5)], false),
        (vec![(KAPPA, 0.1), (MU, 0.15)], true),
        (vec![("contact.restitution", 0.5), (PULSE, 5e4)], false),
    ] {
        let part = |step: f64| {
            let mut scene = scene(&changes);
            scene.set("solver.model", if full { "full" } else { "modal" }).unwrap();
            scene.set(STEP, &step.to_string()).unwrap();
            scene.set(END, "4e-3").unwrap();
            let ledger = run(&scene).energy.unwrap();
            for loss in [
                ledger.casing_loss_j,
                ledger.blade_loss_j,
                ledger.friction_heat_j,
                ledger.impact_loss_j,
            ] {
                assert!(loss >= 0.0, "{ledger:?}");
            }
            let gained = ledger.stored_j - ledger.supplied() + ledger.friction_heat_j;
            assert!(gained <= 1e-3 * ledger.pulse_work_j, "{ledger:?}");
            ledger.residual().abs() / ledger.pulse_work_j
        };
        let (coarse, fine) = (part(4e-7), part(1e-7));
        assert!(fine < 1e-3, "{changes:?}: {fine}");
        assert!(fine < 0.5 * coarse, "{changes:?}: {coarse} {fine}");
    }
}
