//! The engine without clock or thread: takes orders, plays the motion,
//! computes the full run and the studies, and makes snapshots.

use std::time::{Duration, Instant};

use super::background::Background;
use super::comparison::{Comparison, other_law};
use super::full_run::{FullRunJob, SLICE};
use super::recorder::Recorder;
use super::studies::Studies;
use crate::motion::{Change, GoOn, Motion, Script, is_sensitive, run_to_verdict};
use crate::scene::{Scene, SolverKind};
use crate::tui::engine::{
    FORECAST_LIMIT, FullRun, FullRunState, Moment, Order, Pace, Results, Snapshot,
};

/// Samples per recorded bin.
const SAMPLES: f64 = 4.0;
/// Samples per turn of the wave, at least.
const PER_TURN: f64 = 24.0;
/// Longest wall time of one call of `play` in the explorer.
const PLAY_LIMIT: Duration = Duration::from_millis(25);
/// Most samples that a jump to the next change of contact searches.
const JUMP_SAMPLES: usize = 20_000;
/// Longest wall time of such a jump; a second press goes on from there.
const JUMP_LIMIT: Duration = Duration::from_secs(1);

/// A motion being played, and its full runs.
#[derive(Debug)]
pub struct Playback {
    order: Order,
    motion: Motion,
    recorder: Recorder,
    target: f64,
    limited: bool,
    full_run: FullRunJob,
    reference: Option<FullRunJob>,
    comparison: Option<Comparison>,
    /// Whether it has not caught up yet.
    behind: bool,
    studies: Studies,
    sensitive: Option<bool>,
    sensitivity: Option<Background<bool>>,
    time_limit: Duration,
}

impl Playback {
    /// Starts the scene of the order.
    pub fn new(order: Order) -> Self {
        Self::with_time_limit(order, PLAY_LIMIT)
    }

    /// As `new`; `play` may take this much wall time per call.
    pub fn with_time_limit(order: Order, time_limit: Duration) -> Self {
        let scene = &order.scene;
        let motion = Motion::new(scene);
        let mut playback = Self {
            recorder: Recorder::default(),
            target: 0.0,
            limited: false,
            full_run: FullRunJob::new(motion.clone(), scene.solver.end_s),
            reference: reference(scene),
            comparison: None,
            behind: false,
            studies: Studies::default(),
            sensitive: None,
            sensitivity: None,
            time_limit,
            motion,
            order,
        };
        playback.start_comparison();
        playback.record();
        playback
    }

    /// Limits the cells of a map.
    pub fn limit_cells(&mut self, most: usize) {
        self.studies.limit_cells(most);
    }

    /// Takes a newer order and does what its counters ask for.
    pub fn apply(&mut self, order: &Order) {
        let before = std::mem::replace(&mut self.order, order.clone());
        self.studies.stop_unwanted(order);
        if order.restarts != before.restarts {
            let mut studies = std::mem::take(&mut self.studies);
            studies.forget_spectrum();
            *self = Self { studies, ..Self::with_time_limit(order.clone(), self.time_limit) };
            return;
        }
        let changed = order.changes != before.changes || order.pulses != before.pulses;
        if changed && self.behind {
            self.level_comparison();
        }
        let other = other_law(&order.scene);
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
            let end = order.scene.solver.end_s;
            self.full_run = FullRunJob::new(self.motion.clone(), end);
            if let Some(comparison) = &mut self.comparison {
                comparison.full_run = FullRunJob::new(comparison.motion.clone(), end);
            }
            self.studies.forget_spectrum();
            // The reference starts from rest, so it does not apply to a changed run.
            self.reference = None;
            self.sensitivity = None;
            self.sensitive = Some(false);
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
    }

    /// Plays the same scene under the other contact law too, if it is wanted.
    fn start_comparison(&mut self) {
        self.comparison = self.order.compare.then(|| Comparison::of(&self.order.scene)).flatten();
        self.play_comparison(self.time_limit);
    }

