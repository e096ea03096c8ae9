//! Computes the run to its end ahead of the playback, in slices so short that a
//! newer order does not wait.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::motion::{Motion, verdict_of};
use crate::tolerances::LAST_PART;
use crate::tui::engine::{FORECAST_LIMIT, FullRun, FullRunState};
use crate::tui::trace::{Mark, Marks, Trace};

/// A full run that is being computed.
#[derive(Debug)]
pub struct FullRunJob {
    motion: Motion,
    start: f64,
    end: f64,
    window: f64,
    taken: u32,
    points: Vec<[f64; 4]>,
    marks: Marks,
    wall: Duration,
    limit: Duration,
    steps: u64,
    result: Option<FullRun>,
}

/// Samples of one run, for its spectrum.
const SAMPLES: u32 = 2048;

/// Wall time of one slice.
pub(super) const SLICE: Duration = Duration::from_millis(5);

impl FullRunJob {
    /// A run of `length` seconds from where the motion is.
    pub fn new(motion: Motion, length: f64) -> Self {
        let start = motion.state().t_s;
        let steps = motion.steps().unwrap_or(0);
        Self {
            end: start + length,
            // As a run from the start to there is judged.
            window: LAST_PART * (start + length),
            taken: 0,
            points: vec![point(&motion)],
            marks: Marks::from(motion.contacts()),
            wall: Duration::ZERO,
            limit: FORECAST_LIMIT,
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
        let go_on = || began.elapsed() < SLICE;
        let length = self.end - self.start;
        let mut reached = Ok(true);
        while reached == Ok(true) && self.taken < SAMPLES && go_on() {
            let part = f64::from(self.taken + 1) / f64::from(SAMPLES);
            let sample =
                if self.taken + 1 == SAMPLES { self.end } else { self.start + part * length };
            reached = self.motion.advance_while(sample, &go_on);
            if reached == Ok(true) {
                self.taken += 1;
                self.points.push(point(&self.motion));
                self.marks.look(self.motion.contacts());
            }
        }
        self.wall += began.elapsed();
        if reached.is_err() || self.taken >= SAMPLES {
            self.result = Some(self.finished());
        }
    }

    /// `u_c` and `u_s` at equal intervals over the run so far \[m\].
    pub fn signal(&self) -> Vec<[f64; 2]> {
        self.points.iter().skip(1).map(|[u_c, u_s, ..]| [*u_c, *u_s]).collect()
    }

    /// The changes of contact so far, in order of time.
    pub fn marks(&self) -> &[Mark] {
        &self.marks.seen
    }

    /// The end of the run \[s\].
    pub fn end(&self) -> f64 {
        self.end
    }

    fn finished(&self) -> FullRun {
        let motion = &self.motion;
        let log = motion.contacts();
        let verdict = verdict_of(motion, self.window);
        let period = std::f64::consts::TAU / motion.machine().omega_c;
        let broken = log.longest_hold.filter(|hold| hold.length() >= period);
        let step = (self.end - self.start) / f64::from(SAMPLES);
        FullRun {
            trace: Arc::new(Trace { from: self.start, step, points: self.points.clone() }),
            marks: Arc::new(self.marks.seen.clone()),
            broken: broken.map(|hold| (hold, motion.rotor().speed(hold.ended))),
            verdict,
            since: verdict.keeps_contact().then_some(log.since),
            multipliers: motion.multipliers(),
            impacts: log.impact_count,
            checks: motion.checks(),
            failure: motion.failure().map(ToString::to_string),
        }
    }

    /// Its progress or its result.
    pub fn state(&self) -> FullRunState {
        if let Some(run) = &self.result {
            return FullRunState::Done(run.clone());
        }
        let part = (self.motion.state().t_s - self.start) / (self.end - self.start);
        let part = part.clamp(0.0, 1.0);
        if self.is_done() { FullRunState::GivenUp(part) } else { FullRunState::Computing(part) }
    }

    /// Whether it is over.
    pub fn is_done(&self) -> bool {
        self.result.is_some() || self.wall >= self.limit
    }

    /// Wall time so far.
    pub fn wall(&self) -> Duration {
        self.wall
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

fn point(motion: &Motion) -> [f64; 4] {
    let state = motion.state();
    let ([u_c, u_s], [alpha_c, alpha_s]) = (state.u, state.alpha);
    [u_c, u_s, alpha_c, alpha_s]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Scene, SolverKind};

    #[test]
    fn a_run_that_takes_too_long_is_given_up_with_what_it_reached() {
        let mut scene = Scene::builtin("undamped").unwrap().as_reference();
        scene.solver.kind = SolverKind::Event;
        scene.solver.end_s = 1e6;
        let mut job = FullRunJob::new(Motion::new(&scene.checked().unwrap()), 1e6);
        job.limit = SLICE * 3;
        while !job.is_done() {
            job.compute();
        }
        let FullRunState::GivenUp(part) = job.state() else { panic!("{:?}", job.state()) };
        assert!(part > 0.0 && part < 1.0, "{part}");
        // One slice more than the limit, on a machine that does nothing else.
        assert!(job.wall >= job.limit);
    }
}
