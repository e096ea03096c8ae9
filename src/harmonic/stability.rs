//! Stability of an equilibrium of the blade frame: eigenvalues of the motion
//! linearised about it, with the sides in contact kept in contact.
//!
//! Coordinates `(x, y, alpha_c, alpha_s)`, lengths in `g0`, blade coordinates
//! in units that make their stiffness one, time in `1/omega_c`:
//! `M w'' + C w' + K w + sum Lambda_k grad g_k(w) = 0` with `g_k(w) = 0`.
//! Writing `w = w_0 + Z q + ...` with `Z` the null space of the constraint
//! gradients leaves `Z^T M Z q'' + Z^T C Z q' + Z^T (K + sum Lambda_k H_k) Z q = 0`,
//! `H_k` the second derivatives of the gap. The damping of the casing is at
//! rest in the standing frame, so `K` holds its circulatory part.

use nalgebra::{Complex, DMatrix, DVector, Matrix2, Matrix4, Matrix4x2, Schur, Vector4};

use super::equations::{Scales, Wave};
use crate::model::Machine;

/// Rate over `omega_c` from which on time is counted in a shorter unit.
const STIFF: f64 = 1e4;
/// Iterations for eigenvalues, at most; a few dozen do.
const MOST_ITERATIONS: usize = 10_000;

/// One side in contact: its phase, `(C, S)` of `psi + n_d alpha`, the lever
/// `y C - x S` and the multiplier, all scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Held {
    pub phase: (f64, f64),
    pub direction: (f64, f64),
    pub arm: f64,
    pub multiplier: f64,
}

/// `M`, `C` and `K` (with the contacts' second derivatives), and the
/// constraint gradients, at one equilibrium.
#[derive(Clone, Debug)]
pub(super) struct Linearised {
    mass: Vector4<f64>,
    damping: Matrix4<f64>,
    stiffness: Matrix4<f64>,
    gradients: Vec<Vector4<f64>>,
    multipliers: Vec<f64>,
    sine_mode: bool,
    damped: bool,
    rate: f64,
}

impl Linearised {
    /// About an equilibrium at rotor speed `speed` \[rad/s\]; `damped` includes
    /// the damping of casing and blades.
    pub fn about(machine: &Machine, speed: f64, damped: bool, held: &[Held]) -> Self {
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
        let mut stiffness = Matrix4::from_diagonal(&Vector4::new(wave.kappa, wave.kappa, 1.0, 1.0));
        stiffness[(0, 1)] = -wave.drag;
        stiffness[(1, 0)] = wave.drag;
        let softness = blade_scale(machine);
        let mut gradients = Vec::with_capacity(held.len());
        for side in held {
            let (c, s) = side.direction;
            let shape = [softness * side.phase.0, softness * side.phase.1];
            gradients.push(Vector4::new(c, s, side.arm * shape[0], side.arm * shape[1]));
            for i in 0..2 {
                // d2g/dx dphi = -S, d2g/dy dphi = C, d2g/dphi2 = -(x C + y S) = 1.
                for (row, slope) in [(0, -s), (1, c)] {
                    stiffness[(row, 2 + i)] += side.multiplier * slope * shape[i];
                    stiffness[(2 + i, row)] += side.multiplier * slope * shape[i];
                }
                for j in 0..2 {
                    stiffness[(2 + i, 2 + j)] += side.multiplier * shape[i] * shape[j];
                }
            }
        }
        let inertia = ratio * ratio;
        Self {
            mass: Vector4::new(1.0, 1.0, inertia, inertia),
            damping,
            stiffness,
            gradients,
            multipliers: held.iter().map(|side| side.multiplier).collect(),
            sine_mode: machine.has_sine_mode,
            damped,
            rate: machine.omega_c,
        }
    }

    /// Basis of the motions that keep every contact, one column each.
    fn free_motions(&self) -> DMatrix<f64> {
        let all = match self.gradients.as_slice() {
            [] => DMatrix::identity(4, 4),
            [one] => {
                // Two casing and two blade motions less one: the casing follows
                // along the normal what the blades do, and slides freely.
                let (c, s) = (one[0], one[1]);
                let mut basis = DMatrix::zeros(4, 3);
                basis[(0, 0)] = -s;
                basis[(1, 0)] = c;
                for i in 0..2 {
                    basis[(0, 1 + i)] = -one[2 + i] * c;
                    basis[(1, 1 + i)] = -one[2 + i] * s;
                    basis[(2 + i, 1 + i)] = 1.0;
                }
                basis
            }
            [a, b, ..] => {
                let follow = follow(a, b);
                DMatrix::from_fn(4, 2, |row, column| follow[(row, column)])
            }
        };
        // The last column is the sine mode of the blades.
        let last = all.ncols() - 1;
        if self.sine_mode { all } else { all.remove_column(last) }
    }

    /// Whether without the contact forces every contact would close: then the
    /// equality of Eq. (11) holds this state whatever the signs.
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

