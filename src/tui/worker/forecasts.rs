//! What is computed beside the motion that plays: the run to its end, the same by the event
//! solver, whether a small change would change it, and the studies. While a knob is turned
//! faster than a run takes, an older run goes on, so that verdicts come as often as runs can.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::tui::engine::{
    Answer, FORECAST_LIMIT, FullRun, FullRunState, Order, Pace, Results, Sensitive,
};
use crate::tui::trace::Mark;
use crate::tui::worker::background::{Background, on_spare_cores};
use crate::tui::worker::full_run::{FullRunJob, SLICE};
use crate::tui::worker::studies::Studies;
use rubscope_solver::motion::{Certainty, Motion, VerdictReached, certainty};
use rubscope_solver::scene::{CheckedScene, ContactLaw, Scene, SolverKind};

/// The computations for one motion.
#[derive(Debug)]
pub struct Forecasts {
    full_run: FullRunJob,
    reference: Option<FullRunJob>,
    sensitive: Option<Sensitive>,
    sensitivity: Option<Background<Certainty>>,
    studies: Studies,
    answers: Answers,
}

impl Forecasts {
    /// Creates the forecasts for the motion of a scene at its start.
    pub fn of(motion: &Motion, scene: &Scene, (studies, answers): (Studies, Answers)) -> Self {
        Self {
            full_run: FullRunJob::new(motion.clone(), scene.solver.end_s),
            reference: reference(scene),
            sensitive: None,
            sensitivity: None,
            studies,
            answers,
        }
    }

    /// Returns the studies.
    pub fn studies(&mut self) -> &mut Studies {
        &mut self.studies
    }

    /// Stops the studies that are not wanted any more.
    pub fn stop_unwanted(&mut self, order: &Order) {
        self.studies.stop_unwanted(order, &self.full_run);
    }

    /// Returns the studies and answers for the next motion; this one was of `scene`.
    pub fn hand_over(&mut self, scene: &CheckedScene, motion: &Motion) -> (Studies, Answers) {
        self.changed(scene, motion, 0.0);
        (std::mem::take(&mut self.studies), std::mem::take(&mut self.answers))
    }

    /// Same as [`Self::again`], for a motion of `scene` that has been changed.
    pub fn changed(&mut self, scene: &CheckedScene, motion: &Motion, length: f64) {
        let run = std::mem::replace(&mut self.full_run, FullRunJob::new(motion.clone(), length));
        self.answers.turned_on(scene, run);
        self.reference = None;
    }

    /// Starts a new run of `length` seconds from where the motion is. The reference starts from
    /// rest, so it does not apply to it.
    pub fn again(&mut self, motion: &Motion, length: f64) {
        self.full_run = FullRunJob::new(motion.clone(), length);
        self.reference = None;
    }

    /// Marks the sensitivity as unknown: it is not computed for a motion that was changed.
    pub fn forget_sensitivity(&mut self) {
        (self.sensitivity, self.sensitive) = (None, Some(Sensitive::Unknown));
    }

    /// Returns the end of the run \[s\].
    pub fn end(&self) -> f64 {
        self.full_run.end()
    }

    /// Returns the motion of the run by `t`, computed on the way; none before its start.
    pub fn before(&self, t: f64) -> Option<Motion> {
        self.full_run.before(t)
    }

    /// Returns how far the run is \[s\], and whether it goes no farther.
    pub fn reached(&self) -> (f64, bool) {
        (self.full_run.t_s(), self.full_run.is_done())
    }

    /// Returns the wall time spent on the run, until it is done.
    pub fn wall(&self) -> Option<Duration> {
        (!self.full_run.is_done()).then(|| self.full_run.wall())
    }

    /// Returns the changes of contact ahead, as far as they are known.
    pub fn marks(&self) -> &[Mark] {
        self.full_run.marks()
    }

    /// Returns whether there is more to compute.
    pub fn is_computing(&self, order: &Order, comparison: Option<&FullRunJob>) -> bool {
        let mut runs = std::iter::once(&self.full_run).chain(&self.reference).chain(comparison);
        runs.any(|run| !run.is_done())
            || self.answers.is_computing()
            || self.sensitive.is_none()
            || self.studies.is_computing(order, &self.full_run)
    }

    /// Computes a slice of a run that was begun before the last change, or of the present one
    /// that may be quicker; false where there is none.
    pub fn compute_older(&mut self, order: &Order) -> bool {
        let is_slow = self.answers.older.as_ref().is_some_and(|(_, run)| run.wall() >= HELD);
        if !is_slow || self.full_run.wall() >= QUICK {
            return self.answers.compute();
        }
        self.full_run.compute();
        self.answers.note(&order.scene, &self.full_run.state());
        true
    }

