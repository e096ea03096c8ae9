//! An elastic lining, by the explicit solver, against numbers of another code: states,
//! second order, growth rates, limit cycles, and the verdicts on them. A case is a speed and
//! the numbers there.

use crate::tips_support::{END, KAPPA, MU, PULSE, SPEED, STEP, TAU, coordinates, limit, pressed};
use rubscope_solver::motion::{Motion, Verdict, run_to_verdict, to_the_end};
use rubscope_solver::scene::{Scene, SolverKind};
use rubscope_solver::study::precision::{Effort, Measure};

fn set(mut scene: Scene, key: &str, value: &str) -> Scene {
    scene.set(key, value).unwrap();
    scene
}

/// All four coordinates at steps of 2, 1 and half a microsecond, into which the pulse
/// fits: cut steps would have another error.
fn at_three_steps(scene: &Scene) -> [[f64; 4]; 3] {
    ["2e-6", "1e-6", "5e-7"].map(|step| coordinates(&set(scene.clone(), STEP, step)))
}

#[test]
fn states_at_50_ms_to_nine_digits_and_second_order() {
    for (speed, expected) in [
        (425.0, [-5.874_927_727e-7, 1.777_200_076e-7, -1.330_428_526e-6, -5.044_801_465e-7]),
        (390.0, [3.732_738_077e-8, 1.174_734_342e-7, 4.860_205_230e-7, -6.759_426_547e-7]),
    ] {
        let values = at_three_steps(&pressed(&[(SPEED, speed), (END, 0.05)]));
        let size = |k: usize| f64::hypot(expected[k & 2], expected[(k & 2) + 1]);
        for k in 0..4 {
            let found = limit(2, values.map(|at| at[k]));
            assert!((found - expected[k]).abs() < 1e-8 * size(k), "{speed} {k}: {found:e}");
        }
        let error = |step: usize| {
            let each = (0..4).map(|k| ((values[step][k] - expected[k]) / size(k)).powi(2));
            each.sum::<f64>().sqrt()
        };
        let order = (error(0) / error(1)).log2();
        assert!((order - 2.0).abs() < 0.02, "{speed}: {order}");
    }
}

#[test]
fn single_blades_without_a_slope_are_pressed_from_the_start_and_of_second_order() {
    let of = |model: &str, pulse: f64, step: &str| {
        let keys = [(KAPPA, 0.0), ("contact.stiffness_n_per_m", 2.7e6), (SPEED, 500.0)];
        let scene = pressed(&[&keys[..], &[(PULSE, pulse), (END, 0.01)]].concat());
        set(set(scene, "solver.model", model), STEP, step)
    };
    let stored = |model: &str| {
        let report = crate::run_once(&of(model, 5e3, "1e-6").checked().unwrap());
        (report.energy.unwrap().stored_j, report.checks.energy_residual_j.unwrap())
    };
    // Without a slope nothing tells single blades from the two modes.
    let ((modal, _), (full, residual)) = (stored("modal"), stored("full"));
    assert!((full / modal - 1.0).abs() < 1e-6, "{full} {modal}");
    assert!(residual.abs() < 1e-5 * full, "{residual} {full}");
    // A pulse after which no blade lifts off, which would cost part of the order.
    let [a, b, c] = ["2e-6", "1e-6", "5e-7"].map(|step| coordinates(&of("full", 300.0, step)));
    for k in 0..2 {
        let order = ((a[k] - b[k]) / (b[k] - c[k])).log2();
        assert!((order - 2.0).abs() < 0.05, "{k}: {order}");
    }
}

/// Growth \[1/s\] and frequency \[rad/s\] of `alpha_c + i alpha_s` between two instants.
fn growth(scene: &Scene, from: f64, to: f64) -> (f64, f64) {
    let mut motion = Motion::new(&scene.checked().unwrap());
    let (mut turned, mut last, mut first) = (0.0, None, None);
    let looks = 2000;
    for look in 0..=looks {
        let t = from + (to - from) * f64::from(look) / f64::from(looks);
        motion.advance(t).unwrap();
        let [c, s] = motion.state().alpha;
        let (size, angle) = (c.hypot(s), s.atan2(c));
        let pi = std::f64::consts::PI;
        turned += last
            .map_or(0.0, |(_, before): (f64, f64)| (angle - before + pi).rem_euclid(2.0 * pi) - pi);
        first.get_or_insert((size, t));
        last = Some((size, angle));
    }
    let ((start, t), (end, _)) = (first.unwrap(), last.unwrap());
    ((end / start).ln() / (to - t), turned / (to - t))
}

#[test]
fn growth_is_that_of_the_worst_root() {
    // A pulse so weak that no blade lifts.
    let scene = pressed(&[(SPEED, 425.0), (PULSE, 1e-3), (STEP, 2e-6), (END, 1.0)]);
    let (found, turned) = growth(&scene, 0.4, 0.8);
    assert!((found / 7.512_595_085 - 1.0).abs() < 2e-3, "{found}");
    assert!((turned / -304.463_551 - 1.0).abs() < 1e-4, "{turned}");
}

#[test]
fn the_limit_cycle_has_the_amplitude_of_the_balance() {
    let scene = pressed(&[(SPEED, 410.0), (PULSE, 2e3), (END, 2.0)]);
    let mut motion = Motion::new(&scene.checked().unwrap());
    motion.advance(1.9).unwrap();
    let (mut mean_u, mut mean_a) = (0.0, 0.0);
    for look in 0..1000 {
        motion.advance(1.9 + 1e-4 * f64::from(look)).unwrap();
        let state = motion.state();
        mean_u += state.amplitude() / 1000.0;
        mean_a += state.alpha[0].hypot(state.alpha[1]) / 1000.0;
    }
    assert!((mean_u / 5.284_105_64e-5 - 1.0).abs() < 2e-3, "{mean_u}");
    assert!((mean_a / 1.718_733_47e-4 - 1.0).abs() < 2e-3, "{mean_a}");
    motion.advance(2.0).unwrap();
    assert_eq!(motion.lasting(0.2), Verdict::Whirl);
}

