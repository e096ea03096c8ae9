//! The three forms of the harmonic balance equations of a corner.

use serde::Serialize;

/// Which equations bend the blades. Casing amplitudes and multipliers hardly
/// notice; the blade angles do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// Eq. (27) as printed: its first two rows carry the contact torque with
    /// the factor -2 against Eq. (19). Expansion (26).
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

    /// The word used in files and on the command line.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Printed => "printed",
            Self::Blade => "blade",
            Self::Modal => "modal",
        }
    }

    /// The form a word stands for.
    #[must_use]
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|form| form.word() == word)
    }
}

impl std::fmt::Display for Form {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.pad(self.word())
    }
}
