//! What undo, and the end of a lesson, come back to: a scene, and if another one
//! was opened since, also where it is from and how it was shown.

use super::{App, LessonProgress, Source};
use crate::scene::CheckedScene;
use crate::tui::views::ViewId;

/// Number of changes that can be undone.
const KEPT: usize = 1000;

/// A state to come back to.
#[derive(Clone, Debug, PartialEq)]
pub struct Past {
    scene: CheckedScene,
    opened: CheckedScene,
    source: Option<Source>,
    view: ViewId,
    companions: Vec<ViewId>,
    rate: usize,
    zoom: i32,
    pub(super) slow_at_events: bool,
    pub(super) live: bool,
    pub(super) compare: bool,
    lesson: Option<LessonProgress>,
}

impl App {
    /// The present state, to come back to.
    pub(super) fn past(&self) -> Past {
        Past {
            scene: self.scene.clone(),
            opened: self.opened.clone(),
            source: self.source.clone(),
            view: self.view,
            companions: self.companions.clone(),
            rate: self.rate,
            zoom: self.zoom,
            slow_at_events: self.slow_at_events,
            live: self.live,
            compare: self.compare,
            lesson: self.lesson.clone(),
        }
    }

    /// Has undo come back to this state.
    pub(super) fn remember(&mut self, past: Past) {
        self.undo.push(past);
        if self.undo.len() > KEPT {
            self.undo.remove(0);
        }
        self.redo.clear();
    }

    /// Undoes the last change of the scene, or redoes the last that was undone.
    pub(super) fn step_back(&mut self, redo: bool) {
        let (from, word) = if redo { (&mut self.redo, "redo") } else { (&mut self.undo, "undo") };
        let Some(past) = from.pop() else {
            self.status = Some(format!("nothing to {word}"));
            return;
        };
        let now = self.past();
        if redo {
            self.undo.push(now)
        } else {
            self.redo.push(now)
        }
        self.come_back(past);
    }

    /// Gives the user's own state back, as it was before a lesson.
    pub(super) fn give_back(&mut self, own: Past) {
        self.remember(self.past());
        (self.rate, self.zoom, self.slow_at_events) = (own.rate, own.zoom, own.slow_at_events);
        self.come_back(own);
    }

    /// Makes a state the present one. If only knobs were turned since, their
    /// turning may act on the running motion; another scene begins anew.
    pub(super) fn come_back(&mut self, past: Past) {
        self.refusal = None;
        let step = |lesson: &Option<LessonProgress>| {
            lesson.as_ref().map(|now| (now.lesson, now.step, now.now().answer))
        };
        let same_step = step(&past.lesson) == step(&self.lesson);
        if past.opened == self.opened && past.source == self.source && same_step {
            self.set_turned_scene(past.scene);
            return;
        }
        (self.opened, self.source, self.lesson) = (past.opened, past.source, past.lesson);
        if self.lesson.is_some() {
            self.present(false);
        }
        let same_view = self.view == past.view;
        (self.view, self.companions, self.live) = (past.view, past.companions, past.live);
        if !same_view {
            self.keep_instant();
        }
        self.set_compare(past.compare);
        if past.scene != self.scene {
            self.set_scene(past.scene, false);
        }
    }

    /// Compares the other contact law, or no longer.
    pub(super) fn set_compare(&mut self, compare: bool) {
        if compare != self.compare {
            self.compare = compare;
            let results = &mut self.latest.results;
            (results.comparison, results.comparison_page) = (None, None);
            self.comparison_history.clear();
        }
    }
}
