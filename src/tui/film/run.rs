//! The film: a run computed ahead in slices short enough that a new order is not delayed, with its
//! copies of the motion, changes of contact, and verdict.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::copies::Copies;
use super::page::Page;
use super::plan::FilmPlan;
use crate::sheet::sentence::Facts;
use crate::tui::engine::{FORECAST_LIMIT, FullRun, FullRunState, SLICE};
use crate::tui::trace::{Mark, Marks};
use rubscope_solver::motion::{
    GoOn, LAST_PART, Motion, RunReport, Scripted, Verdict, VerdictReached, judge_end,
};

/// A film, computed up to some instant.
#[derive(Clone, Debug)]
pub struct Film {
    /// What the film shows.
    pub plan: FilmPlan,
    /// The furthest instant computed.
    pub ahead: Scripted,
    /// Time up to which the film is computed, where the explicit solver may be at its last step
    /// before \[s\].
    reached: f64,
    /// Number of samples of the last part, of which its start is the first.
    samples: u32,
    marks: Marks,
    copies: Copies,
    /// Wall-clock time spent on the last part and what was missing before it.
    pub wall: Duration,
    /// Wall-clock time of one slice.
    slice: Duration,
    /// Wall-clock time after which the film is computed only as far as it is watched.
    limit: Duration,
    /// Steps taken and skipped before this film was computed.
    before: [u64; 2],
    /// The verdict proved before the end; `None` until then.
    proved: Option<Verdict>,
    /// The result; `None` until the film is complete.
    pub result: Option<Arc<FullRun>>,
    /// The page of time whose curves are recorded.
    pub page: Page,
}

/// Intervals of the last part, at whose ends the log of contacts is read; enough for its spectrum.
const SAMPLES: u32 = 2048;

impl Film {
    /// Creates a film at the start of its scene.
    pub fn new(plan: FilmPlan) -> Self {
        let mut motion = Motion::new(&plan.scene);
        // No screen shows them, and they cost more than the motion.
        motion.forgo_checks();
        let ahead = Scripted::new(motion, &plan.script);
        let mut copies = Copies::default().under(&plan.script, 0, plan.end_s - plan.from_s);
        copies.push(&ahead);
        let marks = Marks::from(ahead.motion.contacts());
        Self::going_on(plan, ahead, copies, marks)
    }

    fn going_on(plan: FilmPlan, ahead: Scripted, copies: Copies, marks: Marks) -> Self {
        Self {
            reached: ahead.motion.t_s(),
            samples: u32::from(ahead.motion.t_s() >= plan.from_s),
            wall: Duration::ZERO,
            slice: SLICE,
            limit: FORECAST_LIMIT,
            before: steps(&ahead.motion).unwrap_or_default(),
            proved: None,
            result: None,
            page: Page::default(),
            plan,
            ahead,
            marks,
            copies,
        }
    }

    /// Returns the film of another plan, which keeps what both have in common. `head` is a motion
    /// of this film that may be nearer to the cut than the last copy.
    pub fn replanned(&self, plan: FilmPlan, head: Option<&Scripted>) -> Self {
        if plan.scene != self.plan.scene {
            return Self::new(plan);
        }
        let common = plan.script.common(&self.plan.script);
        let copies = self.copies.under(&plan.script, common, plan.end_s - plan.from_s);
        let under = |at: &Scripted| at.under(&plan.script, common);
        let last = copies.before(plan.from_s);
        let ahead = [last, head, Some(&self.ahead)].into_iter().flatten();
        let ahead = ahead
            .filter(|at| at.motion.t_s() <= plan.from_s && at.motion.failure().is_none())
            .filter_map(under)
            .max_by(|a, b| a.motion.t_s().total_cmp(&b.motion.t_s()));
        let Some(mut ahead) = ahead else { return Self::new(plan) };
        ahead.motion.set_end(plan.end_s);
        let marks = self.marks.up_to(ahead.motion.t_s(), ahead.motion.contacts());
        Self::going_on(plan, ahead, copies, marks)
    }

