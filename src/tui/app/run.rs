//! The run on the screen and its results. Snapshots of the engine are applied here; results of an
//! older run or of other knob values are dropped.

use std::sync::Arc;

use super::App;
use super::play::begin_s;
use crate::tui::axis::{AutoRange, instant, readable};
use crate::tui::engine::{Answer, Moment, Results, Sensitive, Snapshot, generation};
use crate::tui::history::{Bin, BinHistory, Channel};
use crate::tui::knobs::{KNOBS, Knob};
use rubscope_solver::model::Machine;
use rubscope_solver::motion::ActiveSet;
use rubscope_solver::scene::CheckedScene;

/// A corner held for this fraction of a page counts as standing still.
const STILL: f64 = 0.2;

/// The run on the screen, and what is compared with it.
#[derive(Clone, Debug)]
pub struct Run {
    /// The scene at the start of the run; live changes since then are not in it.
    pub started: CheckedScene,
    /// The latest snapshot, with results of the current generation only.
    pub latest: Snapshot,
    /// Whether the scene also runs under the other contact law.
    pub compare: bool,
    /// The pinned run that is drawn behind the current one; `None` if none is pinned.
    pub baseline: Option<Baseline>,
    /// Axis ranges of the charts.
    pub ranges: Ranges,
    /// Record of the playing motion.
    pub history: BinHistory,
    /// Record of the motion under the other contact law.
    pub comparison: BinHistory,
    /// The latest known verdict, whose scene may be an older one; `None` before the first.
    pub answer: Option<Arc<Answer>>,
    /// Number of restarts in this session.
    pub restarts: u64,
    /// Number of live changes of knobs in this session.
    pub changes: u64,
    /// Number of pulses fired by a key in this session.
    pub pulses: u64,
}

/// A pinned run, drawn behind later ones.
#[derive(Clone, Debug)]
pub struct Baseline {
    /// Record of its motion, up to the time at which it was pinned.
    pub history: BinHistory,
    /// Its verdict as displayed.
    pub word: String,
    /// The scene with the knob values at that time.
    pub scene: CheckedScene,
}

impl Baseline {
    /// Describes the pinned run: up to two knobs that differ from the current scene, and the
    /// verdict.
    pub fn what(&self, app: &App) -> String {
        let differs = |knob: &&Knob| knob.get(&self.scene) != knob.get(&app.scene);
        let shown = |knob: &Knob| format!("{} {}", knob.label, knob.text(&self.scene));
        let mut parts: Vec<String> = KNOBS.iter().filter(differs).take(2).map(shown).collect();
        parts.push(self.word.clone());
        parts.join(", ")
    }
}

/// Axis ranges of the charts; they follow the data with hysteresis.
#[derive(Clone, Copy, Debug)]
pub struct Ranges {
    /// `u_c`, `u_s` \[m\].
    pub casing: AutoRange,
    /// `alpha_c`, `alpha_s` \[rad\].
    pub blades: AutoRange,
    /// Gaps between tips and casing \[m\]; negative in a lining.
    pub gaps: AutoRange,
    /// Casing displacement relative to the tips, in the frame of the blades \[m\].
    pub rim: AutoRange,
    /// Whether the ranges follow the data.
    pub follow: bool,
}

impl Ranges {
    /// Creates ranges around the clearance \[m\]; it is negative if the blades rub at rest.
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

impl Run {
    /// Creates the run of a scene before its first snapshot.
    pub fn of(scene: &CheckedScene, machine: &Machine) -> Self {
        Self {
            started: scene.clone(),
            latest: Snapshot::default(),
            compare: false,
            baseline: None,
            ranges: Ranges::of(machine.clearance()),
            history: BinHistory::default(),
            comparison: BinHistory::default(),
            answer: None,
            restarts: 0,
            changes: 0,
            pulses: 0,
        }
    }

