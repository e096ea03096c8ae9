//! The contact laws.

use serde::Serialize;
use strum::{AsRefStr, Display, EnumString, IntoStaticStr, VariantNames};

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

    /// Returns the force that keeps a corner closed, for the multipliers of its sides and the
    /// cosine of the angle between them; the corner opens where it is zero \[N\]. It lasts while
    /// both sides push, or, where they may pull, are predicted to penetrate.
    #[must_use]
    pub fn hold(self, [a, b]: [f64; 2], cos: f64) -> f64 {
        if self.pulls() { (-(a + cos * b)).min(-(b + cos * a)) } else { (-a).min(-b) }
    }
}
