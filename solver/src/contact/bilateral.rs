//! The paper's law, Eq. (13a): every predicted penetration is closed as an
//! equality, by a push or by a pull (docs/theory.md, section 6).

use super::{Several, StepLaw};

/// The law `g = 0` on every row that was predicted to penetrate.
#[derive(Debug)]
pub(super) struct Bilateral;

impl StepLaw for Bilateral {
    fn pulls(&self) -> bool {
        true
    }
    fn pair(&self, w: [[f64; 2]; 2], gap: [f64; 2]) -> Option<[f64; 2]> {
        Some(pair(w, gap))
    }
    fn several<'a>(&self, rows: &'a mut Several) -> Option<&'a [f64]> {
        rows.all_closed()
    }
    /// It lasts while both sides are predicted to penetrate.
    fn hold(&self, [a, b]: [f64; 2], cos: f64) -> f64 {
        (-(a + cos * b)).min(-(b + cos * a))
    }
}

/// Returns the multipliers of two rows closed as equalities, which are not finite where the
/// rows are dependent.
#[must_use]
pub fn pair(w: [[f64; 2]; 2], gap: [f64; 2]) -> [f64; 2] {
    let determinant = w[0][0] * w[1][1] - w[0][1] * w[1][0];
    [
        (w[1][1] * gap[0] - w[0][1] * gap[1]) / determinant,
        (w[0][0] * gap[1] - w[1][0] * gap[0]) / determinant,
    ]
}
