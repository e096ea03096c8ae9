//! The corner of very soft blades: contact forces open it until, at some speed, the branch folds
//! back (docs/theory.md, section 8).
//!
//! The corner is described by one equation for its half angle `Delta`, explicit in the stiffness:
//! `stiffness = -(Delta - delta) cos^3 Delta/(c sin Delta)`, where `c` is `chi` in the theory.
//! [`CornerAngle::at`] solves it for `Delta`, [`CornerAngle::at_fold`] finds its fold.

use std::f64::consts::FRAC_PI_2;

use super::equations::Scales;
use crate::model::{Machine, Number};
use crate::numeric::bisection::bisected;
use crate::tolerances::{AS_GOOD_AS_RIGID, CONVERGED};

/// Equation for the half angle of a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CornerAngle<T = f64> {
    /// Half angle with rigid blades, `delta` \[rad\].
    pub delta: f64,
    /// Compliance `c` of the equation above.
    compliance: T,
}

impl<T: Number> CornerAngle<T> {
    /// Creates the equation for a machine.
    pub fn of(machine: &Machine<T>) -> Self {
        let scales = Scales::new(machine);
        Self::new(machine.polygon.delta, scales.softness * scales.share)
    }

    /// Creates the equation from the dimensionless compliance `bend`, softness times share.
    pub fn new(delta: f64, bend: T) -> Self {
        Self { delta, compliance: bend * delta.sin().powi(2) }
    }

    /// Returns `stiffness` at the fold. The angle there depends on `delta` alone, so `stiffness` is
    /// inversely proportional to the compliance.
    pub fn fold_stiffness(&self) -> Option<T> {
        let plain = CornerAngle { delta: self.delta, compliance: self.compliance.re() };
        let (stiffness, _) = plain.stiffness(plain.at_fold())?;
        Some(self.compliance.recip() * (stiffness * plain.compliance))
    }
}

impl CornerAngle {
    /// Returns the opening `Delta - delta` at `stiffness` on the branch of stiff blades; `None`
    /// beyond its fold \[rad\].
    pub fn at(&self, stiffness: f64) -> Option<f64> {
        let mut angle_change = 0.0;
        // Newton steps shrink at least by half (at the fold) until they are round-off.
        let mut last = f64::INFINITY;
        for _ in 0..100 {
            let angle = self.delta + angle_change;
            let (sin, cos) = angle.sin_cos();
            let pull = self.compliance * stiffness / (cos * cos);
            let value = angle_change + pull * sin / cos;
            let slope = 1.0 + pull * (1.0 + 2.0 * sin * sin) / (cos * cos);
            // The slope vanishes at the fold. The equation is convex, so Newton steps from delta
            // stay on the near side of the root.
            if slope <= 0.0 {
                return None;
            }
            let step = value / slope;
            angle_change -= step;
            let angle = self.delta + angle_change;
            if !(angle > 0.0 && angle < FRAC_PI_2) {
                return None;
            }
            if step.abs() <= 2.0 * f64::EPSILON * angle_change.abs()
                || (step.abs() >= last && step.abs() <= CONVERGED * angle)
            {
                return Some(angle_change);
            }
            last = step.abs();
        }
        None
    }

    /// Returns `stiffness` at an opening of the corner, and its slope; `None` if the blades are too
    /// stiff to open that far.
    pub fn stiffness(&self, angle_change: f64) -> Option<(f64, f64)> {
        if self.compliance < AS_GOOD_AS_RIGID {
            return None;
        }
        let (sin, cos) = (self.delta + angle_change).sin_cos();
        let scale = -cos * cos / (self.compliance * sin * sin);
        let stiffness = scale * angle_change * sin * cos;
        let slope = scale * (sin * cos - angle_change * (1.0 + 2.0 * sin * sin));
        (stiffness.is_finite() && slope.is_finite()).then_some((stiffness, slope))
    }

    /// Returns the opening at the fold, which depends on `delta` alone \[rad\].
    pub fn at_fold(&self) -> f64 {
        let falls = |angle_change: f64| {
            let (sin, cos) = (self.delta + angle_change).sin_cos();
            sin * cos <= angle_change * (1.0 + 2.0 * sin * sin)
        };
        bisected([0.0, FRAC_PI_2 - self.delta], falls)[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_branch_by_speed_is_the_branch_by_opening() {
        for (delta, bend) in [(0.1428, 1e-6), (0.1428, 40.0), (0.6, 3.0), (1.0, 0.3)] {
            let corner_angle = CornerAngle::new(delta, bend);
            let (limit, slope) = corner_angle.stiffness(corner_angle.at_fold()).unwrap();
            assert!(slope.abs() < 1e-12 * (limit / delta).abs());
            for part in [-3.0, -0.5, 0.0, 1e-9, 0.1, 0.5, 0.9, 0.999] {
                let angle_change = corner_angle.at(part * limit).unwrap();
                let (back, _) = corner_angle.stiffness(angle_change).unwrap();
                // Near the fold the rounding error of an angle is amplified by a factor of a
                // hundred.
                assert!((back - part * limit).abs() <= 1e-13 * limit.abs());
                assert_eq!(angle_change > 0.0, part > 0.0);
            }
            assert_eq!(corner_angle.at(1.001 * limit), None);
        }
    }

    #[test]
    fn the_slope_is_the_slope_and_the_fold_is_the_extreme() {
        let corner_angle = CornerAngle::new(0.3, 2.0);
        let at = |angle_change| corner_angle.stiffness(angle_change).unwrap().0;
        for angle_change in [-0.1, 0.05, 0.7] {
            let (_, slope) = corner_angle.stiffness(angle_change).unwrap();
            let measured = (at(angle_change + 1e-5) - at(angle_change - 1e-5)) / 2e-5;
            assert!((measured - slope).abs() < 1e-7 * slope.abs().max(1.0));
        }
        let fold = corner_angle.at_fold();
        assert!(at(fold) < at(fold - 1e-4) && at(fold) < at(fold + 1e-4));
    }
}