    fn sample_length(&self) -> f64 {
        let machine = self.motion.machine();
        let speed = self.order.scene.operation.speed_rad_s.abs();
        let fastest = machine.omega_c.max(machine.nu(speed)).max(f64::MIN_POSITIVE);
        let length = (self.order.bin_s / SAMPLES).min(std::f64::consts::TAU / fastest / PER_TURN);
        length.max(1e-12)
    }

    fn record(&mut self) {
        self.recorder.record(&mut self.motion, self.order.bin_s);
    }

    /// Plays `seconds` of motion, or less if the solver is too slow.
    pub fn play(&mut self, seconds: f64) {
        self.target += seconds;
        let (began, limit) = (Instant::now(), self.time_limit);
        let go_on = || began.elapsed() < limit;
        let sample = self.sample_length();
        self.limited = false;
        loop {
            let now = self.motion.state().t_s;
            if now + sample > self.target || !self.next_sample(now + sample, &go_on) {
                break;
            }
            self.record();
            if !go_on() {
                self.limited = self.motion.state().t_s + sample <= self.target;
                self.target = self.target.min(self.motion.state().t_s + sample);
                break;
            }
        }
        if self.motion.failure().is_some() {
            self.target = self.motion.state().t_s;
        }
        self.play_comparison(self.time_limit);
    }

