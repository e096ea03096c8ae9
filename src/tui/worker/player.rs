//! The engine without clock or thread: takes orders, plays the motion,
//! computes what it will come to, and says what there is to see.

use std::time::{Duration, Instant};

use super::forecast::Run;
use super::recorder::Recorder;
use super::studies::Studies;
use crate::motion::{Change, Motion, is_sensitive, settle};
use crate::scene::{CheckedScene, ContactLaw, Scene, SolverKind};
use crate::tui::engine::{Ahead, Forecast, Moment, Order, Pace, Snapshot};

/// Samples per recorded bin.
const SAMPLES: f64 = 4.0;
/// Samples per turn of the wave, at least.
const PER_TURN: f64 = 24.0;
/// Longest wall time one call of `play` takes beside a screen.
const PLAY_LIMIT: Duration = Duration::from_millis(25);
/// Samples a jump to the next change of contact looks through at most.
const JUMP_SAMPLES: usize = 20_000;

/// The same scene under the other contact law: played in step, and run ahead.
#[derive(Debug)]
struct Beside {
    motion: Motion,
    recorder: Recorder,
    ahead: Run,
}

/// A motion being played, and its runs ahead.
#[derive(Debug)]
pub struct Player {
    order: Order,
    motion: Motion,
    recorder: Recorder,
    target: f64,
    limited: bool,
    ahead: Run,
    reference: Option<Run>,
    beside: Option<Beside>,
    studies: Studies,
    sensitive: Option<bool>,
    patience: Duration,
}

impl Beside {
    /// Plays to where the other motion is.
    fn catch_up(&mut self, until: f64, sample: f64, bin: f64) {
        loop {
            self.recorder.look(&mut self.motion, bin);
            let next = (self.motion.state().t_s + sample).min(until);
            let before = self.motion.state().t_s;
            // A failure stays in the motion; the run ahead tells of it.
            if next <= before || self.motion.advance(next).is_err() {
                return;
            }
            if self.motion.state().t_s <= before {
                return;
            }
        }
    }
}

impl Player {
    /// Begins the order's scene.
    #[must_use]
    pub fn new(order: Order) -> Self {
        Self::patient(order, PLAY_LIMIT)
    }

    /// As `new`; `play` may take this much wall time a call.
    #[must_use]
    pub fn patient(order: Order, patience: Duration) -> Self {
        let scene = &order.scene;
        let motion = Motion::new(scene);
        let mut player = Self {
            recorder: Recorder::default(),
            target: 0.0,
            limited: false,
            ahead: Run::new(motion.clone(), scene.solver.end_s),
            reference: reference(scene),
            beside: None,
            studies: Studies::default(),
            sensitive: None,
            patience,
            motion,
            order,
        };
        player.beside = player.other_law();
        player.look();
        player
    }

    /// Takes a newer order. Counters that grew are acted on.
    pub fn apply(&mut self, order: &Order) {
        let before = std::mem::replace(&mut self.order, order.clone());
        if order.restarts != before.restarts {
            let mut studies = std::mem::take(&mut self.studies);
            studies.begin();
            *self = Self { studies, ..Self::patient(order.clone(), self.patience) };
            return;
        }
        let other = other_law(&order.scene);
        let beside = self.beside.as_mut().map(|beside| &mut beside.motion).zip(other.as_ref());
        for (motion, scene) in std::iter::once((&mut self.motion, &order.scene)).chain(beside) {
            if order.changes != before.changes {
                for change in Change::between(&before.scene, scene) {
                    motion.apply(&change);
                }
            }
            if order.pulses != before.pulses {
                motion.fire();
            }
        }
        if order.changes != before.changes || order.pulses != before.pulses {
            self.ahead = Run::new(self.motion.clone(), order.scene.solver.end_s);
            if let Some(beside) = &mut self.beside {
                beside.ahead = Run::new(beside.motion.clone(), order.scene.solver.end_s);
            }
            self.studies.begin();
            // Both start from rest; they say nothing about a changed run.
            self.reference = None;
            self.sensitive = Some(false);
        }
        if order.beside != before.beside {
            self.beside = self.other_law();
        }
        for _ in 0..order.steps.saturating_sub(before.steps).min(1000) {
            self.step();
        }
        for _ in 0..order.jumps.saturating_sub(before.jumps).min(10) {
            self.jump();
        }
    }

    /// The same scene under the other contact law, if it is wanted.
    fn other_law(&self) -> Option<Beside> {
        if !self.order.beside {
            return None;
        }
        let scene = other_law(&self.order.scene)?;
        let motion = Motion::new(&scene);
        let ahead = Run::new(motion.clone(), scene.solver.end_s);
        let mut beside = Beside { motion, recorder: Recorder::default(), ahead };
        beside.catch_up(self.motion.state().t_s, self.sample_length(), self.order.bin_s);
        Some(beside)
    }

    fn sample_length(&self) -> f64 {
        let machine = self.motion.machine();
        let speed = self.order.scene.operation.speed_rad_s.abs();
        let fastest = machine.omega_c.max(machine.nu(speed)).max(f64::MIN_POSITIVE);
        let length = (self.order.bin_s / SAMPLES).min(std::f64::consts::TAU / fastest / PER_TURN);
        length.max(1e-12)
    }

    fn look(&mut self) {
        self.recorder.look(&mut self.motion, self.order.bin_s);
    }

