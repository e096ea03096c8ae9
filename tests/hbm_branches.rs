//! Every equilibrium of the blade frame, its stability and the thresholds.

use rubscope::harmonic::{
    Branches, Character, Form, Kind, Threshold, corner_branch, equilibria, locked_motion,
};
use rubscope::model::{BladedDisk, Casing, Machine};

fn machine(stiffness: f64, nodal_diameters: u32, zeta_c: f64) -> Machine {
    let disk = BladedDisk { stiffness_nm_per_rad: stiffness, ..BladedDisk::default() };
    let casing = Casing { damping_ratio: zeta_c, ..Casing::default() };
    Machine::new(&disk, &casing, nodal_diameters)
}

/// Blades stiff enough to be rigid to the last digits.
const RIGID: f64 = 1e15;

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:e} is not {expected:e}");
}

fn threshold(branches: &Branches, kind: Kind, from: Character, to: Character) -> f64 {
    let same = |t: &&Threshold| t.kind == kind && t.from == from && t.to == to;
    branches.thresholds.iter().find(same).map_or(f64::NAN, |threshold| threshold.speed)
}

#[test]
fn thresholds_of_rigid_blades_are_the_closed_forms() {
    let speeds: Vec<f64> = (0..=20).map(|k| 30.0 * f64::from(k)).collect();
    for (diameters, zeta) in [(3, 0.05), (3, 0.01), (4, 0.05), (5, 0.1)] {
        let machine = machine(RIGID, diameters, zeta);
        let branches = Branches::over(&machine, &speeds, true).unwrap();
        let critical = machine.critical_speed().unwrap();
        let lock = machine.lock_speed().unwrap();
        let find = |kind, from, to| threshold(&branches, kind, from, to);
        use Character::{Adhesive, Penetrates, Pulls, Stable, Unstable};
        // Struck blades give way by A^2/M_b, some 1e-9 of what the casing does.
        close(find(Kind::Corner, Pulls, Adhesive), machine.adhesive_speed().unwrap(), 1e-8);
        close(find(Kind::Corner, Adhesive, Stable), lock, 1e-12);
        close(find(Kind::Side, Pulls, Penetrates), critical, 1e-12);
        // Above the lock-in speed the saddle stands on the side: the
        // single-side limit is the same number.
        close(find(Kind::Side, Penetrates, Unstable), lock, 1e-12);
        assert_eq!(branches.thresholds.len(), 4);
    }
}

#[test]
fn without_damping_everything_happens_at_the_critical_speed() {
    let machine = machine(15_000.0, 3, 0.05);
    let branches = Branches::over(&machine, &[0.0, 200.0, 500.0], false).unwrap();
    let critical = machine.critical_speed().unwrap();
    assert_eq!(branches.thresholds.len(), 2, "{:?}", branches.thresholds);
    for threshold in &branches.thresholds {
        close(threshold.speed, critical, 1e-12);
        assert_eq!(threshold.from, Character::Pulls);
    }
}

#[test]
fn a_side_is_a_saddle_with_the_closed_forms_of_sliding() {
    let machine = machine(RIGID, 3, 0.05);
    let speed = 500.0;
    let states = equilibria(&machine, speed, true).unwrap();
    let side = states.iter().find(|state| state.kind == Kind::Side).unwrap();
    let (nu, omega, zeta) = (machine.nu(speed), machine.omega_c, 0.05);
    let square = omega * omega - nu * nu;
    // y* = 2 zeta omega nu g0/(omega^2 - nu^2), and the push at rest there.
    let offset = 2.0 * zeta * omega * nu * machine.clearance() / square;
    let push =
        machine.casing_mass * (-square * machine.clearance() - 2.0 * zeta * omega * nu * offset);
    close(side.contacts[0].1, -push, 1e-12);
    close(side.amplitude(), machine.clearance().hypot(offset), 1e-12);
    let root = (zeta * zeta * omega * omega - square).sqrt() - zeta * omega;
    // Eigenvalues are good to rounding of the largest, here blades at 1e5 omega_c.
    close(side.growth(), root, 1e-7);
    close(side.power, machine.casing_damping * nu * nu * side.amplitude().powi(2), 1e-12);
    assert_eq!(side.eigenvalues.len(), 6);
}

#[test]
fn rest_turns_backward_in_the_blade_frame_and_decays() {
    let machine = machine(15_000.0, 3, 0.05);
    for speed in [0.0, 300.0, 5000.0] {
        let states = equilibria(&machine, speed, true).unwrap();
        let rest = &states[0];
        assert_eq!((rest.kind, rest.character), (Kind::Rest, Character::Stable));
        assert_eq!((rest.torque, rest.eigenvalues.len()), (0.0, 8));
        let slowest = (0.05 * machine.omega_c).min(0.04 * machine.omega_bd);
        close(rest.growth(), -slowest, 1e-9);
    }
}

