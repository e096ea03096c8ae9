//! The current lesson: its step, and whether its task is done.

use super::{App, InputMode, Source};
use crate::scene::{Scene, Value, keys};
use crate::tui::lessons::{self, Condition, Lesson};
use crate::tui::panels;
use crate::tui::views::ViewId;

/// The progress of a lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct LessonProgress {
    /// Which lesson.
    pub lesson: usize,
    /// Which step, from 0.
    pub step: usize,
    /// The task of the step is done.
    pub done: bool,
    /// Its text has been read, if it hides the charts.
    pub read: bool,
}

impl App {
    /// The current lesson.
    pub fn current_lesson(&self) -> Option<(&'static Lesson, &LessonProgress)> {
        let progress = self.lesson.as_ref()?;
        Some((lessons::all().get(progress.lesson)?, progress))
    }

    /// The key of the lessons: the list, or the next step.
    pub(super) fn lesson_key(&mut self) {
        let Some((lesson, progress)) = self.current_lesson() else {
            self.mode = InputMode::Lessons(0);
            return;
        };
        if !progress.read && panels::lesson_fills(self) {
            if let Some(progress) = &mut self.lesson {
                progress.read = true;
            }
            return;
        }
        let (steps, title) = (lesson.steps.len(), lesson.title.clone());
        if progress.step + 1 >= steps {
            self.lesson = None;
            self.status = Some(format!("end of the lesson: {title}"));
        } else {
            self.begin_step(progress.lesson, progress.step + 1);
        }
    }

    /// Starts a lesson with its own scene.
    pub(super) fn begin_lesson(&mut self, place: usize) {
        self.mode = InputMode::Main;
        let Some(lesson) = lessons::all().get(place) else { return };
        match Scene::builtin(&lesson.scene).and_then(|scene| scene.checked()) {
            Ok(scene) => {
                self.opened = scene.clone();
                let read = scene.clone().into_scene();
                self.source = Some(Source { name: lesson.scene.clone(), scene: read });
                self.set_scene(scene, false);
                self.begin_step(place, 0);
            }
            Err(error) => self.status = Some(error.to_string()),
        }
    }

    /// Sets knobs and view for a step.
    fn begin_step(&mut self, lesson: usize, step: usize) {
        self.lesson = Some(LessonProgress { lesson, step, done: false, read: false });
        let Some(found) = lessons::all().get(lesson).and_then(|l| l.steps.get(step)) else {
            return;
        };
        let mut scene = self.scene.clone().into_scene();
        for (path, value) in &found.set {
            if let Err(error) = scene.set(path, value) {
                self.status = Some(error.to_string());
            }
        }
        if scene != *self.scene
            && let Ok(scene) = scene.checked()
        {
            self.set_scene(scene, false);
        }
        if let Some(view) = found.view.as_deref().and_then(ViewId::from_word) {
            self.show(view);
        }
        if let Some(live) = found.live {
            self.live = live;
        }
    }

    /// Records when the task of the step is done.
    pub fn check_lesson(&mut self) {
        let Some((lesson, progress)) = self.current_lesson() else { return };
        if progress.done {
            return;
        }
        let Some(step) = lesson.steps.get(progress.step) else { return };
        let done = step.until.as_ref().is_none_or(|condition| self.meets(condition));
        if let Some(progress) = &mut self.lesson {
            progress.done = done;
        }
    }

    fn meets(&self, condition: &Condition) -> bool {
        match condition {
            Condition::Verdict(word) => {
                let now = self.full_run().map(|run| run.verdict);
                now.is_some() && now == word.parse().ok()
            }
            Condition::View(word) => ViewId::from_word(word) == Some(self.view),
            Condition::Compare(wanted) => self.compare == *wanted,
            Condition::Above(path, limit) => self.number(path).is_some_and(|x| x > *limit),
            Condition::Below(path, limit) => self.number(path).is_some_and(|x| x < *limit),
            Condition::Is(path, word) => {
                let key = keys::find(path).ok();
                key.is_some_and(|key| (key.get)(&self.scene) == Value::Text(word.clone()))
            }
        }
    }

    fn number(&self, path: &str) -> Option<f64> {
        match (keys::find(path).ok()?.get)(&self.scene) {
            Value::Real(x) => Some(x),
            Value::Whole(n) => Some(n as f64),
            Value::Text(_) | Value::Words(_) => None,
        }
    }
}
