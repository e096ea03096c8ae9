//! Laws of the frequency domain over random machines.

use std::ops::Range;

use crate::hbm_slip::slip_map;
use crate::random::{each_case, scale, taken, within};
use fastrand::Rng;
use rubscope_solver::harmonic::{Character, Corner, Form, Kind, Locked, equilibria, slip_over};
use rubscope_solver::model::{BladedDisk, Casing, Machine};

/// Machines with corners: 3 to 40 blades, any diameters that leave three sides,
/// clearances of 10 um to 1 mm, blades from soft to stiff, damping up to 0.3.
fn machines(rng: &mut Rng) -> Machine {
    machines_with(rng, 1e2..1e6)
}

fn machines_with(rng: &mut Rng, stiffness: Range<f64>) -> Machine {
    let any = || {
        let clearance = within(rng, 1e-5..1e-3);
        let disk = BladedDisk {
            blades: rng.u32(3..40),
            blade_length_m: 0.5 - clearance,
            inertia_kg_m2: within(rng, 0.01..10.0),
            stiffness_nm_per_rad: within(rng, stiffness.clone()),
            coupling_nm_per_rad: within(rng, 0.0..1e5),
            damping_ratio: within(rng, 0.0..0.3),
            ..BladedDisk::default()
        };
        let casing = Casing {
            radius_m: 0.5,
            modal_mass_kg: within(rng, 0.1..10.0),
            modal_stiffness_n_per_m: within(rng, 1e4..1e8),
            damping_ratio: within(rng, 0.0..0.3),
            ..Casing::default()
        };
        Machine::new(&disk, &casing, rng.u32(1..60))
    };
    // A corner needs three sides.
    taken(any, |machine| machine.polygon.has_corners())
}

/// A speed, as a part of the critical one.
fn speed_of(rng: &mut Rng, machine: &Machine, parts: Range<f64>) -> f64 {
    within(rng, parts) * machine.critical_speed().unwrap_or(1.0)
}

/// The same machine with blades stiffer by this factor.
fn stiffened(machine: &Machine, times: f64) -> Machine {
    let mut machine = machine.clone();
    machine.omega_bd *= times.sqrt();
    machine.omega_bd_max *= times.sqrt();
    machine.blade_modal_stiffness *= times;
    machine.blade_modal_damping *= times.sqrt();
    machine
}

/// Within a few digits of rounding: `value` against `expected`, of size `scale`.
fn near(value: f64, expected: f64, scale: f64) -> bool {
    (value - expected).abs() <= 1e-11 * scale
}

#[test]
fn every_form_solves_its_equations() {
    each_case(256, |rng| {
        let machine = machines(rng);
        let damped = rng.bool();
        let speed = speed_of(rng, &machine, 0.0..4.0);
        let corner = Corner::after(&machine.polygon, rng.u32(0..1000)).unwrap();
        for form in Form::ALL {
            let locked = Locked::new(&machine, corner, form, damped).unwrap();
            if let Some(point) = locked.at(speed) {
                assert!(point.residual < 1e-11, "{form}: {}", point.residual);
                let pushes = point.multipliers_n.iter().all(|&multiplier| multiplier <= 0.0);
                assert!(!point.admissible || pushes);
                assert!(!point.stable || pushes);
            }
        }
    });
}

/// The result is a state that stiffer blades lead to, not another one that
/// solves the equations at one speed.
#[test]
fn slightly_stiffer_blades_are_held_almost_alike() {
    each_case(256, |rng| {
        let machine = machines(rng);
        let damped = rng.bool();
        let speed = speed_of(rng, &machine, 0.0..4.0);
        let corner = Corner::after(&machine.polygon, 0).unwrap();
        let stiffer = stiffened(&machine, 1.0 + 1e-6);
        for form in Form::ALL {
            let at = |machine| Locked::new(machine, corner, form, damped).unwrap().at(speed);
            if let Some(point) = at(&machine) {
                let neighbour = at(&stiffer);
                assert!(neighbour.is_some(), "{form}: lost by stiffer blades");
                let neighbour = neighbour.unwrap();
                let scale = point.multipliers_n.iter().fold(0.0_f64, |size, l| size.max(l.abs()));
                for i in 0..2 {
                    // As the root of the difference where the branch folds.
                    let off = (point.multipliers_n[i] - neighbour.multipliers_n[i]).abs();
                    assert!(off <= 0.1 * scale, "{form}: {point:?} {neighbour:?}");
                }
            }
        }
    });
}

#[test]
fn power_is_what_the_damper_takes() {
    each_case(256, |rng| {
        let machine = machines(rng);
        let speed = speed_of(rng, &machine, -4.0..4.0);
        let nu = machine.nu(speed);
        for state in equilibria(&machine, speed, true).unwrap() {
            let dissipated = machine.casing_damping * nu * nu * state.amplitude_m.powi(2);
            // The moment arms of a corner cancel but for their difference.
            let k = machine.casing_stiffness - nu * nu * machine.casing_mass;
            let scale = dissipated + (k * nu).abs() * state.amplitude_m.powi(2);
            assert!(near(state.power_w, dissipated, scale), "{:?}", state.kind);
        }
    });
}

