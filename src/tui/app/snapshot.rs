//! Applies a snapshot of the engine. Results of an older run, or of other knob
//! positions, are dropped.

use super::{App, Ranges};
use crate::motion::ActiveSet;
use crate::tui::axis::AutoRange;
use crate::tui::engine::{Results, Snapshot};
use crate::tui::history::{Bin, Channel};

/// Updates of whole waves while a page fills: about one per second.
const THROTTLED_PER_PAGE: f64 = 4.5;

impl App {
    /// Applies a snapshot; false if it is too old.
    pub fn apply_snapshot(&mut self, mut snapshot: Snapshot) -> bool {
        if snapshot.trouble.is_some() {
            self.latest.trouble = snapshot.trouble;
            return true;
        }
        if snapshot.restarts != self.counters.restarts {
            return false;
        }
        self.grow_ranges(&snapshot.bins);
        // Both contact laws have the same axes.
        self.grow_ranges(&snapshot.comparison_bins);
        self.history.extend(&std::mem::take(&mut snapshot.bins));
        self.comparison_history.extend(&std::mem::take(&mut snapshot.comparison_bins));
        let due = match (&self.throttled, &snapshot.moment) {
            (Some(shown), Some(now)) => {
                let elapsed = now.state.t_s - shown.state.t_s;
                !self.playing || elapsed < 0.0 || elapsed >= self.page_s() / THROTTLED_PER_PAGE
            }
            _ => true,
        };
        if due {
            self.throttled.clone_from(&snapshot.moment);
        }
        let known = std::mem::take(&mut self.latest);
        let results = match snapshot.generation == self.order().generation() {
            // An old study stays on the screen until there is a new one.
            true => Results {
                locked: snapshot.results.locked.or(known.results.locked),
                map: snapshot.results.map.or(known.results.map),
                precision: snapshot.results.precision.or(known.results.precision),
                ..snapshot.results
            },
            false => known.results,
        };
        self.latest = Snapshot { results, trouble: known.trouble, ..snapshot };
        self.turn_page();
        self.check_lesson();
        true
    }

    /// Grows the ranges to hold new data at once.
    fn grow_ranges(&mut self, bins: &[Bin]) {
        if !self.ranges.follow {
            return;
        }
        let grow = |range: &mut AutoRange, data: Option<(f64, f64)>| {
            if let Some((low, high)) = data
                && (low < range.low || high > range.high)
            {
                range.follow(low.min(range.low), high.max(range.high));
            }
        };
        let Ranges { casing, blades, gaps, .. } = &mut self.ranges;
        grow(casing, extremes(bins, CASING));
        grow(blades, extremes(bins, BLADES));
        // The greatest gap is about as far above g0 as the amplitude.
        let clearance = self.machine.clearance();
        let (low, amplitude) = (gaps.low, extremes(bins, [Channel::Amplitude; 2]));
        grow(gaps, amplitude.map(|(_, most)| (low, clearance + most)));
    }

    /// When a new page starts, ranges may shrink to the data of the old one.
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
        let Ranges { casing, blades, .. } = &mut self.ranges;
        for (range, channels) in [(casing, CASING), (blades, BLADES)] {
            if let Some((low, high)) = extremes(bins, channels) {
                range.follow(low, high);
            }
        }
    }

    /// Whether the wave is fixed in the frame of the blades: the motion is
    /// paused, or a corner has been held for a while.
    pub fn is_still(&self) -> bool {
        !self.playing
            || self.latest.moment.as_ref().is_some_and(|moment| {
                let held = moment.state.t_s - moment.since;
                matches!(moment.active_set, ActiveSet::Corner(..))
                    && held > self.page_s() / THROTTLED_PER_PAGE
            })
    }
}

const CASING: [Channel; 2] = [Channel::UC, Channel::US];
const BLADES: [Channel; 2] = [Channel::AlphaC, Channel::AlphaS];

fn extremes(bins: &[Bin], channels: [Channel; 2]) -> Option<(f64, f64)> {
    let spans = bins.iter().flat_map(|bin| channels.map(|channel| bin.span(channel)));
    spans
        .filter(|(low, high)| low.is_finite() && high.is_finite())
        .reduce(|(a, b), (low, high)| (a.min(low), b.max(high)))
}
