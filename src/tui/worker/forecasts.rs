//! The computations that look ahead of the playing motion: the run to its end, the reference run
//! with the event solver, the sensitivity check, and the studies. When a knob is turned faster than
//! a run takes, one older run continues, so that a verdict still appears as often as a run can
//! finish.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::tui::engine::{Answer, FORECAST_LIMIT, Order, Pace, Results, Sensitive};
use crate::tui::worker::background::{Background, on_spare_cores};
use crate::tui::worker::full_run::{FullRunJob, SLICE};
use crate::tui::worker::studies::Studies;
use rubscope_solver::motion::{Certainty, Motion, Verdict, VerdictReached, certainty};
use rubscope_solver::scene::{CheckedScene, ContactLaw, Scene, SolverKind};

/// The computations for one motion.
#[derive(Debug)]
pub struct Forecasts {
    /// The run to its end.
    pub full_run: FullRunJob,
    /// The reference run; `None` if the scene has none, or the motion was changed.
    reference: Option<FullRunJob>,
    /// Outcome of the sensitivity check; `None` until it is complete or given up.
    sensitive: Option<Sensitive>,
    /// The sensitivity check; `None` before it starts, which is after the run.
    sensitivity: Option<Background<Certainty>>,
    /// The studies for the open views.
    pub studies: Studies,
    answers: Answers,
}

impl Forecasts {
    /// Creates the forecasts for a motion at the start of its scene.
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

    /// Stops the studies that the order no longer needs.
    pub fn stop_unwanted(&mut self, order: &Order) {
        self.studies.stop_unwanted(order, &self.full_run);
    }

    /// Returns studies and answers for the next motion; an unfinished run of `scene` continues in
    /// the background.
    pub fn hand_over(&mut self, scene: &CheckedScene, motion: &Motion) -> (Studies, Answers) {
        self.changed(scene, motion, 0.0);
        (std::mem::take(&mut self.studies), std::mem::take(&mut self.answers))
    }

    /// Starts a new run of `length` seconds after a change of the motion. It has neither a
    /// reference nor a sensitivity check. The run of the previous `scene` continues in the
    /// background.
    pub fn changed(&mut self, scene: &CheckedScene, motion: &Motion, length: f64) {
        let run = std::mem::replace(&mut self.full_run, FullRunJob::new(motion.clone(), length));
        self.answers.turned_on(scene, run);
        self.reference = None;
        (self.sensitivity, self.sensitive) = (None, Some(Sensitive::Unknown));
    }

    /// Starts a new run of `length` seconds from the current time. It has no reference, because the
    /// reference starts from rest.
    pub fn again(&mut self, motion: &Motion, length: f64) {
        self.full_run = FullRunJob::new(motion.clone(), length);
        self.reference = None;
    }

    /// Returns whether any computation is unfinished.
    pub fn is_computing(&self, order: &Order, comparison: Option<&FullRunJob>) -> bool {
        let mut runs = std::iter::once(&self.full_run).chain(&self.reference).chain(comparison);
        runs.any(|run| !run.is_done())
            || self.answers.older.is_some()
            || self.sensitive.is_none()
            || self.studies.is_computing(order, &self.full_run)
    }

    /// Computes for one slice of wall-clock time, the most urgent first.
    pub fn compute(&mut self, order: &Order, comparison: Option<&mut FullRunJob>) {
        self.answers.look();
        let known = self.full_run.verdict().is_some();
        // The verdict comes first; then the run with the least time so far, so that a quick one
        // does not wait for a slow one.
        let alone = !known && self.full_run.wall() < ALONE;
        let others = self.reference.iter_mut().chain(comparison).filter(|_| !alone);
        let runs = std::iter::once(&mut self.full_run).chain(others);
        if let Some(run) = runs.filter(|run| !run.is_done()).min_by_key(|run| run.wall()) {
            run.compute();
            if !known {
                self.answers.note(&order.scene, self.full_run.verdict());
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
                // The run itself was given up.
                None => Some(Sensitive::GivenUp),
            };
            return;
        }
        self.studies.compute(order, &self.full_run);
    }