    /// Eigenvalues of the motion that keeps every contact \[1/s\].
    pub fn eigenvalues(&self) -> Vec<Complex<f64>> {
        let basis = self.free_motions();
        let across = basis.transpose();
        let mass = DMatrix::from_diagonal(&DVector::from_column_slice(self.mass.as_slice()));
        let dense = |m: &Matrix4<f64>| DMatrix::from_column_slice(4, 4, m.as_slice());
        let reduced_mass = &across * mass * &basis;
        let Some(inverse) = reduced_mass.try_inverse() else { return Vec::new() };
        let n = basis.ncols();
        let stiffness = &inverse * (&across * dense(&self.stiffness) * &basis);
        let damping = &inverse * (&across * dense(&self.damping) * &basis);
        // A time unit in which a casing that hardly springs back against its blades
        // is of order one too: its entries would be some 1e17 apart.
        let fastest = damping.amax().max(stiffness.amax().sqrt());
        let unit = if fastest > STIFF { fastest } else { 1.0 };
        let (stiffness, damping) = (stiffness / (unit * unit), damping / unit);
        let mut first_order = DMatrix::zeros(2 * n, 2 * n);
        first_order.view_mut((0, n), (n, n)).fill_with_identity();
        first_order.view_mut((n, 0), (n, n)).copy_from(&-stiffness);
        first_order.view_mut((n, n), (n, n)).copy_from(&-damping);
        let Some(schur) = Schur::try_new(first_order, f64::EPSILON, MOST_ITERATIONS) else {
            return Vec::new();
        };
        schur.complex_eigenvalues().iter().map(|value| value * (unit * self.rate)).collect()
    }

    /// Gradients of the gaps in contact.
    pub fn gradients(&self) -> &[Vector4<f64>] {
        &self.gradients
    }

    /// `K + i ratio C - ratio^2 M`.
    pub fn dynamic_stiffness(&self, ratio: f64) -> Matrix4<Complex<f64>> {
        let static_part = self.stiffness - Matrix4::from_diagonal(&self.mass) * (ratio * ratio);
        static_part.zip_map(&(self.damping * ratio), Complex::new)
    }

    /// The two motions left in a corner: the blades', which the casing follows.
    pub fn corner_basis(&self) -> Option<Matrix4x2<f64>> {
        let [a, b] = self.gradients.as_slice() else { return None };
        Some(follow(a, b))
    }

    /// `M, C, K` of the two blade motions left in a corner.
    fn corner_motion(&self) -> Option<[Matrix2<f64>; 3]> {
        let basis = self.corner_basis()?;
        let across = basis.transpose();
        Some([
            across * Matrix4::from_diagonal(&self.mass) * basis,
            across * self.damping * basis,
            across * self.stiffness * basis,
        ])
    }

    /// Whether no motion that keeps every contact grows. In a corner by the
    /// signs of its characteristic polynomial, which needs no eigenvalues
    /// unless the answer is close; elsewhere by the eigenvalues.
    pub fn is_stable(&self) -> bool {
        let by_signs = self.corner_motion().and_then(|motion| {
            let polynomial = characteristic(&motion);
            if self.damped { hurwitz(polynomial) } else { Some(all_oscillate(polynomial)) }
        });
        by_signs.unwrap_or_else(|| self.growth() <= NEUTRAL * self.rate)
    }

    /// The largest real part of any eigenvalue \[1/s\].
    pub fn growth(&self) -> f64 {
        largest_growth(&self.eigenvalues())
    }
}

/// Real parts up to this fraction of `omega_c` are rounding, not growth:
/// eigenvalues of a nearly defective pair are known to half the digits.
pub(super) const NEUTRAL: f64 = 1e-8;

/// The largest real part of these eigenvalues.
pub(super) fn largest_growth(values: &[Complex<f64>]) -> f64 {
    values.iter().map(|value| value.re).fold(f64::NEG_INFINITY, f64::max)
}

/// `n_d alpha_i` per unit of scaled blade coordinate.
pub(super) fn blade_scale(machine: &Machine) -> f64 {
    let scales = Scales::of(machine);
    (scales.softness * scales.share).sqrt()
}

/// The casing follows the blades: `(x, y) = -B_u^-1 B_alpha alpha`.
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

/// `[a4, a3, a2, a1, a0]` of `det(M s^2 + C s + K)`.
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

/// Hurwitz's criterion: every root has a negative real part. `None` too close
/// to neutral for a clear answer.
fn hurwitz([a4, a3, a2, a1, a0]: [f64; 5]) -> Option<bool> {
    let last = a1 * (a2 * a3 - a1 * a4) - a3 * a3 * a0;
    let size = (a1 * a2 * a3).abs() + a1 * a1 * a4.abs() + a3 * a3 * a0.abs();
    let clear = last.abs() > 1e-9 * size
        && a3.abs() > 1e-6 * (a2 * a4).abs().sqrt()
        && a1.abs() > 1e-6 * (a2 * a0).abs().sqrt();
    let signs = [a4, a3, a2, a1, a0].iter().all(|&coefficient| coefficient > 0.0);
    clear.then_some(signs && last > 0.0)
}

/// Without damping the odd coefficients vanish and no motion grows where both
/// roots in `s^2` are real and negative. Two equal ones differ by rounding.
fn all_oscillate([a4, _, a2, _, a0]: [f64; 5]) -> bool {
    a4 > 0.0 && a2 > 0.0 && a0 > 0.0 && a2 * a2 - 4.0 * a4 * a0 >= -1e-12 * a2 * a2
}
