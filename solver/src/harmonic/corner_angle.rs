//! The corner of very soft blades: contact forces open it until, at some speed, the branch folds
//! back (docs/theory.md, section 8).
//!
//! The half angle `Delta` of the open corner satisfies one equation, which gives the scaled casing
//! stiffness as a function of `Delta`, folds included:
//! `stiffness = -(Delta - delta) cos^3 Delta/(c sin Delta)`, with `c` the theory's `chi`.

use std::f64::consts::FRAC_PI_2;

/// Relative size below which a Newton step that no longer shrinks counts as converged.
const CONVERGED: f64 = 1e-7;

/// Equation for the half angle of a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CornerAngle {
    /// Half angle of the unbent corner, `delta` \[rad\].
    pub delta: f64,
    /// Factor `c` of the equation above: softness times share times `sin^2 delta`.
    compliance: f64,
}

impl CornerAngle {
    /// Creates the corner angle from the (dimensionless) softness of the blades times their
    /// share.
    pub fn new(delta: f64, bend: f64) -> Self {
        Self { delta, compliance: bend * delta.sin().powi(2) }
    }

    /// Returns the change of the corner angle, `Delta - delta`, at the scaled casing stiffness
    /// `stiffness` \[rad\], on the branch of stiff blades. `None` beyond its fold, and where the
    /// angle would leave the range from 0 to `pi/2`.
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_branch_solves_its_equation_up_to_the_fold() {
        for (delta, bend) in [(0.1428_f64, 1e-6), (0.1428, 40.0), (0.6, 3.0), (1.0, 0.3)] {
            let stiffness = |angle: f64| {
                -(angle - delta) * angle.cos().powi(3) / (bend * delta.sin().powi(2) * angle.sin())
            };
            let angles = (0..100_000).map(|k| delta + 1e-5 * (FRAC_PI_2 - delta) * f64::from(k));
            let limit = angles.map(stiffness).fold(0.0, f64::min);
            let corner_angle = CornerAngle::new(delta, bend);
            for part in [-3.0, -0.5, 0.0, 1e-9, 0.1, 0.5, 0.9, 0.999] {
                let angle_change = corner_angle.at(part * limit).unwrap();
                let back = stiffness(delta + angle_change);
                assert!((back - part * limit).abs() <= 1e-12 * limit.abs());
                assert_eq!(angle_change > 0.0, part > 0.0);
            }
            assert_eq!(corner_angle.at(1.001 * limit), None);
        }
    }
}
