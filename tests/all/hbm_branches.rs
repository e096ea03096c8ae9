//! Every equilibrium of the blade frame, its stability and the thresholds.

use crate::close;
use rubscope_solver::harmonic::{Branches, Character, Kind, Threshold, equilibria};
use rubscope_solver::model::{BladedDisk, Casing, Machine};

fn machine(stiffness: f64, nodal_diameters: u32, zeta_c: f64) -> Machine {
    let disk = BladedDisk { stiffness_nm_per_rad: stiffness, ..BladedDisk::default() };
    let casing = Casing { damping_ratio: zeta_c, ..Casing::default() };
    Machine::new(&disk, &casing, nodal_diameters)
}

/// Blades stiff enough to be rigid to the last digits.
const RIGID: f64 = 1e15;

fn threshold(branches: &Branches, kind: Kind, from: Character, to: Character) -> f64 {
    let same = |t: &&Threshold| t.kind == kind && t.below == from && t.above == to;
    branches.thresholds.iter().find(same).map_or(f64::NAN, |threshold| threshold.speed_rad_s)
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
        // Blades yield to an impact by A^2/M_b, some 1e-9 of the casing's part.
        close(find(Kind::Corner, Pulls, Adhesive), machine.adhesive_speed().unwrap(), 1e-8);
        close(find(Kind::Corner, Adhesive, Stable), lock, 1e-12);
        close(find(Kind::Side, Pulls, Penetrates), critical, 1e-12);
        // Above the lock speed the saddle stands on the side: the
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
        close(threshold.speed_rad_s, critical, 1e-12);
        assert_eq!(threshold.below, Character::Pulls);
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
    close(side.contacts[0].multiplier_n, -push, 1e-12);
    close(side.amplitude_m, machine.clearance().hypot(offset), 1e-12);
    let root = (zeta * zeta * omega * omega - square).sqrt() - zeta * omega;
    // Eigenvalues are good to rounding of the largest, here blades at 1e5 omega_c.
    close(side.growth_per_s, root, 1e-7);
    close(side.power_w, machine.casing_damping * nu * nu * side.amplitude_m.powi(2), 1e-12);
    assert_eq!(side.eigenvalues_per_s.len(), 6);
}
