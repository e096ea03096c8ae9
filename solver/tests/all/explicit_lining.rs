//! An elastic lining, by the explicit solver: reference states, second order,
//! growth rates, limit cycles, and the verdicts on them.

use crate::tips_support::{
    END, KAPPA, MU, PULSE, SPEED, STEP, TAU, coordinates, in_corner, limit, pressed, scene,
};
use rubscope_solver::motion::{Motion, Verdict, run_to_verdict, to_the_end};
use rubscope_solver::scene::Scene;

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
        (410.0, [-2.684_877_616e-7, 4.302_712_028e-7, -5.250_561_687e-7, -1.354_601_271e-6]),
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
fn single_blades_on_a_lining_agree_with_the_modes_but_for_their_mean() {
    let scene = set(pressed(&[(SPEED, 410.0), (END, 0.05)]), "solver.model", "full");
    let values = at_three_steps(&scene);
    for (k, expected) in [(0, -2.684_888_543e-7), (1, 4.302_717_509e-7)] {
        let found = limit(2, values.map(|at| at[k]));
        assert!((found - expected).abs() < 1e-8 * 5e-7, "{k}: {found:e}");
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
    for (speed, rate, frequency) in
        [(410.0, 6.643_429_931, -292.499_395), (425.0, 7.512_595_085, -304.463_551)]
    {
        // A pulse so weak that no blade lifts.
        let scene = pressed(&[(SPEED, speed), (PULSE, 1e-3), (STEP, 2e-6), (END, 1.0)]);
        let (found, turned) = growth(&scene, 0.4, 0.8);
        assert!((found / rate - 1.0).abs() < 2e-3, "{speed}: {found}");
        assert!((turned / frequency - 1.0).abs() < 1e-4, "{speed}: {turned}");
    }
}

#[test]
fn the_rest_flutters_between_two_speeds() {
    for (speed, grows) in [(397.0, false), (402.0, true), (435.0, true), (440.0, false)] {
        let scene = pressed(&[(SPEED, speed), (PULSE, 1e-3), (END, 1.0)]);
        let (found, _) = growth(&scene, 0.4, 0.8);
        assert_eq!(found > 0.0, grows, "{speed}: {found}");
    }
}

#[test]
fn the_limit_cycle_has_the_amplitude_of_the_balance() {
    for (speed, casing, angle) in
        [(410.0, 5.284_105_64e-5, 1.718_733_47e-4), (406.0, 0.0, 1.8201e-4)]
    {
        let scene = pressed(&[(SPEED, speed), (PULSE, 2e3), (END, 2.0)]);
        let mut motion = Motion::new(&scene.checked().unwrap());
        motion.advance(1.9).unwrap();
        let (mut mean_u, mut mean_a) = (0.0, 0.0);
        for look in 0..1000 {
            motion.advance(1.9 + 1e-4 * f64::from(look)).unwrap();
            let state = motion.state();
            mean_u += state.amplitude() / 1000.0;
            mean_a += state.alpha[0].hypot(state.alpha[1]) / 1000.0;
        }
        if casing > 0.0 {
            assert!((mean_u / casing - 1.0).abs() < 2e-3, "{speed}: {mean_u}");
        }
        assert!((mean_a / angle - 1.0).abs() < 2e-3, "{speed}: {mean_a}");
        motion.advance(2.0).unwrap();
        assert_eq!(motion.lasting(0.2), Verdict::Whirl);
    }
}

fn verdict(scene: &Scene) -> Verdict {
    run_to_verdict(&scene.checked().unwrap(), &to_the_end).unwrap().verdict
}

#[test]
fn the_coincidence_is_seen_between_its_two_sides() {
    for (speed, expected) in
        [(390.0, Verdict::Decay), (406.0, Verdict::Whirl), (445.0, Verdict::Decay)]
    {
        assert_eq!(verdict(&pressed(&[(SPEED, speed), (END, 1.5)])), expected, "{speed}");
    }
}

#[test]
fn a_wave_that_grows_without_lifting_a_blade_is_no_decay() {
    let scene = pressed(&[(SPEED, 410.0), (PULSE, 20.0), (END, 0.3)]);
    assert_eq!(verdict(&scene), Verdict::Slip);
}

#[test]
fn aliases_of_the_casing_wave_meet_the_disk() {
    for (speed, expected) in
        [(61.0, Verdict::Decay), (66.0, Verdict::Whirl), (70.0, Verdict::Decay)]
    {
        let mut scene = pressed(&[(SPEED, speed), (END, 1.5)]);
        scene.operation.nodal_diameters = 19;
        scene.bladed_disk.nodal_diameters = 3;
        assert_eq!(verdict(&scene), expected, "{speed}");
    }
}

#[test]
fn modes_that_are_no_aliases_are_not_coupled_by_a_pressed_rim() {
    for speed in [390.0, 406.0, 420.0] {
        let mut scene = pressed(&[(SPEED, speed), (END, 0.5)]);
        scene.bladed_disk.nodal_diameters = 4;
        assert_eq!(verdict(&scene), Verdict::Decay, "{speed}");
    }
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

/// A lock on two blades of a lining without damping depth, at its equilibrium.
fn soft_lock(speed: f64) -> Scene {
    let stiffness = 1e9;
    let mut scene =
        in_corner(set(scene(&[(SPEED, speed), (STEP, 1e-6)]), "solver.contact", "smooth"));
    scene.contact.stiffness_n_per_m = stiffness;
    scene.contact.smoothing_m = 0.0;
    let machine = scene.machine();
    let nu = machine.nu(speed);
    // (K + iD) z + k_p sum (g0 + Re[z conj(e)]) e = 0 of two unknowns.
    let stiff = machine.casing_stiffness - nu * nu * machine.casing_mass;
    let drag = machine.casing_damping * nu;
    let (mut a, mut b) = ([[stiff, -drag], [drag, stiff]], [0.0; 2]);
    for side in [15, 16] {
        let (c, s) = machine.polygon.direction(side);
        for (row, along) in [c, s].into_iter().enumerate() {
            a[row][0] += stiffness * along * c;
            a[row][1] += stiffness * along * s;
            b[row] -= stiffness * along * machine.clearance();
        }
    }
    let determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    let x = (b[0] * a[1][1] - b[1] * a[0][1]) / determinant;
    let y = (a[0][0] * b[1] - a[1][0] * b[0]) / determinant;
    (scene.initial.u_c_m, scene.initial.u_s_m) = (x, y);
    (scene.initial.v_c_m_s, scene.initial.v_s_m_s) = (-nu * y, nu * x);
    scene
}

#[test]
fn a_stiff_lining_holds_a_lock_a_little_above_the_rigid_speed() {
    let mut motion = Motion::new(&soft_lock(418.616_650_8).checked().unwrap());
    motion.advance(0.1).unwrap();
    let pushes = motion.multipliers();
    assert_eq!(pushes.iter().map(|(side, _)| *side).collect::<Vec<_>>(), [15, 16]);
    // The scheme's own error is of second order, 1e-6 of the larger push.
    assert!((pushes[0].1 + 163.825_941).abs() < 2e-3, "{pushes:?}");
    assert!((pushes[1].1 + 0.541_935).abs() < 2e-3, "{pushes:?}");
    let mut motion = Motion::new(&soft_lock(416.616_650_8).checked().unwrap());
    motion.advance(0.1).unwrap();
    assert!(motion.multipliers().len() < 2);
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
    let tuned = largest(0.0);
    for (sd, low, high) in [(0.005, 1.005, 1.06), (0.02, 1.03, 1.15)] {
        let ratio = largest(sd) / tuned;
        assert!(low < ratio && ratio < high, "{sd}: {ratio}");
    }
}

#[test]
fn energy_is_accounted_for_to_second_order() {
    for (changes, model) in [
        (vec![(SPEED, 410.0), (PULSE, 2e3), (END, 0.05)], "modal"),
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
