//! The engine without clock or thread: takes orders, plays the motion, and makes
//! snapshots.

use std::time::{Duration, Instant};

use super::comparison::{Comparison, other_law};
use super::copies::Copies;
use super::forecasts::Forecasts;
use super::full_run::{FullRunJob, SLICE};
use super::jump::{met, next_change};
use super::pacing::{Turned, rate_at};
use super::reading::Reading;
use super::recorder::Recorder;
use super::studies::Studies;
use crate::motion::{Change, GoOn, Motion};
use crate::scene::keys::differences;
use crate::tui::engine::{Limit, Moment, Order, Snapshot};
use crate::tui::trace::{Mark, Marks};
use crate::tui::views::ViewId;

/// Samples per recorded bin.
const SAMPLES: f64 = 4.0;
/// Bins between two copies of the motion that are kept.
const BINS: f64 = 1024.0;
/// Samples per turn of the wave, at least.
const PER_TURN: f64 = 24.0;
/// Longest wall time of one call of `play` in the explorer.
const PLAY_LIMIT: Duration = Duration::from_millis(25);
/// Most samples that a jump to the next change of contact records.
const JUMP_SAMPLES: f64 = 20_000.0;
/// Longest wall time of such a jump; a second press goes on from there.
const JUMP_LIMIT: Duration = Duration::from_secs(1);

/// A motion being played, and its full runs.
#[derive(Debug)]
pub struct Playback {
    order: Order,
    motion: Motion,
    recorder: Recorder,
    target: f64,
    limit: Limit,
    turned: Turned,
    copies: Copies,
    reading: Reading,
    applied: Vec<(f64, String)>,
    met: (u64, Option<Mark>),
    ends: u64,
    forecasts: Forecasts,
    comparison: Option<Comparison>,
    /// Whether it has not caught up yet.
    behind: bool,
    time_limit: Duration,
}

impl Playback {
    /// Starts the scene of the order.
    pub fn new(order: Order) -> Self {
        Self::with_time_limit(order, PLAY_LIMIT)
    }

    /// As `new`; `play` may take this much wall time per call.
    pub fn with_time_limit(order: Order, time_limit: Duration) -> Self {
        Self::start(order, time_limit, Studies::default())
    }

    fn start(order: Order, time_limit: Duration, studies: Studies) -> Self {
        let scene = &order.scene;
        let motion = Motion::new(scene);
        let mut playback = Self {
            recorder: Recorder::default(),
            target: 0.0,
            limit: Limit::None,
            turned: Turned::default(),
            copies: Copies::of(&motion, order.bin_s * BINS),
            reading: Reading::default(),
            applied: Vec::new(),
            met: (order.jumps, None),
            ends: 0,
            forecasts: Forecasts::of(&motion, scene, studies),
            comparison: None,
            behind: false,
            time_limit,
            motion,
            order,
        };
        playback.start_comparison();
        playback.record();
        playback.read();
        playback
    }

    /// Limits the cells of a map, and whether lasting pulses are searched.
    pub fn limit_studies(&mut self, most_cells: usize, searches: bool) {
        self.forecasts.studies().limit(most_cells, searches);
    }

