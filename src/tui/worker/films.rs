//! The films that an order wants, the checks of the run, and the studies. When a knob is turned
//! faster than a run takes, one older film continues, so that a verdict still appears as often as a
//! run can finish.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::tui::engine::{Answer, FORECAST_LIMIT, Order, Pace, Results, SLICE, Sensitive};
use crate::tui::film::{Film, FilmPlan};
use crate::tui::worker::background::{Job, on_spare_cores};
use crate::tui::worker::studies::Studies;
use rubscope_solver::motion::{
    Certainty, Scripted, Verdict, VerdictReached, certainty, run_to_verdict,
};
use rubscope_solver::scene::CheckedScene;

/// The films of one order.
#[derive(Debug)]
pub struct Films {
    /// The film of the run.
    pub own: Film,
    /// The same film under the other contact law.
    other: Option<Film>,
    /// The film of the pinned run.
    pinned: Option<Film>,
    /// Outcome of the sensitivity check; `None` until it is complete or given up.
    pub sensitive: Option<Sensitive>,
    /// The checks; `None` before they start, which is after the run.
    checks: Option<Job<Checks>>,
    /// The studies for the open views.
    pub studies: Studies,
    answers: Answers,
}

impl Films {
    /// Begins the films of an order.
    pub fn of(order: &Order) -> Self {
        let mut films = Self {
            own: Film::new(order.film.clone()),
            other: None,
            pinned: None,
            sensitive: None,
            checks: None,
            studies: Studies::default(),
            answers: Answers::default(),
        };
        films.want_others(order);
        films
    }

    /// Replaces the films that an order no longer wants. `head` is a motion of the film before,
    /// which shows the scene `before`. Returns whether the film of the run is another one.
    pub fn want(&mut self, order: &Order, before: &CheckedScene, head: &Scripted) -> bool {
        self.studies.stop_unwanted(order, &self.own);
        let plan = &self.own.plan;
        let is_other = *plan != order.film;
        if is_other {
            let same_motion = plan.scene == order.film.scene && plan.script == order.film.script;
            let new = self.own.replanned(order.film.clone(), Some(head));
            let old = std::mem::replace(&mut self.own, new);
            if !same_motion {
                self.answers.turned_on(before, old);
                let is_changed = !order.film.script.changes().is_empty();
                self.checks = None;
                self.sensitive = is_changed.then_some(Sensitive::Unknown);
            }
        }
        self.want_others(order);
        is_other
    }

    fn want_others(&mut self, order: &Order) {
        let law = order.compare.then(|| order.film.under_other_law()).flatten();
        self.other = replanned(self.other.take(), law);
        self.pinned = match &order.pinned {
            Some(plan) if self.pinned.is_none() && self.own.plan == *plan => Some(self.own.clone()),
            plan => replanned(self.pinned.take(), plan.clone()),
        };
        for film in self.all() {
            film.page.want(order.page, film.plan.end_s);
        }
    }

    /// Returns the films, that of the run first.
    fn all(&mut self) -> impl Iterator<Item = &mut Film> {
        std::iter::once(&mut self.own).chain(&mut self.other).chain(&mut self.pinned)
    }

    /// Returns whether any computation is unfinished.
    pub fn is_computing(&self, order: &Order) -> bool {
        let mut films = std::iter::once(&self.own).chain(&self.other).chain(&self.pinned);
        films.any(|film| !film.is_done() || !film.page.is_done())
            || self.answers.older.is_some()
            || self.sensitive.is_none()
            || self.studies.is_computing(order, &self.own)
    }

    /// Computes for one slice of wall-clock time, the most urgent first.
    pub fn compute(&mut self, order: &Order) {
        self.answers.look();
        let wall = self.own.wall;
        let is_first = |film: &Film| film.has_page_due() && 2 * film.page.wall() < wall;
        let is_done = self.own.is_done();
        // A page gets a third of the time until the run is computed.
        if let Some(film) =
            self.all().find(|film| film.has_page_due() && (is_done || is_first(film)))
        {
            return film.compute_page();
        }
        let known = self.own.verdict().is_some();
        // The verdict comes first; then the run with the least time so far, so that a quick one
        // does not wait for a slow one.
        let alone = !known && self.own.wall < ALONE;
        let films = self.all().take(if alone { 1 } else { usize::MAX });
        if let Some(film) = films.filter(|film| !film.is_done()).min_by_key(|film| film.wall) {
            film.compute();
            if !known {
                self.answers.note(&order.scene, self.own.verdict());
            }
            return;
        }
        if self.sensitive.is_none() {
            let begin = || Some(checks(&self.own.plan, self.own.verdict_reached()?));
            self.checks = self.checks.take().or_else(begin);
            self.sensitive = match &mut self.checks {
                Some(job) => {
                    job.work(SLICE);
                    let known = job.found.as_ref().and_then(|found| found.certainty);
                    let known = known.map(Sensitive::Known);
                    known.or(job.is_done().then_some(Sensitive::GivenUp))
                }
                // The run itself was given up.
                None => Some(Sensitive::GivenUp),
            };
            return;
        }
        self.studies.compute(order, &self.own);
    }

