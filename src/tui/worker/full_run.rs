//! Computes the run to its end ahead of the playback, in slices so short that a
//! newer order does not wait.

use std::time::{Duration, Instant};

use crate::motion::{Motion, Verdict, verdict_of};
use crate::tolerances::LAST_PART;
use crate::tui::engine::{FullRun, FullRunState};

/// A full run that is being computed.
#[derive(Debug)]
pub struct FullRunJob {
    motion: Motion,
    start: f64,
    end: f64,
    window: f64,
    taken: u32,
    signal: Vec<[f64; 2]>,
    /// Longest stretch to advance at once \[s\].
    stretch: f64,
    cut: Option<f64>,
    wall: Duration,
    steps: u64,
    result: Option<FullRun>,
}

/// Samples of one run, for its spectrum.
const SAMPLES: u32 = 2048;

/// Wall time one slice should take.
const SLICE: Duration = Duration::from_millis(5);

impl FullRunJob {
    /// A run of `length` seconds from where the motion is.
    pub fn new(motion: Motion, length: f64) -> Self {
        let start = motion.state().t_s;
        let steps = motion.steps().unwrap_or(0);
        Self {
            end: start + length,
            window: LAST_PART * length,
            taken: 0,
            signal: Vec::with_capacity(SAMPLES as usize),
            stretch: f64::INFINITY,
            cut: None,
            wall: Duration::ZERO,
            result: None,
            motion,
            start,
            steps,
        }
    }

    /// Computes one slice.
    pub fn compute(&mut self) {
        if self.result.is_some() {
            return;
        }
        let began = Instant::now();
        let length = self.end - self.start;
        let mut failed = false;
        while !failed && self.taken < SAMPLES && began.elapsed() < SLICE {
            let part = f64::from(self.taken + 1) / f64::from(SAMPLES);
            let sample =
                if self.taken + 1 == SAMPLES { self.end } else { self.start + part * length };
            // If a sample takes longer than a slice, it is divided.
            let until = sample.min(self.cut.unwrap_or(f64::INFINITY));
            let before = self.motion.state().t_s;
            let step = Instant::now();
            failed = self.motion.advance(until).is_err();
            let took = step.elapsed();
            // Shorter intervals if one took long, but not so short that the run
            // stops on a busy machine.
            let least = length / f64::from(SAMPLES) / 32.0;
            if took > SLICE * 4 {
                self.stretch = (0.25 * self.stretch.min(until - before)).max(least);
            } else {
                self.stretch *= 2.0;
            }
            if until >= sample {
                self.taken += 1;
                self.signal.push(self.motion.state().u);
            }
            self.cut = self.stretch.is_finite().then_some(until + self.stretch);
        }
        self.wall += began.elapsed();
        if failed || self.taken >= SAMPLES {
            self.result = Some(self.finished());
        }
    }

    /// `u_c` and `u_s` at equal intervals over the run so far \[m\].
    pub fn signal(&self) -> &[[f64; 2]] {
        &self.signal
    }

    fn finished(&self) -> FullRun {
        let motion = &self.motion;
        let log = motion.contacts();
        let verdict = verdict_of(motion, self.window);
        let lasting = matches!(verdict, Verdict::Locked | Verdict::Adhesive | Verdict::Slip);
        FullRun {
            verdict,
            since: lasting.then_some(log.since),
            multipliers: motion.multipliers(),
            impacts: log.impact_count,
            checks: motion.checks(),
            failure: motion.failure().map(ToString::to_string),
        }
    }

    /// Its progress or its result.
    pub fn state(&self) -> FullRunState {
        match &self.result {
            Some(run) => FullRunState::Done(run.clone()),
            None => {
                let part = (self.motion.state().t_s - self.start) / (self.end - self.start);
                FullRunState::Computing(part.clamp(0.0, 1.0))
            }
        }
    }

    /// Whether it is over.
    pub fn is_done(&self) -> bool {
        self.result.is_some()
    }

    /// Wall time so far \[s\].
    pub fn wall_s(&self) -> f64 {
        self.wall.as_secs_f64()
    }

    /// Wall time of one step \[s\], for a solver that steps.
    pub fn step_s(&self) -> Option<f64> {
        let steps = self.motion.steps()?.saturating_sub(self.steps);
        (steps > 0).then(|| self.wall_s() / steps as f64)
    }
}
