//! The current lesson: its step, the answer, and whether its task is done.

use std::sync::Arc;

use super::knobs::Past;
use super::{App, InputMode, Source};
use crate::tui::knobs::{knob_of, place_of};
use crate::tui::lessons::{self, Condition, LETTERS, Lesson, LessonStep, LessonsDone};
use crate::tui::panels;
use crate::tui::views::ViewId;
use rubscope_solver::scene::{Scene, Value};

/// The progress of a lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct LessonProgress {
    /// Which lesson.
    pub lesson: usize,
    /// Which step, from 0.
    pub step: usize,
    /// Answers given, and tasks done, by step.
    pub steps: Vec<StepProgress>,
    /// Page of the text, if it hides the charts.
    pub page: usize,
    /// The last page has been read.
    pub read: bool,
    /// The place of the answer that Enter gives.
    pub choice: usize,
    /// What the user had before, and gets back.
    own: Arc<Past>,
}

/// The progress of one step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepProgress {
    /// The place of the answer given.
    pub answer: Option<usize>,
    /// The task is done.
    pub done: bool,
}

impl LessonProgress {
    /// The progress of the present step.
    pub fn now(&self) -> StepProgress {
        self.steps.get(self.step).copied().unwrap_or_default()
    }

    fn now_mut(&mut self) -> Option<&mut StepProgress> {
        self.steps.get_mut(self.step)
    }
}

/// The lessons.
#[derive(Clone, Debug, Default)]
pub struct Lessons {
    /// The one under way.
    pub progress: Option<LessonProgress>,
    /// The steps that were done.
    pub done: LessonsDone,
}

impl Lessons {
    /// Whether one is under way.
    pub(super) fn is_open(&self) -> bool {
        self.progress.is_some()
    }

    /// The one under way.
    pub(super) fn progress(&self) -> Option<&LessonProgress> {
        self.progress.as_ref()
    }

    /// The lesson under way is as it was.
    pub(super) fn set_progress(&mut self, progress: Option<LessonProgress>) {
        self.progress = progress;
    }
}

impl App {
    /// The current lesson.
    pub fn current_lesson(&self) -> Option<(&'static Lesson, &LessonProgress)> {
        let progress = self.lessons.progress.as_ref()?;
        Some((lessons::all().get(progress.lesson)?, progress))
    }

    /// The present step of the lesson.
    pub fn lesson_step(&self) -> Option<(&'static LessonStep, StepProgress)> {
        let (lesson, progress) = self.current_lesson()?;
        Some((lesson.steps.get(progress.step)?, progress.now()))
    }

    /// Whether a lesson waits for an answer.
    pub fn is_asked(&self) -> bool {
        let step = self.lesson_step();
        step.is_some_and(|(step, now)| step.question.is_some() && now.answer.is_none())
    }

    /// The key of the lessons: the list, the next page, or the next step.
    pub(super) fn lesson_key(&mut self) {
        let Some((lesson, progress)) = self.current_lesson() else {
            let done = &self.lessons.done;
            let next = lessons::all().iter().position(|lesson| done.next(lesson).is_some());
            self.dialogue.open(InputMode::Lessons(next.unwrap_or(0)));
            return;
        };
        let (number, step) = (progress.lesson, progress.step);
        if !progress.read && panels::lesson_fills(self) {
            let pages = panels::lesson_pages(self);
            if let Some(progress) = &mut self.lessons.progress {
                progress.page += 1;
                progress.read = progress.page >= pages;
            }
        } else if self.is_asked() {
            self.status = Some("first your guess: ↑ ↓ choose it, Enter answers".into());
        } else if step + 1 < lesson.steps.len() {
            self.begin_step(number, step + 1);
        } else {
            self.leave_lesson();
            self.status = Some(format!("end of the lesson: {}; your scene is back", lesson.title));
        }
    }

    /// The step before.
    pub(super) fn lesson_back(&mut self) {
        match self.lessons.progress.as_ref().map(|progress| (progress.lesson, progress.step)) {
            None => self.status = Some("no lesson is open".into()),
            Some((_, 0)) => self.status = Some("this is the first step".into()),
            Some((lesson, step)) => self.begin_step(lesson, step - 1),
        }
    }

    /// Starts a lesson where it was left, with a scene of its own.
    pub fn begin_lesson(&mut self, place: usize) {
        self.dialogue.close();
        if let Some(lesson) = lessons::all().get(place) {
            let step = self.lessons.done.next(lesson).unwrap_or(0);
            self.begin_step(place, step);
        }
    }

    /// Gives the user's own scene back, as it was before the lesson.
    pub(super) fn leave_lesson(&mut self) {
        if let Some(own) = self.lessons.progress.as_ref().map(|progress| Arc::clone(&progress.own))
        {
            self.give_back(Past::clone(&own));
        }
    }

