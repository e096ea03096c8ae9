//! The engine without clock or thread: it applies orders, plays the motion, and makes snapshots.

mod moves;

use std::time::{Duration, Instant};

use super::comparison::{Comparison, other_law};
use super::forecasts::Answers;
use super::forecasts::Forecasts;
use super::full_run::SLICE;
use super::pacing::{Reached, Turned, rate_at};
use super::page::{PER_TURN, Page, next_sample, sample_length};
use super::reading::Copies;
use super::reading::Reading;
use super::recorder::Recorder;
use super::studies::Studies;
use crate::tui::engine::{Limit, Moment, Order, Snapshot};
use crate::tui::trace::Mark;
use crate::tui::views::id::ViewId;
use rubscope_solver::motion::{Change, Motion};
use rubscope_solver::scene::keys::differences;

/// Largest turn of the wave relative to the blades per sample \[rad\].
const TURN: f64 = std::f64::consts::TAU / PER_TURN;
/// Longest wall-clock time of one call of `play` in the explorer.
const PLAY_LIMIT: Duration = Duration::from_millis(25);
/// Most wall-clock time that one tick makes up for, for example after a suspension.
const LONGEST_TICK: Duration = Duration::from_millis(100);
/// The playing motion, with its forecasts.
#[derive(Debug)]
pub struct Playback {
    order: Order,
    motion: Motion,
    recorder: Recorder,
    /// Time up to which the motion is due to be played \[s\].
    target: f64,
    /// What kept the last call of `play` from reaching the target.
    limit: Limit,
    turned: Turned,
    reached: Reached,
    /// Target of a go-to \[s\]; `None` if none is under way.
    going: Option<f64>,
    /// Numbers of steps and jumps to execute after the go-to.
    owed: [u64; 2],
    copies: Copies,
    reading: Reading,
    page: Page,
    /// The live changes of this run: time \[s\], and the argument of `run --at`.
    applied: Vec<(f64, String)>,
    /// Number of jumps executed, and the change of contact that the last one met; `None` if it met
    /// none.
    met: (u64, Option<Mark>),
    /// Number of times that the motion has reached the end of the run.
    ends: u64,
    forecasts: Forecasts,
    /// The motion under the other contact law; `None` if it is not wanted or not possible.
    comparison: Option<Comparison>,
    /// Whether the comparison has yet to catch up with the motion.
    behind: bool,
    /// Longest wall-clock time of one call of `play`.
    time_limit: Duration,
}

impl Playback {
    /// Starts the scene of an order.
    pub fn new(order: Order) -> Self {
        Self::with_time_limit(order, PLAY_LIMIT)
    }

    /// As [`Self::new`], with another limit on the wall-clock time per call of `play`.
    pub fn with_time_limit(order: Order, time_limit: Duration) -> Self {
        Self::start(order, time_limit, Default::default())
    }

    fn start(order: Order, time_limit: Duration, kept: (Studies, Answers)) -> Self {
        let scene = &order.scene;
        let motion = Motion::new(scene);
        let mut playback = Self {
            recorder: Recorder::default(),
            target: 0.0,
            limit: Limit::None,
            turned: Turned::default(),
            reached: Reached::default(),
            going: Some(order.go_to_s).filter(|t| *t > 0.0),
            owed: [0; 2],
            copies: Copies::of(&motion, order.page.1 - order.page.0),
            reading: Reading::default(),
            page: Page::default(),
            applied: Vec::new(),
            met: (order.jumps, None),
            ends: 0,
            forecasts: Forecasts::of(&motion, scene, kept),
            comparison: None,
            behind: false,
            time_limit,
            motion,
            order,
        };
        playback.start_comparison();
        playback.record();
        playback.read();
        playback.want_page();
        playback
    }

    /// Limits the number of computed map cells, for tests.
    pub fn bound_maps(&mut self, cells: usize) {
        self.forecasts.studies.most_cells = Some(cells);
    }