    /// Computes one slice of wall-clock time.
    pub fn compute(&mut self) {
        if self.result.is_some() {
            return;
        }
        let began = Instant::now();
        let slice = self.slice;
        let go_on = || began.elapsed() < slice;
        let mut reached = Ok(true);
        while reached == Ok(true) && !self.is_through() && go_on() {
            let sample = self.next_sample();
            reached = if sample < self.plan.end_s {
                self.ahead.approach(sample, &go_on)
            } else {
                self.ahead.advance_while(sample, &go_on)
            };
            if reached == Ok(true) {
                self.reached = sample;
                self.take_sample();
            }
        }
        self.wall += began.elapsed();
        if reached.is_err() || self.is_through() {
            self.result = Some(Arc::new(self.finished()));
        }
    }

    /// Returns whether all samples are taken.
    fn is_through(&self) -> bool {
        self.samples > SAMPLES
    }

    /// Returns the time of the next sample \[s\]; before the last part, samples only collect marks
    /// and copies.
    fn next_sample(&self) -> f64 {
        let FilmPlan { from_s, end_s, .. } = self.plan;
        let length = end_s - from_s;
        match self.samples {
            0 => (self.reached + length / f64::from(SAMPLES)).min(from_s),
            SAMPLES.. => end_s,
            taken => from_s + f64::from(taken) / f64::from(SAMPLES) * length,
        }
    }

    fn take_sample(&mut self) {
        self.marks.look(self.ahead.motion.contacts());
        if self.samples == 0 && self.reached >= self.plan.from_s {
            // A change at the same instant, or one soon after it, goes on from here.
            self.copies.push(&self.ahead);
            self.samples = 1;
            return;
        }
        self.copies.follow(&self.ahead);
        if self.samples > 0 {
            self.samples += 1;
            self.proved = self.proved.or_else(|| self.proof());
        }
    }

    /// Computes `u_c` and `u_s` of the casing \[m\] up to the end of the complete film, as far as
    /// `go_on` lets it: over the last part, or over its end if the interval between two samples
    /// would exceed `longest` \[s\]. A motion by steps is sampled at whole steps: samples that are
    /// early by parts of a step would add lines that are not in the motion. Returns the start and the
    /// interval \[s\] too.
    pub fn signal(&self, longest: f64, go_on: GoOn<'_>) -> (f64, f64, Vec<[f64; 2]>) {
        let end = self.ahead.motion.t_s().min(self.plan.end_s);
        let part = longest.min((end - self.plan.from_s) / f64::from(SAMPLES));
        let step = steps(&self.ahead.motion).map(|_| self.plan.scene.solver.step_s);
        let whole = |step: f64| step * (part / step).ceil().min((longest / step).floor()).max(1.0);
        let interval = step.map_or(part, whole);
        let count = SAMPLES.min(((end - self.plan.from_s) / interval + 1e-6) as u32);
        let begin = (end - f64::from(count) * interval).max(self.plan.from_s);
        let mut at = self.before(begin).unwrap_or(&self.ahead).clone();
        let sample = |k| {
            let reached = at.advance_while(begin + f64::from(k) * interval, go_on);
            (reached == Ok(true)).then(|| at.motion.state().u)
        };
        (begin, interval, (1..=count).map_while(sample).collect())
    }

    /// Returns the latest known motion at or before `t` \[s\].
    pub fn before(&self, t: f64) -> Option<&Scripted> {
        let ahead = Some(&self.ahead).filter(|ahead| ahead.motion.t_s() <= t);
        let both = [self.copies.before(t), ahead].into_iter().flatten();
        both.max_by(|a, b| a.motion.t_s().total_cmp(&b.motion.t_s()))
    }

    /// Returns the changes of contact so far, in order of time.
    pub fn marks(&self) -> &[Mark] {
        &self.marks.seen
    }

    /// Returns the time up to which instants are known \[s\]; a failed motion stays where it failed
    /// to the end.
    pub fn reach(&self) -> f64 {
        match self.result {
            Some(_) => self.plan.end_s,
            None => {
                let last = self.copies.last().map_or(0.0, |last| last.motion.t_s());
                self.reached.max(self.ahead.motion.t_s()).max(last)
            }
        }
    }

    /// Returns the outcome with which the sensitivity check compares changed runs; `None` until the
    /// film is complete.
    pub fn verdict_reached(&self) -> Option<VerdictReached> {
        Some(VerdictReached::of(&self.ahead.motion, self.result.as_ref()?.facts.verdict))
    }