/// Casings and blades over thirty powers of ten: work is bounded, and without
/// damping every motion that grows has one that decays as fast.
#[test]
fn every_state_has_its_eigenvalues_however_soft_the_machine() {
    each_case(256, |rng| {
        let disk = BladedDisk {
            blades: rng.u32(1..40),
            stiffness_nm_per_rad: scale(rng, 1e-3..1e14),
            ..BladedDisk::default()
        };
        let casing = Casing {
            modal_stiffness_n_per_m: scale(rng, 1e-10..1e12),
            damping_ratio: within(rng, 0.0..0.3),
            ..Casing::default()
        };
        let machine = Machine::new(&disk, &casing, rng.u32(1..60));
        let (speed, damped) = (scale(rng, 1e-3..1e6), rng.bool());
        let states = equilibria(&machine, speed, damped);
        assert!(states.is_ok(), "{states:?}");
        for state in states.unwrap() {
            let values = &state.eigenvalues_per_s;
            let fastest = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
            assert!(!values.is_empty() && fastest.is_finite());
            let sum: f64 = values.iter().map(|value| value.re).sum();
            if !damped {
                assert!(sum.abs() <= 1e-12 * fastest, "{:?}: {sum:e} in {values:?}", state.kind);
            }
            if state.kind == Kind::Rest {
                assert_eq!(state.character, Character::Stable);
            }
        }
    });
}

#[test]
fn turning_by_a_group_turns_the_state() {
    each_case(256, |rng| {
        let machine = machines(rng);
        let a = rng.u32(0..1000);
        let speed = speed_of(rng, &machine, 1.0..3.0);
        let at = |side| {
            let corner = Corner::after(&machine.polygon, side).unwrap();
            Locked::new(&machine, corner, Form::Modal, true).unwrap().at(speed)
        };
        match (at(0), at(a)) {
            (Some(one), Some(other)) => {
                let scale = one.multipliers_n.iter().fold(0.0_f64, |size, l| size.max(l.abs()));
                for i in 0..2 {
                    assert!(near(one.multipliers_n[i], other.multipliers_n[i], scale));
                }
                assert!(near(one.amplitude_m, other.amplitude_m, one.amplitude_m));
                // z turns by the phase of the side.
                let turn = machine.polygon.phase(a % machine.polygon.sides);
                let (x, y) = (
                    one.u_cc_m * turn.cos() - one.u_sc_m * turn.sin(),
                    one.u_cc_m * turn.sin() + one.u_sc_m * turn.cos(),
                );
                assert!(near(x, other.u_cc_m, one.amplitude_m));
                assert!(near(y, other.u_sc_m, one.amplitude_m));
                assert_eq!(one.admissible, other.admissible);
            }
            (None, None) => {}
            _ => panic!("a corner that exists in one place only"),
        }
    });
}

#[test]
fn the_other_sense_of_rotation_is_the_mirror() {
    each_case(256, |rng| {
        let machine = machines(rng);
        let speed = speed_of(rng, &machine, 0.1..3.0);
        let corner = Corner::after(&machine.polygon, 0).unwrap();
        let locked = Locked::new(&machine, corner, Form::Modal, true).unwrap();
        if let (Some(one), Some(mirror)) = (locked.at(speed), locked.at(-speed)) {
            let scale = one.multipliers_n.iter().fold(0.0_f64, |size, l| size.max(l.abs()));
            assert!(near(one.multipliers_n[0], mirror.multipliers_n[1], scale));
            // The moment arms cancel but for their difference, and round each.
            let moment_arm = machine.nodal_diameters * one.amplitude_m;
            let size = one.torque_nm.abs() + 1e-4 * scale * moment_arm;
            assert!(near(one.torque_nm, -mirror.torque_nm, size));
        }
        let slip = |speed| slip_over(&machine, &[speed]).unwrap()[0];
        if let (Ok(one), Ok(mirror)) = (slip(speed).outcome, slip(-speed).outcome) {
            assert_eq!(one.wave_speed_rad_s, -mirror.wave_speed_rad_s);
            assert_eq!(one.power_w, mirror.power_w);
        }
    });
}

/// Stiff enough blades do not move the thresholds: below `Omega_lock` some
/// multiplier pulls, above none, and the saddle stands on the side.
#[test]
fn signs_follow_the_thresholds() {
    each_case(256, |rng| {
        let machine = machines_with(rng, 1e11..1e12);
        let part = taken(|| within(rng, 0.5..2.0), |part| (part - 1.0).abs() > 1e-3);
        let lock = machine.lock_speed().unwrap();
        for state in equilibria(&machine, part * lock, true).unwrap() {
            match state.kind {
                Kind::Rest => assert_eq!(state.character, Character::Stable),
                Kind::Side => assert!(!state.stable),
                Kind::Corner => assert_eq!(state.admissible, part > 1.0),
            }
            if state.kind == Kind::Side {
                assert_eq!(state.admissible, part > 1.0);
            }
        }
    });
}

#[test]
fn slip_is_a_fixed_point_that_attracts_and_closes_its_power() {
    each_case(256, |rng| {
        let machine = machines(rng);
        let speed = speed_of(rng, &machine, 1.0..8.0);
        if let Ok(orbit) = slip_over(&machine, &[speed]).unwrap()[0].outcome {
            assert!(orbit.slope > 0.0 && orbit.slope < 1.0);
            assert!(orbit.wave_speed_rad_s > 0.0 && orbit.wave_speed_rad_s < speed);
            assert!(orbit.least_push_n >= 0.0);
            assert!(near(
                orbit.power_w,
                orbit.damper_power_w + orbit.corner_power_w,
                orbit.power_w
            ));
            let next = slip_map(&machine, speed, orbit.speed_after_corner_m_s).unwrap();
            // Close to the saddle a crossing takes long and loses digits.
            let scale = orbit.speed_after_corner_m_s * (1.0 + orbit.slope / (1.0 - orbit.slope));
            let off = next.speed_after_corner_m_s - orbit.speed_after_corner_m_s;
            assert!(off.abs() < 1e-8 * scale);
        }
    });
}
