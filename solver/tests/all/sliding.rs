//! A wave that slides along a side, by short steps where blades move, against plain stepping
//! in twice the digits, over whole runs of random scenes.

use crate::plain::compare::Pair;
use crate::plain::scenes::{random, scene};

fn pick<T: Copy>(values: &[T], part: f64) -> T {
    values[((values.len() as f64 * part) as usize).min(values.len() - 1)]
}

/// Pulses that make contact, at any speed, with few and many sides.
fn random_pair(seed: u64, model: &str) -> Pair {
    let part = |k| random(seed, k);
    let diameters = pick(&[1_u32, 2, 3, 4], part(6));
    let speed = (150.0 + 450.0 * part(1)) * 3.0 / f64::from(diameters);
    let number = |value: f64| value.to_string();
    Pair::new(&scene(&[
        ("solver.model", model),
        ("solver.contact", pick(&["unilateral", "bilateral"], part(7))),
        ("bladed_disk.blades", pick(&["3", "5", "7", "13", "22", "40", "66"], part(5))),
        ("operation.nodal_diameters", &diameters.to_string()),
        ("operation.speed_rad_s", &number(if part(8) < 0.2 { -speed } else { speed })),
        ("casing.damping_ratio", pick(&["0", "0.003", "0.01", "0.05"], part(2))),
        ("operation.pulse_n", &number(4e3 * 50_f64.powf(part(3)))),
        ("solver.step_s", &number(1e-6 * 5_f64.powf(part(4)))),
    ]))
}

#[test]
fn whole_runs_differ_by_round_off_alone() {
    let mut slid = 0;
    for seed in 0..160 {
        let mut pair = random_pair(seed, ["rigid", "modal"][seed as usize % 2]);
        for look in 1..=24 {
            if pair.advance(f64::from(look) * 4e-4).is_err() || pair.is_chaotic() {
                break;
            }
            pair.check(&format!("seed {seed}"));
            slid += pair.motion.contacts().active_set.sides().count() % 2;
        }
    }
    assert!(slid > 200, "{slid}");
}

/// The same machine, put on a side, where it moves with `rate` clearances a radian of
/// the casing against the blades.
fn on_a_side(pair: &Pair, part: f64, rate: f64) -> Pair {
    let mut scene = pair.scene().clone();
    let machine = scene.machine();
    let (clearance, omega) = (machine.clearance(), machine.omega_c);
    // Side 0 has its inward normal along u_c at t = 0; y grows along u_s.
    let y = part * machine.polygon.half_side().min(clearance);
    let nu = machine.nu(scene.operation.speed_rad_s);
    scene.operation.pulse_n = 0.0;
    (scene.initial.u_c_m, scene.initial.u_s_m) = (-clearance, y);
    // Sign of what the Coriolis force presses against the side.
    let along = -rate * nu.signum() * omega * clearance;
    (scene.initial.v_c_m_s, scene.initial.v_s_m_s) = (-nu * y, along - nu * clearance);
    Pair::new(&scene)
}

#[test]
fn a_way_along_a_side_is_that_of_plain_steps_to_twelve_digits() {
    let mut slid = 0;
    for seed in 0..240 {
        let part = |k: u64| random(seed, 20 + k);
        let machine = random_pair(seed, ["rigid", "modal"][seed as usize % 2]);
        let mut pair = on_a_side(&machine, 1.8 * part(0) - 0.9, 2.0 * part(1) - 0.5);
        let mut amplified = 1.0_f64;
        for look in 1..=100 {
            let until = f64::from(look) * 1e-4;
            if pair.advance(until).is_err() || pair.motion.contacts().impact_count > 1 {
                break;
            }
            let one_side = pair.motion.contacts().active_set.sides().count() == 1;
            if !one_side || pair.motion.contacts().since > 0.9e-4 {
                break;
            }
            amplified = amplified.max(pair.amplified);
            let (u, plain) = (pair.motion.state().u, pair.plain.u());
            let size = plain[0].hypot(plain[1]).max(pair.scene().machine().clearance());
            let error = (u[0] - plain[0]).hypot(u[1] - plain[1]) / size;
            // Every step rounds.
            assert!(error < 1e-12 * amplified, "{seed} at {until}: {error:e} of {amplified:e}");
            pair.check(&format!("seed {seed}"));
            slid += 1;
        }
    }
    assert!(slid > 1000, "{slid}");
}

#[test]
fn what_changes_during_a_slide_counts_from_then_on() {
    let mut changed = [0; 4];
    for seed in 0..160 {
        let part = |k: u64| random(seed, 40 + k);
        let machine = random_pair(seed, ["rigid", "modal"][seed as usize / 4 % 2]);
        let mut pair = on_a_side(&machine, 1.2 * part(0) - 0.6, 0.6 * part(1) - 0.1);
        if pair.advance(1.5e-4).is_err() {
            continue;
        }
        let log = pair.motion.contacts();
        if log.active_set.sides().count() != 1 || log.since > 1e-4 {
            continue;
        }
        let (kind, speed) = (seed as usize % 4, pair.scene().operation.speed_rad_s);
        let mut scene = pair.scene().clone();
        match kind {
            0 => pair.set_speed(1.1 * speed, 0.0),
            1 => pair.set_speed(speed, -300.0 * speed),
            2 => {
                scene.casing.damping_ratio += 0.1;
                pair.adopt(&scene);
            }
            _ => {
                (scene.operation.pulse_n, scene.operation.pulse_s) = (-300.0, 1e-4);
                pair.adopt(&scene);
                pair.fire();
            }
        }
        changed[kind] += 1;
        for look in 1..=8 {
            if pair.advance(1.5e-4 + 5e-5 * f64::from(look)).is_err() || pair.is_chaotic() {
                break;
            }
            pair.check(&format!("seed {seed}, change {kind}"));
        }
    }
    assert!(changed.iter().all(|&count| count > 8), "{changed:?}");
}

#[test]
fn where_one_looks_does_not_change_a_bit_of_a_slide() {
    for seed in 0..40 {
        let pair = random_pair(seed, ["rigid", "modal"][seed as usize % 2]);
        let (mut looked, mut plain) = (pair.motion.clone(), pair.motion);
        for look in 1..=200 {
            if looked.advance(f64::from(look) * 4.7e-5).is_err() {
                break;
            }
            let copy = looked.clone();
            assert_eq!(copy.state(), looked.state());
        }
        let end = looked.state().t_s;
        if plain.advance(end).is_ok() {
            assert_eq!(plain.state(), looked.state(), "seed {seed}");
            assert_eq!(plain.contacts(), looked.contacts());
        }
    }
}
