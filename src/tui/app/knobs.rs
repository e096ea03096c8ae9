//! The selected knob, and undo. A value that the scene's check refuses is shown at its knob and
//! changes nothing. Undo restores the scene; if another scene was opened since, it also restores
//! that scene's source and view.

use crate::report::line::clean;
use crate::tui::app::play::Tempo;
use crate::tui::app::{App, LessonProgress, Source};
use crate::tui::knobs::{KNOBS, Knob, place_of};
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::{CheckedScene, SceneError};

#[derive(Clone, Debug, Default)]
pub struct Knobs {
    /// Index in `KNOBS`.
    pub selected: usize,
    /// Why the last value typed or turned was refused.
    pub refusal: Option<String>,
    /// Whether knobs act on the running motion instead of restarting it.
    pub live: bool,
    /// Further presses of the same key already waiting; they are applied together.
    pub again: usize,
    undo: Vec<Past>,
    redo: Vec<Past>,
}

/// Number of changes that can be undone.
const KEPT: usize = 1000;

#[derive(Clone, Debug, PartialEq)]
pub struct Past {
    pub scene: CheckedScene,
    pub opened: CheckedScene,
    pub source: Option<Source>,
    pub views: Vec<ViewId>,
    pub tempo: Tempo,
    pub live: bool,
    pub compare: bool,
    pub lesson: Option<LessonProgress>,
}

impl Knobs {
    /// Selects the knob at index `place` of `KNOBS`.
    pub fn select(&mut self, place: usize) {
        (self.selected, self.refusal) = (place, None);
    }

    /// Selects the knob above or below, cyclically.
    pub fn walk(&mut self, up: bool) {
        let count = KNOBS.len();
        let next = if up { self.selected + count - 1 } else { self.selected + 1 };
        self.select(next % count);
    }

    pub fn refuse(&mut self, knob: &Knob, error: &SceneError) {
        self.refusal = Some(clean(&knob.refusal(error)));
    }

    /// Switches live mode; returns the status message.
    pub fn turn_live(&mut self) -> String {
        self.live = !self.live;
        let how = match self.live {
            true => "live: knobs act on the running motion",
            false => "a knob restarts the run",
        };
        how.into()
    }

    /// Pushes a state for undo and clears redo.
    pub fn remember(&mut self, past: Past) {
        self.undo.push(past);
        if self.undo.len() > KEPT {
            self.undo.remove(0);
        }
        self.redo.clear();
    }

    /// Returns the state before, or after, this one, and records this one; `None` where there is no
    /// such state.
    pub fn step_back(&mut self, redo: bool, now: Past) -> Option<Past> {
        let Self { undo, redo: redone, .. } = self;
        let (from, to) = if redo { (redone, undo) } else { (undo, redone) };
        let past = from.pop()?;
        to.push(now);
        Some(past)
    }
}

impl App {
    /// Returns the selected knob.
    pub fn selected(&self) -> Option<&'static Knob> {
        KNOBS.get(self.knobs.selected)
    }

    /// Selects the knob of a scene key; false if the key has no knob.
    pub fn select_path(&mut self, path: &str) -> bool {
        let place = place_of(path);
        if let Some(place) = place {
            self.knobs.select(place);
        }
        place.is_some()
    }

    /// Captures the state that undo restores.
    pub fn past(&self) -> Past {
        Past {
            scene: self.scene.clone(),
            opened: self.files.opened.clone(),
            source: self.files.source.clone(),
            views: self.layout.views().to_vec(),
            tempo: self.play.tempo(),
            live: self.knobs.live,
            compare: self.run.compare,
            lesson: self.lessons.progress.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::{Marker, Theme};
    use rubscope_solver::scene::Scene;

    #[test]
    fn undo_and_redo_come_back_and_a_new_change_forgets_what_was_undone() {
        let app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Ascii);
        let (past, mut knobs) = (app.past(), Knobs::default());
        assert!(knobs.step_back(false, past.clone()).is_none());
        let lively = Past { live: true, ..past.clone() };
        knobs.remember(lively.clone());
        assert_eq!(knobs.step_back(false, past.clone()), Some(lively.clone()));
        assert_eq!(knobs.step_back(true, lively), Some(past.clone()));
        knobs.step_back(false, past.clone());
        knobs.remember(past.clone());
        assert!(knobs.step_back(true, past).is_none());
    }

    #[test]
    fn the_knobs_go_round_and_another_one_has_no_refusal() {
        let mut knobs = Knobs::default();
        knobs.refuse(&KNOBS[1], &Scene::base().set("operation.pulse_n", "x").unwrap_err());
        assert!(knobs.refusal.is_some());
        knobs.walk(true);
        assert_eq!((knobs.selected, knobs.refusal.clone()), (KNOBS.len() - 1, None));
        knobs.walk(false);
        assert_eq!(knobs.selected, 0);
    }
}