    /// Computes one slice.
    pub fn compute(&mut self, order: &Order, comparison: Option<&mut FullRunJob>) {
        let known = self.full_run.is_done();
        // The run that had least time: the quick one does not wait for the slow one.
        let runs = [&mut self.full_run].into_iter().chain(&mut self.reference).chain(comparison);
        if let Some(run) = runs.filter(|run| !run.is_done()).min_by_key(|run| run.wall()) {
            run.compute();
            if !known {
                self.answers.note(&order.scene, &self.full_run.state());
            }
            return;
        }
        if self.sensitive.is_none() {
            let begin = || Some(sensitivity(&order.scene, self.full_run.reached()?));
            self.sensitivity = self.sensitivity.take().or_else(begin);
            self.sensitive = match &mut self.sensitivity {
                Some(job) => {
                    let known = job.receive(SLICE);
                    known.map(Sensitive::Known).or(job.is_done().then_some(Sensitive::GivenUp))
                }
                // The run itself took too long.
                None => Some(Sensitive::GivenUp),
            };
            return;
        }
        self.studies.compute(order, &self.full_run);
    }

    /// Returns what is known so far.
    pub fn results(&self, order: &Order, comparison: Option<&FullRunJob>) -> Results {
        let full_run = self.full_run.state();
        let done_in = matches!(full_run, FullRunState::Done(_)).then(|| self.full_run.wall_s());
        Results {
            full_run: Some(full_run),
            answer: self.answers.latest(),
            end_s: self.end(),
            sensitive: self.sensitive.unwrap_or_default(),
            reference: done(self.reference.as_ref()),
            comparison: done(comparison),
            pace: Pace {
                step_s: self.full_run.step_s(),
                skipped: self.full_run.skipped(),
                run_s: done_in,
                ..Pace::default()
            },
            found: self.studies.found(order, &self.full_run),
            working: self.studies.working(order, &self.full_run),
            ..Results::default()
        }
    }
}

/// Returns the event solver under unilateral contact, if the scene uses another solver. An
/// elastic lining is another machine.
fn reference(scene: &Scene) -> Option<FullRunJob> {
    if scene.solver.kind == SolverKind::Event || scene.solver.contact == ContactLaw::Smooth {
        return None;
    }
    let scene = scene.as_reference().checked().ok()?;
    Some(FullRunJob::new(Motion::new(&scene), scene.solver.end_s))
}

/// Finds out whether a tiny change of the pulse, the speed or the motion changes the
/// outcome of the run that came to this; nothing comes where this takes too long.
fn sensitivity(scene: &CheckedScene, reached: VerdictReached) -> Background<Certainty> {
    let scene = scene.clone();
    Background::start(move |to, go_on| {
        let began = Instant::now();
        let go_on = || go_on() && began.elapsed() < FORECAST_LIMIT;
        let found = on_spare_cores(|| certainty(&scene, reached, true, &go_on));
        if let Some(certainty) = found {
            // Without a receiver nobody asks any more.
            let _ = to.send(certainty);
        }
    })
}

fn done(run: Option<&FullRunJob>) -> Option<FullRun> {
    match run?.state() {
        FullRunState::Done(run) => Some(*run),
        FullRunState::Computing(_) | FullRunState::GivenUp(_) => None,
    }
}

/// Wall time that an older run may still take after the last turn of a knob. A held key
/// comes again sooner, at any usual rate; somebody who has let go waits this much longer.
const HELD: Duration = Duration::from_millis(200);

/// Wall time of a run that does not wait for a slow one that was begun before it: a third of the
/// time between two turns of a held key.
const QUICK: Duration = Duration::from_millis(10);

/// The latest answer, and the run for the next.
#[derive(Debug, Default)]
pub struct Answers {
    latest: Option<Arc<Answer>>,
    older: Option<(CheckedScene, FullRunJob)>,
    left: Duration,
}

impl Answers {
    /// Takes over a run that is not wanted any more, unless an older one was begun: beside other
    /// work no run may have had its first slice.
    pub fn turned_on(&mut self, scene: &CheckedScene, run: FullRunJob) {
        self.left = HELD;
        let is_free = self.older.as_ref().is_none_or(|(_, older)| older.wall().is_zero());
        if is_free && !run.is_done() {
            self.older = Some((scene.clone(), run));
        }
    }

    /// Returns whether an older run goes on.
    pub fn is_computing(&self) -> bool {
        self.older.is_some()
    }

