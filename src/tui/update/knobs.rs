//! Turning knobs, undo and redo.

use crossterm::event::KeyEvent;

use crate::tui::app::{App, LessonProgress, Past};
use crate::tui::command::{Chord, Command, lookup};
use crate::tui::knobs::{KNOBS, Knob};
use rubscope_solver::motion::Change;
use rubscope_solver::scene::{CheckedScene, Scene, Value};

impl App {
    /// Returns whether a key turns the selected knob.
    pub fn is_turn(&self, key: &KeyEvent) -> bool {
        matches!(lookup(self.keyboard(), Chord::of(key)), Some(Command::Turn { .. }))
    }

    /// Turns the selected knob once for this press of its key and once for each further press that
    /// is waiting. It stops at the first refused value and shows the reason.
    pub(super) fn turn(&mut self, up: bool, coarse: bool) {
        let again = std::mem::take(&mut self.knobs.again);
        let Some(knob) = self.selected() else { return };
        let turned = |scene: &Scene| knob.turned(&knob.get(scene), up, coarse, scene);
        let next = |scene: &CheckedScene| Some(knob.set(scene, turned(scene)).ok()?.0);
        let all = std::iter::successors(Some(self.scene.clone()), next);
        if let Some(scene) = all.take(again + 1).last() {
            self.turn_to(scene);
        }
        self.set(knob, turned(&self.scene));
    }

    pub(super) fn reset(&mut self) {
        if let Some(knob) = self.selected() {
            self.set(knob, knob.get(&self.files.opened));
        }
    }

    /// Applies the typed text as a value. The prompt stays open if the value is refused.
    pub(super) fn take_typed(&mut self, text: &str) {
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

    /// Selects a knob and gives it a value as typed.
    ///
    /// # Errors
    /// One line that says why the value is refused.
    pub(super) fn set_typed(&mut self, place: usize, text: &str) -> Result<(), String> {
        self.knobs.select(place);
        self.take_typed(text);
        self.knobs.refusal.clone().map_or(Ok(()), Err)
    }

    /// Selects a knob. While the cursor has the arrow keys, the message says how to turn it.
    pub(super) fn select(&mut self, place: usize) {
        self.knobs.select(place);
        if let Some(knob) = self.selected().filter(|_| self.reading.on) {
            self.status = Some(format!("{} selected; i gives it the arrows", knob.label));
        }
    }

    /// Sets a knob to the value at the fraction `part` of its bar, 0 to 1.
    pub(super) fn set_part(&mut self, place: usize, part: f64) {
        let Some(knob) = KNOBS.get(place) else { return };
        self.knobs.select(place);
        let range = knob.range(&self.scene, &self.files.opened, &self.machine);
        if let Some(value) = range.and_then(|range| knob.near(range.at(part))) {
            self.set(knob, value);
        }
    }

    /// Replaces the scene by one with other knob values, as an undoable step.
    pub(super) fn turn_to(&mut self, scene: CheckedScene) {
        if scene != self.scene {
            self.knobs.remember(self.past());
            self.set_turned_scene(scene);
        }
    }

    /// Sets a knob as an undoable step; returns false if the value was refused.
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

    /// Applies a scene with other knob values: to the running motion in live mode if the change can
    /// act on it, otherwise by a restart.
    pub(super) fn set_turned_scene(&mut self, scene: CheckedScene) {
        let failed = self.failure().is_some();
        let live = self.knobs.live && !failed && Change::acts_live(&self.scene, &scene);
        if self.knobs.live && !live && self.status.is_none() {
            self.status = Some("this cannot act on a running motion: restarted".into());
        }
        self.set_scene(scene, live);
    }

    /// Undoes the last change of the scene, or redoes it.
    pub(super) fn step_back(&mut self, redo: bool) {
        match self.knobs.step_back(redo, self.past()) {
            Some(past) => self.come_back(past),
            None => {
                let word = if redo { "redo" } else { "undo" };
                self.status = Some(format!("nothing to {word}"));
            }
        }
    }

    /// Restores a state. If only knobs differ, this counts as turning them, which may act on the
    /// running motion; another scene or lesson step restarts the run.
    pub(super) fn come_back(&mut self, past: Past) {
        self.knobs.refusal = None;
        let step = |lesson: Option<&LessonProgress>| {
            lesson.map(|now| (now.lesson, now.step, now.now().answer))
        };
        let same_step = step(past.lesson.as_ref()) == step(self.lessons.progress.as_ref());
        let same_file = past.source.as_ref() == self.files.source.as_ref();
        if past.opened == self.files.opened && same_file && same_step {
            self.set_turned_scene(past.scene);
            return;
        }
        (self.files.opened, self.files.source) = (past.opened, past.source);
        self.lessons.progress = past.lesson;
        self.knobs.live = past.live;
        (self.play.rate, self.play.zoom) = (past.tempo.rate, past.tempo.zoom);
        self.play.slow_at_events = past.tempo.slow_at_events;
        if self.layout.set_views(past.views) {
            self.keep_instant();
        }
        self.run.set_compare(past.compare);
        if past.scene != self.scene {
            self.set_scene(past.scene, false);
        }
    }
}
