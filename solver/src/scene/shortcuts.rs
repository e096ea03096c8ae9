//! Shortcuts of the explicit solver.

/// Shortcuts of the explicit solver. All are on by default. Each reproduces the result of plain
/// steps to round-off; runs without them serve to verify that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shortcuts {
    /// Skip steps of free flight.
    pub flight: bool,
    /// Skip steps of a held lock.
    pub lock: bool,
    /// Take cheaper steps while the wave slides along one side.
    pub slide: bool,
    /// End the run once its verdict is proved.
    pub proofs: bool,
}

impl Shortcuts {
    /// No shortcuts: every step is computed, and the verdict is that of the whole run.
    pub const NONE: Self = Self { flight: false, lock: false, slide: false, proofs: false };
}

impl Default for Shortcuts {
    fn default() -> Self {
        Self { flight: true, lock: true, slide: true, proofs: true }
    }
}
