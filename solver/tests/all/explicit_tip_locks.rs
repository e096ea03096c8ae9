//! Locks of blades that bend and rub, by the explicit solver: pushes, their limits, and
//! the speeds down to which they hold. A case is some keys and the numbers of another code.

use crate::tips_support::{KAPPA, MU, PULSE, SPEED, STEP, TAU, ZETA_BD, in_corner, limit, scene};
use rubscope_solver::motion::{Change, Motion, Verdict, verdict_of};

/// The mean pushes over the end of a lock, both negative.
fn pushes(changes: &[(&str, f64)], step: f64) -> [f64; 2] {
    let mut scene = in_corner(scene(changes));
    scene.set(STEP, &step.to_string()).unwrap();
    let mut motion = Motion::new(&scene.checked().unwrap());
    motion.advance(0.1).unwrap();
    motion.take_mean_forces();
    motion.advance(0.12).unwrap();
    let means = motion.take_mean_forces();
    assert_eq!(means.iter().map(|(side, _)| *side).collect::<Vec<_>>(), [15, 16]);
    [means[0].1, means[1].1]
}

#[test]
fn pushes_are_those_of_the_equilibrium() {
    for (changes, a, b, most) in [
        // The remainder of the series, (nu h)^3 of the larger push.
        (vec![(KAPPA, 0.2)], 310.464_467_44, 46.978_987_52, 1e-5),
        // Of linearised tips. Blades turn by up to 2e-4 rad, their phases by 6e-4: as a part
        // of the larger push over the angle of a corner that is a hundredth of a newton.
        (vec![(KAPPA, 0.1), (MU, 0.15)], 282.221_918_276, 52.075_944_593, 0.02),
        (vec![(MU, 0.15), (TAU, 1.0 / 3.0)], 295.465_760_024, 4.150_702_554, 0.02),
    ] {
        let at = [1e-6, 5e-7, 2.5e-7].map(|step| pushes(&changes, step));
        for (side, expected) in [a, b].into_iter().enumerate() {
            let found = limit(1, at.map(|pushes| pushes[side]));
            assert!((found + expected).abs() < most, "{changes:?}: {found} {expected}");
        }
    }
}

#[test]
fn the_error_of_the_scheme_is_that_of_a_little_more_casing_friction() {
    // mu_c + nu h: the closed form gives 258.6944 N at this step.
    let [a, _] = pushes(&[(KAPPA, 0.1)], 2e-7);
    // Full angles add 0.0092.
    assert!((a + 258.6944 + 0.0092).abs() < 1e-3, "{a}");
}

/// Goes on until then, and turns the rotor with this acceleration from there; its speed.
fn turn(motion: &mut Motion, until: f64, ramp: f64) -> f64 {
    motion.advance(until).unwrap();
    motion.apply(&Change::Rotor { speed: None, ramp });
    motion.rotor().speed(until)
}

/// Slows a lock down to each of these speeds in turn, and keeps it there; whether it
/// still holds.
fn held_at(from: f64, speeds: [f64; 2], changes: &[(&str, f64)]) -> [bool; 2] {
    let changes = [changes, &[(SPEED, from)]].concat();
    let mut motion = Motion::new(&in_corner(scene(&changes)).checked().unwrap());
    // Fast at first; slowly near the end, where the ramp itself may break it.
    let mut t = 0.02;
    let mut speed = turn(&mut motion, t, -800.0);
    let near = speeds[0] + 5.0;
    if speed > near {
        t += (speed - near) / 800.0;
    }
    speed = turn(&mut motion, t, -40.0);
    let mut held = [false; 2];
    for (held, wanted) in held.iter_mut().zip(speeds) {
        turn(&mut motion, t, -40.0);
        t += (speed - wanted) / 40.0;
        speed = turn(&mut motion, t, 0.0);
        t += 0.04;
        turn(&mut motion, t, 0.0);
        *held = motion.lasting(0.02) == Verdict::Locked;
    }
    held
}

#[test]
fn locks_are_lost_below_their_speed_and_kept_above() {
    for (speed, from, above, changes) in [
        (489.713_631, 0.5, 0.5, vec![(MU, 0.15), (TAU, 1.0 / 3.0)]),
        (406.867_471, 0.5, 0.5, vec![(KAPPA, -0.1), (MU, 0.3)]),
    ] {
        let held = held_at(speed + from, [speed + above, speed - 0.5], &changes);
        assert_eq!(held, [true, false], "{changes:?}");
    }
}

#[test]
fn no_lock_where_friction_on_the_ring_is_steeper_than_the_corner() {
    // mu_c = 0.15 is beyond tan(delta) = 0.1438.
    for speed in [500.0, 900.0] {
        let changes = [(MU, 0.45), (TAU, 1.0 / 3.0), (SPEED, speed), (STEP, 2e-7)];
        let mut motion = Motion::new(&in_corner(scene(&changes)).checked().unwrap());
        let ran = motion.advance(0.05);
        assert!(ran.is_err() || verdict_of(&motion, 0.01) != Verdict::Locked, "{speed}");
    }
}

#[test]
fn forced_blades_are_loudest_where_slip_meets_their_frequency() {
    // Blades that friction drives and that push nothing back: kappa = 0.
    let amplitude = |zeta: f64| {
        let changes = [
            (MU, 0.15),
            (PULSE, 51_742.0),
            (STEP, 2e-7),
            ("casing.damping_ratio", zeta),
            (ZETA_BD, 0.04),
        ];
        let mut motion = Motion::new(&scene(&changes).checked().unwrap());
        let mut sum = 0.0;
        for look in 0..50 {
            motion.advance(0.4 + 0.001 * f64::from(look)).unwrap();
            let [c, s] = motion.state().alpha;
            sum += c.hypot(s);
        }
        assert_eq!(verdict_of(&motion, 0.03), Verdict::Slip, "{zeta}");
        sum / 50.0
    };
    for (zeta, expected) in [(0.010, 0.99e-4), (0.007, 7.05e-4)] {
        let found = amplitude(zeta);
        // The formula takes the mean push and the mean speed of the slip.
        assert!((found / expected - 1.0).abs() < 0.06, "{zeta}: {found}");
    }
}
