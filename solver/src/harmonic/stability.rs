//! Stability of an equilibrium in the blade frame: eigenvalues of the motion linearised about it,
//! with the contacts kept (docs/theory.md, section 8).
//!
//! Coordinates are `(x, y, alpha_c, alpha_s)`, lengths in `g0`, blade coordinates in units that
//! make their stiffness one, time in `1/omega_c`:
//! `M w'' + C w' + K w + sum Lambda_k grad g_k(w) = 0` with `g_k(w) = 0`. Writing
//! `w = w_0 + Z q + ...`, where `Z` spans the null space of the constraint gradients, leaves
//! `Z^T M Z q'' + Z^T C Z q' + Z^T (K + sum Lambda_k H_k) Z q = 0`, `H_k` being the second
//! derivatives of the gaps. The casing damping is fixed in the stationary frame, so `K` contains
//! its circulatory part.
//!
//! If tips are inclined or rub (section 10), the forces do not act along the gradients, and the
//! equations are projected onto the null space of the force directions instead. For gaps that do
//! not turn with the blade angle this is the coupled motion of casing and blades,
//! `L_c(s) + (1 + i mu_c) L_a(s)/c2 = 0`.

use nalgebra::{Complex, DMatrix, DVector, Matrix2, Matrix4, Matrix4x2, Vector4};

use super::equations::{Scales, Wave};
use crate::model::Machine;
use crate::numeric::eigen::eigenvalues;
use crate::tolerances::{AS_ZERO, CLEAR_DAMPING, CLEAR_SIGN, NEUTRAL, ROUND_OFF};

/// A side in contact, scaled: its phase; the direction `(C, S)` of `psi + n_d alpha`; the component
/// `x C + y S` of `z`; the derivative of the gap with respect to the blade angle (`y C - x S` and
/// the tip slope); the lever of the contact force on the blade (with friction); and the multiplier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ClosedSide {
    pub phase: (f64, f64),
    pub direction: (f64, f64),
    pub along: f64,
    pub arm: f64,
    pub moment: f64,
    pub multiplier: f64,
}

/// `M`, `C` and `K` (including the second derivatives of the gaps), the constraint gradients and
/// the force directions at one equilibrium.
#[derive(Clone, Debug)]
pub(super) struct Linearised {
    mass: Vector4<f64>,
    damping: Matrix4<f64>,
    stiffness: Matrix4<f64>,
    gradients: Vec<Vector4<f64>>,
    forces: Vec<Vector4<f64>>,
    multipliers: Vec<f64>,
    sine_mode: bool,
    damped: bool,
    rate: f64,
}

impl Linearised {
    /// Linearises the motion about an equilibrium at a rotor speed \[rad/s\], with or without the
    /// damping of casing and blades.
    pub fn about(machine: &Machine, speed: f64, damped: bool, held: &[ClosedSide]) -> Self {
        let wave = Wave::at(machine, speed, damped);
        let whirl = 2.0 * machine.nu(speed) / machine.omega_c;
        let ratio = machine.omega_c / machine.omega_bd;
        let (casing, blades) = if damped {
            (2.0 * machine.casing_damping_ratio, 2.0 * machine.blade_damping_ratio * ratio)
        } else {
            (0.0, 0.0)
        };
        let mut damping = Matrix4::from_diagonal(&Vector4::new(casing, casing, blades, blades));
        damping[(0, 1)] = -whirl;
        damping[(1, 0)] = whirl;
        let mut stiffness =
            Matrix4::from_diagonal(&Vector4::new(wave.stiffness, wave.stiffness, 1.0, 1.0));
        stiffness[(0, 1)] = -wave.drag;
        stiffness[(1, 0)] = wave.drag;
        let softness = blade_scale(machine);
        let mu = machine.casing_friction_at(speed);
        let (mut gradients, mut forces) = (Vec::with_capacity(2), Vec::with_capacity(2));
        for side in held {
            let (c, s) = side.direction;
            let push = [c - mu * s, s + mu * c];
            let shape = [softness * side.phase.0, softness * side.phase.1];
            let turned =
                |[x, y]: [f64; 2], arm: f64| Vector4::new(x, y, arm * shape[0], arm * shape[1]);
            gradients.push(turned([c, s], side.arm));
            forces.push(turned(push, side.moment));
            for i in 0..2 {
                // Blades turn the force, and the casing its lever; without friction d2g/dx dphi =
                // -S, d2g/dy dphi = C, d2g/dphi2 = -(x C + y S).
                for (row, turn, swing) in [(0, -push[1], -s), (1, push[0], c)] {
                    stiffness[(row, 2 + i)] += side.multiplier * turn * shape[i];
                    stiffness[(2 + i, row)] += side.multiplier * swing * shape[i];
                }
                let bend = -(side.multiplier * side.along);
                for j in 0..2 {
                    stiffness[(2 + i, 2 + j)] += bend * shape[i] * shape[j];
                }
            }
        }
        let inertia = ratio * ratio;
        Self {
            mass: Vector4::new(1.0, 1.0, inertia, inertia),
            damping,
            stiffness,
            gradients,
            forces,
            multipliers: held.iter().map(|side| side.multiplier).collect(),
            sine_mode: machine.has_sine_mode,
            damped,
            rate: machine.omega_c,
        }
    }