    /// Clears what belongs to the previous run. Results of studies stay until new ones arrive.
    pub fn restart(&mut self, scene: &CheckedScene) {
        self.restarts += 1;
        self.started = scene.clone();
        self.history.clear();
        self.comparison.clear();
        self.forget_forecasts();
        let mut results = std::mem::take(&mut self.latest.results);
        results.applied.clear();
        (results.reading, results.end_s) = (None, 0.0);
        self.latest = Snapshot { results, ..Snapshot::default() };
    }

    /// Counts a live change of the motion.
    fn change(&mut self) {
        self.changes += 1;
        self.forget_forecasts();
    }

    /// Counts another firing of the pulse.
    pub fn fire(&mut self) {
        self.pulses += 1;
        self.forget_forecasts();
    }

    /// Drops the results that a change of the motion makes invalid.
    fn forget_forecasts(&mut self) {
        let results = &mut self.latest.results;
        (results.full_run, results.verdict) = (None, None);
        (results.reference, results.comparison) = (None, None);
        (results.page, results.comparison_page) = (None, None);
        results.sensitive = Sensitive::Unknown;
    }

    /// Switches whether the chart ranges follow the data; returns the status message.
    pub fn autoscale(&mut self) -> String {
        self.ranges.follow = !self.ranges.follow;
        format!("scales {}", if self.ranges.follow { "follow the data" } else { "stay fixed" })
    }

    /// Switches the comparison with the other contact law.
    pub fn set_compare(&mut self, compare: bool) {
        if compare != self.compare {
            self.compare = compare;
            let results = &mut self.latest.results;
            (results.comparison, results.comparison_page) = (None, None);
            self.comparison.clear();
        }
    }
}

impl App {
    /// Returns the results of the current run.
    pub fn results(&self) -> &Results {
        &self.run.latest.results
    }

    /// Returns the state of the playing motion; `None` before the first snapshot of the run.
    pub fn moment(&self) -> Option<&Moment> {
        self.run.latest.moment.as_ref()
    }

    /// Replaces the current scene. It restarts the run, or, if `live`, changes the running motion.
    pub fn set_scene(&mut self, scene: CheckedScene, live: bool) {
        let clearance = self.machine.clearance();
        self.scene = scene;
        self.machine = self.scene.machine();
        self.locks = Default::default();
        if self.machine.clearance() != clearance {
            let follow = self.run.ranges.follow;
            self.run.ranges = Ranges { follow, ..Ranges::of(self.machine.clearance()) };
        }
        if live { self.run.change() } else { self.restart() }
    }

    /// Restarts the run. A cursor keeps its time and page.
    pub fn restart(&mut self) {
        self.run.restart(&self.scene);
        self.play.restart(begin_s(&self.scene));
        self.play.middle_s = self.play.middle_s.filter(|_| self.reading.at_s.is_some());
    }

    /// Pins the run, to be drawn behind later ones, or removes the pinned one.
    pub fn pin(&mut self) {
        if self.run.baseline.take().is_some() {
            self.status = Some("baseline removed".into());
            return;
        }
        if self.full_run().is_none() && !self.is_given_up() {
            self.status = Some("not pinned: the run has no verdict yet".into());
            return;
        }
        let (history, scene) = (self.run.history.clone(), self.scene.clone());
        let word = self.verdict_word();
        let what = format!("{word} at {}", readable(self.speed(), "rad/s"));
        self.run.baseline = Some(Baseline { history, word, scene });
        self.status = Some(format!("pinned behind the next runs: {what}"));
    }

