//! What undo, and the end of a lesson, come back to: a scene, and if another one
//! was opened since, also where it is from and how it was shown.

use super::play::Tempo;
use super::{App, LessonProgress, Source};
use crate::scene::CheckedScene;
use crate::tui::views::ViewId;

/// A state to come back to.
#[derive(Clone, Debug, PartialEq)]
pub struct Past {
    scene: CheckedScene,
    opened: CheckedScene,
    source: Option<Source>,
    views: Vec<ViewId>,
    pub(super) tempo: Tempo,
    pub(super) live: bool,
    pub(super) compare: bool,
    lesson: Option<LessonProgress>,
}

impl App {
    /// The present state, to come back to.
    pub(super) fn past(&self) -> Past {
        Past {
            scene: self.scene.clone(),
            opened: self.files.opened().clone(),
            source: self.files.source().cloned(),
            views: self.layout.views().to_vec(),
            tempo: self.play.tempo(),
            live: self.knobs.is_live(),
            compare: self.run.is_compared(),
            lesson: self.lessons.progress().cloned(),
        }
    }

    /// Undoes the last change of the scene, or redoes the last that was undone.
    pub(super) fn step_back(&mut self, redo: bool) {
        match self.knobs.step_back(redo, self.past()) {
            Some(past) => self.come_back(past),
            None => {
                let word = if redo { "redo" } else { "undo" };
                self.status = Some(format!("nothing to {word}"));
            }
        }
    }

    /// Gives the user's own state back, as it was before a lesson.
    pub(super) fn give_back(&mut self, own: Past) {
        self.knobs.remember(self.past());
        self.play.set_tempo(own.tempo);
        self.come_back(own);
    }

    /// Makes a state the present one. If only knobs were turned since, their
    /// turning may act on the running motion; another scene begins anew.
    pub(super) fn come_back(&mut self, past: Past) {
        self.knobs.forget_refusal();
        let step = |lesson: Option<&LessonProgress>| {
            lesson.map(|now| (now.lesson, now.step, now.now().answer))
        };
        let same_step = step(past.lesson.as_ref()) == step(self.lessons.progress());
        let same_file = past.source.as_ref() == self.files.source();
        if past.opened == *self.files.opened() && same_file && same_step {
            self.set_turned_scene(past.scene);
            return;
        }
        self.files.reopen(past.opened, past.source);
        self.lessons.set_progress(past.lesson);
        if self.lessons.is_open() {
            self.present(false);
        }
        self.knobs.set_live(past.live);
        if self.layout.set_views(past.views) {
            self.keep_instant();
        }
        self.run.set_compare(past.compare);
        if past.scene != self.scene {
            self.set_scene(past.scene, false);
        }
    }
}
