//! Taking in what the engine says. What belongs to an older run, or to knobs
//! that have been turned since, is dropped.

use super::App;
use crate::motion::Touching;
use crate::tui::engine::Snapshot;
use crate::tui::history::{Bin, Channel};

/// Frames of the busy pictures on one page: about one a second.
const SLOW_FRAMES: f64 = 4.5;

impl App {
    /// Takes a snapshot in; false where it was too old to change anything.
    pub fn absorb(&mut self, snapshot: Snapshot) -> bool {
        if let Some(trouble) = snapshot.trouble {
            self.trouble = Some(trouble);
            return true;
        }
        if snapshot.restarts != self.counters.restarts {
            return false;
        }
        self.follow(&snapshot.bins);
        self.history.extend(&snapshot.bins);
        self.beside_history.extend(&snapshot.beside_bins);
        let due = self.slow.as_ref().is_none_or(|slow| {
            let elapsed = snapshot.moment.state.t_s - slow.state.t_s;
            !self.playing || elapsed < 0.0 || elapsed >= self.page_s() / SLOW_FRAMES
        });
        if due {
            self.slow = Some(snapshot.moment.clone());
        }
        self.moment = Some(snapshot.moment);
        self.turn_page();
        if snapshot.generation == self.order().generation() {
            self.ahead = snapshot.ahead;
            self.reference = snapshot.reference;
            self.sensitive = snapshot.sensitive;
            self.beside = snapshot.beside;
            self.pace = snapshot.pace;
            self.spectrum = snapshot.spectrum;
            self.map = snapshot.map.or(self.map.take());
            self.precision = snapshot.precision.or(self.precision.take());
            self.locked = snapshot.locked.or(self.locked.take());
        }
        self.check_lesson();
        true
    }

    /// Grows the ranges to hold new data at once.
    fn follow(&mut self, bins: &[Bin]) {
        if !self.ranges.follow {
            return;
        }
        let clearance = self.machine.clearance();
        if let Some((low, high)) = extremes(bins, &[Channel::UC, Channel::US]) {
            let range = &mut self.ranges.casing;
            if low < range.low || high > range.high {
                range.follow(low.min(range.low), high.max(range.high));
            }
        }
        if let Some((low, high)) = extremes(bins, &[Channel::AlphaC, Channel::AlphaS]) {
            let range = &mut self.ranges.blades;
            if low < range.low || high > range.high {
                range.follow(low.min(range.low), high.max(range.high));
            }
        }
        // The greatest gap is about as far above g0 as the amplitude.
        if let Some((_, amplitude)) = extremes(bins, &[Channel::Amplitude]) {
            let range = &mut self.ranges.gaps;
            if clearance + amplitude > range.high {
                range.follow(range.low, clearance + amplitude);
            }
        }
    }

    /// At the turn of a page, ranges may shrink to what the old page held.
    fn turn_page(&mut self) {
        let page = self.page_number();
        if page == self.page {
            return;
        }
        self.page = page;
        if !self.ranges.follow {
            return;
        }
        let (from, _) = self.page();
        let bins = self.history.between(from - self.page_s(), from);
        if let Some((low, high)) = extremes(bins, &[Channel::UC, Channel::US]) {
            self.ranges.casing.follow(low, high);
        }
        if let Some((low, high)) = extremes(bins, &[Channel::AlphaC, Channel::AlphaS]) {
            self.ranges.blades.follow(low, high);
        }
    }
}

fn extremes(bins: &[Bin], channels: &[Channel]) -> Option<(f64, f64)> {
    let mut found: Option<(f64, f64)> = None;
    for bin in bins {
        for channel in channels {
            let (low, high) = (bin.low[*channel as usize], bin.high[*channel as usize]);
            if low.is_finite() && high.is_finite() {
                found = Some(found.map_or((low, high), |(a, b)| (a.min(low), b.max(high))));
            }
        }
    }
    found
}

impl App {
    /// Whether the wave stands still in the frame of the blades: paused, or a
    /// corner has been held for a while.
    #[must_use]
    pub fn still(&self) -> bool {
        !self.playing
            || self.moment.as_ref().is_some_and(|moment| {
                let held = moment.state.t_s - moment.since;
                matches!(moment.touching, Touching::Corner(..))
                    && held > self.page_s() / SLOW_FRAMES
            })
    }
}
