//! Runs a motion ahead to its end, in slices short enough that a newer order
//! never waits.

use std::time::{Duration, Instant};

use crate::motion::verdict::{LAST_PART, judge};
use crate::motion::{Motion, Verdict};
use crate::tui::engine::{Ahead, Forecast};

/// A motion on its way to an end.
#[derive(Debug)]
pub struct Run {
    motion: Motion,
    start: f64,
    end: f64,
    window: f64,
    slice: f64,
    wall: Duration,
    steps: u64,
    result: Option<Forecast>,
}

/// Wall time one slice should take.
const SLICE: Duration = Duration::from_millis(5);

impl Run {
    /// A run of `length` seconds from where the motion is.
    #[must_use]
    pub fn new(motion: Motion, length: f64) -> Self {
        let start = motion.state().t_s;
        let steps = motion.steps().unwrap_or(0);
        Self {
            end: start + length,
            window: LAST_PART * length,
            slice: length / 1000.0,
            wall: Duration::ZERO,
            result: None,
            motion,
            start,
            steps,
        }
    }

    /// Goes one slice on.
    pub fn go_on(&mut self) {
        if self.result.is_some() {
            return;
        }
        let began = Instant::now();
        let until = (self.motion.state().t_s + self.slice).min(self.end);
        // The explicit solver stops at its last step before `until`.
        let near_end = self.end - until < 0.5 * self.slice;
        let until = if near_end { self.end } else { until };
        let failed = self.motion.advance(until).is_err();
        let took = began.elapsed();
        self.wall += took;
        if took * 2 < SLICE {
            self.slice *= 2.0;
        } else if took > SLICE * 2 {
            self.slice = (0.5 * self.slice).max((self.end - self.start) * 1e-7);
        }
        if failed || until >= self.end || self.motion.over() {
            self.result = Some(self.judged());
        }
    }

    fn judged(&self) -> Forecast {
        let motion = &self.motion;
        let (log, state) = (motion.contacts(), motion.state());
        let verdict = match motion.failure() {
            Some(_) => Verdict::Failed,
            None => judge(log, motion.machine(), state.t_s, self.window, motion.over()),
        };
        let lasting = matches!(verdict, Verdict::Locked | Verdict::Adhesive | Verdict::Slip);
        Forecast {
            verdict,
            since: lasting.then_some(log.since),
            multipliers: motion.multipliers(),
            amplitude: state.amplitude(),
            impacts: log.impact_count,
            checks: motion.checks(),
            failure: motion.failure().map(ToString::to_string),
        }
    }

    /// How far it is, or what it came to.
    #[must_use]
    pub fn ahead(&self) -> Ahead {
        match &self.result {
            Some(forecast) => Ahead::Done(forecast.clone()),
            None => {
                let part = (self.motion.state().t_s - self.start) / (self.end - self.start);
                Ahead::Computing(part.clamp(0.0, 1.0))
            }
        }
    }

    /// Whether it is over.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.result.is_some()
    }

    /// Wall time so far \[s\].
    #[must_use]
    pub fn wall_s(&self) -> f64 {
        self.wall.as_secs_f64()
    }

    /// Wall time of one step \[s\], for a solver that steps.
    #[must_use]
    pub fn step_s(&self) -> Option<f64> {
        let steps = self.motion.steps()?.saturating_sub(self.steps);
        (steps > 0).then(|| self.wall_s() / steps as f64)
    }
}
