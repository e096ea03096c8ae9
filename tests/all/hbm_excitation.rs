//! The response of a locked motion to an engine-order excitation, put into the
//! equations of motion of the standing frame.

use nalgebra::Complex;
use rubscope_solver::harmonic::{ExcitedLock, drives, excited_locks};
use rubscope_solver::model::{BladedDisk, Casing, Excitation, Machine};

fn machine(nodal_diameters: u32) -> Machine {
    Machine::new(&BladedDisk::default(), &Casing::default(), nodal_diameters)
}

fn lock(machine: &Machine, speed: f64, order: u32, amplitude_nm: f64) -> ExcitedLock {
    let excitation = Excitation { amplitude_nm, order };
    excited_locks(machine, 15, &excitation, &[speed]).unwrap().remove(0)
}

#[test]
fn only_orders_of_the_same_symmetry_reach_the_modes() {
    let driven: Vec<u32> = (1..=50).filter(|&order| drives(&machine(3), order)).collect();
    assert_eq!(driven, [3, 19, 25, 41, 47]);
    let other = lock(&machine(3), 500.0, 4, 1.0);
    assert_eq!((other.relative_amplitude, other.release_torque_nm), (0.0, None));
}

/// Residual of the equations of motion at `t` for the locked motion plus the
/// real part of the response: casing [N], blades [N m], gaps [m].
fn residual(machine: &Machine, speed: f64, order: u32, torque: f64, t: f64) -> [f64; 6] {
    let excited = lock(machine, speed, order, torque);
    let state = &excited.state;
    let omega = excited.frequency_rad_s;
    let turn = Complex::new(0.0, omega * t).exp();
    let i_omega = Complex::new(0.0, omega);
    let value = |k: usize, power: i32| (excited.response[k] * i_omega.powi(power) * turn).re;
    let n_d = machine.nodal_diameters;
    let theta = speed * t;
    let nu = machine.nu(speed);
    let z = |p: i32| {
        let mean = if p == 0 { Complex::new(state.z_m[0], state.z_m[1]) } else { 0.0.into() };
        mean + Complex::new(value(0, p), value(1, p))
    };
    let i_nu = Complex::new(0.0, nu);
    // Standing frame: u = z exp(i nu t) and its derivatives.
    let frame = Complex::new(0.0, nu * t).exp();
    let u = z(0) * frame;
    let u1 = (z(1) + i_nu * z(0)) * frame;
    let u2 = (z(2) + 2.0 * i_nu * z(1) - nu * nu * z(0)) * frame;
    let alpha = |k: usize, p: i32| {
        (if p == 0 { [state.alpha_c_rad, state.alpha_s_rad][k] } else { 0.0 }) + value(2 + k, p)
    };
    let mut casing =
        machine.casing_mass * u2 + machine.casing_damping * u1 + machine.casing_stiffness * u;
    let mut blades = [0, 1].map(|k| {
        machine.blade_modal_mass * alpha(k, 2)
            + machine.blade_modal_damping * alpha(k, 1)
            + machine.blade_modal_stiffness * alpha(k, 0)
    });
    let mut gaps = [0.0; 2];
    for (n, contact) in state.contacts.iter().enumerate() {
        let side = contact.side;
        let multiplier = contact.multiplier_n + (excited.multipliers_n[n] * turn).re;
        let psi = machine.polygon.phase(side);
        let (p_c, p_s) = (psi.cos(), psi.sin());
        let beta = n_d * theta + psi + n_d * (p_c * alpha(0, 0) + p_s * alpha(1, 0));
        let direction = Complex::new(0.0, beta).exp();
        casing += multiplier * direction;
        let a = n_d * (u.im * beta.cos() - u.re * beta.sin());
        blades[0] += multiplier * a * p_c;
        blades[1] += multiplier * a * p_s;
        gaps[n] = machine.clearance() + u.re * beta.cos() + u.im * beta.sin();
    }
    for blade in 0..machine.polygon.blades {
        let phi = std::f64::consts::TAU * f64::from(blade) / f64::from(machine.polygon.blades);
        let load = torque * (f64::from(order) * (theta + phi)).cos();
        blades[0] -= load * (n_d * phi).cos();
        blades[1] -= load * (n_d * phi).sin();
    }
    [casing.re, casing.im, blades[0], blades[1], gaps[0], gaps[1]]
}

#[test]
fn the_response_solves_the_equations_of_motion_to_first_order() {
    for (order, speed) in [(3, 500.0), (19, 450.0), (25, 600.0)] {
        let machine = machine(3);
        for t in [1e-4, 3.3e-3] {
            // The linear response leaves an error of second order: a tenth of
            // the load leaves a hundredth of the residual.
            let large = residual(&machine, speed, order, 100.0, t);
            let small = residual(&machine, speed, order, 10.0, t);
            // Sizes: K z of 100 N, 1000 N m of load, 1e-4 m; 1e-12 of them is rounding.
            for (k, size) in [150.0, 150.0, 1e3, 1e3, 1e-4, 1e-4].into_iter().enumerate() {
                let (large, small) = (large[k].abs() / size, small[k].abs() / size);
                assert!(large < 1e-4, "{order} {k}: {large:e}");
                assert!(small < 0.015 * large + 1e-10, "{order} {k}: {large:e}, {small:e}");
            }
        }
    }
}