    /// Computes a slice of the older run; false where none goes on.
    pub fn compute(&mut self) -> bool {
        let Some((_, run)) = &mut self.older else { return false };
        let before = run.wall();
        run.compute();
        let spent = run.wall().saturating_sub(before);
        self.spend(spent);
        true
    }

    /// Records the wall time of the older run: its result is kept, or it is given up.
    fn spend(&mut self, spent: Duration) {
        let Some((scene, run)) = &self.older else { return };
        self.left = self.left.saturating_sub(spent);
        if run.is_done() || self.left.is_zero() {
            let (scene, state) = (scene.clone(), run.state());
            self.older = None;
            self.note(&scene, &state);
        }
    }

    /// Notes the result of a run, if it is one; that of an older one is not waited for any more.
    pub fn note(&mut self, scene: &CheckedScene, state: &FullRunState) {
        if let FullRunState::Done(run) = state {
            self.older = None;
            self.latest = Some(Arc::new(Answer { scene: scene.clone(), verdict: run.verdict }));
        }
    }

    /// Returns the latest answer.
    pub fn latest(&self) -> Option<Arc<Answer>> {
        self.latest.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(speed: f64) -> (CheckedScene, FullRunJob) {
        let mut scene = Scene::builtin("slip").unwrap();
        scene.operation.speed_rad_s = speed;
        let scene = scene.checked().unwrap();
        let motion = Motion::new(&scene);
        (scene, FullRunJob::new(motion, 0.02).in_slices_of(Duration::from_micros(20)))
    }

    #[test]
    fn a_held_key_gets_the_answer_of_a_run_that_was_begun() {
        let mut answers = Answers::default();
        // Each run has a slice before the next turn of the knob, and takes many.
        let mut reported = Vec::new();
        for turn in 0..100_000 {
            let (scene, mut run) = run(400.0 + 1e-3 * f64::from(turn));
            if !answers.compute() {
                run.compute();
            }
            answers.turned_on(&scene, run);
            let speed = answers.latest().map(|answer| answer.scene.operation.speed_rad_s);
            if reported.last().copied() != speed {
                reported.extend(speed);
            }
            if reported.len() > 2 {
                break;
            }
        }
        // Not those of all values, but the next one begins when one is done.
        assert!(reported.len() > 2 && reported.is_sorted(), "{reported:?}");
    }

    #[test]
    fn a_quick_run_does_not_wait_for_a_slow_one_that_was_begun_before_it() {
        let slow = Scene::builtin("undamped").unwrap().as_reference().checked().unwrap();
        let mut forecasts = Forecasts::of(&Motion::new(&slow), &slow, Default::default());
        forecasts.again(&Motion::new(&slow), 1e6);
        while forecasts.full_run.wall() < HELD {
            forecasts.full_run.compute();
        }
        let (quick, _) = run(400.0);
        forecasts.changed(&slow, &Motion::new(&quick), 1e-6);
        forecasts.answers.left = Duration::MAX;
        let app = crate::tui::app::on_screen();
        let order = Order { scene: quick.clone(), ..app.order() };
        for _ in 0..3 {
            forecasts.compute_older(&order);
        }
        // The newest that is ready is not followed by an older one.
        assert_eq!(forecasts.answers.latest().map(|answer| answer.scene.clone()), Some(quick));
        assert!(!forecasts.compute_older(&order));
    }

    #[test]
    fn a_long_run_does_not_keep_a_key_that_was_let_go_waiting() {
        let mut answers = Answers::default();
        let scene = Scene::builtin("undamped").unwrap().as_reference().checked().unwrap();
        let mut run = FullRunJob::new(Motion::new(&scene), 1e6);
        run.compute();
        answers.turned_on(&scene, run);
        answers.spend(HELD / 2);
        assert!(answers.is_computing());
        answers.spend(HELD / 2);
        assert!(!answers.is_computing() && answers.latest().is_none());
    }

    #[test]
    fn the_run_that_was_begun_first_goes_on_and_before_that_the_latest() {
        let mut answers = Answers::default();
        for speed in [398.0, 399.0] {
            let (scene, waits) = run(speed);
            answers.turned_on(&scene, waits);
            assert!(answers.older.as_ref().is_some_and(|(older, _)| *older == scene));
        }
        for speed in [400.0, 401.0] {
            let (scene, mut run) = run(speed);
            run.compute();
            assert!(!run.is_done());
            answers.turned_on(&scene, run);
        }
        answers.left = Duration::MAX;
        while answers.compute() {}
        assert_eq!(answers.latest().unwrap().scene.operation.speed_rad_s, 400.0);
    }
}
