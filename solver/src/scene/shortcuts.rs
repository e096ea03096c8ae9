//! Which shortcuts the explicit solver may take.

/// Shortcuts of the explicit solver, all of which are taken by default. Each gives the result
/// of plain steps, to round-off; without them a result can be audited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shortcuts {
    /// Leaps over free flight.
    pub flight: bool,
    /// Leaps over a held lock.
    pub lock: bool,
    /// Short steps of a wave that slides along one side.
    pub slide: bool,
    /// Verdicts that nothing to come can change, before the end of the run.
    pub proofs: bool,
}

impl Shortcuts {
    /// No shortcut: every step is taken, and the verdict is that of the whole run.
    pub const NONE: Self = Self { flight: false, lock: false, slide: false, proofs: false };
}

impl Default for Shortcuts {
    fn default() -> Self {
        Self { flight: true, lock: true, slide: true, proofs: true }
    }
}
