//! Many steps of a linear map at once, by its powers `2^j`.
//! (docs/theory.md, section 6.)
//!
//! A step changes its coordinates by little: `T = 1 + S`, where `S` is small. As
//! `(1 + S)^2 = 1 + (2 S + S^2)`, squaring the change alone keeps its digits;
//! squaring `T` would round them off against the one, and a million steps add
//! that up. Once the change is no longer small, `T` itself is squared, so that a
//! motion that dies away keeps its digits too.

use std::sync::Arc;

use crate::tolerances::LEAP_SMALL;
use nalgebra::{SMatrix, SVector};

/// Largest number of steps that can be taken at once, as a power of two.
pub(in crate::motion::explicit) const LARGEST: usize = 40;
/// Powers of a map of `N` coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::motion::explicit) struct Leap<const N: usize> {
    /// `T^(2^j) - 1`, as long as it is small.
    changes: Arc<[SMatrix<f64, N, N>]>,
    /// `T^(2^j)`, from the last of the changes on.
    powers: Arc<[SMatrix<f64, N, N>]>,
}

impl<const N: usize> Leap<N> {
    /// Of the map that adds `change` times the coordinates to them.
    pub fn new(change: SMatrix<f64, N, N>) -> Self {
        let mut changes = vec![change];
        let is_small = |change: &SMatrix<f64, N, N>| change.diagonal().amax() < LEAP_SMALL;
        while changes.len() <= LARGEST
            && let Some(last) = changes.last().filter(|last| is_small(last))
        {
            changes.push(last * 2.0 + last * last);
        }
        let mut powers = Vec::new();
        if let Some(last) = changes.last() {
            powers.push(SMatrix::identity() + last);
        }
        while let Some(last) = powers.last().filter(|_| changes.len() + powers.len() <= LARGEST + 1)
        {
            powers.push(last * last);
        }
        Self { changes: changes.into(), powers: powers.into() }
    }

    /// The coordinates `2^exponent` steps on, for an exponent up to `LARGEST`.
    pub fn doubled(&self, at: SVector<f64, N>, exponent: usize) -> SVector<f64, N> {
        match self.changes.get(exponent) {
            Some(change) => at + change * at,
            None => self.powers[exponent + 1 - self.changes.len()] * at,
        }
    }

    /// The coordinates `steps` steps on.
    pub fn apply(&self, mut at: SVector<f64, N>, steps: u64) -> SVector<f64, N> {
        let near = self.changes.len();
        let mut left = steps;
        while left > 0 {
            let bit = left.trailing_zeros() as usize;
            left &= left - 1;
            if let Some(change) = self.changes.get(bit) {
                at += change * at;
            } else if let Some(power) = self.powers.get(bit + 1 - near) {
                at = power * at;
            }
        }
        at
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Vector2};

    /// A turn by `angle` that shrinks by `loss` each step.
    fn turn(angle: f64, loss: f64) -> Matrix2<f64> {
        let versine = 2.0 * (0.5 * angle).sin().powi(2);
        let shrunk = loss + versine - loss * versine;
        let sine = (1.0 - loss) * angle.sin();
        Matrix2::new(-shrunk, -sine, sine, -shrunk)
    }

    #[test]
    fn a_billion_small_turns_keep_their_digits() {
        // Angles that are whole numbers of 2^-40, so that their multiples are exact.
        for angle in [3.0, 1001.0, 1e6, 1e11].map(|x: f64| x.round() / 2f64.powi(40)) {
            let leap = Leap::new(turn(angle, 0.0));
            for steps in [1, 7, 1000, 123_456_789, 1_000_000_007_u64] {
                let at = leap.apply(Vector2::new(1.0, 0.0), steps);
                let (sin, cos) = (angle * steps as f64).sin_cos();
                // A rounding for each doubling and for each radian turned through.
                let allowed = 1e-16 * (40.0 + 2.0 * angle * steps as f64);
                let error = (at - Vector2::new(cos, sin)).norm();
                assert!(error < allowed, "{angle} {steps}: {error}");
            }
        }
    }

    #[test]
    fn a_motion_that_dies_away_keeps_its_digits() {
        let leap = Leap::new(turn(1e-6, 2e-6));
        let steps = 30_000_000_u64;
        let size = leap.apply(Vector2::new(1.0, 0.0), steps).norm();
        let expected = (steps as f64 * (-2e-6_f64).ln_1p()).exp();
        assert!((size / expected - 1.0).abs() < 1e-13, "{size} {expected}");
    }

    #[test]
    fn every_number_of_steps_has_its_power() {
        let leap = Leap::new(Matrix2::zeros());
        assert_eq!(leap.changes.len() + leap.powers.len(), LARGEST + 2);
        let halving = Leap::new(Matrix2::new(-0.5, 0.0, 0.0, -0.5));
        assert_eq!(halving.apply(Vector2::new(1.0, 1.0), 5).x, 1.0 / 32.0);
        assert_eq!(halving.changes.len() + halving.powers.len(), LARGEST + 2);
    }
}
