//! Computes the run to its end ahead of the playback, in slices short enough that a new order is
//! not delayed.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::reading::Copies;
use crate::tui::engine::{FORECAST_LIMIT, FullRun, FullRunState};
use crate::tui::trace::{Mark, Marks, Trace};
use rubscope_solver::motion::LAST_PART;
use rubscope_solver::motion::{
    Motion, Seen, Verdict, VerdictReached, caught_at, judge_end, lock_that_broke,
};

/// A full run in progress.
#[derive(Debug)]
pub struct FullRunJob {
    motion: Motion,
    /// Time at which the run begins \[s\].
    start: f64,
    /// Time at which the run ends \[s\].
    end: f64,
    /// Length of the last part of the run, which the verdict describes \[s\].
    window: f64,
    /// Number of samples taken after the start.
    taken: u32,
    /// `u_c`, `u_s` \[m\], `alpha_c` and `alpha_s` \[rad\] at the start and at every sample.
    points: Vec<[f64; 4]>,
    marks: Marks,
    copies: Copies,
    /// Wall-clock time spent on the run.
    wall: Duration,
    /// Wall-clock time of one slice.
    slice: Duration,
    /// Wall-clock time after which the run is given up.
    limit: Duration,
    /// Steps taken and skipped before this run began.
    before: [u64; 2],
    /// The verdict proved before the end; `None` until then.
    proved: Option<Verdict>,
    /// The result; `None` until the run is complete.
    result: Option<FullRun>,
}

/// Samples per run, enough for its spectrum.
const SAMPLES: u32 = 2048;

/// Wall-clock time of one slice.
pub(super) const SLICE: Duration = Duration::from_millis(5);

impl FullRunJob {
    /// Creates a run of `length` seconds from the current time of the motion.
    pub fn new(motion: Motion, length: f64) -> Self {
        let start = motion.t_s();
        let before = steps(&motion).unwrap_or_default();
        Self {
            end: start + length,
            // Judge it like a run from t = 0 to the same end.
            window: LAST_PART * (start + length),
            taken: 0,
            points: vec![point(&motion)],
            marks: Marks::from(motion.contacts()),
            copies: Copies::of(&motion, length),
            wall: Duration::ZERO,
            slice: SLICE,
            limit: FORECAST_LIMIT,
            proved: None,
            result: None,
            motion,
            start,
            before,
        }
    }

    /// Advances the run by one slice of wall-clock time.
    pub fn compute(&mut self) {
        if self.result.is_some() {
            return;
        }
        let began = Instant::now();
        let go_on = || began.elapsed() < self.slice;
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
                self.copies.follow(&self.motion);
                self.proved = self.proved.or_else(|| self.proof());
            }
        }
        self.wall += began.elapsed();
        if reached.is_err() || self.taken >= SAMPLES {
            self.result = Some(self.finished());
        }
    }

    /// Returns `u_c` and `u_s` of the casing at equal intervals after the start, so far \[m\].
    pub fn signal(&self) -> Vec<[f64; 2]> {
        self.points.iter().skip(1).map(|[u_c, u_s, ..]| [*u_c, *u_s]).collect()
    }

    /// Returns the latest copy of the motion at or before `t` \[s\]; `None` before the run begins.
    pub fn before(&self, t: f64) -> Option<Motion> {
        self.copies.before(t, &self.motion)
    }

    /// Returns the changes of contact so far, in order of time.
    pub fn marks(&self) -> &[Mark] {
        &self.marks.seen
    }

    /// Returns the time reached \[s\].
    pub fn t_s(&self) -> f64 {
        self.motion.t_s()
    }

    /// Returns the time at which the run ends \[s\].
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Returns the outcome with which the sensitivity check compares changed runs; `None` until the
    /// run is complete.
    pub fn reached(&self) -> Option<VerdictReached> {
        Some(VerdictReached::of(&self.motion, self.result()?.verdict))
    }

    /// Returns the verdict; `None` until the run is complete or its verdict is proved.
    pub fn verdict(&self) -> Option<Verdict> {
        self.result().map(|run| run.verdict).or(self.proved)
    }

    /// Returns the result; `None` until the run is complete.
    pub fn result(&self) -> Option<&FullRun> {
        self.result.as_ref()
    }

    /// Returns the proved verdict if judging the run now would give the same; `None` otherwise, and
    /// while nothing is proved.
    fn proof(&self) -> Option<Verdict> {
        let end = || judge_end(&self.motion, &self.motion.checks(), self.window).0;
        self.motion.final_verdict().filter(|proved| *proved == end())
    }

    fn finished(&self) -> FullRun {
        let motion = &self.motion;
        let log = motion.contacts();
        let checks = motion.checks();
        let (verdict, failure) = judge_end(motion, &checks, self.window);
        let step = (self.end - self.start) / f64::from(SAMPLES);
        FullRun {
            trace: Arc::new(Trace { from: self.start, step, points: self.points.clone() }),
            marks: Arc::new(self.marks.seen.clone()),
            broken: lock_that_broke(motion),
            caught: caught_at(motion),
            seen: Seen::at_end(motion, verdict, self.window),
            still: motion.state().amplitude() == 0.0,
            verdict,
            since: verdict.keeps_contact().then_some(log.since),
            multipliers: motion.multipliers(),
            impacts: log.impact_count,
            checks,
            stopped: motion.stopped().or_else(|| failure.as_ref().map(ToString::to_string)),
            failure,
        }
    }

    /// Returns the progress, or the result.
    pub fn state(&self) -> FullRunState {
        if let Some(run) = &self.result {
            return FullRunState::Done(Box::new(run.clone()));
        }
        let part = self.part();
        if self.is_done() { FullRunState::GivenUp(part) } else { FullRunState::Computing(part) }
    }

    fn part(&self) -> f64 {
        ((self.motion.t_s() - self.start) / (self.end - self.start)).clamp(0.0, 1.0)
    }

    /// Returns whether the run is complete or was given up.
    pub fn is_done(&self) -> bool {
        self.result.is_some() || self.wall >= self.limit
    }

    /// Returns the wall-clock time spent on the run so far.
    pub fn wall(&self) -> Duration {
        self.wall
    }

    /// Returns the wall-clock time per time step that was taken, not skipped \[s\]; `None` for
    /// solvers without steps, and before the first one.
    pub fn step_s(&self) -> Option<f64> {
        let [taken, _] = self.steps()?;
        (taken > 0).then(|| self.wall.as_secs_f64() / taken as f64)
    }

    /// Returns the fraction of the time steps that was skipped, 0 to 1; `None` for solvers without
    /// steps, and before the first one.
    pub fn skipped(&self) -> Option<f64> {
        let [taken, skipped] = self.steps()?;
        (taken + skipped > 0).then(|| skipped as f64 / (taken + skipped) as f64)
    }

    /// Returns the numbers of steps taken and skipped since this run began; `None` for solvers
    /// without steps.
    fn steps(&self) -> Option<[u64; 2]> {
        let [taken, skipped] = steps(&self.motion)?;
        let [taken_before, skipped_before] = self.before;
        Some([taken.saturating_sub(taken_before), skipped.saturating_sub(skipped_before)])
    }
}

