//! The three forms of the harmonic balance equations of a corner
//! (docs/theory.md, section 8).

use serde::Serialize;
use strum::{AsRefStr, Display, EnumString, VariantNames};

/// The equations of the blade angles. Their choice hardly changes casing
/// amplitudes and multipliers, but it changes the blade angles.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Hash,
    Serialize,
    Display,
    EnumString,
    AsRefStr,
    VariantNames,
)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Form {
    /// Eq. (27) as printed: its first two rows have the contact torque of Eq.
    /// (19) times -2. Expansion (26).
    Printed,
    /// From Eq. (19) with the neighbours eliminated by (20): every contacting
    /// blade on its own spring `m_b omega_bd^2`. Expansion (26).
    Blade,
    /// The two blade modes of the time model, exact in the blade angle.
    #[default]
    Modal,
}

impl Form {
    /// Every form, in the order of the documentation.
    pub const ALL: [Self; 3] = [Self::Printed, Self::Blade, Self::Modal];
}