    /// Returns an orthonormal basis of the motions that keep every contact, one column each, in
    /// coordinates of unit mass.
    fn free_motions(&self, weights: &[f64]) -> DMatrix<f64> {
        let mut basis = DMatrix::identity(weights.len(), weights.len());
        for gradient in &self.gradients {
            // Householder reflection of the remaining motions, after which only the first one
            // changes this gap.
            let gradient = DVector::from_fn(weights.len(), |row, _| gradient[row] / weights[row]);
            let mut seen = basis.tr_mul(&gradient);
            let length = seen.norm();
            seen[0] += length.copysign(seen[0]);
            let square = seen.norm_squared();
            if square > 0.0 {
                let shares = (&basis * &seen) * (2.0 / square);
                basis -= shares * seen.transpose();
            }
            basis = basis.remove_column(0);
        }
        basis
    }

    /// Returns whether every contact would close if the contact forces were removed. The equality
    /// of Eq. (11) then holds this state whatever the signs.
    pub fn closes(&self) -> bool {
        self.gradients.iter().all(|gradient| {
            let pushes = self.gradients.iter().zip(&self.multipliers);
            let acceleration: f64 = pushes
                .map(|(other, multiplier)| {
                    multiplier * gradient.component_div(&self.mass).dot(other)
                })
                .sum();
            acceleration < 0.0
        })
    }

    /// Returns the eigenvalues of the motion that keeps every contact \[1/s\]; `None` if they
    /// overflow or do not converge.
    pub fn eigenvalues(&self) -> Option<Vec<Complex<f64>>> {
        // The last coordinate is the sine mode of the blades. Blades so stiff that their rates
        // overflow have zero mass in these units and are left out.
        let masses = self.mass.iter().take(if self.sine_mode { 4 } else { 3 });
        let weights: Vec<f64> = masses.map(|m| m.sqrt()).filter(|&weight| weight > 0.0).collect();
        let coordinates = weights.len();
        let basis = self.free_motions(&weights);
        // Unit of time in which the rates of stiff blades are of order one.
        let unit = weights.iter().fold(1.0, |unit: f64, weight| unit.min(*weight));
        let reduced = |entry: &dyn Fn(usize, usize) -> f64| {
            basis.tr_mul(&(DMatrix::from_fn(coordinates, coordinates, entry) * &basis))
        };
        let stiffness =
            reduced(&|i, j| self.stiffness[(i, j)] * (unit / weights[i]) * (unit / weights[j]));
        let damping = reduced(&|i, j| self.damping[(i, j)] / weights[i] * (unit / weights[j]));
        let n = basis.ncols();
        let mut first_order = DMatrix::zeros(2 * n, 2 * n);
        first_order.view_mut((0, n), (n, n)).fill_with_identity();
        first_order.view_mut((n, 0), (n, n)).copy_from(&-stiffness);
        first_order.view_mut((n, n), (n, n)).copy_from(&-damping);
        let values = eigenvalues(first_order)?;
        Some(values.iter().map(|value| value * (self.rate / unit)).collect())
    }

    /// Returns the gradients of the closed gaps.
    pub fn gradients(&self) -> &[Vector4<f64>] {
        &self.gradients
    }

