//! Held locks of soft blades under long steps, up to the longest that is stable, against
//! plain stepping in twice the digits. A push bends such blades so far in one step that
//! the corrected gaps are not closed.

use crate::plain::compare::Pair;
use crate::plain::scenes::{in_corner, random, scene};
use rubscope_solver::scene::{ContactLaw, ModelSize, Scene};

/// A start in a corner of blades that are soft or stiff, light or heavy.
fn soft(seed: u64) -> Scene {
    let part = |k: u64| random(seed, 500 + k);
    let between = |k, low: f64, high: f64| low * (high / low).powf(part(k));
    let mut scene = scene(&[]);
    (scene.bladed_disk.blades, scene.operation.nodal_diameters) =
        [(22, 3), (8, 5), (12, 5), (7, 2), (40, 3)][(5.0 * part(0)) as usize % 5];
    scene.solver.model = ModelSize::Modal;
    scene.solver.contact =
        if part(1) < 0.7 { ContactLaw::Unilateral } else { ContactLaw::Bilateral };
    scene.bladed_disk.blade_length_m = 0.5 - between(2, 5e-5, 1e-3);
    scene.bladed_disk.inertia_kg_m2 = between(3, 1e-6, 3.0);
    // From the frequency of the casing to some times as fast.
    let omega = between(4, 300.0, 6e3);
    scene.bladed_disk.stiffness_nm_per_rad = omega * omega * scene.bladed_disk.inertia_kg_m2;
    scene.bladed_disk.coupling_nm_per_rad = 0.0;
    scene.bladed_disk.damping_ratio = between(5, 0.05, 2.0);
    scene.casing.damping_ratio = 0.08 * part(6);
    let lock = scene.machine().omega_c / f64::from(scene.operation.nodal_diameters);
    scene.operation.speed_rad_s = lock * between(7, 1.2, 3.0) * (0.5 - part(8)).signum();
    let turn = 0.4 / scene.machine().nu(scene.operation.speed_rad_s).abs();
    let longest = scene.stable_step().min(turn);
    scene.solver.step_s = longest * (0.97_f64).min(between(9, 1e-3, 2.0));
    scene.solver.end_s = 1.0;
    in_corner(scene)
}

/// Compares plain stepping and the program over so many steps. Returns whether a lock lasted.
fn compare(seed: u64, steps: u32) -> bool {
    let scene = soft(seed);
    let mut pair = Pair::new(&scene);
    for look in 1..=8 {
        let until = scene.solver.step_s * f64::from(steps / 8 * look);
        if pair.advance(until).is_err() || pair.is_chaotic() {
            return false;
        }
        pair.check(&format!("seed {seed}"));
    }
    let held = pair.plain.window(f64::from(steps / 4) * scene.solver.step_s).kept;
    held.is_some_and(|sides| sides.len() == 2)
}

/// Compares so many scenes, most of which lock.
fn locks(scenes: u64, steps: u32) {
    let count = (0..scenes).filter(|seed| compare(*seed, steps)).count() as u64;
    assert!(4 * count > 3 * scenes, "{count} locks of {scenes}");
}

#[test]
fn soft_blades_in_long_steps_hold_as_plain_steps_do() {
    locks(24, 5600);
}
