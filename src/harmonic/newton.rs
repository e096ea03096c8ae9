//! Newton's method on the equations of a corner, kept on the branch of its
//! rigid blades.
//!
//! Far from the solution Newton's method is unreliable: it may miss the solution or
//! find another branch, at one speed and not at the next. So a start is accepted
//! only if its steps are small and shrink. If not, because blades are soft, the
//! solution is followed from rigid to soft blades; it ends where that branch folds.

use super::equations::{Equations, Unknowns, Wave};

/// Newton steps from one start.
const MOST_STEPS: usize = 40;
/// How much a step must shrink: by half close to a fold, with a small margin.
const SHRINK: f64 = 0.75;
/// Largest step, as a part of the unknowns, and of the turns \[rad\]; only in
/// these the equations are not bilinear.
const LARGEST: f64 = 0.1;
/// How much the determinant may change from one softness to the next: it is zero
/// at a fold, and differs on another branch.
const ALIKE: std::ops::Range<f64> = 0.5..2.0;
/// Shortest stride of the softness, and most strides.
const SHORTEST: f64 = 1e-6;
const MOST_STRIDES: usize = 500;

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
        for _ in 0..MOST_STRIDES {
            let next = f64::min(part + stride, 1.0);
            let softer = self.stiffened(next);
            let found = softer.solve(wave, here).map(|found| (found, slope(&softer, &found)));
            match found.filter(|(_, slope)| ALIKE.contains(&(slope / last))) {
                Some((found, _)) if next == 1.0 => return Some(found),
                Some((found, slope)) => {
                    (part, stride, here, last) = (next, 2.0 * stride, found, slope);
                }
                None if stride < SHORTEST => return None,
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
        let mut last = LARGEST * unknowns.amax() / SHRINK;
        for _ in 0..MOST_STEPS {
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
            if length > SHRINK * last || turn > LARGEST {
                break;
            }
            unknowns -= step;
            if length <= 4.0 * f64::EPSILON * unknowns.amax() {
                return Some(unknowns);
            }
            last = length;
        }
        // Ill-conditioned, close to a fold: accept what is accurate enough.
        (self.residual(wave, &unknowns).amax() <= 1e-11 * size).then_some(unknowns)
    }
}
