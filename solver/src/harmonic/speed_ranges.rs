//! The ranges of rotor speed of one machine in one direction of rotation: with a lock, with flutter,
//! with whirl, and with rubbing that grows without bound. Each is computed on first use and kept.

use std::cell::OnceCell;

use super::round_whirl::whirl_spans;
use super::windows::{flutters, lock_windows_beside};
use crate::model::{LockWindow, Machine};

/// Ranges of rotor speed, each in increasing order of magnitude.
#[derive(Clone, Debug)]
pub struct SpeedRanges {
    machine: Machine,
    toward: f64,
    locks: OnceCell<Vec<LockWindow>>,
    flutters: OnceCell<Vec<LockWindow>>,
    whirls: OnceCell<Vec<LockWindow>>,
    growths: OnceCell<Vec<LockWindow>>,
}

impl SpeedRanges {
    /// Creates the ranges for a rotor that turns in the direction of the sign of `toward`.
    #[must_use]
    pub fn new(machine: &Machine, toward: f64) -> Self {
        Self {
            machine: machine.clone(),
            toward,
            locks: OnceCell::new(),
            flutters: OnceCell::new(),
            whirls: OnceCell::new(),
            growths: OnceCell::new(),
        }
    }

    /// Returns the machine.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// Returns the ranges with a lock, as [`lock_windows`].
    #[must_use]
    pub fn locks(&self) -> &[LockWindow] {
        let of = || lock_windows_beside(&self.machine, self.toward, || self.flutters());
        self.locks.get_or_init(of)
    }

    /// Returns the ranges with flutter, as `windows::flutters`.
    #[must_use]
    pub fn flutters(&self) -> &[LockWindow] {
        self.flutters.get_or_init(|| flutters(&self.machine, self.toward))
    }

    /// Returns the ranges in which a wave attracts, as `whirl_spans`.
    #[must_use]
    pub fn whirls(&self) -> &[LockWindow] {
        self.whirls.get_or_init(|| whirl_spans(&self.machine, self.toward))
    }

    /// Returns the ranges in which rubbing grows without bound: with flutter and without an attracting
    /// wave. Empty on a lining.
    #[must_use]
    pub fn growths(&self) -> &[LockWindow] {
        let rigid = self.machine.lining.is_none() && self.machine.clearance_at_rest() > 0.0;
        let less = |spans: Vec<LockWindow>, whirl: &LockWindow| {
            spans.into_iter().flat_map(|span| span.without(whirl)).collect()
        };
        self.growths.get_or_init(|| match rigid {
            true => self.whirls().iter().fold(self.flutters().to_vec(), less),
            false => Vec::new(),
        })
    }
}

/// Returns the window of [`lock_windows`] with the lowest speeds; `None` if there is no window.
#[must_use]
pub fn lock_window(machine: &Machine, toward: f64) -> Option<LockWindow> {
    lock_windows(machine, toward).into_iter().next()
}

/// Returns every window of speeds in which a lock holds, in increasing order, for a rotor that turns
/// in the direction of the sign of `toward`. On a lining and out of round only the pushes are
/// considered. Empty where unequal tips or lobes have no closed form.
#[must_use]
pub fn lock_windows(machine: &Machine, toward: f64) -> Vec<LockWindow> {
    SpeedRanges::new(machine, toward).locks().to_vec()
}
