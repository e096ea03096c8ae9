//! Progress in the lessons: the current step, its answer, and whether its task is done.

use std::sync::Arc;

use super::{App, Past};
use crate::tui::knobs::knob_of;
use crate::tui::lessons::{self, Condition, Lesson, LessonStep, LessonsDone};
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::Value;

/// Progress in the current lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct LessonProgress {
    /// Index of the lesson.
    pub lesson: usize,
    /// Index of the current step.
    pub step: usize,
    /// Answer and task of every step.
    pub steps: Vec<StepProgress>,
    /// The place of the answer that Enter gives.
    pub choice: usize,
    /// State before the lesson, restored when it ends.
    pub own: Arc<Past>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepProgress {
    /// Index of the answer given.
    pub answer: Option<usize>,
    /// Whether the step is complete.
    pub done: bool,
}

impl LessonProgress {
    pub fn now(&self) -> StepProgress {
        self.steps.get(self.step).copied().unwrap_or_default()
    }

    pub fn now_mut(&mut self) -> Option<&mut StepProgress> {
        self.steps.get_mut(self.step)
    }
}

#[derive(Clone, Debug, Default)]
pub struct Lessons {
    /// Progress in the current lesson, if one is open.
    pub progress: Option<LessonProgress>,
    /// All steps completed so far, in any session.
    pub done: LessonsDone,
}

impl App {
    /// Returns the open lesson and its progress.
    pub fn current_lesson(&self) -> Option<(&'static Lesson, &LessonProgress)> {
        let progress = self.lessons.progress.as_ref()?;
        Some((lessons::all().get(progress.lesson)?, progress))
    }

    /// Returns the current step and its progress.
    pub fn lesson_step(&self) -> Option<(&'static LessonStep, StepProgress)> {
        let (lesson, progress) = self.current_lesson()?;
        Some((lesson.steps.get(progress.step)?, progress.now()))
    }

    /// Returns whether the current step has an unanswered question.
    pub fn is_asked(&self) -> bool {
        let step = self.lesson_step();
        step.is_some_and(|(step, now)| step.question.is_some() && now.answer.is_none())
    }

    /// Marks the current step as done once its question is answered and its task's condition is
    /// met.
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

    /// Returns whether the state satisfies a task's condition.
    pub fn meets(&self, condition: &Condition) -> bool {
        let number = |path: &str| knob_of(path)?.number(&self.scene);
        match condition {
            Condition::Verdict(word) => {
                let now = self.full_run().map(|run| run.verdict);
                now.is_some() && now == word.parse().ok()
            }
            Condition::View(word) => ViewId::from_word(word) == Some(self.view()),
            Condition::Compare(wanted) => self.run.compare == *wanted,
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
