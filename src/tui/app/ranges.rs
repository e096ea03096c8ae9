//! The ranges of the charts over time.

use crate::tui::axis::AutoRange;

/// Ranges of the charts; they follow the data with hysteresis.
#[derive(Clone, Copy, Debug)]
pub struct Ranges {
    /// `u_c`, `u_s` \[m\].
    pub casing: AutoRange,
    /// `alpha_c`, `alpha_s` \[rad\].
    pub blades: AutoRange,
    /// Gaps \[m\].
    pub gaps: AutoRange,
    /// Whether they follow.
    pub follow: bool,
}

impl Ranges {
    /// Ranges at the start: the clearance and a little more.
    pub fn of(clearance: f64) -> Self {
        Self {
            casing: AutoRange::new(-1.25 * clearance, 1.25 * clearance),
            blades: AutoRange::new(-1e-9, 1e-9),
            gaps: AutoRange::new(-0.2 * clearance, 2.2 * clearance),
            follow: true,
        }
    }
}
