//! The corner branch of soft blades: it ends at the requested speed, or passes
//! its fold, and always satisfies its equations.

use std::f64::consts::FRAC_PI_2;

use crate::hbm_support::keeps_to_its_laws;
use rubscope_solver::harmonic::{CornerBranch, Equilibrium, Form, corner_branch, locked_motion};
use rubscope_solver::model::{BladedDisk, Casing, Machine};

/// Fourteen blades and 55 diameters: the corner branch of blades of such a
/// stiffness \[N m/rad\] folds at speeds that a rotor has.
fn machine(stiffness: f64) -> Machine {
    let disk = BladedDisk { blades: 14, stiffness_nm_per_rad: stiffness, ..BladedDisk::default() };
    Machine::new(&disk, &Casing::default(), 55)
}

fn followed(machine: &Machine, range: [f64; 2], step: f64) -> CornerBranch {
    let branch = corner_branch(machine, 0, true, range, step).unwrap();
    if let Err(what) = keeps_to_its_laws(machine, &branch, range, step) {
        panic!("{range:?} by {step}: {what}");
    }
    branch
}

fn fold_of(machine: &Machine) -> f64 {
    corner_branch(machine, 0, true, [0.0, 1.0], 1.0).unwrap().fold.unwrap().speed_rad_s
}

#[test]
fn a_branch_asked_to_end_just_below_its_fold_ends_there() {
    for (stiffness, tops) in [(96_780.0, [5408.7145, 5408.71946]), (5000.0, [1296.49, 1296.4987])] {
        let machine = machine(stiffness);
        for top in tops {
            let branch = followed(&machine, [0.0, top], 0.05);
            let (opening, last) = branch.points.last().unwrap();
            assert_eq!(last.speed_rad_s, top);
            assert!(*opening < branch.fold.unwrap().opening_rad);
        }
    }
}

#[test]
fn the_fold_itself_and_its_neighbours_among_the_numbers() {
    for stiffness in [96_780.0, 5000.0] {
        let machine = machine(stiffness);
        let fold = fold_of(&machine);
        let below = fold.next_down();
        for from in [0.0, 0.97 * fold, below.next_down()] {
            for (top, folds) in [(below, false), (fold, false), (fold.next_up(), true)] {
                let branch = followed(&machine, [from, top], 1.0);
                let top = branch.fold.unwrap().opening_rad;
                let last = branch.points.last().unwrap();
                // So close to the fold its two sides are the same numbers.
                assert!(if folds { last.0 >= top } else { last.0 <= top }, "{from} {top}");
                assert_eq!(
                    folds,
                    branch.points.iter().any(|(_, state)| state.speed_rad_s > last.1.speed_rad_s)
                );
            }
        }
        let alone = followed(&machine, [fold, 2.0 * fold], 0.05);
        assert_eq!(alone.points.len(), 1);
        assert!(followed(&machine, [fold.next_up(), 2.0 * fold], 0.05).points.is_empty());
    }
}

#[test]
fn every_step_and_the_smallest_ranges() {
    let machine = machine(5000.0);
    let fold = fold_of(&machine);
    let critical = machine.critical_speed().unwrap();
    for step in [1e-4, 1e-3, 0.3, 1.0_f64] {
        // The span of a thousand steps, half of it behind the fold.
        let from = fold - 500.0 * step.min(0.05) * critical;
        followed(&machine, [from, fold - 1e-6], step);
        followed(&machine, [from, 1e6], step);
        // Less than a step: only the two ends.
        for from in [0.0, critical, 0.9 * fold] {
            let branch = followed(&machine, [from, from.next_up()], step);
            assert_eq!(branch.points.len(), 2);
        }
    }
    // From a speed above the critical one the branch comes back to it.
    let from = 1.5 * critical;
    let back = followed(&machine, [from, 2.0 * fold], 0.3);
    assert_eq!(back.points.last().unwrap().1.speed_rad_s, from);
    // From one below it, it ends wide open, just above the critical speed.
    let open = followed(&machine, [0.5 * critical, 2.0 * fold], 0.3);
    let (opening, last) = open.points.last().unwrap();
    assert!((opening + 1e-3 - FRAC_PI_2).abs() < 1e-15);
    assert!(
        last.speed_rad_s > critical && last.speed_rad_s < 1.1 * critical,
        "{}",
        last.speed_rad_s
    );
}

/// Practically rigid blades do not fold; the branch is the rigid corner. Blades
/// as soft as these have no branch at the critical speed.
#[test]
fn blades_of_any_stiffness_end_where_they_were_asked_to() {
    for stiffness in [0.1, 10.0, 15_000.0, 1e15, 1e200, 1e290, 1e308] {
        let disk = BladedDisk {
            blades: 14,
            stiffness_nm_per_rad: stiffness,
            coupling_nm_per_rad: 0.0,
            ..BladedDisk::default()
        };
        let machine = Machine::new(&disk, &Casing::default(), 55);
        for top in [10.0, 1e3] {
            followed(&machine, [0.0, top], 0.3);
        }
        let rigid = followed(&machine, [0.0, 0.5], 1e-4);
        assert_eq!(rigid.fold.is_none(), stiffness > 1e289, "{stiffness:e}");
    }
}