    /// Applies a newer order: compares its counters with those of the last one and executes the
    /// difference.
    pub fn apply(&mut self, order: &Order) {
        let before = std::mem::replace(&mut self.order, order.clone());
        self.forecasts.stop_unwanted(order);
        if order.restarts != before.restarts {
            let kept = self.forecasts.hand_over(&before.scene, &self.motion);
            *self = Self::start(order.clone(), self.time_limit, kept);
            return self.owe(&before);
        }
        let length = order.scene.solver.end_s;
        let changed = order.changes != before.changes || order.pulses != before.pulses;
        if changed && self.behind {
            self.level_comparison();
        }
        let other = other_law(&order.scene).ok();
        let theirs = self.comparison.as_mut().map(|theirs| &mut theirs.motion).zip(other.as_ref());
        for (motion, scene) in std::iter::once((&mut self.motion, &order.scene)).chain(theirs) {
            if order.changes != before.changes {
                for change in Change::between(&before.scene, scene) {
                    motion.apply(&change);
                }
            }
            if order.pulses != before.pulses {
                motion.fire();
            }
        }
        if changed {
            self.note_changes(&before);
            self.copies.changed(&self.motion);
            self.page.forget();
            self.forecasts.changed(&before.scene, &self.motion, length);
            if let Some(comparison) = &mut self.comparison {
                comparison.changed(length);
            }
        }
        if order.extensions != before.extensions && self.is_at_end() {
            self.forecast();
        }
        if order.compare != before.compare {
            self.start_comparison();
        }
        if (order.rate, order.playing) != (before.rate, before.playing) {
            self.reached = Reached::default();
        }
        if order.goes != before.goes {
            self.going = Some(order.go_to_s);
        }
        self.owe(&before);
        if order.cursor_s != before.cursor_s || changed {
            self.read();
        }
        self.want_page();
    }

    /// Records what the latest order changed, as arguments of `run --at`.
    fn note_changes(&mut self, before: &Order) {
        let now = self.motion.t_s();
        if self.order.changes != before.changes {
            let keys = differences(&before.scene, &self.order.scene);
            self.applied.extend(keys.map(|(path, text)| (now, format!("{path}={text}"))));
        }
        if self.order.pulses != before.pulses {
            self.applied.push((now, "pulse".into()));
        }
    }

    /// Starts new full runs from the current time.
    fn forecast(&mut self) {
        let length = self.order.scene.solver.end_s;
        self.forecasts.again(&self.motion, length);
        if let Some(comparison) = &mut self.comparison {
            comparison.forecast(length);
        }
    }

    /// Returns whether the motion has reached the end of its run.
    fn is_at_end(&self) -> bool {
        let step = self.motion.steps().map_or(0.0, |_| self.order.scene.solver.step_s);
        // The explicit solver stops at its last step before the end.
        self.motion.t_s() + step > self.forecasts.full_run.end() * (1.0 - f64::EPSILON)
    }

    /// Starts the motion under the other contact law, if the order wants it.
    fn start_comparison(&mut self) {
        let (from, to) = self.order.page;
        let other = || Comparison::of(&self.order.scene, to - from);
        self.comparison = self.order.compare.then(other).flatten();
        self.play_comparison(self.time_limit);
    }

    fn sample_length(&self) -> f64 {
        sample_length(&self.motion, self.order.bin_s)
    }

    fn record(&mut self) {
        let state = self.motion.state();
        self.recorder.record(&mut self.motion, &state, self.order.bin_s);
        self.copies.follow(&self.motion);
        self.turned.follow(&self.motion, &state);
    }

    /// Reports that a frame was drawn: the wave may turn further.
    pub fn drawn(&mut self) {
        self.turned.drawn();
    }

    /// Plays what is due after `wall`: at the requested rate, slower near changes of contact if
    /// wanted, and never so far that a turning picture could not be followed. Returns whether the
    /// motion advanced.
    pub fn play_paced(&mut self, wall: Duration) -> bool {
        let due = wall.min(LONGEST_TICK).as_secs_f64();
        let (now, rate) = (self.motion.t_s(), self.order.rate);
        let rate = match self.order.slow_at_events {
            true => rate_at(now, rate, self.forecasts.full_run.marks()),
            false => rate,
        };
        let turns = self.order.shows(ViewId::Frame) || self.order.shows(ViewId::Gaps);
        self.play_within(due * rate, turns);
        let played = self.motion.t_s() - now;
        self.reached.add(wall.as_secs_f64(), played);
        played != 0.0
    }