    /// Takes a newer order and does what its counters ask for.
    pub fn apply(&mut self, order: &Order) {
        let before = std::mem::replace(&mut self.order, order.clone());
        self.forecasts.studies().stop_unwanted(order);
        if order.restarts != before.restarts {
            let studies = self.forecasts.take_studies();
            *self = Self::start(order.clone(), self.time_limit, studies);
            return;
        }
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
            self.forecast();
            self.forecasts.forget_sensitivity();
        }
        if order.extensions != before.extensions && self.is_at_end() {
            self.forecast();
        }
        if order.compare != before.compare {
            self.start_comparison();
        }
        for _ in 0..order.steps.saturating_sub(before.steps).min(1000) {
            self.step();
        }
        for _ in 0..order.jumps.saturating_sub(before.jumps).min(10) {
            self.jump();
        }
        self.met.0 = order.jumps;
        if order.cursor_s != before.cursor_s || changed {
            self.read();
        }
    }

    /// Notes what the latest order changed, as `run --at` takes it.
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

    /// A new forecast, from here on.
    fn forecast(&mut self) {
        let length = self.order.scene.solver.end_s;
        self.forecasts.again(&self.motion, length);
        if let Some(comparison) = &mut self.comparison {
            comparison.full_run = FullRunJob::new(comparison.motion.clone(), length);
        }
    }

    /// Whether the motion has come to the end of its forecast.
    fn is_at_end(&self) -> bool {
        let step = self.motion.steps().map_or(0.0, |_| self.order.scene.solver.step_s);
        // The explicit solver ends at its last step by then.
        self.motion.t_s() + step > self.forecasts.end() * (1.0 - f64::EPSILON)
    }

    /// Plays the same scene under the other contact law too, if it is wanted.
    fn start_comparison(&mut self) {
        self.comparison = self.order.compare.then(|| Comparison::of(&self.order.scene)).flatten();
        self.play_comparison(self.time_limit);
    }

    fn sample_length(&self) -> f64 {
        (self.order.bin_s / SAMPLES).min(self.longest_sample()).max(1e-12)
    }

    /// The longest sample in which no turn of the wave against the blades is lost.
    fn longest_sample(&self) -> f64 {
        let machine = self.motion.machine();
        let speed = self.motion.rotor().speed(self.motion.t_s()).abs();
        let fastest = machine.omega_c + machine.nu(speed);
        std::f64::consts::TAU / fastest.max(f64::MIN_POSITIVE) / PER_TURN
    }

    fn record(&mut self) {
        let state = self.motion.state();
        self.recorder.record(&mut self.motion, &state, self.order.bin_s);
        self.copies.follow(&self.motion);
        self.turned.follow(&self.motion, &state);
    }

    /// A frame was drawn: the wave may turn on.
    pub fn drawn(&mut self) {
        self.turned.drawn();
    }

    /// Plays what is due after `wall` seconds: at the requested rate, slower at
    /// changes of contact if this is wanted, and never so far that a turning
    /// picture on the screen could not be followed.
    /// False where nothing moved.
    pub fn play_paced(&mut self, wall: f64) -> bool {
        let (now, rate) = (self.motion.t_s(), self.order.rate);
        let rate = match self.order.slow_at_events {
            true => rate_at(now, rate, self.forecasts.marks()),
            false => rate,
        };
        let turns = self.order.shows(ViewId::Frame) || self.order.shows(ViewId::Gaps);
        self.play_within(wall * rate, turns);
        self.motion.t_s() != now
    }

    /// Plays `seconds` of motion, or less if the solver is too slow.
    pub fn play(&mut self, seconds: f64) {
        self.play_within(seconds, false);
    }

    fn play_within(&mut self, seconds: f64, turns: bool) {
        self.target += seconds;
        let (began, limit) = (Instant::now(), self.time_limit);
        let go_on = || began.elapsed() < limit;
        let sample = self.sample_length();
        let turn = std::f64::consts::TAU / PER_TURN;
        self.limit = Limit::None;
        let (end, before) = (self.forecasts.end(), self.motion.t_s());
        loop {
            let now = self.motion.t_s();
            let next = if now + sample > end { end } else { now + sample };
            if next > self.target || next <= now {
                break;
            }
            if turns && self.turned.must_wait(turn) {
                (self.limit, self.target) = (Limit::Wave, now);
                break;
            }
            if !self.next_sample(next, &go_on) {
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

    /// Before a change, which acts at one instant on both motions: the other
    /// contact law is played up to it, or given up.
    fn level_comparison(&mut self) {
        self.play_comparison(self.time_limit.max(JUMP_LIMIT));
        if std::mem::take(&mut self.behind) {
            self.comparison = None;
        }
    }

    /// Plays to `until`, or to the next time step if that is later; false if the
    /// motion has failed. It stays behind where `go_on` says no, which happens
    /// only if this sample takes very long.
    fn next_sample(&mut self, until: f64, go_on: GoOn<'_>) -> bool {
        let before = self.motion.t_s();
        // The motion stores a failure, and every snapshot reports it.
        let reached = self.motion.advance_while(until, go_on);
        if reached == Ok(true) && self.motion.t_s() <= before {
            let next = before + self.order.scene.solver.step_s;
            return self.motion.advance_while(next, go_on).is_ok();
        }
        reached.is_ok()
    }

    /// One time step, or one sample of a solver that does not step.
    fn step(&mut self) {
        let step = match self.motion.steps() {
            Some(_) => self.order.scene.solver.step_s,
            None => self.sample_length(),
        };
        let (began, limit) = (Instant::now(), self.time_limit);
        let until = self.motion.t_s() + step;
        self.next_sample(until, &|| began.elapsed() < limit);
        self.record();
        self.target = self.motion.t_s();
        self.play_comparison(self.time_limit);
    }

    /// Plays to the next change of contact, exactly.
    fn jump(&mut self) {
        let (began, limit) = (Instant::now(), self.time_limit.max(JUMP_LIMIT));
        let go_on = || began.elapsed() < limit;
        let marks = Marks::from(self.motion.contacts());
        let found = next_change(&self.motion, self.longest_sample(), &go_on);
        if let Some(until) = found {
            let length = until - self.motion.t_s();
            let sample = self.sample_length().max(length / JUMP_SAMPLES);
            while self.motion.t_s() < until {
                let now = self.motion.t_s();
                let moved = self.next_sample((now + sample).min(until), &go_on);
                self.record();
                // The explicit solver may be at its last step by then.
                if !moved || self.motion.t_s() <= now || !go_on() {
                    break;
                }
            }
        }
        self.met.1 = found.and_then(|_| met(marks, &self.motion));
        self.target = self.motion.t_s();
        if self.is_at_end() {
            self.forecast();
        }
        self.play_comparison(self.time_limit);
    }

    /// Begins to compute the instant of the reading cursor.
    fn read(&mut self) {
        let at = self.order.cursor_s;
        let from = at.and_then(|t| Some((t, self.copies.before(t, &self.motion)?)));
        self.reading.begin(from);
        self.reading.go_on(self.time_limit.min(SLICE));
    }

    /// Whether there is more to compute.
    pub fn is_computing(&self) -> bool {
        let comparison = self.comparison.as_ref().map(|comparison| &comparison.full_run);
        self.behind
            || !self.reading.is_done()
            || self.forecasts.is_computing(&self.order, comparison)
    }

    /// Computes one slice of what is not done.
    pub fn compute(&mut self) {
        if self.behind {
            return self.play_comparison(self.time_limit);
        }
        self.reading.go_on(self.time_limit.min(SLICE));
        let comparison = self.comparison.as_mut().map(|comparison| &mut comparison.full_run);
        self.forecasts.compute(&self.order, comparison);
    }

    /// The present instant and results, and the bins since the last call.
    pub fn snapshot(&mut self) -> Snapshot {
        let now = Moment {
            multipliers: self.recorder.mean_forces(),
            met: self.met,
            ends: self.ends,
            ..Moment::of(&self.motion)
        };
        let comparison = self.comparison.as_mut();
        let mut results =
            self.forecasts.results(comparison.as_ref().map(|comparison| &comparison.full_run));
        results.pace.limit = self.limit;
        results.reading = self.reading.moment();
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
