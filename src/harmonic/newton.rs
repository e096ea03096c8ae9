//! Newton's method on the equations of a corner, kept on the branch of its
//! rigid blades.
//! (docs/theory.md, section 8.)
//!
//! Far from the solution Newton's method is unreliable: it may miss the solution or
//! find another branch, at one speed and not at the next. So a start is accepted
//! only if its steps are small and shrink. If not, because blades are soft, the
//! solution is followed from rigid to soft blades; it ends where that branch folds.

use super::equations::{Equations, Unknowns, Wave};
use crate::tolerances::{
    NEAR_A_FOLD, NEWTON_ALIKE, NEWTON_LARGEST, NEWTON_SHRINK, NEWTON_STEPS, NEWTON_STRIDE,
    NEWTON_STRIDES,
};

impl Equations {
    /// The corner that rigid blades grow into as they soften; `None` if it
    /// folds before they are this soft.
    pub fn locked(&self, wave: Wave) -> Option<Unknowns> {
        let start = self.predict(wave)?;
        if self.is_exact() {
            return self.solve(wave, start);
        }
        let slope =
            |equations: &Self, at: &Unknowns| equations.linearised(wave, at).1.determinant();
        let (mut part, mut stride, mut here) = (0.0, 1.0, start);
        let mut last = slope(&self.stiffened(part), &here);
        for _ in 0..NEWTON_STRIDES {
            let next = f64::min(part + stride, 1.0);
            let softer = self.stiffened(next);
            let found = softer.solve(wave, here).map(|found| (found, slope(&softer, &found)));
            match found.filter(|(_, slope)| NEWTON_ALIKE.contains(&(slope / last))) {
                Some((found, _)) if next == 1.0 => return Some(found),
                Some((found, slope)) => {
                    (part, stride, here, last) = (next, 2.0 * stride, found, slope);
                }
                None if stride < NEWTON_STRIDE => return None,
                None => stride *= 0.5,
            }
        }
        None
    }

    /// Newton's method from `start`; `None` where its steps are large or do not
    /// shrink.
    fn solve(&self, wave: Wave, start: Unknowns) -> Option<Unknowns> {
        // Rows are of order one, so rounding leaves a residual of a few units
        // in the last place of the largest term.
        let size = 1.0 + wave.kappa.abs() + wave.drag.abs();
        let mut unknowns = start;
        let mut last = NEWTON_LARGEST * unknowns.amax() / NEWTON_SHRINK;
        for _ in 0..NEWTON_STEPS {
            let (residual, jacobian) = self.linearised(wave, &unknowns);
            let norm = residual.amax();
            if !norm.is_finite() {
                return None;
            }
            if norm <= 4.0 * f64::EPSILON * size {
                return Some(unknowns);
            }
            let step = jacobian.lu().solve(&residual)?;
            let length = step.amax();
            let turn = self.softness() * step[4].abs().max(step[5].abs());
            if length > NEWTON_SHRINK * last || turn > NEWTON_LARGEST {
                break;
            }
            unknowns -= step;
            if length <= 4.0 * f64::EPSILON * unknowns.amax() {
                return Some(unknowns);
            }
            last = length;
        }
        // Ill-conditioned, close to a fold: accept what is accurate enough.
        (self.residual(wave, &unknowns).amax() <= NEAR_A_FOLD * size).then_some(unknowns)
    }
}