    /// Returns the dynamic stiffness `K + i ratio C - ratio^2 M`.
    pub fn dynamic_stiffness(&self, ratio: f64) -> Matrix4<Complex<f64>> {
        let static_part = self.stiffness - Matrix4::from_diagonal(&self.mass) * (ratio * ratio);
        static_part.zip_map(&(self.damping * ratio), Complex::new)
    }

    /// Returns a basis of the two motions that remain in a corner: those of the blades, which the
    /// casing follows.
    pub fn corner_basis(&self) -> Option<Matrix4x2<f64>> {
        let [a, b] = self.gradients.as_slice() else { return None };
        Some(follow(a, b))
    }

    /// Returns `M, C, K` of the two blade motions in a corner, projected onto the directions in
    /// which the contact forces do no work.
    fn corner_motion(&self) -> Option<[Matrix2<f64>; 3]> {
        let basis = self.corner_basis()?;
        let [a, b] = self.forces.as_slice() else { return None };
        let across = follow(a, b).transpose();
        Some([
            across * Matrix4::from_diagonal(&self.mass) * basis,
            across * self.damping * basis,
            across * self.stiffness * basis,
        ])
    }

    /// Returns the eigenvalues in a corner whose contact forces do not act along the gradients
    /// \[1/s\]; `None` if they cannot be computed.
    fn eigenvalues_in_corner(&self) -> Option<Vec<Complex<f64>>> {
        let [mass, damping, stiffness] = self.corner_motion()?;
        let inverse = mass.try_inverse()?;
        let mut first_order = DMatrix::zeros(4, 4);
        first_order.view_mut((0, 2), (2, 2)).fill_with_identity();
        first_order.view_mut((2, 0), (2, 2)).copy_from(&-(inverse * stiffness));
        first_order.view_mut((2, 2), (2, 2)).copy_from(&-(inverse * damping));
        Some(eigenvalues(first_order)?.iter().map(|value| value * self.rate).collect())
    }

    /// Returns the growth rate of the fastest motion that keeps every contact \[1/s\]; `None` if
    /// none grows, infinite if the eigenvalues cannot be computed. In a corner the signs of the
    /// characteristic polynomial are tried first; eigenvalues are computed only if these are
    /// inconclusive or show growth.
    pub fn growth(&self) -> Option<f64> {
        let along = self.forces == self.gradients;
        let by_signs = self.corner_motion().filter(|_| along).and_then(|motion| {
            let polynomial = characteristic(&motion);
            if self.damped { hurwitz(polynomial) } else { Some(all_oscillate(polynomial)) }
        });
        if by_signs == Some(true) {
            return None;
        }
        let values = if along { self.eigenvalues() } else { self.eigenvalues_in_corner() };
        let Some(values) = values else { return Some(f64::INFINITY) };
        let unstable = by_signs == Some(false) || grows(&values, self.rate);
        unstable.then(|| largest_growth(&values))
    }
}

/// Returns whether a motion with one of these eigenvalues grows. Real parts up to a small fraction
/// of the eigenvalue, or of `rate`, are round-off: a nearly defective pair has half the digits, and
/// all eigenvalues have the round-off of the largest.
pub(super) fn grows(values: &[Complex<f64>], rate: f64) -> bool {
    let fastest = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
    values
        .iter()
        .any(|value| value.re > (NEUTRAL * value.norm().max(rate)).max(ROUND_OFF * fastest))
}

/// Returns the eigenvalues of the motion about rest without contact \[1/s\]: those of the casing,
/// shifted by the rotation, and of the blades.
pub(super) fn at_rest(machine: &Machine, speed: f64, damped: bool) -> Vec<Complex<f64>> {
    let roots = |rate: f64, zeta: f64| {
        let zeta = if damped { zeta } else { 0.0 };
        let root = Complex::new((zeta - 1.0) * (zeta + 1.0), 0.0).sqrt();
        // The slower of two real roots as a quotient, which avoids cancellation.
        let slow = if zeta > 1.0 { -1.0 / (root + zeta) } else { root - zeta };
        [slow * rate, (-root - zeta) * rate]
    };
    let casing = roots(machine.omega_c, machine.casing_damping_ratio);
    let turn = Complex::new(0.0, machine.nu(speed));
    let mut values: Vec<_> = casing.iter().flat_map(|root| [root + turn, root - turn]).collect();
    let modes = if machine.has_sine_mode { 2 } else { 1 };
    for _ in 0..modes {
        values.extend(roots(machine.omega_bd, machine.blade_damping_ratio));
    }
    values
}