    fn play_comparison(&mut self, limit: Duration) {
        let (now, sample, bin) = (self.motion.state().t_s, self.sample_length(), self.order.bin_s);
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
        let before = self.motion.state().t_s;
        // The motion stores a failure, and every snapshot reports it.
        let reached = self.motion.advance_while(until, go_on);
        if reached == Ok(true) && self.motion.state().t_s <= before {
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
        let until = self.motion.state().t_s + step;
        self.next_sample(until, &|| began.elapsed() < limit);
        self.record();
        self.target = self.motion.state().t_s;
        self.play_comparison(self.time_limit);
    }

    /// Plays until the contact changes.
    fn jump(&mut self) {
        let (began, limit) = (Instant::now(), self.time_limit.max(JUMP_LIMIT));
        let go_on = || began.elapsed() < limit;
        let sample = self.sample_length();
        let (active_set, impacts) =
            (self.motion.contacts().active_set, self.motion.contacts().impact_count);
        for _ in 0..JUMP_SAMPLES {
            let until = self.motion.state().t_s + sample;
            if self.motion.over() || !go_on() || !self.next_sample(until, &go_on) {
                break;
            }
            self.record();
            let log = self.motion.contacts();
            if log.active_set != active_set || log.impact_count != impacts {
                break;
            }
        }
        self.target = self.motion.state().t_s;
        self.play_comparison(self.time_limit);
    }

    /// Whether there is more to compute.
    pub fn is_computing(&self) -> bool {
        let comparison = self.comparison.as_ref().map(|comparison| &comparison.full_run);
        let mut runs = std::iter::once(&self.full_run).chain(&self.reference).chain(comparison);
        self.behind
            || runs.any(|run| !run.is_done())
            || self.sensitive.is_none()
            || self.studies.is_computing(&self.order)
    }

    /// Computes one slice of the first job that is not done.
    pub fn compute(&mut self) {
        if self.behind {
            return self.play_comparison(self.time_limit);
        }
        let comparison = self.comparison.as_mut().map(|comparison| &mut comparison.full_run);
        let runs = std::iter::once(&mut self.full_run).chain(&mut self.reference);
        if let Some(run) = runs.chain(comparison).find(|run| !run.is_done()) {
            return run.compute();
        }
        if self.sensitive.is_none() {
            let scene = &self.order.scene;
            let job = self.sensitivity.get_or_insert_with(|| sensitivity(scene));
            self.sensitive = job.receive(SLICE).or(job.is_done().then_some(false));
            return;
        }
        let length = self.order.scene.solver.end_s;
        self.studies.compute(&self.order, self.full_run.signal(), length);
    }

    /// The present instant and results, and the bins since the last call.
    pub fn snapshot(&mut self) -> Snapshot {
        let (state, log) = (self.motion.state(), self.motion.contacts().clone());
        let moment = Moment {
            state,
            angle: self.motion.rotor().angle(state.t_s),
            speed: self.motion.rotor().speed(state.t_s),
            active_set: log.active_set,
            since: log.since,
            gaps: self.motion.blade_gaps(),
            multipliers: self.recorder.mean_forces(),
            failure: self.motion.failure().map(ToString::to_string),
        };
        let comparison = self.comparison.as_mut();
        let full_run = self.full_run.state();
        let done_in = matches!(full_run, FullRunState::Done(_)).then(|| self.full_run.wall_s());
        let mut results = Results {
            full_run: Some(full_run),
            sensitive: self.sensitive.unwrap_or(false),
            reference: done(self.reference.as_ref()),
            comparison: done(comparison.as_ref().map(|comparison| &comparison.full_run)),
            pace: Pace { step_s: self.full_run.step_s(), run_s: done_in, limited: self.limited },
            ..Results::default()
        };
        self.studies.show(&mut results);
        Snapshot {
            generation: self.order.generation(),
            restarts: self.order.restarts,
            moment: Some(moment),
            bins: self.recorder.take_bins(),
            comparison_bins: comparison
                .map(|comparison| comparison.recorder.take_bins())
                .unwrap_or_default(),
            results,
            trouble: None,
        }
    }
}

/// The event solver under unilateral contact, if the scene uses another solver.
fn reference(scene: &Scene) -> Option<FullRunJob> {
    if scene.solver.kind == SolverKind::Event {
        return None;
    }
    let scene = scene.as_reference().checked().ok()?;
    Some(FullRunJob::new(Motion::new(&scene), scene.solver.end_s))
}

/// Finds out whether a tiny change of the pulse changes the outcome; nothing
/// comes where this takes too long.
fn sensitivity(scene: &Scene) -> Background<bool> {
    let scene = scene.as_reference().checked();
    Background::start(move |to, go_on| {
        let began = Instant::now();
        let go_on = || go_on() && began.elapsed() < FORECAST_LIMIT;
        let found = scene.ok().and_then(|scene| {
            let reached = run_to_verdict(&scene, &go_on)?;
            is_sensitive(&scene, &Script::default(), reached, &go_on)
        });
        if let Some(sensitive) = found {
            // Without a receiver nobody asks any more.
            let _ = to.send(sensitive);
        }
    })
}

fn done(run: Option<&FullRunJob>) -> Option<FullRun> {
    match run?.state() {
        FullRunState::Done(run) => Some(run),
        FullRunState::Computing(_) | FullRunState::GivenUp(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::{App, Marker, Theme};

    #[test]
    fn a_comparison_that_is_slow_catches_up_before_a_change_acts_on_both() {
        let mut scene = Scene::base();
        scene.solver.step_s = 1e-6;
        scene.solver.end_s = 1e-3;
        let app = App::new(scene.checked().unwrap(), Theme::Mono, Marker::Ascii);
        let mut order = Order { bin_s: 2e-5, ..app.order() };
        let mut playback = Playback::with_time_limit(order.clone(), Duration::MAX);
        playback.play(2e-3);
        // Asked for late, and without time: one sample a call.
        playback.time_limit = Duration::ZERO;
        order.compare = true;
        playback.apply(&order);
        assert!(playback.behind && playback.is_computing());
        order.pulses += 1;
        playback.apply(&order);
        let (now, theirs) = (playback.motion.state().t_s, playback.comparison.as_ref().unwrap());
        assert!(!playback.behind && now - theirs.motion.state().t_s < 1.5e-6, "{now}");
        assert_eq!(theirs.motion.pulse().start, playback.motion.pulse().start);
        while playback.is_computing() {
            playback.compute();
        }
    }
}
