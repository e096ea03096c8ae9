//! The knobs, and what can be undone. A value is checked first and refused at its knob.
//! Undo, and the end of a lesson, come back to a scene, and if another one was opened since,
//! also to where it is from and how it was shown.

use super::play::Tempo;
use super::{App, LessonProgress, Source, Sweep};
use crate::motion::Change;
use crate::report::line::clean;
use crate::scene::{CheckedScene, SceneError, Value};
use crate::tui::knobs::{KNOBS, Knob, place_of};
use crate::tui::views::ViewId;

/// The knobs, and what can be undone.
#[derive(Clone, Debug, Default)]
pub struct Knobs {
    /// The selected one.
    pub selected: usize,
    /// The reason if its last value was refused.
    pub refusal: Option<String>,
    /// Whether they act on the running motion.
    pub live: bool,
    /// The sweep of one that is under way.
    pub sweep: Option<Sweep>,
    undo: Vec<Past>,
    redo: Vec<Past>,
}

/// Number of changes that can be undone.
const KEPT: usize = 1000;

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

impl Knobs {
    /// Selects the one at a place of the table.
    pub(super) fn select(&mut self, place: usize) {
        (self.selected, self.refusal) = (place, None);
    }

    /// Selects the one above or below.
    pub(super) fn walk(&mut self, up: bool) {
        let count = KNOBS.len();
        let next = if up { self.selected + count - 1 } else { self.selected + 1 };
        self.select(next % count);
    }

    /// The last value of a knob was refused.
    pub(super) fn refuse(&mut self, knob: &Knob, error: &SceneError) {
        self.refusal = Some(clean(&knob.refusal(error)));
    }

    /// A refusal is not shown any more.
    pub(super) fn forget_refusal(&mut self) {
        self.refusal = None;
    }

    /// Why the last value was refused.
    pub(super) fn refusal(&self) -> Option<&String> {
        self.refusal.as_ref()
    }

    /// Whether they act on the running motion.
    pub(super) fn is_live(&self) -> bool {
        self.live
    }

    /// They act on the running motion, or no longer.
    pub(super) fn set_live(&mut self, live: bool) {
        self.live = live;
    }

    /// The same by its key; what to say.
    pub(super) fn turn_live(&mut self) -> String {
        self.live = !self.live;
        let how = match self.live {
            true => "live: knobs act on the running motion",
            false => "a knob restarts the run",
        };
        how.into()
    }

    /// Has undo come back to this state.
    pub(super) fn remember(&mut self, past: Past) {
        self.undo.push(past);
        if self.undo.len() > KEPT {
            self.undo.remove(0);
        }
        self.redo.clear();
    }

    /// Number of states that undo can come back to.
    pub(super) fn remembered(&self) -> usize {
        self.undo.len()
    }

    /// Undo comes back to the first so many states only.
    pub(super) fn merge(&mut self, known: usize) {
        self.undo.truncate(known);
    }

    /// The state before, or after, this one; none where there is no such state.
    pub(super) fn step_back(&mut self, redo: bool, now: Past) -> Option<Past> {
        let Self { undo, redo: redone, .. } = self;
        let (from, to) = if redo { (redone, undo) } else { (undo, redone) };
        let past = from.pop()?;
        to.push(now);
        Some(past)
    }
}

impl App {
    /// The selected knob.
    pub fn selected(&self) -> Option<&'static Knob> {
        KNOBS.get(self.knobs.selected)
    }

    /// Selects the knob of a key; false if there is none.
    pub fn select_path(&mut self, path: &str) -> bool {
        let place = place_of(path);
        if let Some(place) = place {
            self.knobs.select(place);
        }
        place.is_some()
    }

    pub(super) fn turn(&mut self, up: bool, coarse: bool) {
        if let Some(knob) = self.selected() {
            let value = knob.turned(&knob.get(&self.scene), up, coarse, &self.scene);
            self.set(knob, value);
        }
    }

    pub(super) fn reset(&mut self) {
        if let Some(knob) = self.selected() {
            self.set(knob, knob.get(self.files.opened()));
        }
    }

    /// Accepts the typed text; after a refusal it can be corrected.
    pub(super) fn accept(&mut self, text: &str) {
        let Some(knob) = self.selected() else { return };
        match knob.parse(text) {
            Ok(value) => {
                if self.set(knob, value) {
                    self.dialogue.close();
                }
            }
            Err(error) => self.knobs.refuse(knob, &error),
        }
    }

    /// Makes a scene that differs in knobs the current one; it can be undone.
    pub(super) fn turn_to(&mut self, scene: CheckedScene) {
        if scene != self.scene {
            self.knobs.remember(self.past());
            self.set_turned_scene(scene);
        }
    }

    /// Sets a knob; false where the value was refused.
    pub(super) fn set(&mut self, knob: &'static Knob, value: Value) -> bool {
        match knob.set(&self.scene, value) {
            Ok((scene, said)) => {
                self.knobs.refusal = None;
                if said.is_some() {
                    self.status = said;
                }
                self.turn_to(scene);
                true
            }
            Err(error) => {
                self.knobs.refuse(knob, &error);
                false
            }
        }
    }

    /// Uses the scene after a turn of a knob: live, if this is enabled and possible.
    pub(super) fn set_turned_scene(&mut self, scene: CheckedScene) {
        let failed = self.failure().is_some();
        let live = self.knobs.live && !failed && Change::acts_live(&self.scene, &scene);
        if self.knobs.live && !live && self.status.is_none() {
            self.status = Some("this cannot act on a running motion: restarted".into());
        }
        self.set_scene(scene, live);
    }

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
    /// turning may act on the running motion; another scene starts from t = 0.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::tui::{Marker, Theme};

    #[test]
    fn undo_and_redo_come_back_and_a_new_change_forgets_what_was_undone() {
        let app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Ascii);
        let (past, mut knobs) = (app.past(), Knobs::default());
        assert!(knobs.step_back(false, past.clone()).is_none());
        let lively = Past { live: true, ..past.clone() };
        (0..3).for_each(|_| knobs.remember(lively.clone()));
        knobs.merge(1);
        assert_eq!(knobs.step_back(false, past.clone()), Some(lively.clone()));
        assert_eq!((knobs.remembered(), knobs.step_back(true, lively)), (0, Some(past.clone())));
        knobs.step_back(false, past.clone());
        knobs.remember(past.clone());
        assert!(knobs.step_back(true, past).is_none());
    }

    #[test]
    fn the_knobs_go_round_and_another_one_has_no_refusal() {
        let mut knobs = Knobs::default();
        knobs.refuse(&KNOBS[1], &Scene::base().set("operation.pulse_n", "x").unwrap_err());
        assert!(knobs.refusal().is_some());
        knobs.walk(true);
        assert_eq!((knobs.selected, knobs.refusal()), (KNOBS.len() - 1, None));
        knobs.walk(false);
        assert_eq!(knobs.selected, 0);
    }
}