/// Returns the largest real part of these eigenvalues.
pub(super) fn largest_growth(values: &[Complex<f64>]) -> f64 {
    values.iter().map(|value| value.re).fold(f64::NEG_INFINITY, f64::max)
}

/// Returns the factor `n_d alpha_i` per unit of scaled blade coordinate.
pub(super) fn blade_scale(machine: &Machine) -> f64 {
    let scales = Scales::new(machine);
    (scales.softness * scales.share).sqrt()
}

/// Returns the motions in which the casing follows the blades, `(x, y) = -B_u^-1 B_alpha alpha`.
fn follow(a: &Vector4<f64>, b: &Vector4<f64>) -> Matrix4x2<f64> {
    let determinant = a[0] * b[1] - a[1] * b[0];
    let mut basis = Matrix4x2::zeros();
    for i in 0..2 {
        let (right_a, right_b) = (-a[2 + i], -b[2 + i]);
        basis[(0, i)] = (right_a * b[1] - right_b * a[1]) / determinant;
        basis[(1, i)] = (a[0] * right_b - b[0] * right_a) / determinant;
        basis[(2 + i, i)] = 1.0;
    }
    basis
}

/// Returns the coefficients `[a4, a3, a2, a1, a0]` of `det(M s^2 + C s + K)`.
fn characteristic([m, c, k]: &[Matrix2<f64>; 3]) -> [f64; 5] {
    let entry = |i: usize, j: usize| [m[(i, j)], c[(i, j)], k[(i, j)]];
    let product = |p: [f64; 3], q: [f64; 3]| {
        [
            p[0] * q[0],
            p[0] * q[1] + p[1] * q[0],
            p[0] * q[2] + p[1] * q[1] + p[2] * q[0],
            p[1] * q[2] + p[2] * q[1],
            p[2] * q[2],
        ]
    };
    let (diagonal, other) = (product(entry(0, 0), entry(1, 1)), product(entry(0, 1), entry(1, 0)));
    std::array::from_fn(|i| diagonal[i] - other[i])
}

/// Applies Hurwitz's criterion: whether every root has a negative real part. `None` if it is too
/// close to neutral to decide.
fn hurwitz([a4, a3, a2, a1, a0]: [f64; 5]) -> Option<bool> {
    let last = a1 * (a2 * a3 - a1 * a4) - a3 * a3 * a0;
    let size = (a1 * a2 * a3).abs() + a1 * a1 * a4.abs() + a3 * a3 * a0.abs();
    let clear = last.abs() > CLEAR_SIGN * size
        && a3.abs() > CLEAR_DAMPING * (a2 * a4).abs().sqrt()
        && a1.abs() > CLEAR_DAMPING * (a2 * a0).abs().sqrt();
    let signs = [a4, a3, a2, a1, a0].iter().all(|&coefficient| coefficient > 0.0);
    clear.then_some(signs && last > 0.0)
}

/// Returns whether no undamped motion grows: the odd coefficients vanish, so both roots in `s^2`
/// must be real and negative. The tolerance accepts two equal roots that differ by round-off.
fn all_oscillate([a4, _, a2, _, a0]: [f64; 5]) -> bool {
    a4 > 0.0 && a2 > 0.0 && a0 > 0.0 && a2 * a2 - 4.0 * a4 * a0 >= -AS_ZERO * a2 * a2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_that_flutters_is_unstable_though_every_coefficient_is_positive() {
        // (s^2 + p s + 1)(s^2 + q s + 4) grows if p or q is negative.
        let polynomial = |p: f64, q: f64| [1.0, p + q, 5.0 + p * q, 4.0 * p + q, 4.0];
        assert_eq!(hurwitz(polynomial(0.1, 0.3)), Some(true));
        assert_eq!(hurwitz(polynomial(-0.01, 0.3)), Some(false));
        assert!(polynomial(-0.01, 0.3).iter().all(|&coefficient| coefficient > 0.0));
        assert_eq!(hurwitz(polynomial(0.3, -0.1)), Some(false));
        // A nearly neutral pair is left to the eigenvalues.
        assert_eq!(hurwitz(polynomial(0.0, 0.3)), None);
    }
}
