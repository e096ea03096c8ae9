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
    /// The wave in the frame of the blades, as their tips see it \[m\].
    pub rim: AutoRange,
    /// Whether they follow.
    pub follow: bool,
}

impl Ranges {
    /// Ranges at the start: the clearance and a little more. Where the blades rub at
    /// rest, as far into the lining.
    pub fn of(clearance: f64) -> Self {
        let size = clearance.abs();
        let gaps = match clearance < 0.0 {
            true => AutoRange::new(-2.2 * size, 1.2 * size),
            false => AutoRange::new(-0.2 * clearance, 2.2 * clearance),
        };
        Self {
            casing: AutoRange::new(-1.25 * size, 1.25 * size),
            blades: AutoRange::new(-1e-9, 1e-9),
            gaps,
            rim: AutoRange::new(-size, size),
            follow: true,
        }
    }
}
