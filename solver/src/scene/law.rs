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
    /// Returns the law that the explorer compares this one with.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Unilateral => Self::Bilateral,
            Self::Bilateral | Self::Smooth => Self::Unilateral,
        }
    }

    /// Returns why the event solver does not support the law; `None` if it does.
    #[must_use]
    pub fn lacks_events(self) -> Option<&'static str> {
        match self {
            Self::Unilateral => None,
            Self::Bilateral => Some("bilateral is a law of the time step"),
            Self::Smooth => Some("a lining has no events"),
        }
    }

    /// Returns whether a multiplier may pull.
    #[must_use]
    pub fn pulls(self) -> bool {
        self == Self::Bilateral
    }

    /// Returns the force that keeps a corner closed \[N\], from the multipliers of its sides and the
    /// cosine of the angle between them. The corner opens when it falls to zero: when a side stops
    /// pushing or, if multipliers may pull, is no longer predicted to penetrate.
    #[must_use]
    pub fn hold(self, [a, b]: [f64; 2], cos: f64) -> f64 {
        if self.pulls() { (-(a + cos * b)).min(-(b + cos * a)) } else { (-a).min(-b) }
    }
}
