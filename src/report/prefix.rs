//! SI prefixes: which one a number is read under, and which units take one.

/// One SI prefix, of a number or for a whole axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SiScale {
    /// Value of one shown unit.
    pub factor: f64,
    /// The prefix in front of the unit.
    pub prefix: &'static str,
}

/// Prefixes in increasing order; micro is written `u` where only ASCII is allowed.
const PREFIXES: &[(f64, &str)] = &[
    (1e-15, "f"),
    (1e-12, "p"),
    (1e-9, "n"),
    (1e-6, "µ"),
    (1e-3, "m"),
    (1.0, ""),
    (1e3, "k"),
    (1e6, "M"),
    (1e9, "G"),
];

impl SiScale {
    /// The prefix under which the largest magnitude reads as 1 to 999.
    #[must_use]
    pub fn of(magnitude: f64) -> Self {
        let magnitude = magnitude.abs() * (1.0 + 1e-9);
        let (factor, prefix) = PREFIXES
            .iter()
            .rev()
            .find(|(factor, _)| magnitude >= *factor)
            .copied()
            .unwrap_or(if magnitude > 0.0 { (1e-15, "f") } else { (1.0, "") });
        Self { factor, prefix }
    }

    /// The prefix of a number of this unit, where one is usual in front of it.
    #[must_use]
    pub fn before(unit: &str, magnitude: f64) -> Self {
        if WITH_PREFIX.contains(&unit) { Self::of(magnitude) } else { Self::plain() }
    }

    /// The prefix in letters of ASCII.
    #[must_use]
    pub fn in_ascii(&self) -> &'static str {
        if self.prefix == "µ" { "u" } else { self.prefix }
    }

    /// No prefix, for angles, speeds and counts.
    #[must_use]
    pub const fn plain() -> Self {
        Self { factor: 1.0, prefix: "" }
    }

    /// The label of a tick, with the decimals that its spacing needs.
    #[must_use]
    pub fn label(&self, value: f64, step: f64) -> String {
        let shown = step / self.factor;
        let decimals = if shown > 0.0 && shown.is_finite() {
            (-shown.log10() - 1e-9).ceil().clamp(0.0, 9.0) as usize
        } else {
            0
        };
        format!("{:.decimals$}", value / self.factor)
    }
}

/// Units in front of which a prefix is usual.
const WITH_PREFIX: [&str; 9] = ["m", "s", "N", "N/m", "m/s", "N m/rad", "N m", "W", "J"];
