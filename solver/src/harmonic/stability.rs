//! Stability of an equilibrium in the blade frame: eigenvalues of the motion about it with the
//! contacts kept (`model::Frame`; docs/theory.md, section 8).
//!
//! Run, `hbm`, margins, survey, check and screen all judge a lock by [`Kept`]. It includes the change
//! of the contact forces' directions as blades bend (the curvature of the pushes).

use nalgebra::Complex;

use crate::model::{Frame, Machine, Row};
use crate::numeric::rounding::ROUND_OFF;

/// Real part of an eigenvalue, relative to the eigenvalue, up to which it counts as round-off: a
/// nearly defective pair of eigenvalues is accurate to half the digits only.
const NEUTRAL: f64 = 1e-8;

/// Equilibrium with contact rows, and the motion about it.
#[derive(Clone, Debug)]
pub(super) struct Kept {
    pub frame: Frame,
    pub rows: Vec<Row>,
    /// Multipliers of the rows; negative is a push \[N\].
    pub multipliers: Vec<f64>,
    /// Unit of growth rates, the casing frequency \[rad/s\].
    pub rate: f64,
}

impl Kept {
    /// Returns whether every contact would close if the contact forces were removed. The equality
    /// of Eq. (11) then holds this state whatever the signs.
    pub fn closes(&self) -> bool {
        let [casing, blades] = [self.frame.casing.mass, self.frame.blades.mass];
        let moved = |row: &Row, by: &Row| {
            let product = row.gap.component_mul(&by.force);
            (product.x + product.y) / casing + (product.z + product.w) / blades
        };
        let forces = || self.rows.iter().zip(&self.multipliers);
        self.rows
            .iter()
            .all(|row| forces().map(|(by, lambda)| lambda * moved(row, by)).sum::<f64>() < 0.0)
    }

    /// Returns the eigenvalues of the motion that keeps every contact \[1/s\]; `None` if they cannot
    /// be computed.
    pub fn eigenvalues(&self) -> Option<Vec<Complex<f64>>> {
        self.frame.motion(&self.rows, &[]).eigenvalues()
    }

    /// Returns the growth rate of the fastest motion that keeps every contact \[1/s\]; `None` if none
    /// grows, infinite if the eigenvalues cannot be computed.
    pub fn growth(&self) -> Option<f64> {
        let Some(values) = self.eigenvalues() else { return Some(f64::INFINITY) };
        grows(&values, self.rate).then(|| largest_growth(&values))
    }
}

/// Returns whether a motion with one of these eigenvalues grows. Real parts up to [`NEUTRAL`] times
/// the eigenvalue or `rate` count as round-off, and so do those within the round-off of the largest
/// eigenvalue.
pub(super) fn grows(values: &[Complex<f64>], rate: f64) -> bool {
    let fastest = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
    values
        .iter()
        .any(|value| value.re > (NEUTRAL * value.norm().max(rate)).max(ROUND_OFF * fastest))
}

/// Returns the eigenvalues of the motion about rest without contact \[1/s\]: those of the casing,
/// shifted by the rotation, and of the blades.
pub(super) fn at_rest(machine: &Machine, speed: f64) -> Vec<Complex<f64>> {
    let roots = |rate: f64, zeta: f64| {
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