    /// Forgets the lesson, but not what it left on the screen.
    pub(super) fn end_lesson(&mut self) {
        if let Some(progress) = self.lessons.progress.take() {
            self.knobs.set_live(progress.own.live);
            self.play.slow_as(progress.own.tempo);
            self.run.set_compare(progress.own.compare);
        }
    }

    /// Shows a step, with the answer if one was given before.
    fn begin_step(&mut self, place: usize, step: usize) {
        let Some(lesson) = lessons::all().get(place) else { return };
        let past = self.past();
        // A screen for a projector has no room for a lesson.
        self.present(false);
        let begun = self.lessons.progress.clone().filter(|progress| progress.lesson == place);
        let begun = begun.unwrap_or_else(|| LessonProgress {
            lesson: place,
            step,
            steps: vec![StepProgress::default(); lesson.steps.len()],
            page: 0,
            read: false,
            choice: 0,
            own: match &self.lessons.progress {
                Some(other) => Arc::clone(&other.own),
                None => Arc::new(past.clone()),
            },
        });
        self.lessons.progress =
            Some(LessonProgress { step, page: 0, read: false, choice: 0, ..begun });
        let knob = lesson.steps.get(step).and_then(|found| found.knob.as_deref());
        if let Some(place) = knob.and_then(place_of) {
            self.knobs.select(place);
        }
        self.show_step(past);
    }

    /// Goes to the answer above or below.
    pub(super) fn choose_answer(&mut self, up: bool) {
        if let Some(progress) = &mut self.lessons.progress {
            let by = if up { LETTERS.len() - 1 } else { 1 };
            progress.choice = (progress.choice + by) % LETTERS.len();
        }
    }

    /// Takes the chosen answer.
    pub(super) fn answer_chosen(&mut self) {
        if let Some(choice) = self.lessons.progress.as_ref().map(|progress| progress.choice) {
            self.answer(choice);
        }
    }

    /// Takes an answer: now its scene is run.
    pub(super) fn answer(&mut self, place: usize) {
        if !self.is_asked() {
            self.status = Some("no question is open".into());
            return;
        }
        if self.lessons.progress.as_ref().is_some_and(|progress| !progress.read)
            && panels::lesson_fills(self)
            && self
                .lessons
                .progress
                .as_ref()
                .is_some_and(|now| now.page + 1 < panels::lesson_pages(self))
        {
            self.status = Some("the question is on the next page: g".into());
            return;
        }
        let past = self.past();
        if let Some(progress) = &mut self.lessons.progress {
            (progress.page, progress.read) = (0, false);
            if let Some(now) = progress.now_mut() {
                now.answer = Some(place.min(LETTERS.len() - 1));
            }
        }
        self.show_step(past);
    }

    /// Makes scene and view those of the present step; undo comes back to `past`.
    fn show_step(&mut self, past: Past) {
        let Some((lesson, progress)) = self.current_lesson() else { return };
        let Some(step) = lesson.steps.get(progress.step) else { return };
        let answered = !self.is_asked();
        match lesson.scene_at(progress.step, answered) {
            Ok(scene) => {
                self.knobs.remember(past);
                let name = lesson.scene.clone();
                let source = Scene::builtin(&name).ok().map(|scene| Source { name, scene });
                self.files.open(scene.clone(), source);
                if scene != self.scene {
                    self.set_scene(scene, false);
                }
            }
            Err(error) => self.status = Some(error.to_string()),
        }
        self.knobs.forget_refusal();
        self.knobs.set_live(step.live);
        self.run.set_compare(step.compare && answered);
        let own_pages = lesson.steps.iter().any(|step| step.page_s.is_some());
        self.play.show_closely(own_pages.then_some(step.page_s));
        let then = step.then_view.as_ref().filter(|_| answered);
        let view = then.or(step.view.as_ref()).and_then(|word| ViewId::from_word(word));
        if let Some(view) = view {
            self.show(view);
        }
        // A chart that gives the answer away waits for it, and one that takes long
        // to compute is not needed.
        let hidden = step.then_view.as_deref().filter(|_| !answered);
        let hidden = hidden.and_then(ViewId::from_word);
        self.layout.order_beside(|view| match view {
            view if Some(view) == hidden => 2,
            ViewId::Map | ViewId::Precision | ViewId::Margins => 1,
            _ => 0,
        });
    }