fn verdict(scene: &Scene) -> Verdict {
    run_to_verdict(&scene.checked().unwrap(), &to_the_end).unwrap().verdict
}

#[test]
fn a_wave_that_grows_without_lifting_a_blade_is_no_decay() {
    let scene = pressed(&[(SPEED, 410.0), (PULSE, 20.0), (END, 0.3)]);
    assert_eq!(verdict(&scene), Verdict::Slip);
}

#[test]
fn aliases_of_the_casing_wave_meet_the_disk() {
    for (speed, expected) in [(61.0, Verdict::Decay), (66.0, Verdict::Whirl)] {
        let mut scene = pressed(&[(SPEED, speed), (END, 1.5)]);
        scene.operation.nodal_diameters = 19;
        scene.bladed_disk.nodal_diameters = 3;
        assert_eq!(verdict(&scene), expected, "{speed}");
    }
    // Modes that are no aliases are not coupled by a pressed rim.
    let mut scene = pressed(&[(SPEED, 406.0), (END, 0.5)]);
    scene.bladed_disk.nodal_diameters = 4;
    assert_eq!(verdict(&scene), Verdict::Decay);
}

#[test]
fn friction_on_the_ring_whips_the_rest_backward() {
    let changes = [(MU, 0.3), (TAU, 1.0 / 3.0), (KAPPA, 0.0), (SPEED, 300.0)];
    let lining = [("contact.stiffness_n_per_m", 3e5), (STEP, 4e-6), (END, 2.0)];
    let scene = pressed(&[&changes[..], &lining[..]].concat());
    let report = crate::run_once(&scene.checked().unwrap());
    assert_eq!(report.outcome.verdict, Verdict::Slip);
    let omega = 3.0 * report.outcome.wave_speed_rad_s.unwrap();
    assert!((omega / -1421.66 - 1.0).abs() < 2e-3, "{omega}");
    let amplitude = report.outcome.amplitude_m;
    assert!((amplitude / 4.686e-5 - 1.0).abs() < 5e-3, "{amplitude}");
}

#[test]
fn mistuning_is_mild() {
    let largest = |sd: f64| {
        let mut scene = pressed(&[(SPEED, 410.0), (PULSE, 2e3), (END, 0.8)]);
        scene.set("solver.model", "full").unwrap();
        scene.bladed_disk.mistuning = sd;
        let mut motion = Motion::new(&scene.checked().unwrap());
        motion.advance(0.75).unwrap();
        let mut most = 0.0_f64;
        for look in 0..250 {
            motion.advance(0.75 + 2e-4 * f64::from(look)).unwrap();
            let angles = motion.blade_angles();
            let mean = angles.iter().sum::<f64>() / angles.len() as f64;
            most = angles.iter().fold(most, |most, angle| most.max((angle - mean).abs()));
        }
        assert_eq!(motion.lasting(0.04), Verdict::Whirl, "{sd}");
        most
    };
    let ratio = largest(0.02) / largest(0.0);
    assert!(1.03 < ratio && ratio < 1.15, "{ratio}");
}

#[test]
fn energy_is_accounted_for_to_second_order() {
    for (changes, model) in [
        (vec![(SPEED, 410.0), (PULSE, 2e3), (MU, 0.1), (TAU, 0.2), (END, 0.05)], "full"),
        (vec![(SPEED, 410.0), (PULSE, 2e3), (END, 0.05)], "rigid"),
    ] {
        let residual = |step: &str| {
            let scene = set(set(pressed(&changes), STEP, step), "solver.model", model);
            let report = crate::run_once(&scene.checked().unwrap());
            let ledger = report.energy.unwrap();
            assert_eq!(report.checks.energy_residual_j, Some(ledger.residual()));
            assert_eq!(ledger.impact_loss_j, 0.0);
            ledger.residual().abs() / ledger.pulse_work_j
        };
        let (coarse, fine) = (residual("2e-6"), residual("5e-7"));
        assert!(fine < 1e-5, "{changes:?} {model}: {fine}");
        // Contact that opens and closes has a jump of the third derivative.
        assert!(fine < 0.12 * coarse, "{changes:?} {model}: {coarse} {fine}");
    }
}

/// By a Runge-Kutta method of eighth order, with the full angles of the blades.
#[test]
fn a_reference_on_a_lining_is_that_of_a_method_of_high_order() {
    let mut scene = Scene::builtin("coincidence").unwrap();
    (scene.operation.speed_rad_s, scene.solver.end_s) = (410.0, 0.05);
    let measure = Measure::new(&scene, Effort::QUICK, &to_the_end).unwrap().unwrap();
    let way = measure.reference().way;
    assert_eq!((way.solver, way.step_s), (SolverKind::Explicit, Some(5e-7)));
    let mut motion = Motion::new(&way.of(&scene).unwrap());
    motion.advance(0.05).unwrap();
    let [x, y] = motion.state().u;
    // The casing moves by 5e-7 m.
    let off = (x + 2.684_877_616e-7).hypot(y - 4.302_712_028e-7);
    assert!(off < 1e-12, "{off:e}");
}