#[test]
fn the_corner_keeps_only_the_blades_moving() {
    let machine = machine(15_000.0, 3, 0.05);
    let states = equilibria(&machine, 500.0, true).unwrap();
    let corner = states.last().unwrap();
    assert_eq!((corner.kind, corner.character), (Kind::Corner, Character::Stable));
    assert_eq!(corner.eigenvalues.len(), 4);
    // The casing adds 1e-6 of the blades' inertia.
    close(corner.growth(), -0.04 * machine.omega_bd, 1e-5);
    for value in &corner.eigenvalues {
        close(value.norm(), machine.omega_bd, 1e-5);
    }
}

#[test]
fn one_or_two_sides_have_no_corner_but_states_all_the_same() {
    for (diameters, count) in [(0, 6), (11, 6)] {
        let machine = machine(15_000.0, diameters, 0.05);
        let states = equilibria(&machine, 100.0, true).unwrap();
        let kinds: Vec<Kind> = states.iter().map(|state| state.kind).collect();
        let expected = [Kind::Rest, Kind::Side];
        assert_eq!(kinds, expected);
        assert_eq!(states[0].eigenvalues.len(), count, "one blade mode");
    }
    let machine = machine(15_000.0, 11, 0.05);
    let above = equilibria(&machine, 500.0, true).unwrap();
    assert_eq!(above[1].character, Character::Unstable);
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
    let machine = soft();
    let branch = corner_branch(&machine, 15, true, [100.0, 2000.0], 0.02).unwrap();
    let fold = branch.fold.unwrap();
    assert!((300.0..2000.0).contains(&fold.speed), "{}", fold.speed);
    let speeds: Vec<f64> = branch.points.iter().map(|(_, state)| state.speed).collect();
    let top = speeds.iter().position(|&speed| speed == fold.speed).unwrap();
    assert!(speeds[..top].windows(2).all(|pair| pair[0] < pair[1]));
    assert!(speeds[top..].windows(2).all(|pair| pair[0] > pair[1]));
    assert!(branch.points.windows(2).all(|pair| pair[0].0 < pair[1].0));
    for (opening, state) in &branch.points {
        // An equilibrium, whatever the branch: both gaps closed, forces balanced.
        let nu = machine.nu(state.speed);
        let k = machine.casing_stiffness - nu * nu * machine.casing_mass;
        let d = machine.casing_damping * nu;
        let z = state.z;
        let mut force = [k * z[0] - d * z[1], k * z[1] + d * z[0]];
        let scale = force[0].hypot(force[1]);
        for &(side, multiplier) in &state.contacts {
            let (cos, sin) = machine.rim.direction(side);
            let phase =
                machine.rim.phase(side) + 3.0 * (cos * state.alpha[0] + sin * state.alpha[1]);
            let gap = machine.clearance() + z[0] * phase.cos() + z[1] * phase.sin();
            // Phases up to 2 pi and amplitudes up to 1000 clearances round off.
            assert!(gap.abs() < 1e-14 * state.amplitude() / 1e-4, "{gap:e}");
            force = [force[0] + multiplier * phase.cos(), force[1] + multiplier * phase.sin()];
        }
        assert!(force[0].hypot(force[1]) < 1e-11 * scale, "{force:?} at {opening}");
        let dissipated = machine.casing_damping * nu * nu * state.amplitude().powi(2);
        close(state.power, dissipated, 1e-11);
    }
    // A fold exchanges stability: an eigenvalue passes through zero.
    let sign = |state: &rubscope::harmonic::Equilibrium| {
        state.eigenvalues.iter().product::<nalgebra::Complex<f64>>().re
    };
    let (before, after) = (&branch.points[top - 1].1, &branch.points[top + 1].1);
    assert!(sign(before) > 0.0 && sign(after) < 0.0);
    assert!(after.growth() > 0.0);
}

#[test]
fn beyond_its_fold_a_speed_has_no_locked_motion() {
    let machine = soft();
    let fold = corner_branch(&machine, 15, false, [0.0, 1.0], 0.02).unwrap().fold.unwrap().speed;
    let speeds = [0.5 * fold, 0.999 * fold, 1.001 * fold, 3.0 * fold];
    let sweep = locked_motion(&machine, Form::Modal, false, None, &speeds).unwrap();
    assert_eq!((sweep.points.len(), sweep.missing.as_slice()), (2, &speeds[2..]));
    assert!(sweep.points.iter().all(|point| point.residual < 1e-12));
    // The paper's blades fold far beyond any rotor.
    let paper = machine_of_table_1();
    let branch = corner_branch(&paper, 15, true, [0.0, 500.0], 0.05).unwrap();
    assert!(branch.fold.unwrap().speed > 1e6);
    assert_eq!(branch.points.last().unwrap().1.speed, 500.0);
}

fn machine_of_table_1() -> Machine {
    machine(15_000.0, 3, 0.05)
}
