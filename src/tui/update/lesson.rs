//! Going through a lesson: steps and answers.

use std::sync::Arc;

use crate::tui::app::{App, InputMode, LessonProgress, Past, Source, StepProgress};
use crate::tui::knobs::place_of;
use crate::tui::lessons::{self, LETTERS};
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::Scene;

impl App {
    /// Opens the list of lessons, or goes to the next step.
    pub(super) fn guide(&mut self) {
        let Some((lesson, progress)) = self.current_lesson() else {
            let done = &self.lessons.done;
            let next = lessons::all().iter().position(|lesson| done.next(lesson).is_some());
            self.dialogue.open(InputMode::Lessons(next.unwrap_or(0)));
            return;
        };
        let (number, step) = (progress.lesson, progress.step);
        if self.is_asked() {
            self.status = Some("first your guess: ↑ ↓ choose it, Enter answers".into());
        } else if step + 1 < lesson.steps.len() {
            self.begin_step(number, step + 1);
        } else {
            self.leave_lesson();
            self.status = Some("end of the lesson; your scene is back".into());
        }
    }

    /// Goes back one step.
    pub(super) fn lesson_back(&mut self) {
        match self.lessons.progress.as_ref().map(|progress| (progress.lesson, progress.step)) {
            None => self.status = Some("no lesson is open".into()),
            Some((_, 0)) => self.status = Some("this is the first step".into()),
            Some((lesson, step)) => self.begin_step(lesson, step - 1),
        }
    }

    /// Starts a lesson at its first unfinished step, with the lesson's own scene.
    pub fn begin_lesson(&mut self, place: usize) {
        self.dialogue.close();
        if let Some(lesson) = lessons::all().get(place) {
            let step = self.lessons.done.next(lesson).unwrap_or(0);
            self.begin_step(place, step);
        }
    }

    /// Closes the lesson and restores the user's scene.
    pub(super) fn leave_lesson(&mut self) {
        if let Some(own) = self.lessons.progress.as_ref().map(|progress| Arc::clone(&progress.own))
        {
            // Undo can reopen the lesson.
            self.knobs.remember(self.past());
            self.come_back(Past::clone(&own));
        }
    }

    /// Drops the lesson without restoring the scene; the modes it had changed are restored.
    pub(super) fn end_lesson(&mut self) {
        if let Some(progress) = self.lessons.progress.take() {
            self.knobs.live = progress.own.live;
            self.play.slow_at_events = progress.own.tempo.slow_at_events;
            self.run.set_compare(progress.own.compare);
        }
    }

    /// Shows a step; an answer given before stays.
    fn begin_step(&mut self, place: usize, step: usize) {
        let Some(lesson) = lessons::all().get(place) else { return };
        let past = self.past();
        // A step starts playing even if the cursor had paused the run.
        self.play.playing |= self.reading.at_s.is_some();
        self.stop_reading();
        let begun = self.lessons.progress.clone().filter(|progress| progress.lesson == place);
        let begun = begun.unwrap_or_else(|| LessonProgress {
            lesson: place,
            step,
            steps: vec![StepProgress::default(); lesson.steps.len()],
            choice: 0,
            own: match &self.lessons.progress {
                Some(other) => Arc::clone(&other.own),
                None => Arc::new(past.clone()),
            },
        });
        self.lessons.progress = Some(LessonProgress { step, choice: 0, ..begun });
        let knob = lesson.steps.get(step).and_then(|found| found.knob.as_deref());
        if let Some(place) = knob.and_then(place_of) {
            self.knobs.select(place);
        }
        self.show_step(past);
    }

    /// Selects the answer above or below, cyclically.
    pub(super) fn choose_answer(&mut self, up: bool) {
        if let Some(progress) = &mut self.lessons.progress {
            let by = if up { LETTERS.len() - 1 } else { 1 };
            progress.choice = (progress.choice + by) % LETTERS.len();
        }
    }

    /// Gives the selected answer.
    pub(super) fn answer_chosen(&mut self) {
        if let Some(choice) = self.lessons.progress.as_ref().map(|progress| progress.choice) {
            self.answer(choice);
        }
    }

    /// Records an answer and runs the scene that it is about.
    pub(super) fn answer(&mut self, place: usize) {
        if !self.is_asked() {
            self.status = Some("no question is open".into());
            return;
        }
        let past = self.past();
        if let Some(now) = self.lessons.progress.as_mut().and_then(LessonProgress::now_mut) {
            now.answer = Some(place.min(LETTERS.len() - 1));
        }
        self.show_step(past);
    }

    /// Applies scene and view of the current step; undo returns to `past`.
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
        self.knobs.refusal = None;
        self.knobs.live = step.live;
        self.run.set_compare(step.compare && answered);
        self.play.show_closely(step.page_s);
        let then = step.then_view.as_ref().filter(|_| answered);
        let view = then.or(step.view.as_ref()).and_then(|word| ViewId::from_word(word));
        if let Some(view) = view {
            self.show(view);
        }
        // A chart that would reveal the answer goes last until then, and slow studies go after
        // quick ones.
        let hidden = step.then_view.as_deref().filter(|_| !answered);
        let hidden = hidden.and_then(ViewId::from_word);
        self.layout.order_beside(|view| match view {
            view if Some(view) == hidden => 2,
            ViewId::Map | ViewId::Precision | ViewId::Margins => 1,
            _ => 0,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::app::tests::on_screen;
    use crate::tui::command::Command;
    use crate::tui::lessons::Condition;

    #[test]
    fn a_step_is_done_by_its_answer_and_the_next_one_waits_for_it() {
        let mut app = on_screen();
        app.begin_lesson(1);
        let lesson = &lessons::all()[1];
        assert!(app.is_asked() && app.lessons.progress.is_some());
        app.guide();
        assert!(app.status.as_ref().is_some_and(|status| status.contains("your guess")));
        assert_eq!(app.lessons.progress.as_ref().unwrap().step, 0);
        app.answer(9);
        app.check_lesson();
        let now = app.lesson_step().unwrap().1;
        assert_eq!((now.answer, now.done), (Some(2), true));
        assert!(app.lessons.done.has(lesson, 0) && !app.lessons.done.has(lesson, 1));
        // A second answer is ignored.
        app.act(Command::Accept);
        app.answer(0);
        assert_eq!(app.lesson_step().unwrap().1.answer, Some(2));
        app.guide();
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
        for command in [Command::Below, Command::Above, Command::Below, Command::Accept] {
            app.act(command);
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
                app.guide();
            }
            if app.lessons.progress.is_some() {
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