    /// Applies a snapshot; returns false if it belongs to an older run.
    pub fn apply_snapshot(&mut self, mut snapshot: Snapshot) -> bool {
        if snapshot.trouble.is_some() {
            self.run.latest.trouble = snapshot.trouble;
            return true;
        }
        // The header shows the latest verdict with its knob value, even if it is outdated.
        self.run.answer = snapshot.results.answer.take().or(self.run.answer.take());
        if snapshot.restarts != self.run.restarts {
            return false;
        }
        self.grow_ranges(&snapshot.bins);
        // Both contact laws share their axes, for comparison.
        self.grow_ranges(&snapshot.comparison_bins);
        self.run.history.extend(&std::mem::take(&mut snapshot.bins));
        self.run.comparison.extend(&std::mem::take(&mut snapshot.comparison_bins));
        let had_forecast = self.full_run().is_some();
        let known = std::mem::take(&mut self.run.latest);
        let results = match snapshot.generation == self.generation() {
            true => snapshot.results,
            false => known.results,
        };
        self.run.latest = Snapshot { results, trouble: known.trouble, ..snapshot };
        self.turn_page();
        self.fit_to_forecast(!had_forecast);
        self.report_moment();
        self.check_lesson();
        true
    }

    /// Grows the ranges of casing and blades to include the page and the forecast on it. For a new
    /// forecast they may also shrink, that of the casing not below the clearance.
    fn fit_to_forecast(&mut self, is_new: bool) {
        // Blades that rub at rest have no clearance to include.
        let clearance = self.machine.clearance().max(0.0);
        let (from, to) = self.page();
        if !self.run.ranges.follow {
            return;
        }
        let page = self.record();
        let (waves, swings) = (extremes(page, CASING), extremes(page, BLADES));
        grow(&mut self.run.ranges.casing, waves);
        grow(&mut self.run.ranges.blades, swings);
        let Some(run) = self.full_run() else { return };
        let span = |place: usize| {
            let values = run.trace.between(place, from, to).map(|(_, value)| (value, value));
            values.filter(|(value, _)| value.is_finite()).reduce(wider)
        };
        let [casing, blades] =
            [[0, 1], [2, 3]].map(|places| places.into_iter().filter_map(span).reduce(wider));
        let casing = casing.map(|data| wider(data, (-clearance, clearance)));
        let Ranges { casing: of_casing, blades: of_blades, .. } = &mut self.run.ranges;
        for (range, data) in [(of_casing, casing), (of_blades, blades)] {
            match data {
                Some((low, high)) if is_new && high > low => range.follow(low, high),
                data => grow(range, data),
            }
        }
    }

    /// Returns the generation of the knobs: see [`generation`].
    fn generation(&self) -> u64 {
        generation(self.run.restarts, self.run.changes, self.run.pulses)
    }

    /// Sets the status message when a jump is complete or the run has ended.
    fn report_moment(&mut self) {
        let Some(moment) = self.moment() else { return };
        let ((jumps, met), ends) = (moment.met, moment.ends);
        if self.play.is_met(jumps) {
            self.status = Some(match met {
                Some(mark) => format!("{}: {}", instant(mark.t_s), self.happening(mark.what)),
                None => "no change of contact comes soon".into(),
            });
        }
        // Do not overwrite the message about a key.
        if self.play.stop_at_end(ends) && self.status.is_none() {
            self.status = Some("the end of the run; Space goes on".into());
        }
    }

    /// Grows the ranges to include new bins.
    fn grow_ranges(&mut self, bins: &[Bin]) {
        if !self.run.ranges.follow {
            return;
        }
        let (roomiest, usual) = (self.roomiest(), self.usual_reach());
        let lining = self.has_lining();
        let Ranges { casing, blades, gaps, rim, .. } = &mut self.run.ranges;
        grow(casing, extremes(bins, CASING));
        grow(blades, extremes(bins, BLADES));
        let most = extremes(bins, [Channel::Amplitude; 2]).map(|(_, most)| most);
        // With radial coupling the tips move outward, so the amplitude can exceed the clearance.
        grow(rim, most.filter(|most| *most > usual).map(|most| (-most, most)));
        // The largest gap is about the clearance plus the amplitude. With a lining, gaps can also
        // be negative.
        let low = if lining { extremes(bins, [Channel::Gap; 2]) } else { None };
        let low = low.map_or(gaps.low, |(low, _)| low.min(gaps.low));
        grow(gaps, most.map(|most| (low, roomiest + most)));
    }