/// If a branch would have too many points, they are spread over all of it.
#[test]
fn a_long_branch_reaches_its_end_all_the_same() {
    let branch = followed(&machine(96_780.0), [0.0, 5000.0], 1e-3);
    assert!((15_000..20_000).contains(&branch.points.len()), "{}", branch.points.len());
}

/// The closed form `kappa = -(Delta - delta) cos^3 Delta/(c sin Delta)` turns
/// back at its largest speed, seen here on a fine grid of openings.
#[test]
fn the_fold_is_the_largest_speed_of_the_branch() {
    for (stiffness, expected) in [(96_780.0, 5408.72), (5000.0, 1296.5)] {
        let machine = machine(stiffness);
        let fold = corner_branch(&machine, 0, true, [0.0, 1.0], 1.0).unwrap().fold.unwrap();
        assert!((fold.speed_rad_s - expected).abs() < 1e-2, "{}", fold.speed_rad_s);
        let nd = machine.nodal_diameters;
        let softness = nd * nd * machine.casing_stiffness * machine.clearance().powi(2)
            / (machine.blade_inertia * machine.omega_bd * machine.omega_bd);
        let delta = machine.polygon.delta;
        let c = softness * 2.0 / 14.0 * delta.sin().powi(2);
        let speed = |opening: f64| {
            let (sin, cos) = opening.sin_cos();
            let kappa = -(opening - delta) * cos.powi(3) / (c * sin);
            machine.critical_speed().unwrap() * (1.0 - kappa).sqrt()
        };
        let grid = (1..1_000_000).map(|k| delta + 1.3e-6 * f64::from(k));
        let largest = grid.map(speed).fold(0.0, f64::max);
        assert!((fold.speed_rad_s / largest - 1.0).abs() < 1e-11, "{} {largest}", fold.speed_rad_s);
        assert!((speed(fold.opening_rad) / fold.speed_rad_s - 1.0).abs() < 1e-12);
    }
}

#[test]
fn what_is_no_range_is_refused() {
    let machine = machine(5000.0);
    for range in [[10.0, 10.0], [-1.0, 5.0], [5.0, 1.0], [0.0, f64::INFINITY], [f64::NAN, 1.0]] {
        let refused = corner_branch(&machine, 0, true, range, 0.05).unwrap_err().to_string();
        assert!(refused.starts_with("speed = "), "{refused}");
    }
    for step in [0.0, 9e-5, 1.1, f64::NAN] {
        let refused = corner_branch(&machine, 0, true, [0.0, 1.0], step).unwrap_err().to_string();
        assert!(refused.starts_with("step = "), "{refused}");
    }
}

/// Soft enough to fold within the speeds of the paper.
fn soft() -> Machine {
    let disk = BladedDisk {
        stiffness_nm_per_rad: 2e-3,
        coupling_nm_per_rad: 0.0,
        ..BladedDisk::default()
    };
    Machine::new(&disk, &Casing::default(), 3)
}

#[test]
fn the_fold_of_very_soft_blades_is_passed() {
    let branch = followed(&soft(), [100.0, 2000.0], 0.02);
    let fold = branch.fold.unwrap();
    assert!((300.0..2000.0).contains(&fold.speed_rad_s), "{}", fold.speed_rad_s);
    // A fold exchanges stability: an eigenvalue passes through zero.
    let sign =
        |state: &Equilibrium| state.eigenvalues_per_s.iter().product::<nalgebra::Complex<f64>>().re;
    let top =
        branch.points.iter().position(|(_, state)| state.speed_rad_s == fold.speed_rad_s).unwrap();
    let (before, after) = (&branch.points[top - 1].1, &branch.points[top + 1].1);
    assert!(sign(before) > 0.0 && sign(after) < 0.0);
    assert!(after.growth_per_s > 0.0);
}

#[test]
fn beyond_its_fold_a_speed_has_no_locked_motion() {
    let machine = soft();
    let fold = fold_of(&machine);
    let speeds = [0.5 * fold, 0.999 * fold, 1.001 * fold, 3.0 * fold];
    let sweep = locked_motion(&machine, Form::Modal, false, None, &speeds).unwrap();
    assert_eq!((sweep.points.len(), sweep.missing.as_slice()), (2, &speeds[2..]));
    assert!(sweep.points.iter().all(|point| point.residual < 1e-12));
    // The paper's blades fold far beyond any rotor.
    let paper = Machine::new(&BladedDisk::default(), &Casing::default(), 3);
    let branch = followed(&paper, [0.0, 500.0], 0.05);
    assert!(branch.fold.unwrap().speed_rad_s > 1e6);
}
