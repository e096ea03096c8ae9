//! Applies a snapshot of the engine. Results of an older run, or of other knob
//! positions, are dropped.

use super::{App, Ranges};
use crate::motion::ActiveSet;
use crate::tui::axis::{AutoRange, instant};
use crate::tui::engine::Snapshot;
use crate::tui::history::{Bin, Channel};

/// Part of a page for which a held corner counts as standing still.
const STILL: f64 = 0.2;

impl App {
    /// Applies a snapshot; false if it is too old.
    pub fn apply_snapshot(&mut self, mut snapshot: Snapshot) -> bool {
        if snapshot.trouble.is_some() {
            self.latest.trouble = snapshot.trouble;
            return true;
        }
        // An answer is told with its value, however old.
        self.answer = snapshot.results.answer.take().or(self.answer.take());
        if snapshot.restarts != self.counters.restarts {
            return false;
        }
        self.grow_ranges(&snapshot.bins);
        // Both contact laws have the same axes.
        self.grow_ranges(&snapshot.comparison_bins);
        self.history.extend(&std::mem::take(&mut snapshot.bins));
        self.comparison_history.extend(&std::mem::take(&mut snapshot.comparison_bins));
        let had_forecast = self.full_run().is_some();
        let known = std::mem::take(&mut self.latest);
        let results = match snapshot.generation == self.counters.generation() {
            true => snapshot.results,
            false => known.results,
        };
        self.latest = Snapshot { results, trouble: known.trouble, ..snapshot };
        self.turn_page();
        self.fit_to_forecast(!had_forecast);
        self.tell_moment();
        self.check_lesson();
        true
    }

    /// Makes the ranges hold the page as it is computed, and the part of the forecast that
    /// is on it; for a new one they may shrink, too, but not below the clearance.
    fn fit_to_forecast(&mut self, is_new: bool) {
        // Where blades rub at rest there is no play to be seen.
        let clearance = self.machine.clearance().max(0.0);
        let (from, to) = self.page();
        if !self.ranges.follow {
            return;
        }
        let page = self.record();
        let (waves, swings) = (extremes(page, CASING), extremes(page, BLADES));
        grow(&mut self.ranges.casing, waves);
        grow(&mut self.ranges.blades, swings);
        let Some(run) = self.full_run() else { return };
        let span = |place: usize| {
            let values = run.trace.between(place, from, to).map(|(_, value)| (value, value));
            values.filter(|(value, _)| value.is_finite()).reduce(wider)
        };
        let [casing, blades] =
            [[0, 1], [2, 3]].map(|places| places.into_iter().filter_map(span).reduce(wider));
        let casing = casing.map(|data| wider(data, (-clearance, clearance)));
        let Ranges { casing: of_casing, blades: of_blades, .. } = &mut self.ranges;
        for (range, data) in [(of_casing, casing), (of_blades, blades)] {
            match data {
                Some((low, high)) if is_new && high > low => range.follow(low, high),
                data => grow(range, data),
            }
        }
    }

    /// Says what a jump has met, and that the run has come to its end.
    fn tell_moment(&mut self) {
        let Some(moment) = &self.latest.moment else { return };
        let (jumps, met) = moment.met;
        if jumps == self.counters.jumps && jumps > self.counters.met {
            self.counters.met = jumps;
            self.status = Some(match met {
                Some(mark) => format!("{}: {}", instant(mark.t_s), self.happening(mark.what)),
                None => "no change of contact comes soon".into(),
            });
        }
        if moment.ends > self.counters.ends {
            self.counters.ends = moment.ends;
            // An answer to a key is not covered.
            self.stopped_by_end = std::mem::take(&mut self.playing);
            if self.stopped_by_end && self.status.is_none() {
                self.status = Some("the end of the run; Space goes on".into());
            }
        }
    }

    /// Grows the ranges to hold new data at once.
    fn grow_ranges(&mut self, bins: &[Bin]) {
        if !self.ranges.follow {
            return;
        }
        let (clearance, usual) = (self.machine.clearance(), self.usual_reach());
        let lining = self.has_lining();
        let Ranges { casing, blades, gaps, rim, .. } = &mut self.ranges;
        grow(casing, extremes(bins, CASING));
        grow(blades, extremes(bins, BLADES));
        let most = extremes(bins, [Channel::Amplitude; 2]).map(|(_, most)| most);
        // The rim passes the clearance where the tips move with it.
        grow(rim, most.filter(|most| *most > usual).map(|most| (-most, most)));
        // The greatest gap is about as far above g0 as the amplitude; in a lining the
        // smallest is as far below.
        let low = if lining { extremes(bins, [Channel::Gap; 2]) } else { None };
        let low = low.map_or(gaps.low, |(low, _)| low.min(gaps.low));
        grow(gaps, most.map(|most| (low, clearance + most)));
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
        let Ranges { casing, blades, rim, .. } = &mut self.ranges;
        for (range, channels) in [(casing, CASING), (blades, BLADES), (rim, RIM)] {
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
                matches!(moment.active_set, ActiveSet::Corner(..)) && held > self.page_s() * STILL
            })
    }
}

const CASING: [Channel; 2] = [Channel::UC, Channel::US];
const RIM: [Channel; 2] = [Channel::RimX, Channel::RimY];
const BLADES: [Channel; 2] = [Channel::AlphaC, Channel::AlphaS];

fn extremes(bins: &[Bin], channels: [Channel; 2]) -> Option<(f64, f64)> {
    let spans = bins.iter().flat_map(|bin| channels.map(|channel| bin.span(channel)));
    spans.filter(|(low, high)| low.is_finite() && high.is_finite()).reduce(wider)
}

fn wider((a, b): (f64, f64), (low, high): (f64, f64)) -> (f64, f64) {
    (a.min(low), b.max(high))
}

/// Grows a range at once to hold data.
fn grow(range: &mut AutoRange, data: Option<(f64, f64)>) {
    if let Some((low, high)) = data
        && (low < range.low || high > range.high)
    {
        range.follow(low.min(range.low), high.max(range.high));
    }
}
