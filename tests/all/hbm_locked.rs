//! Locked motion in the frequency domain against the closed forms, the paper's
//! numbers, and the eight equations (27) written out as they are printed.

use crate::hbm_slip::machine;
use crate::near;
use nalgebra::SVector;
use rubscope_solver::harmonic::{Form, LockedPoint, locked_motion};
use rubscope_solver::model::{BladedDisk, Casing, Machine};

fn at(machine: &Machine, form: Form, damped: bool, speed: f64) -> LockedPoint {
    locked_motion(machine, form, damped, None, &[speed]).unwrap().points[0]
}

/// With practically rigid blades every form is the closed form of the model.
#[test]
fn stiff_blades_meet_the_closed_forms_to_twelve_digits() {
    let stiff = BladedDisk { stiffness_nm_per_rad: 1e15, ..BladedDisk::default() };
    for (diameters, zeta) in [(3, 0.05), (3, 0.0), (4, 0.05), (1, 0.3), (10, 0.01)] {
        let casing = Casing { damping_ratio: zeta, ..Casing::default() };
        let machine = Machine::new(&stiff, &casing, diameters);
        for form in Form::ALL {
            let critical = machine.critical_speed().unwrap();
            for speed in [-430.0, 0.0, 100.0, critical, 293.0, 411.0, 500.0, 2000.0] {
                let point = at(&machine, form, true, speed);
                let expected = machine.locked_multipliers(speed).unwrap();
                let scale = machine.casing_stiffness * machine.clearance()
                    + expected[0].abs().max(expected[1].abs());
                for (value, exact) in point.multipliers_n.iter().zip(expected) {
                    near(*value, exact, 1e-12 * scale);
                }
                let amplitude = machine.locked_amplitude().unwrap();
                near(point.amplitude_m, amplitude, 1e-12 * amplitude);
                let nu = machine.nu(speed);
                let dissipated = machine.casing_damping * nu * nu * amplitude * amplitude;
                // The clearance itself is a difference of two numbers near 0.5 m,
                // but both sides use the same one.
                near(point.power_w, dissipated, 1e-12 * (dissipated + 1.0));
            }
        }
    }
}

/// `[u_cc, u_cs, u_sc, u_ss, lambda_1, lambda_2, alpha_1, alpha_2]`
type Eight = SVector<f64, 8>;

/// Eq. (27) exactly as printed, neighbours by Eq. (20); casing rows divided by
/// 1e6 and blade rows left in N m, so that they are of one size.
fn printed_equations(disk: &BladedDisk, casing: &Casing, speed: f64, u: &Eight) -> Eight {
    let n_d = 3.0;
    let (i1, i2) = (6.0, 21.0);
    let phase = |i: f64| n_d * std::f64::consts::TAU * (i - 1.0) / 22.0;
    let (p_c, p_s) = (|i: f64| phase(i).cos(), |i: f64| phase(i).sin());
    let [u_cc, u_cs, u_sc, u_ss, l1, l2, a1, a2]: [f64; 8] = (*u).into();
    let pair = nalgebra::Matrix2::new(p_c(i1), p_s(i1), p_c(i2), p_s(i2)).try_inverse().unwrap();
    let modes = pair * nalgebra::Vector2::new(a1, a2);
    let angle = |i: f64| p_c(i) * modes[0] + p_s(i) * modes[1];
    let (k_b, k_bb) = (disk.stiffness_nm_per_rad, disk.coupling_nm_per_rad);
    let (c1, s1, c2, s2) = (p_c(i1), p_s(i1), p_c(i2), p_s(i2));
    let g0 = casing.radius_m - disk.blade_length_m;
    let k = casing.modal_stiffness_n_per_m - (n_d * speed).powi(2) * casing.modal_mass_kg;
    let blade = |l: f64, a: f64, c: f64, s: f64, i: f64| {
        l * n_d * s * (u_ss + u_cc + n_d * a * (u_sc - u_cs))
            + l * n_d * c * (u_cs - u_sc + n_d * a * (u_ss + u_cc))
            + (k_b + 2.0 * k_bb) * a
            - k_bb * (angle(i - 1.0) + angle(i + 1.0))
    };
    let gap = |a: f64, c: f64, s: f64| {
        2.0 * g0
            + s * (u_sc - u_cs - n_d * a * (u_ss + u_cc))
            + c * (u_ss + u_cc + n_d * a * (u_sc - u_cs))
    };
    let push_c = l1 * (c1 - n_d * a1 * s1) + l2 * (c2 - n_d * a2 * s2);
    let push_s = l1 * (s1 + n_d * a1 * c1) + l2 * (s2 + n_d * a2 * c2);
    Eight::from([
        blade(l1, a1, c1, s1, i1),
        blade(l2, a2, c2, s2, i2),
        gap(a1, c1, s1),
        gap(a2, c2, s2),
        (k * u_cc + push_c) / 1e6,
        (k * u_cs - push_s) / 1e6,
        (k * u_sc + push_s) / 1e6,
        (k * u_ss + push_c) / 1e6,
    ])
}

#[test]
fn the_eight_printed_equations_hold() {
    let (disk, casing) = (BladedDisk::default(), Casing::default());
    let machine = machine(3, 0.05);
    for speed in [50.0, 290.0, 400.0, 500.0] {
        let point = at(&machine, Form::Printed, false, speed);
        let found = Eight::from([
            point.u_cc_m,
            point.u_cs_m,
            point.u_sc_m,
            point.u_ss_m,
            point.multipliers_n[0],
            point.multipliers_n[1],
            point.alpha_rad[0],
            point.alpha_rad[1],
        ]);
        let residual = printed_equations(&disk, &casing, speed, &found);
        // Terms of 1e-4 m and 1e-2 N m, so 1e-15 is a few units of rounding of
        // the torque rows.
        assert!(residual.amax() < 1e-15, "{residual}");
    }
}