    /// Returns the results so far.
    pub fn results(&self, order: &Order, comparison: Option<&FullRunJob>) -> Results {
        let done_in = self.full_run.result().map(|_| self.full_run.wall().as_secs_f64());
        Results {
            full_run: Some(self.full_run.state()),
            verdict: self.full_run.verdict(),
            answer: self.answers.latest.clone(),
            end_s: self.full_run.end(),
            sensitive: self.sensitive.unwrap_or_default(),
            reference: self.reference.as_ref().and_then(FullRunJob::result).cloned(),
            comparison: comparison.and_then(FullRunJob::result).cloned(),
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

/// Creates the reference run: the event solver with push-only contact. `None` if the scene uses the
/// event solver already, has an elastic lining, which is a different machine, or has something else
/// that the event solver does not support.
fn reference(scene: &Scene) -> Option<FullRunJob> {
    if scene.solver.kind == SolverKind::Event || scene.solver.contact == ContactLaw::Smooth {
        return None;
    }
    let scene = scene.as_reference().checked().ok()?;
    Some(FullRunJob::new(Motion::new(&scene), scene.solver.end_s))
}

/// Starts the sensitivity check in the background: whether a tiny change of the pulse, the speed or
/// the motion changes the verdict. It sends nothing if it exceeds the time limit.
fn sensitivity(scene: &CheckedScene, reached: VerdictReached) -> Background<Certainty> {
    let scene = scene.clone();
    Background::start(move |to, go_on| {
        let began = Instant::now();
        let go_on = || go_on() && began.elapsed() < FORECAST_LIMIT;
        let found = on_spare_cores(|| certainty(&scene, reached, true, &go_on));
        if let Some(certainty) = found {
            // Sending fails only if the check was dropped.
            let _ = to.send(certainty);
        }
    })
}

/// Time for which the run may use its core alone before its verdict is known.
const ALONE: Duration = Duration::from_millis(200);

/// The latest verdict, and an older run that is still being finished in the background.
#[derive(Debug, Default)]
pub struct Answers {
    /// The latest verdict, with its scene; `None` before the first.
    latest: Option<Arc<Answer>>,
    /// The older run and its scene; `None` if none is being finished.
    older: Option<(CheckedScene, Background<Verdict>)>,
}

impl Answers {
    /// Continues a replaced run of `scene` in the background, unless another one is already running
    /// there or the verdict of this one is known.
    pub fn turned_on(&mut self, scene: &CheckedScene, mut run: FullRunJob) {
        if self.older.is_some() || run.verdict().is_some() {
            return;
        }
        let older = Background::start(move |to, go_on| {
            while run.verdict().is_none() && !run.is_done() && go_on() {
                run.compute();
            }
            // Sending fails only if the run was dropped.
            _ = run.verdict().map(|verdict| to.send(verdict));
        });
        self.older = Some((scene.clone(), older));
    }

    /// Records the verdict of the background run once it is known.
    fn look(&mut self) {
        if let Some((scene, mut older)) = self.older.take() {
            match older.receive(Duration::ZERO) {
                None if !older.is_done() => self.older = Some((scene, older)),
                verdict => self.note(&scene, verdict),
            }
        }
    }

    /// Records a verdict if there is one, and drops the background run, which is older.
    pub fn note(&mut self, scene: &CheckedScene, verdict: Option<Verdict>) {
        if let Some(verdict) = verdict {
            self.older = None;
            self.latest = Some(Arc::new(Answer { scene: scene.clone(), verdict }));
        }
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
        // Each run gets one slice before the next turn of the knob, and needs many.
        let mut reported = Vec::new();
        for turn in 0.. {
            let (scene, mut run) = run(400.0 + 1e-3 * f64::from(turn));
            run.compute();
            answers.turned_on(&scene, run);
            answers.look();
            let speed = answers.latest.as_ref().map(|answer| answer.scene.operation.speed_rad_s);
            if reported.last().copied() != speed {
                reported.extend(speed);
            }
            if reported.len() > 2 {
                break;
            }
        }
        // Some values are skipped, but a new run starts whenever one finishes.
        assert!(reported.is_sorted(), "{reported:?}");
    }

    #[test]
    fn no_run_waits_for_a_slow_one_that_was_begun_before_it() {
        let slow = Scene::builtin("undamped").unwrap().as_reference().checked().unwrap();
        let mut forecasts = Forecasts::of(&Motion::new(&slow), &slow, Default::default());
        forecasts.again(&Motion::new(&slow), 1e6);
        let (quick, _) = run(400.0);
        forecasts.changed(&slow, &Motion::new(&quick), 1e-6);
        assert!(forecasts.answers.older.is_some());
        let app = crate::tui::app::tests::on_screen();
        let order = Order { scene: quick.clone(), ..app.order() };
        while forecasts.full_run.verdict().is_none() {
            forecasts.compute(&order, None);
        }
        // A verdict is never replaced by that of an older run.
        let latest = forecasts.answers.latest.as_ref();
        assert_eq!(latest.map(|answer| &answer.scene), Some(&quick));
        assert!(forecasts.answers.older.is_none());
    }

    #[test]
    fn the_verdict_of_a_run_does_not_wait_for_the_reference() {
        let scene = Scene::builtin("rub").unwrap().checked().unwrap();
        let mut forecasts = Forecasts::of(&Motion::new(&scene), &scene, Default::default());
        let order = Order { scene, ..crate::tui::app::tests::on_screen().order() };
        let spent = |forecasts: &Forecasts| forecasts.reference.as_ref().unwrap().wall();
        while forecasts.full_run.verdict().is_none() && forecasts.full_run.wall() < ALONE {
            forecasts.compute(&order, None);
            assert!(spent(&forecasts).is_zero());
        }
        while forecasts.is_computing(&order, None) && spent(&forecasts).is_zero() {
            forecasts.compute(&order, None);
        }
        assert!(!spent(&forecasts).is_zero());
    }

    #[test]
    fn the_run_that_was_begun_first_goes_on() {
        let mut answers = Answers::default();
        for speed in [398.0, 399.0, 400.0] {
            let (scene, waits) = run(speed);
            answers.turned_on(&scene, waits);
        }
        while answers.older.is_some() {
            answers.look();
        }
        assert_eq!(answers.latest.unwrap().scene.operation.speed_rad_s, 398.0);
    }
}
