//! The plain stepper against results that do not need the program.

use crate::plain::dd::{Dd, ONE, PI, ZERO};
use crate::plain::disk::Disk;
use crate::plain::scenes::{in_corner, scene};
use crate::plain::{Plain, law};

#[test]
fn reference_numbers_of_the_scheme() {
    // Case A at four steps: errors of u_s at 0.1 s that other codes find.
    for (step, error) in [("1e-5", 0.288), ("1e-6", 0.0247), ("5e-7", 0.0131)] {
        let mut plain = Plain::new(&scene(&[("solver.step_s", step), ("solver.model", "rigid")]));
        assert!(plain.advance(0.1).is_ok());
        let found = (plain.u()[1] / 1.310_205_9e-7 - 1.0).abs();
        assert!((found / error - 1.0).abs() < 0.03, "{step}: {found}");
        assert_eq!(plain.impacts.len(), 2);
    }
    // Locked multipliers without damping, at a microsecond.
    let locked = in_corner(scene(&[("casing.damping_ratio", "0"), ("solver.model", "rigid")]));
    let mut plain = Plain::new(&locked);
    assert!(plain.advance(0.001).is_ok());
    let forces: Vec<f64> = plain.multipliers().iter().map(|&(_, force)| force).collect();
    assert!((forces[0] + 152.43).abs() < 0.01 && (forces[1] + 149.28).abs() < 0.01, "{forces:?}");
}

#[test]
fn the_modes_of_the_disk_are_those_of_springs_between_neighbours() {
    let mut scene = scene(&[
        ("solver.model", "full"),
        ("bladed_disk.damping_ratio", "0"),
        ("bladed_disk.blades", "7"),
    ]);
    scene.bladed_disk.coupling_nm_per_rad = 9000.0;
    let (h, disk) = (1e-5, scene.bladed_disk.clone());
    let mut modes = Disk::new(&scene, Dd::from(h));
    // A blow on one blade, then central differences in blade coordinates.
    modes.correct(2, Dd::from(40.0));
    let mut now: Vec<f64> = modes.angles();
    let mut before = vec![0.0; 7];
    assert!(
        (now[2] - 40.0 * h * h / disk.inertia_kg_m2).abs() < 1e-12 * now[2] && now[3].abs() < 1e-24
    );
    for _ in 0..3000 {
        modes.predict(ZERO);
        let next = (0..7).map(|i| {
            let (left, right) = (now[(i + 6) % 7], now[(i + 1) % 7]);
            let torque = -disk.stiffness_nm_per_rad * now[i]
                - disk.coupling_nm_per_rad * (2.0 * now[i] - left - right);
            2.0 * now[i] - before[i] + h * h * torque / disk.inertia_kg_m2
        });
        let next: Vec<f64> = next.collect();
        (before, now) = (now, next);
    }
    let size = now.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    for (a, b) in modes.angles().iter().zip(&now) {
        // Round-off of 3000 second differences in double precision.
        assert!((a - b).abs() < 1e-8 * size, "{a:e} {b:e}");
    }
}

#[test]
fn every_diameter_is_damped_by_the_same_ratio() {
    let mut scene = scene(&[("solver.model", "full"), ("bladed_disk.damping_ratio", "0.1")]);
    scene.bladed_disk.coupling_nm_per_rad = 9000.0;
    let h = 1e-6;
    for diameters in [0_u32, 1, 5, 11] {
        let omega = rubscope_solver::model::blade_frequency(&scene.bladed_disk, diameters);
        let mut disk = Disk::new(&scene, Dd::from(h));
        let angle = |i: usize| std::f64::consts::TAU * f64::from(diameters) * i as f64 / 22.0;
        for blade in 0..22 {
            disk.correct(blade, Dd::from(angle(blade).cos()));
        }
        // x[-1] = 0, x[0] = h v.
        let rate = disk.angles()[0] / h;
        for _ in 0..10_000 {
            disk.predict(ZERO);
        }
        let (decay, t) = (0.1 * omega, 0.01 + h);
        let swing = (omega * omega - decay * decay).sqrt();
        let expected = rate * (-decay * t).exp() * (swing * t).sin() / swing;
        // The first step is first order: h omega/2 of the amplitude rate/swing.
        assert!((disk.angles()[0] - expected).abs() < h * omega * rate / swing, "{diameters}");
    }
}

#[test]
fn both_laws_solve_what_they_state() {
    // Sides a fifth of a turn apart, two rows each that differ in digit 9, 13
    // or not at all, and blades that couple them a little.
    for seed in 1..=60_u64 {
        let split = [1e-9, 1e-13, 0.0][(seed % 3) as usize];
        let random = |k: u64| {
            let bits = (seed * 1000 + k).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            (bits ^ bits >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9) as f64 / u64::MAX as f64 - 0.5
        };
        let rows = 6;
        let normals: Vec<(Dd, Dd)> = (0..rows)
            .map(|k| (PI * Dd::from((k / 2) as f64 * 0.4) + Dd::from(split * random(k))).sin_cos())
            .collect();
        let w: law::Matrix = (0..rows as usize)
            .map(|i| {
                let entry = |j: usize| {
                    let ((s, c), (t, d)) = (normals[i], normals[j]);
                    let own = if i == j { split } else { 0.0 };
                    c * d + s * t + Dd::from(own)
                };
                (0..rows as usize).map(entry).collect()
            })
            .collect();
        // Depths that a point of the plane can have, so that nothing contradicts.
        let (x, y) = (Dd::from(random(90)), Dd::from(random(91)));
        let gaps: Vec<Dd> = normals.iter().map(|&(s, c)| x * c + y * s - Dd::from(0.3)).collect();
        let after = |lambda: &[Dd], row: usize| {
            gaps[row] - lambda.iter().zip(&w[row]).map(|(&l, &w)| l * w).sum()
        };
        let lambda = law::unilateral(&w, &gaps);
        assert!(lambda.is_some(), "{split} {seed}");
        if let Some(lambda) = lambda {
            for row in 0..rows as usize {
                let left = after(&lambda, row);
                assert!(left.0 > -1e-22 && lambda[row].0 <= 0.0, "{split} {seed} {left:?}");
                // Large opposite pushes of near equal rows lose some digits.
                assert!((left * lambda[row]).0.abs() < 1e-18, "{split} {seed} {left:?} {lambda:?}");
            }
        }
        if split > 1e-12 {
            // Three sides closed by a point in the plane: only with the blades.
            let lambda = law::bilateral(&w, &gaps);
            assert!(lambda.is_some(), "{split} {seed}");
            if let Some(lambda) = lambda {
                assert!((0..rows as usize).all(|row| after(&lambda, row).0.abs() < 1e-18));
            }
        }
    }
}

#[test]
fn thirty_two_digits() {
    for n in 1..200 {
        let x = Dd::from(f64::from(n)) / Dd::from(7.0);
        assert!((x * Dd::from(7.0) - Dd::from(f64::from(n))).0.abs() < 1e-29);
        assert!((x.sqrt() * x.sqrt() - x).0.abs() < 1e-29);
        let ((sin, cos), triple) = (x.sin_cos(), (x + x + x).sin_cos().0);
        assert!((sin * sin + cos * cos - ONE).0.abs() < 1e-30);
        let expected = sin * (Dd::from(3.0) - Dd::from(4.0) * sin * sin);
        assert!((triple - expected).0.abs() < 1e-29, "{triple:?} {expected:?}");
        assert!((sin.value() - x.0.sin()).abs() < 1e-14);
    }
}
