//! Contact laws, which solve one step on predicted gaps: the corrected gaps are
//! `g = g* - W lambda` (docs/theory.md, section 6). A multiplier below zero pushes.
//!
//! At most one corner of the polygon touches in every ordinary step, so a law
//! solves two rows by cases; larger sets go to `several`.

mod several;

use serde::Serialize;
use strum::{AsRefStr, Display, EnumString, IntoStaticStr, VariantNames};

pub use several::Several;

/// Which contact law closes the predicted penetrations.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Serialize,
    Display,
    EnumString,
    AsRefStr,
    IntoStaticStr,
    VariantNames,
)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum ContactLaw {
    /// Signorini: multipliers may only push.
    Unilateral,
    /// The paper's Eqs. (11)-(13): every penetration is an equality, pull or push.
    Bilateral,
    /// An elastic lining: contact forces grow with the depth (docs/theory.md, section 10).
    Smooth,
}

impl ContactLaw {
    /// Returns the law to compare with.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Unilateral => Self::Bilateral,
            Self::Bilateral | Self::Smooth => Self::Unilateral,
        }
    }

    /// Returns why the event solver does not know the law; `None` where it does.
    #[must_use]
    pub fn lacks_events(self) -> Option<&'static str> {
        match self {
            Self::Unilateral => None,
            Self::Bilateral => Some("bilateral is a law of the time step"),
            Self::Smooth => Some("a lining has no events"),
        }
    }

    /// Returns whether a multiplier may pull. A lining has the rigid law of its stiff limit.
    #[must_use]
    pub fn pulls(self) -> bool {
        self == Self::Bilateral
    }

    /// Solves two rows of different sides; `None` where they cannot be told apart (singular
    /// equations).
    #[must_use]
    pub fn pair(self, w: [[f64; 2]; 2], gap: [f64; 2]) -> Option<[f64; 2]> {
        if self.pulls() { Some(pair(w, gap)) } else { complementary_pair(w, gap) }
    }

    /// Solves any number of rows of different sides, as `pair`.
    #[must_use]
    pub fn several(self, rows: &mut Several) -> Option<&[f64]> {
        if self.pulls() { rows.all_closed() } else { rows.complementary() }
    }

    /// Returns the force that keeps a corner closed, for the multipliers of its sides and the
    /// cosine of the angle between them; the corner opens where it is zero \[N\]. It lasts while
    /// both sides push, or, where they may pull, are predicted to penetrate.
    #[must_use]
    pub fn hold(self, [a, b]: [f64; 2], cos: f64) -> f64 {
        if self.pulls() { (-(a + cos * b)).min(-(b + cos * a)) } else { (-a).min(-b) }
    }
}

/// Returns the multiplier of one row alone, `lambda = g/W`.
#[must_use]
pub fn single(w: f64, gap: f64) -> f64 {
    gap / w
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

/// Solves the complementarity problem of two rows, `g >= 0`, `lambda <= 0`, `g lambda = 0`
/// (Signorini; docs/theory.md, section 2), by cases: neither, the first, the second,
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// `W` of two sides of the polygon, an angle `turn` apart.
    fn rows(turn: f64) -> [[f64; 2]; 2] {
        [[1.0, turn.cos()], [turn.cos(), 1.0]]
    }

    #[test]
    fn a_corner_closes_both_sides() {
        let w = rows(0.2856);
        let gap = [-1e-6, -0.9e-6];
        let lambda = pair(w, gap);
        for row in 0..2 {
            let left = gap[row] - w[row][0] * lambda[0] - w[row][1] * lambda[1];
            assert!(left.abs() < 1e-20, "{left}");
        }
    }

    #[test]
    fn equality_pulls_where_complementarity_lets_go() {
        let w = rows(0.2856);
        let gap = [-1e-6, -0.5e-6];
        assert!(pair(w, gap)[1] > 0.0);
        assert_eq!(complementary_pair(w, gap), Some([-1e-6, 0.0]));
    }

    proptest! {
        #[test]
        fn complementarity_holds_and_both_solvers_agree(
            turn in 0.05..3.0_f64, a in -1.0..1.0_f64, b in -1.0..1.0_f64,
        ) {
            let (w, gap) = (rows(turn), [a, b]);
            let lambda = complementary_pair(w, gap).unwrap();
            for row in 0..2 {
                let left = gap[row] - w[row][0] * lambda[0] - w[row][1] * lambda[1];
                prop_assert!(lambda[row] <= 0.0);
                prop_assert!(left >= -1e-13);
                prop_assert!((left * lambda[row]).abs() < 1e-11);
            }
            let mut several = Several::default();
            several.fill(&gap, |i, j| w[i][j]);
            let general = several.complementary().unwrap();
            for row in 0..2 {
                // The condition number of W bounds what round-off may change.
                prop_assert!((general[row] - lambda[row]).abs() < 1e-11);
            }
        }
    }
}