    /// Returns the results so far.
    pub fn results(&self, order: &Order) -> Results {
        let own = &self.own;
        let result = |film: &Option<Film>| film.as_ref().and_then(|film| film.result.clone());
        let page = |film: &Option<Film>| film.as_ref().and_then(|film| film.page.done.clone());
        Results {
            full_run: Some(own.state()),
            verdict: own.verdict(),
            answer: self.answers.latest.clone(),
            sensitive: self.sensitive.unwrap_or_default(),
            reference: self.checks.as_ref().and_then(|job| job.found.as_ref()?.reference),
            comparison: result(&self.other),
            page: own.page.done.clone(),
            comparison_page: page(&self.other),
            pinned_page: page(&self.pinned),
            pace: Pace {
                step_s: own.step_s(),
                skipped: own.skipped(),
                run_s: own.result.as_ref().map(|_| own.wall.as_secs_f64()),
                ..Pace::default()
            },
            found: self.studies.found(order, own),
            working: self.studies.working(order, own),
        }
    }
}

/// Returns the film of a plan, which goes on from an older film if there is one.
fn replanned(film: Option<Film>, plan: Option<FilmPlan>) -> Option<Film> {
    let plan = plan?;
    Some(match film {
        Some(film) if film.plan == plan => film,
        Some(film) => film.replanned(plan, None),
        None => Film::new(plan),
    })
}

/// What is asked about a run that is complete; `None` for what is not known yet.
#[derive(Debug)]
struct Checks {
    /// The verdict of the reference run; `None` also if there is none.
    reference: Option<Verdict>,
    /// Whether a tiny change of the pulse, the speed or the motion changes the verdict.
    certainty: Option<Certainty>,
}

/// Starts the checks of a run in the background. What exceeds the time limit is not sent.
fn checks(plan: &FilmPlan, reached: VerdictReached) -> Job<Checks> {
    let (scene, reference) = (plan.scene.clone(), plan.reference());
    Job::by(move |to, go_on| {
        let in_time = |began: Instant| go_on() && began.elapsed() < FORECAST_LIMIT;
        let began = Instant::now();
        let run = |scene: &CheckedScene| run_to_verdict(scene, &|| in_time(began));
        let reference = reference.as_ref().and_then(run).map(|reached| reached.verdict);
        // Sending fails only if the checks were dropped.
        let _ = to.send(Checks { reference, certainty: None });
        let began = Instant::now();
        let certainty = on_spare_cores(|| certainty(&scene, reached, true, &|| in_time(began)));
        let _ = to.send(Checks { reference, certainty });
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
    older: Option<(CheckedScene, Job<Verdict>)>,
}

impl Answers {
    /// Continues a replaced run of `scene` in the background, unless another one is already running
    /// there or the verdict of this one is known.
    pub fn turned_on(&mut self, scene: &CheckedScene, mut run: Film) {
        if self.older.is_some() || run.verdict().is_some() {
            return;
        }
        let older = Job::by(move |to, go_on| {
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
            older.work(Duration::ZERO);
            match older.found.as_deref().copied() {
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
    use rubscope_solver::scene::Scene;

    fn film(speed: f64) -> (CheckedScene, Film) {
        let mut scene = Scene::builtin("slip").unwrap();
        (scene.operation.speed_rad_s, scene.solver.end_s) = (speed, 0.02);
        let scene = scene.checked().unwrap();
        let film = Film::new(FilmPlan::new(&scene));
        (scene, film.in_slices_of(Duration::from_micros(20)))
    }

    fn order(scene: &CheckedScene) -> Order {
        let film = FilmPlan::new(scene);
        Order { film, scene: scene.clone(), ..crate::tui::app::tests::on_screen().order() }
    }

    #[test]
    fn a_held_key_gets_the_answer_of_a_run_that_was_begun() {
        let mut answers = Answers::default();
        // Each run gets one slice before the next turn of the knob, and needs many.
        let mut reported = Vec::new();
        for turn in 0.. {
            let (scene, mut film) = film(400.0 + 1e-3 * f64::from(turn));
            film.compute();
            answers.turned_on(&scene, film);
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
        let mut slow = Scene::builtin("undamped").unwrap().as_reference();
        slow.solver.end_s = 1e6;
        let slow = slow.checked().unwrap();
        let mut films = Films::of(&order(&slow));
        let (quick, _) = film(400.0);
        let order = order(&quick);
        let head = films.own.before(0.0).unwrap().clone();
        assert!(films.want(&order, &slow, &head) && films.answers.older.is_some());
        while films.own.verdict().is_none() {
            films.compute(&order);
        }
        // A verdict is never replaced by that of an older run.
        let latest = films.answers.latest.as_ref();
        assert_eq!(latest.map(|answer| &answer.scene), Some(&quick));
        assert!(films.answers.older.is_none());
    }
}