    /// Fits the ranges to the previous page when a new page starts; they may shrink.
    fn turn_page(&mut self) {
        let page = self.page_number();
        if std::mem::replace(&mut self.play.page, page) == page || !self.run.ranges.follow {
            return;
        }
        let (from, _) = self.page();
        let bins = self.run.history.between(from - self.page_s(), from);
        let Ranges { casing, blades, rim, .. } = &mut self.run.ranges;
        for (range, channels) in [(casing, CASING), (blades, BLADES), (rim, RIM)] {
            if let Some((low, high)) = extremes(bins, channels) {
                range.follow(low, high);
            }
        }
    }

    /// Returns whether the wave stands still in the frame of the blades: playback is paused, or a
    /// corner has been held for a while.
    pub fn is_still(&self) -> bool {
        !self.play.playing
            || self.moment().is_some_and(|moment| {
                let held = moment.state.t_s - moment.since;
                matches!(moment.active_set, ActiveSet::Corner(..)) && held > self.page_s() * STILL
            })
    }
}

const CASING: [Channel; 2] = [Channel::UC, Channel::US];
const RIM: [Channel; 2] = [Channel::RimX, Channel::RimY];
const BLADES: [Channel; 2] = [Channel::AlphaC, Channel::AlphaS];

/// Returns the lowest and highest value of some channels; `None` if no bin has finite values.
fn extremes(bins: &[Bin], channels: [Channel; 2]) -> Option<(f64, f64)> {
    let spans = bins.iter().flat_map(|bin| channels.map(|channel| bin.span(channel)));
    spans.filter(|(low, high)| low.is_finite() && high.is_finite()).reduce(wider)
}

fn wider((a, b): (f64, f64), (low, high): (f64, f64)) -> (f64, f64) {
    (a.min(low), b.max(high))
}

/// Extends a range if the data exceed it.
fn grow(range: &mut AutoRange, data: Option<(f64, f64)>) {
    if let Some((low, high)) = data
        && (low < range.low || high > range.high)
    {
        range.follow(low.min(range.low), high.max(range.high));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::engine::FullRunState;
    use rubscope_solver::scene::Scene;

    #[test]
    fn a_run_without_a_verdict_is_not_pinned() {
        let mut app = crate::tui::app::tests::on_screen();
        app.pin();
        assert_eq!(app.status.as_deref(), Some("not pinned: the run has no verdict yet"));
        assert!(app.run.baseline.is_none());
        app.run.latest.results.full_run = Some(FullRunState::GivenUp(0.2));
        app.pin();
        assert_eq!(app.run.baseline.as_ref().unwrap().word, "NO FORECAST");
        // A pinned run can be removed at any time.
        app.run.latest.results.full_run = None;
        app.pin();
        assert!(app.run.baseline.is_none());
    }

    #[test]
    fn what_was_computed_of_a_motion_is_forgotten_with_it_and_its_studies_stay() {
        let scene = Scene::base().checked().unwrap();
        let mut run = Run::of(&scene, &scene.machine());
        run.latest.results.found.map = None;
        run.latest.results.found.spectrum = Some(Arc::default());
        for change in [Run::change, Run::fire, |run: &mut Run| run.restart(&run.started.clone())] {
            run.latest.results.reference = None;
            run.latest.results.sensitive = Sensitive::GivenUp;
            change(&mut run);
            assert_eq!(run.latest.results.sensitive, Sensitive::Unknown);
            assert!(run.latest.results.found.spectrum.is_some());
        }
        assert_eq!((run.restarts, run.changes, run.pulses), (1, 1, 1));
        run.set_compare(true);
        assert!(run.compare);
        assert_eq!(run.autoscale(), "scales stay fixed");
        assert!(!run.ranges.follow);
    }
}
