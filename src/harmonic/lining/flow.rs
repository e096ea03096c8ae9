//! Small motions about a steady wave on a lining, as eigenvalues of eight real states:
//! casing and blade wave with their rates, in the frame that turns with the wave.
//! (docs/theory.md, section 10.)
//!
//! With `z -> z e^{ist}` every time derivative becomes `d/dt + i omega` for the casing
//! and `d/dt + i s` for the blades; a steady state has `omega = nu`, `s = 0`.

use nalgebra::{Complex, DMatrix};

use crate::harmonic::Joint;
use crate::numeric::eigen;

/// A real matrix of two rows that acts on `(Re w, Im w)`.
pub(super) type Tangent = [[f64; 2]; 2];

/// The growth rates `Re` and frequencies `Im` of the motions about a wave of casing
/// frequency `omega` and blade frequency `s` \[rad/s\], whose pushes change by
/// `dp = -tangent dw` \[N/m\]; `None` where the eigenvalues overflow.
pub(super) fn eigenvalues(
    joint: &Joint,
    [omega, s]: [f64; 2],
    tangent: Tangent,
) -> Option<Vec<Complex<f64>>> {
    let m = joint.machine;
    let friction = joint.casing_friction;
    let (kappa, length) = (m.radial_coupling, m.blade_length);
    // Lengths of the blades' tips, times in units of the fastest frequency.
    let rate = omega.abs().max(s.abs()).max(m.omega_c).max(m.omega_bd);
    let lead = kappa + joint.machine.friction_at(joint.nu);
    let blade_mass = m.blade_modal_mass / (length * length);
    let mut matrix = DMatrix::zeros(8, 8);
    let parts = [
        (omega, m.casing_mass, m.casing_damping, m.casing_stiffness),
        (s, m.blade_modal_mass, m.blade_modal_damping, m.blade_modal_stiffness),
    ];
    for (part, (turn, mass, damping, stiffness)) in parts.into_iter().enumerate() {
        let (at, to) = (4 * part, 4 * part + 2);
        let (turn, drag) = (turn / rate, damping / (mass * rate));
        let spring = stiffness / (mass * rate * rate) - turn * turn;
        for k in 0..2 {
            matrix[(at + k, to + k)] = 1.0;
            matrix[(to + k, at + k)] -= spring;
            matrix[(to + k, to + k)] -= drag;
        }
        // -(2 i turn) times the rate, -(i turn drag) times the place.
        for (row, column, sign) in [(0, 1, 1.0), (1, 0, -1.0)] {
            matrix[(to + row, to + column)] += sign * 2.0 * turn;
            matrix[(to + row, at + column)] += sign * turn * drag;
        }
    }
    // dp = -T (dz - kappa da), with da in lengths of the tip.
    let square = rate * rate;
    for column in 0..2 {
        for (from, gain) in [(0, 1.0), (4, -kappa)] {
            let push = [-tangent[0][column] * gain, -tangent[1][column] * gain];
            let on_casing = [push[0] - friction * push[1], push[1] + friction * push[0]];
            for row in 0..2 {
                matrix[(2 + row, from + column)] += on_casing[row] / (m.casing_mass * square);
                matrix[(6 + row, from + column)] -= lead * push[row] / (blade_mass * square);
            }
        }
    }
    let values = eigen::eigenvalues(matrix)?;
    Some(values.into_iter().map(|value| value * rate).collect())
}