    /// Returns the verdict; `None` until the film is complete or its verdict is proved.
    pub fn verdict(&self) -> Option<Verdict> {
        self.result.as_ref().map(|run| run.facts.verdict).or(self.proved)
    }

    /// Returns the proved verdict if judging the run now would give the same; `None` otherwise, and
    /// while nothing is proved.
    fn proof(&self) -> Option<Verdict> {
        let motion = &self.ahead.motion;
        let end = || judge_end(motion, &motion.checks(), LAST_PART * self.plan.end_s).0;
        motion.final_verdict().filter(|proved| *proved == end())
    }

    fn finished(&self) -> FullRun {
        let end_s = self.plan.end_s;
        let report = RunReport::at_end(self.plan.scene_at(end_s), &self.ahead.motion, end_s);
        FullRun {
            marks: self.marks.seen.clone(),
            broken: report.broken.map(|(hold, _)| hold),
            locked_s: report.outcome.lock_time_s,
            facts: Facts::of(&report),
        }
    }

    /// Returns the progress, or the result.
    pub fn state(&self) -> FullRunState {
        if let Some(run) = &self.result {
            return FullRunState::Done(Arc::clone(run));
        }
        let FilmPlan { from_s, end_s, .. } = self.plan;
        let part = ((self.ahead.motion.t_s() - from_s) / (end_s - from_s)).clamp(0.0, 1.0);
        if self.is_done() { FullRunState::GivenUp(part) } else { FullRunState::Computing(part) }
    }