    /// Plays `seconds` of motion, or as much as the solver can in good time.
    pub fn play(&mut self, seconds: f64) {
        self.target += seconds;
        let began = Instant::now();
        let sample = self.sample_length();
        self.limited = false;
        while self.motion.failure().is_none() {
            let until = self.motion.state().t_s + sample;
            if until > self.target {
                break;
            }
            let before = self.motion.state().t_s;
            if self.motion.advance(until).is_err() {
                break;
            }
            if self.motion.state().t_s <= before {
                // A sample shorter than a step: go to the next step.
                self.one_step();
            }
            self.look();
            if began.elapsed() > self.patience {
                self.limited = self.motion.state().t_s + sample <= self.target;
                self.target = self.target.min(self.motion.state().t_s + sample);
                break;
            }
        }
        if self.motion.failure().is_some() {
            self.target = self.motion.state().t_s;
        }
        self.bring_beside();
    }

    fn bring_beside(&mut self) {
        let (now, sample, bin) = (self.motion.state().t_s, self.sample_length(), self.order.bin_s);
        if let Some(beside) = &mut self.beside {
            beside.catch_up(now, sample, bin);
        }
    }

    /// One time step, or one sample of a solver that does not step.
    fn one_step(&mut self) {
        let step = match self.motion.steps() {
            Some(_) => self.order.scene.solver.step_s,
            None => self.sample_length(),
        };
        let now = self.motion.state().t_s;
        // A failure stays in the motion, where every snapshot finds it.
        let _ = self.motion.advance(now + step);
    }

    fn step(&mut self) {
        self.one_step();
        self.look();
        self.target = self.motion.state().t_s;
        self.bring_beside();
    }

    /// Goes on until the contact changes.
    fn jump(&mut self) {
        let sample = self.sample_length();
        let (touching, impacts) =
            (self.motion.contacts().touching, self.motion.contacts().impact_count);
        for _ in 0..JUMP_SAMPLES {
            let until = self.motion.state().t_s + sample;
            if self.motion.over() || self.motion.advance(until).is_err() {
                break;
            }
            self.look();
            let log = self.motion.contacts();
            if log.touching != touching || log.impact_count != impacts {
                break;
            }
        }
        self.target = self.motion.state().t_s;
        self.bring_beside();
    }

    /// Whether a run ahead is not at its end.
    #[must_use]
    pub fn is_computing(&self) -> bool {
        self.runs().any(|run| !run.is_done())
            || self.sensitive.is_none()
            || self.studies.is_computing(&self.order)
    }

    fn runs(&self) -> impl Iterator<Item = &Run> {
        let beside = self.beside.as_ref().map(|beside| &beside.ahead);
        std::iter::once(&self.ahead).chain(&self.reference).chain(beside)
    }

    /// Goes one slice on with the first run that is not at its end.
    pub fn compute(&mut self) {
        let beside = self.beside.as_mut().map(|beside| &mut beside.ahead);
        let runs = std::iter::once(&mut self.ahead).chain(&mut self.reference).chain(beside);
        for run in runs {
            if !run.is_done() {
                run.go_on();
                return;
            }
        }
        if self.sensitive.is_none() {
            self.sensitive = Some(sensitive(&self.order.scene));
            return;
        }
        let length = self.order.scene.solver.end_s;
        self.studies.go_on(&self.order, self.ahead.signal(), length);
    }

    /// What there is to see now, with the bins since the last call.
    pub fn snapshot(&mut self) -> Snapshot {
        let (state, log) = (self.motion.state(), self.motion.contacts().clone());
        let moment = Moment {
            state,
            angle: self.motion.rotor().angle(state.t_s),
            speed: self.motion.rotor().speed(state.t_s),
            touching: log.touching,
            since: log.since,
            impacts: log.impact_count,
            gaps: self.motion.blade_gaps(),
            multipliers: self.recorder.mean_forces(),
            checks: self.motion.checks(),
            over: self.motion.over(),
            failure: self.motion.failure().map(ToString::to_string),
        };
        let mut snapshot = Snapshot {
            generation: self.order.generation(),
            restarts: self.order.restarts,
            moment,
            bins: self.recorder.take_bins(),
            ahead: Some(self.ahead.ahead()),
            sensitive: self.sensitive.unwrap_or(false),
            reference: done(self.reference.as_ref()),
            beside: done(self.beside.as_ref().map(|beside| &beside.ahead)),
            beside_bins: self
                .beside
                .as_mut()
                .map(|beside| beside.recorder.take_bins())
                .unwrap_or_default(),
            pace: Pace {
                step_s: self.ahead.step_s(),
                run_s: self.ahead.is_done().then(|| self.ahead.wall_s()),
                limited: self.limited,
            },
            ..Snapshot::default()
        };
        self.studies.show(&mut snapshot);
        snapshot
    }
}

/// The scene under the other contact law, by the solver that knows both.
fn other_law(scene: &Scene) -> Option<CheckedScene> {
    let mut scene = scene.clone();
    scene.solver.kind = SolverKind::Explicit;
    scene.solver.contact = match scene.solver.contact {
        ContactLaw::Unilateral => ContactLaw::Bilateral,
        ContactLaw::Bilateral => ContactLaw::Unilateral,
    };
    scene.checked().ok()
}

/// The event solver under unilateral contact, where the scene's own solver is another.
fn reference(scene: &Scene) -> Option<Run> {
    if scene.solver.kind == SolverKind::Event {
        return None;
    }
    let scene = scene.as_reference().checked().ok()?;
    Some(Run::new(Motion::new(&scene), scene.solver.end_s))
}

/// Whether a tiny change of the pulse changes the outcome.
fn sensitive(scene: &Scene) -> bool {
    scene.as_reference().checked().is_ok_and(|scene| is_sensitive(&scene, settle(&scene)))
}

fn done(run: Option<&Run>) -> Option<Forecast> {
    match run?.ahead() {
        Ahead::Done(forecast) => Some(forecast),
        Ahead::Computing(_) => None,
    }
}
