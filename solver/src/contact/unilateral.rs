//! Signorini's law (docs/theory.md, section 2): `g >= 0`, `lambda <= 0`,
//! `g lambda = 0`. A multiplier only pushes, and only where the gap is closed.

use super::{Several, StepLaw, pair, single};

/// The linear complementarity problem of the rows.
#[derive(Debug)]
pub(super) struct Unilateral;

impl StepLaw for Unilateral {
    fn pulls(&self) -> bool {
        false
    }
    fn pair(&self, w: [[f64; 2]; 2], gap: [f64; 2]) -> Option<[f64; 2]> {
        complementary_pair(w, gap)
    }
    fn several<'a>(&self, rows: &'a mut Several) -> Option<&'a [f64]> {
        rows.complementary()
    }
    /// It lasts while both sides push.
    fn hold(&self, [a, b]: [f64; 2], _: f64) -> f64 {
        (-a).min(-b)
    }
}

/// Solves the complementarity problem of two rows by cases: neither, the first, the second,
/// both. `None` where no case holds (dependent rows).
#[must_use]
pub fn complementary_pair(w: [[f64; 2]; 2], gap: [f64; 2]) -> Option<[f64; 2]> {
    if gap[0] >= 0.0 && gap[1] >= 0.0 {
        return Some([0.0, 0.0]);
    }
    let first = single(w[0][0], gap[0]);
    if first <= 0.0 && gap[1] - w[1][0] * first >= 0.0 {
        return Some([first, 0.0]);
    }
    let second = single(w[1][1], gap[1]);
    if second <= 0.0 && gap[0] - w[0][1] * second >= 0.0 {
        return Some([0.0, second]);
    }
    let both = pair(w, gap);
    (both[0] <= 0.0 && both[1] <= 0.0).then_some(both)
}