    /// Records when the step is done: it is answered, and so is its task.
    pub fn check_lesson(&mut self) {
        let Some((step, now)) = self.lesson_step() else { return };
        if now.done || self.is_asked() {
            return;
        }
        let done = step.until.as_ref().is_none_or(|condition| self.meets(condition));
        if !done {
            return;
        }
        if let Some(now) = self.lessons.progress.as_mut().and_then(LessonProgress::now_mut) {
            now.done = true;
        }
        if let Some((lesson, progress)) = self.current_lesson() {
            let step = progress.step;
            self.lessons.done.add(lesson, step);
        }
    }

    fn meets(&self, condition: &Condition) -> bool {
        let number = |path: &str| knob_of(path)?.number(&self.scene);
        match condition {
            Condition::Verdict(word) => {
                let now = self.full_run().map(|run| run.verdict);
                now.is_some() && now == word.parse().ok()
            }
            Condition::View(word) => ViewId::from_word(word) == Some(self.view()),
            Condition::Compare(wanted) => self.run.is_compared() == *wanted,
            Condition::Above(path, limit) => number(path).is_some_and(|x| x > *limit),
            Condition::Below(path, limit) => number(path).is_some_and(|x| x < *limit),
            Condition::Limit(name, least) => self.margins().is_some_and(|(live, old)| {
                let value = live.margins.limit(*name).and_then(|limit| limit.value);
                !old && value.is_some_and(|value| value > *least)
            }),
            Condition::Is(path, word) => {
                let word = Value::Text(word.clone());
                knob_of(path).is_some_and(|knob| knob.get(&self.scene) == word)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::app::on_screen;
    use crate::tui::bindings::Action;

    #[test]
    fn a_step_is_done_by_its_answer_and_the_next_one_waits_for_it() {
        let mut app = on_screen();
        app.begin_lesson(1);
        let lesson = &lessons::all()[1];
        assert!(app.is_asked() && app.lessons.is_open());
        app.lesson_key();
        assert!(app.status.as_ref().is_some_and(|status| status.contains("your guess")));
        assert_eq!(app.lessons.progress.as_ref().unwrap().step, 0);
        app.answer(9);
        app.check_lesson();
        let now = app.lesson_step().unwrap().1;
        assert_eq!((now.answer, now.done), (Some(2), true));
        assert!(app.lessons.done.has(lesson, 0) && !app.lessons.done.has(lesson, 1));
        // A second answer is none.
        app.act(Action::Accept);
        app.answer(0);
        assert_eq!(app.lesson_step().unwrap().1.answer, Some(2));
        app.lesson_key();
        assert_eq!((app.lessons.progress.as_ref().unwrap().step, app.is_asked()), (1, true));
        app.lesson_back();
        assert!(!app.is_asked());
        app.lesson_back();
        assert_eq!(app.status.as_deref(), Some("this is the first step"));
    }

    #[test]
    fn arrows_choose_an_answer_and_enter_gives_it() {
        let mut app = on_screen();
        app.begin_lesson(1);
        let knob = app.selected().map(|knob| knob.path);
        for action in [Action::KnobBelow, Action::KnobAbove, Action::KnobBelow, Action::Accept] {
            app.act(action);
        }
        assert_eq!(app.lesson_step().unwrap().1.answer, Some(1));
        assert_eq!(app.selected().map(|knob| knob.path), knob);
    }

    #[test]
    fn a_lesson_that_is_left_gives_the_own_scene_back_and_one_that_ends_says_so() {
        let mut app = on_screen();
        let mut own = app.scene.clone().into_scene();
        own.operation.speed_rad_s = 333.0;
        app.set_scene(own.checked().unwrap(), false);
        let before = app.scene.clone();
        for steps in [1, lessons::all()[5].steps.len()] {
            app.begin_lesson(5);
            assert_ne!(app.scene, before);
            for _ in 0..steps {
                app.answer(0);
                app.lesson_key();
            }
            if app.lessons.is_open() {
                app.leave_lesson();
            } else {
                assert!(app.status.as_ref().is_some_and(|status| status.contains("end of the")));
            }
            assert_eq!(app.scene, before);
        }
        app.lesson_back();
        assert_eq!(app.status.as_deref(), Some("no lesson is open"));
    }

    #[test]
    fn a_condition_of_a_task_is_that_of_the_screen() {
        let app = on_screen();
        let speed = || "operation.speed_rad_s".to_string();
        for (condition, met) in [
            (Condition::View("response".into()), app.is_large(ViewId::Response)),
            (Condition::Compare(false), true),
            (Condition::Above(speed(), 499.0), true),
            (Condition::Above(speed(), 500.0), false),
            (Condition::Below(speed(), 501.0), true),
            (Condition::Is("solver.contact".into(), "bilateral".into()), true),
            (Condition::Is("solver.contact".into(), "smooth".into()), false),
            (Condition::Verdict("locked".into()), false),
        ] {
            assert_eq!(app.meets(&condition), met, "{condition:?}");
        }
    }
}
