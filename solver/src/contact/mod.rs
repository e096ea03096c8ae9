//! Contact laws. A law determines the multipliers of one time step from the predicted gaps `g*`;
//! the corrected gaps are `g = g* - W lambda` (docs/theory.md, section 6). A negative multiplier is
//! a push.
//!
//! In nearly every step at most two sides touch, so two rows are solved by cases ([`pair`],
//! [`complementary_pair`]); larger sets are solved in `several`.

mod several;

use serde::Serialize;
use strum::{AsRefStr, Display, EnumString, IntoStaticStr, VariantNames};

pub use several::Several;

/// Contact law: which multipliers close the predicted penetrations.
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
    /// Signorini conditions: multipliers can only push.
    Unilateral,
    /// The paper's Eqs. (11)-(13): every predicted penetration is closed as an equality, with a
    /// push or a pull.
    Bilateral,
    /// Elastic lining: the contact force grows with the depth (docs/theory.md, section 10).
    Smooth,
}

impl ContactLaw {
    /// Returns the law that comparison runs use.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Unilateral => Self::Bilateral,
            Self::Bilateral | Self::Smooth => Self::Unilateral,
        }
    }

    /// Returns the reason why the event solver does not support the law; `None` if it does.
    #[must_use]
    pub fn lacks_events(self) -> Option<&'static str> {
        match self {
            Self::Unilateral => None,
            Self::Bilateral => Some("bilateral is a law of the time step"),
            Self::Smooth => Some("a lining has no events"),
        }
    }

    /// Returns whether a multiplier may pull. On a lining none can, as in its stiff limit.
    #[must_use]
    pub fn pulls(self) -> bool {
        self == Self::Bilateral
    }

    /// Solves two rows that belong to different sides; `None` if the equations are singular.
    #[must_use]
    pub fn pair(self, w: [[f64; 2]; 2], gap: [f64; 2]) -> Option<[f64; 2]> {
        if self.pulls() { Some(pair(w, gap)) } else { complementary_pair(w, gap) }
    }

    /// Solves any number of rows that belong to different sides; `None` as for
    /// [`pair`](Self::pair).
    #[must_use]
    pub fn several(self, rows: &mut Several) -> Option<&[f64]> {
        if self.pulls() { rows.all_closed() } else { rows.complementary() }
    }

    /// Returns the margin to the opening of a corner \[N\]: positive while the corner stays closed,
    /// zero where it opens. Takes the multipliers of both sides and the cosine of the angle between
    /// them. Without pulls a corner stays closed while both sides push; with pulls, while both
    /// sides would penetrate if let go.
    #[must_use]
    pub fn hold(self, [a, b]: [f64; 2], cos: f64) -> f64 {
        if self.pulls() { (-(a + cos * b)).min(-(b + cos * a)) } else { (-a).min(-b) }
    }
}

/// Returns the multiplier of a single row, `lambda = g/W`.
#[must_use]
pub fn single(w: f64, gap: f64) -> f64 {
    gap / w
}

/// Returns the multipliers that close two rows as equalities. They are not finite if the rows are
/// linearly dependent.
#[must_use]
pub fn pair(w: [[f64; 2]; 2], gap: [f64; 2]) -> [f64; 2] {
    let determinant = w[0][0] * w[1][1] - w[0][1] * w[1][0];
    [
        (w[1][1] * gap[0] - w[0][1] * gap[1]) / determinant,
        (w[0][0] * gap[1] - w[1][0] * gap[0]) / determinant,
    ]
}

/// Solves the complementarity problem of two rows, `g >= 0`, `lambda <= 0`, `g lambda = 0`
/// (Signorini; docs/theory.md, section 2), by cases: none closed, the first, the second, both.
/// `None` if no case applies (linearly dependent rows).
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

    /// Returns `W` for two sides whose normals are `turn` radians apart.
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
                // The accuracy is limited by the condition number of W.
                prop_assert!((general[row] - lambda[row]).abs() < 1e-11);
            }
        }
    }
}