/// Returns the numbers of steps that a motion has taken and skipped; `None` for solvers without
/// steps.
fn steps(motion: &Motion) -> Option<[u64; 2]> {
    Some([motion.steps_taken()?, motion.steps_skipped()?])
}

fn point(motion: &Motion) -> [f64; 4] {
    let state = motion.state();
    let ([u_c, u_s], [alpha_c, alpha_s]) = (state.u, state.alpha);
    [u_c, u_s, alpha_c, alpha_s]
}

#[cfg(test)]
mod tests {
    use super::*;
    use rubscope_solver::scene::{Scene, SolverKind};

    impl FullRunJob {
        /// Changes the length of a slice, so that a test does not depend on the machine's speed.
        pub(in crate::tui::worker) fn in_slices_of(mut self, slice: Duration) -> Self {
            self.slice = slice;
            self
        }
    }

    #[test]
    fn the_steps_of_a_run_are_those_since_its_start() {
        let scene = Scene::base().checked().unwrap();
        let mut motion = Motion::new(&scene);
        motion.advance(1e-4).unwrap();
        let before = motion.steps_taken().unwrap();
        let mut job = FullRunJob::new(motion, 0.01);
        assert_eq!((job.step_s(), job.skipped()), (None, None));
        while !job.is_done() {
            job.compute();
        }
        let [taken, skipped] = job.steps().unwrap();
        assert_eq!(taken + skipped, 100_000);
        assert_eq!(taken + before, job.motion.steps_taken().unwrap());
        assert!(before > 0 && taken > 0 && taken < skipped, "{before} {taken} {skipped}");
        assert_eq!(job.skipped(), Some(skipped as f64 / 1e5));
        assert_eq!(job.step_s(), Some(job.wall.as_secs_f64() / taken as f64));
    }

    #[test]
    fn a_verdict_that_is_proved_is_known_before_the_end_and_is_that_of_the_end() {
        for (name, key, value) in
            [("paper-nd3", "operation.pulse_n", "75e3"), ("rub", "operation.speed_rad_s", "400")]
        {
            let scene = Scene::builtin(name).unwrap().with(&[(key, value)]).unwrap();
            let job = FullRunJob::new(Motion::new(&scene), scene.solver.end_s);
            let mut job = job.in_slices_of(Duration::from_micros(20));
            while job.verdict().is_none() {
                job.compute();
            }
            let proved = job.verdict();
            assert!(matches!(job.state(), FullRunState::Computing(_)), "{name}");
            while !job.is_done() {
                job.compute();
            }
            assert_eq!(job.result().map(|run| run.verdict), proved, "{name}");
        }
    }

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
        // The last slice may exceed the limit.
        assert!(job.wall >= job.limit);
    }
}