    /// Plays `seconds` of simulated time, or less if the solver is too slow.
    pub fn play(&mut self, seconds: f64) {
        self.play_within(seconds, false);
    }

    fn play_within(&mut self, seconds: f64, turns: bool) {
        if self.going.is_some() {
            return;
        }
        self.target += seconds;
        let (began, limit) = (Instant::now(), self.time_limit);
        let go_on = || began.elapsed() < limit;
        let sample = self.sample_length();
        self.limit = Limit::None;
        let (end, before) = (self.forecasts.full_run.end(), self.motion.t_s());
        loop {
            let now = self.motion.t_s();
            let next = if now + sample > end { end } else { now + sample };
            if next > self.target || next <= now {
                break;
            }
            if turns && self.turned.must_wait(TURN) {
                (self.limit, self.target) = (Limit::Wave, now);
                break;
            }
            // The motion stores its failure, and every snapshot reports it.
            if next_sample(&mut self.motion, next, self.order.scene.solver.step_s, &go_on).is_err()
            {
                break;
            }
            self.record();
            if self.is_at_end() {
                break;
            }
            if !go_on() {
                let now = self.motion.t_s();
                if now + sample <= self.target {
                    self.limit = Limit::Solver;
                }
                self.target = self.target.min(now + sample);
                break;
            }
        }
        if self.is_at_end() {
            self.target = self.motion.t_s();
            self.ends += u64::from(self.target > before);
        }
        if self.motion.failure().is_some() {
            self.target = self.motion.t_s();
        }
        self.play_comparison(self.time_limit);
    }

    fn play_comparison(&mut self, limit: Duration) {
        let (now, sample, bin) = (self.motion.t_s(), self.sample_length(), self.order.bin_s);
        self.behind = self.comparison.as_mut().is_some_and(|comparison| {
            let began = Instant::now();
            !comparison.catch_up(now, sample, bin, &|| began.elapsed() < limit)
        });
    }

    /// Brings the comparison to the current time before a change, which must act on both motions at
    /// the same time; drops the comparison if that takes too long.
    fn level_comparison(&mut self) {
        self.play_comparison(self.time_limit.max(moves::JUMP_LIMIT));
        if std::mem::take(&mut self.behind) {
            self.comparison = None;
        }
    }

    /// Returns whether anything is left to compute.
    pub fn is_computing(&self) -> bool {
        let comparison = self.comparison.as_ref().map(|comparison| &comparison.full_run);
        self.behind
            || self.going.is_some()
            || !self.reading.is_done()
            || !self.pages_are_done()
            || self.forecasts.is_computing(&self.order, comparison)
    }

    /// Computes for one slice of wall-clock time: the comparison if it is behind, otherwise the
    /// cursor, then a go-to, the page, or the forecasts.
    pub fn compute(&mut self) {
        if self.behind {
            return self.play_comparison(self.time_limit);
        }
        self.reading.go_on(self.time_limit.min(SLICE));
        if self.arrive() || self.compute_page() {
            return;
        }
        let comparison = self.comparison.as_mut().map(|comparison| &mut comparison.full_run);
        self.forecasts.compute(&self.order, comparison);
    }

    /// Returns the current state, the results, and the bins since the last call.
    pub fn snapshot(&mut self) -> Snapshot {
        let now = Moment {
            multipliers: self.recorder.mean_forces(),
            met: self.met,
            ends: self.ends,
            ..Moment::of(&self.motion)
        };
        let comparison = self.comparison.as_mut();
        let theirs = comparison.as_ref().map(|comparison| &comparison.full_run);
        let mut results = self.forecasts.results(&self.order, theirs);
        results.pace.limit = self.limit;
        results.pace.reached = self.reached.rate();
        results.reading = self.reading.moment();
        results.page = self.page.record();
        results.comparison_page = comparison.as_ref().and_then(|theirs| theirs.page.record());
        results.applied.clone_from(&self.applied);
        Snapshot {
            generation: self.order.generation(),
            restarts: self.order.restarts,
            moment: Some(now),
            bins: self.recorder.take_bins(),
            comparison_bins: comparison
                .map(|comparison| comparison.recorder.take_bins())
                .unwrap_or_default(),
            results,
            trouble: None,
        }
    }
}

#[cfg(test)]
#[path = "playback_tests.rs"]
mod tests;
