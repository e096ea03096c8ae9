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

#[test]
fn one_or_two_sides_have_no_corner_but_states_all_the_same() {
    for (diameters, count) in [(0, 6), (11, 6)] {
        let machine = machine(15_000.0, diameters, 0.05);
        let states = equilibria(&machine, 100.0, true).unwrap();
        let kinds: Vec<Kind> = states.iter().map(|state| state.kind).collect();
        let expected = [Kind::Rest, Kind::Side];
        assert_eq!(kinds, expected);
        assert_eq!(states[0].eigenvalues_per_s.len(), count, "one blade mode");
    }
    let machine = machine(15_000.0, 11, 0.05);
    let above = equilibria(&machine, 500.0, true).unwrap();
    assert_eq!(above[1].character, Character::Unstable);
}

/// A casing so soft that the rotor is 3.5e8 times critical: eigenvalues of rest
/// nearly coincide, and those of the side differ by as much.
#[test]
fn a_very_soft_casing_has_the_closed_forms_all_the_same() {
    let disk = BladedDisk::default();
    let casing = Casing { modal_stiffness_n_per_m: 6e-8, ..Casing::default() };
    let machine = Machine::new(&disk, &casing, 11);
    let speed = 5578.0;
    for damped in [false, true] {
        let branches = Branches::over(&machine, &[0.0, speed], damped).unwrap();
        let at = |place| branches.states_at(place).unwrap();
        let states: Vec<_> = (0..branches.speeds()).flat_map(at).collect();
        assert_eq!(states.len(), 4);
        let (rest, side) = (&states[2], &states[3]);
        assert_eq!((rest.kind, rest.character), (Kind::Rest, Character::Stable));
        let slowest = if damped { -0.05 * machine.omega_c } else { 0.0 };
        close(rest.growth_per_s, slowest, 1e-12);
        assert_eq!((side.kind, side.character), (Kind::Side, Character::Unstable));
        // (s^2 + kappa)(s^2 + w^2 - kappa e) = kappa^2 e, kappa = w_c^2 - nu^2:
        // along the side the casing moves the blades. Damping is 1e-10 of it.
        let kappa = (machine.omega_c - machine.nu(speed)) * (machine.omega_c + machine.nu(speed));
        let moved = (11.0 * machine.clearance()).powi(2) * machine.casing_mass;
        let share = moved / (22.0 * machine.blade_inertia);
        let blade = machine.omega_bd.powi(2) - kappa * share;
        let (sum, product) = (kappa + blade, kappa * blade - kappa * kappa * share);
        let square = -0.5 * (sum - (sum * sum - 4.0 * product).sqrt());
        close(side.growth_per_s, square.sqrt(), 1e-9);
        assert!(branches.thresholds.iter().all(|threshold| threshold.kind == Kind::Side));
        close(branches.thresholds[0].speed_rad_s, machine.critical_speed().unwrap(), 1e-12);
    }
}

/// Next to the critical speed the moment arm of a damped side is 1e14 long.
#[test]
fn a_side_next_to_the_critical_speed_keeps_its_eigenvalues() {
    let machine = machine(15_000.0, 3, 0.05);
    let critical = machine.critical_speed().unwrap();
    for part in [-1e-6, -1e-10, -1e-14, 1e-14, 1e-10, 1e-6] {
        let states = equilibria(&machine, critical * (1.0 + part), true).unwrap();
        let side = states.iter().find(|state| state.kind == Kind::Side).unwrap();
        assert_eq!(side.eigenvalues_per_s.len(), 6, "{part:e}");
        assert!(side.eigenvalues_per_s.iter().all(|value| value.re.is_finite()));
    }
}
