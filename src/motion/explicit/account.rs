//! The energy ledger of a motion under way, added up step by step.

use crate::motion::EnergyAccount;

/// The account of a motion under way.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Account {
    pub sums: EnergyAccount,
    /// Energy at the start, less what changes from outside have put in \[J\].
    pub start: f64,
    /// Energy in the lining at the step before the latest \[J\].
    pub lining_before: f64,
    /// The same at the latest \[J\].
    pub lining: f64,
    /// Whether nobody asks.
    pub forgone: bool,
}

impl Account {
    /// The lining holds this at a new step \[J\].
    pub fn press(&mut self, energy: f64) {
        (self.lining_before, self.lining) = (self.lining, energy);
    }

    /// Stored in the lining between the last two steps \[J\].
    pub fn in_lining(&self) -> f64 {
        0.5 * (self.lining_before + self.lining)
    }
}
