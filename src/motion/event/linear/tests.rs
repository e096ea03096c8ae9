//! Tests that need more than a scene can say: motions that start in a corner with
//! blades bent as they are there.

use super::*;
use crate::motion::{ActiveSet, FailureReason, Solver, Verdict};
use crate::scene::Scene;

fn scene(keys: &[(&str, f64)]) -> CheckedScene {
    let mut scene = Scene::base();
    scene.set("solver.kind", "event").unwrap();
    scene.set("operation.pulse_n", "0").unwrap();
    for (key, value) in keys {
        scene.set(key, &value.to_string()).unwrap();
    }
    scene.checked().unwrap()
}

/// `kappa`, `mu`, `tau` and the speed.
fn keys([kappa, mu, tau, speed]: [f64; 4]) -> [(&'static str, f64); 4] {
    [
        ("bladed_disk.radial_coupling", kappa),
        ("contact.friction", mu),
        ("casing.tangential_ratio", tau),
        ("operation.speed_rad_s", speed),
    ]
}

/// Locked in the corner of sides 0 and 1: the closed form, from the joint compliance.
fn locked(scene: &CheckedScene) -> Joined {
    let parameters = Parameters::new(scene);
    let (machine, nu) = (&parameters.machine, parameters.nu);
    let delta = machine.polygon.delta;
    let stiffness = machine.casing_stiffness - nu * nu * machine.casing_mass;
    let casing = parameters.turn / Plane::new(stiffness, nu * machine.casing_damping);
    let bending = machine.blade_modal_stiffness;
    let compliance = casing + machine.coupling_product_at(parameters.speed) / bending;
    let push = -Plane::cis(delta) * machine.clearance() / (compliance * delta.cos());
    let slope = machine.radial_coupling + parameters.friction;
    let (z, a) = (casing * push, -push * (slope * machine.blade_length / bending));
    Joined::from_point(scene, parameters, Point { z, a, ..Point::default() })
}

#[test]
fn a_lock_pushes_as_its_closed_form() {
    for (data, [first, second, z, a]) in [
        ([0.1, 0.0, 0.0, 500.0], [258.358348020, 55.600932525, 1.051647234e-4, 8.308641313e-5]),
        ([0.1, 0.15, 0.0, 500.0], [282.221918276, 52.075944593, 1.120426576e-4, 2.213009798e-4]),
        (
            [0.0, 0.15, 1.0 / 3.0, 500.0],
            [295.465760024, 4.150702554, 1.010283227e-4, 1.195782347e-4],
        ),
        ([-0.05, 0.15, 0.0, 500.0], [237.953135565, 57.982055172, 9.907933261e-5, 7.827859089e-5]),
    ] {
        let mut motion = locked(&scene(&keys(data)));
        for t in [0.0, 1e-3, 0.1, 1e5] {
            motion.advance(t).unwrap();
            assert_eq!(motion.final_verdict(), Some(Verdict::Locked), "{data:?} {t}");
            let [(0, one), (1, other)] = motion.multipliers()[..] else { panic!("{data:?}") };
            assert!((one + first).abs() < 1e-9 && (other + second).abs() < 1e-9, "{one} {other}");
            let state = motion.state();
            assert!((state.amplitude() / z - 1.0).abs() < 1e-9);
            assert!((state.alpha[0].hypot(state.alpha[1]) / a - 1.0).abs() < 1e-9);
        }
        assert!(motion.looks < 1000, "{} stretches of a motion at rest", motion.looks);
    }
}

#[test]
fn a_lock_is_kept_above_its_speed_and_lost_below() {
    for ([kappa, mu, casing_friction], speed) in [
        ([0.0, 0.15, 0.05], 489.713631),
        ([0.0, 0.1, 0.1 / 3.0], 454.981573),
        ([0.0, 0.3, 0.1], 787.541069),
        ([0.1, 0.0, 0.0], 414.855),
        ([0.1, 0.15, 0.05], 548.980917),
        ([-0.1, 0.3, 0.0], 406.867471),
    ] {
        let tau = if mu > 0.0 { casing_friction / mu } else { 0.0 };
        // As many digits as are printed.
        let digit = if speed == 414.855 { 1e-3 } else { 2e-6 };
        for (at, kept) in [(speed + digit, true), (speed - digit, false)] {
            let mut motion = locked(&scene(&keys([kappa, mu, tau, at])));
            motion.advance(0.3).unwrap();
            let held = motion.contacts().active_set == ActiveSet::Corner(0, 1);
            assert_eq!(held, kept, "{kappa} {mu} {at}: {:?}", motion.contacts());
            assert_eq!(motion.final_verdict() == Some(Verdict::Locked), kept);
        }
    }
}

#[test]
fn what_is_held_for_good_stays_and_what_swings_too_far_is_not() {
    let scene = scene(&keys([0.1, 0.15, 0.0, 500.0]));
    let calm = locked(&scene);
    let from = *calm.stretch.from();
    let mut proven = 0;
    for k in 0..200 {
        let size = if k == 0 { 0.0 } else { 1e-6 * 1.08_f64.powi(k) };
        let da = Plane::cis(f64::from(k)) * size;
        let point = Point { da, dz: da * calm.parameters.arm(), ..from };
        let mut motion = Joined::from_point(&scene, calm.parameters.clone(), point);
        if motion.final_verdict() == Some(Verdict::Locked) {
            proven += 1;
            motion.advance(0.5).unwrap();
            assert_eq!(motion.contacts().since, 0.0, "{size}");
            assert_eq!(motion.contacts().active_set, ActiveSet::Corner(0, 1));
        }
    }
    assert!((2..200).contains(&proven), "{proven}");
}

#[test]
fn a_growing_motion_is_told_as_one() {
    // Above the flutter of the joined structures (516 rad/s at most here).
    let scene = scene(&keys([0.5, 0.0, 0.0, 560.0]));
    let mut motion = locked(&scene);
    let failure = motion.advance(5.0).unwrap_err();
    assert!(matches!(failure.reason, FailureReason::BladeAngle { .. }), "{failure}");
    assert_eq!(motion.final_verdict(), Some(Verdict::Divergent));
}

#[test]
fn a_ramp_is_refused_by_name() {
    let mut motion = Joined::new(&scene(&keys([0.1, 0.0, 0.0, 500.0])));
    motion.set_speed(480.0, 10.0);
    assert_eq!(motion.advance(0.1).unwrap_err().reason, FailureReason::Ramp);
    assert_eq!(motion.final_verdict(), Some(Verdict::Failed));
}