    /// Returns whether the film is complete or was given up.
    pub fn is_done(&self) -> bool {
        self.result.is_some() || self.wall >= self.limit
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

    /// Returns the numbers of steps taken and skipped for this film; `None` for solvers without
    /// steps.
    fn steps(&self) -> Option<[u64; 2]> {
        let [taken, skipped] = steps(&self.ahead.motion)?;
        let [taken_before, skipped_before] = self.before;
        Some([taken.saturating_sub(taken_before), skipped.saturating_sub(skipped_before)])
    }

    /// Returns whether a slice of the page can be computed now: its start is known, or never will
    /// be.
    pub fn has_page_due(&self) -> bool {
        let is_known = |from: f64| self.reach() >= from || self.is_done();
        self.page.due().is_some_and(|(from, _)| is_known(from))
    }

    /// Computes a slice of the page.
    pub fn compute_page(&mut self) {
        let from = self.page.due().filter(|(_, has_begun)| !has_begun);
        let from = from.and_then(|(from, _)| self.before(from).cloned());
        self.page.compute(from, self.plan.scene.solver.step_s);
    }
}

/// Returns the numbers of steps that a motion has taken and skipped; `None` for solvers without
/// steps.
fn steps(motion: &Motion) -> Option<[u64; 2]> {
    Some([motion.steps_taken()?, motion.steps_skipped()?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use rubscope_solver::scene::{Scene, SolverKind, keys};

    impl Film {
        /// Changes the length of a slice, so that a test does not depend on the machine's speed.
        pub(in crate::tui) fn in_slices_of(mut self, slice: Duration) -> Self {
            self.slice = slice;
            self
        }

        /// Computes the film to its end, or until it is given up.
        pub(in crate::tui) fn computed(mut self) -> Self {
            while !self.is_done() {
                self.compute();
            }
            self
        }
    }

    fn plan(name: &str) -> FilmPlan {
        FilmPlan::new(&Scene::builtin(name).unwrap().checked().unwrap())
    }

    #[test]
    fn a_verdict_that_is_proved_is_known_before_the_end_and_is_that_of_the_end() {
        for (name, key, value) in
            [("paper-nd3", "operation.pulse_n", "75e3"), ("rub", "operation.speed_rad_s", "400")]
        {
            let scene = Scene::builtin(name).unwrap().with(&[(key, value)]).unwrap();
            let film = Film::new(FilmPlan::new(&scene));
            let mut film = film.in_slices_of(Duration::from_micros(20));
            while film.verdict().is_none() {
                film.compute();
            }
            let proved = film.verdict();
            assert!(matches!(film.state(), FullRunState::Computing(_)), "{name}");
            assert_eq!(film.computed().result.map(|run| run.facts.verdict), proved, "{name}");
        }
    }

    #[test]
    fn a_live_change_late_in_a_run_is_judged_as_in_a_run_of_the_longer_end() {
        for (name, at) in [("rub", 0.35), ("rub", 0.4), ("rub", 0.49), ("digs-in", 0.4)] {
            let whole = Film::new(plan(name)).computed();
            let now = Scene::clone(&whole.plan.scene).with(&[(keys::CASING_DAMPING, "0.04")]);
            let changed = whole.plan.changed(at, &now.unwrap());
            let live = whole.replanned(changed.clone(), None).computed();
            let mut scene = Scene::clone(&changed.scene);
            scene.solver.end_s = changed.end_s;
            let scene = scene.checked().unwrap();
            let run = Film::new(FilmPlan { scene, from_s: 0.0, ..changed }).computed();
            let verdicts = [live.verdict(), run.verdict()];
            assert_eq!(verdicts, [Some(Verdict::Whirl); 2], "{name} changed at {at} s");
        }
    }

    #[test]
    fn a_motion_by_steps_is_sampled_at_whole_steps() {
        let film = Film::new(plan("paper-nd3")).computed();
        let (step, end) = (film.plan.scene.solver.step_s, &film.ahead.motion);
        let (begin, interval, signal) = film.signal(4.95 * step, &|| true);
        assert!((interval - 4.0 * step).abs() < 1e-9 * step, "{interval:e}");
        assert!((begin + 2048.0 * interval - end.t_s()).abs() < 1e-6 * step, "{begin:e}");
        assert_eq!((signal.len(), signal.last()), (2048, Some(&end.state().u)));
        let (begin, interval, signal) = film.signal(1.0, &|| true);
        assert!(0.0 <= begin && begin < interval, "{begin:e} {interval:e}");
        assert_ne!(signal.first(), signal.last());
    }

    #[test]
    fn a_run_that_takes_too_long_is_given_up_with_what_it_reached() {
        let mut scene = Scene::builtin("undamped").unwrap().as_reference();
        scene.solver.kind = SolverKind::Event;
        scene.solver.end_s = 1e6;
        let mut film = Film::new(FilmPlan::new(&scene.checked().unwrap()));
        film.limit = SLICE * 3;
        let film = film.computed();
        let FullRunState::GivenUp(part) = film.state() else { panic!("{:?}", film.state()) };
        assert!(part > 0.0 && part < 1.0, "{part}");
        // The last slice may exceed the limit.
        assert!(film.wall >= film.limit);
    }

    #[test]
    fn a_cut_film_is_that_of_its_plan_computed_at_once() {
        for name in ["paper-nd3", "rub", "rocking"] {
            let mut now = plan(name);
            let mut film = Film::new(now.clone()).computed();
            let mut scene = now.scene.clone().into_scene();
            for (t, speed) in [(4e-3, 430.0), (2.5e-3, 500.0), (6e-3, 520.0)] {
                scene.operation.speed_rad_s = speed;
                now = now.changed(t, &scene.checked().unwrap()).fired(t + 1e-3);
                film = film.replanned(now.clone(), None).computed();
                let whole = Film::new(now.clone()).computed();
                assert_eq!(film.ahead.motion.state(), whole.ahead.motion.state(), "{name}");
                let [own, other] = [&film, &whole].map(|film| film.result.as_ref().unwrap());
                assert_eq!(own.facts.verdict, other.facts.verdict, "{name}");
                assert_eq!(own.facts.touches, other.facts.touches, "{name}");
            }
            assert_eq!(now.script.changes().iter().filter(|(t, _)| *t < 2.5e-3).count(), 0);
        }
    }

    #[test]
    fn a_film_keeps_few_copies_however_long_it_goes_on() {
        let mut plan = plan("rocking");
        (plan.end_s, plan.from_s) = (1e-3, 0.0);
        let mut film = Film::new(plan.clone()).computed();
        for _ in 0..12 {
            plan = FilmPlan { from_s: plan.end_s, end_s: plan.end_s + 1e-3, ..plan };
            film = film.replanned(plan.clone(), None).computed();
        }
        let kept = (0..1300).map(|k| film.before(1e-5 * f64::from(k)).unwrap().motion.t_s());
        let mut kept: Vec<f64> = kept.collect();
        kept.dedup();
        assert!((40..130).contains(&kept.len()), "{}", kept.len());
    }
}
