//! The selected knob, turning it, and undo. A value that the scene's check refuses is shown at its
//! knob and changes nothing. Undo restores the scene; if another scene was opened since, it also
//! restores that scene's source and view.

pub mod panel;
pub mod strip;

use super::model::{App, Knobs, LessonProgress, Past};
use crate::sheet::line::clean;
use crate::sheet::number::rounded;
use crate::tui::engine::Move;
use crate::tui::knobs::{KNOBS, Knob, KnobRange};
use rubscope_solver::motion::Change;
use rubscope_solver::scene::{CheckedScene, Scene, SceneError, SolverKind, Value};

/// Number of changes that can be undone.
const KEPT: usize = 1000;

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

    /// Pushes a state for undo and clears redo.
    pub fn remember(&mut self, past: Past) {
        self.undo.push(past);
        if self.undo.len() > KEPT {
            self.undo.remove(0);
        }
        self.redo.clear();
    }
}

impl App {
    /// Returns the selected knob.
    pub fn selected(&self) -> Option<&'static Knob> {
        KNOBS.get(self.knobs.selected)
    }

    /// Returns the range of a knob's bar with its marks; `None` if the knob has no bar. It follows
    /// from the opened scene and the machine, and hardly from the present value except for its sign,
    /// so that the scale stays put while the knob turns. It is computed once for a scene: limits
    /// that are searched take milliseconds, and several parts of each frame need it.
    pub fn range(&self, knob: &Knob) -> Option<KnobRange> {
        let opened = knob.number(&self.files.opened)?;
        let range = || knob.range(opened, &self.scene, &self.machine);
        self.ranges.borrow_mut().entry((knob.path, opened.to_bits())).or_insert_with(range).clone()
    }

    /// Captures the state that undo restores.
    pub fn past(&self) -> Past {
        Past {
            scene: self.scene.clone(),
            film: self.run.film.clone(),
            at_s: self.now(),
            playing: self.play.playing,
            opened: self.files.opened.clone(),
            source: self.files.source.clone(),
            views: self.layout.views.clone(),
            tempo: self.play.tempo,
            live: self.knobs.live,
            compare: self.run.compare,
            lesson: self.lessons.progress.clone(),
        }
    }

    /// Turns the selected knob once for this press of its key and once for each further press that
    /// is waiting. It stops at the first refused value and shows the reason.
    pub fn turn(&mut self, up: bool, coarse: bool) {
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

    /// Gives the selected knob its value in the opened scene.
    pub fn reset(&mut self) {
        if let Some(knob) = self.selected() {
            self.set(knob, knob.get(&self.files.opened));
        }
    }

    /// Applies the typed text as a value. The prompt stays open if the value is refused.
    pub fn take_typed(&mut self, text: &str) {
        let Some(knob) = self.selected() else { return };
        match self.parse(knob, text) {
            Ok(value) => {
                if self.set(knob, value) {
                    self.dialogue.close();
                }
            }
            Err(error) => self.knobs.refuse(knob, &error),
        }
    }

    /// Parses the text of a knob's value. A share of a tip's length or of a shape's height is one of
    /// the clearance.
    ///
    /// # Errors
    /// The text is refused, for this reason.
    pub fn parse(&self, knob: &Knob, text: &str) -> Result<Value, SceneError> {
        let share = text.trim().strip_suffix('%').filter(|_| knob.is_of_clearance());
        let share = share.and_then(|share| share.trim().parse::<f64>().ok());
        let length = |share| rounded(0.01 * share * self.machine.clearance(), 9);
        let length = share.filter(|share| share.is_finite()).map(length);
        length.map_or_else(|| knob.parse(text), |length| Ok(Value::Real(length)))
    }

    /// Selects a knob. While the cursor has the arrow keys, the message says how to turn it.
    pub fn select(&mut self, place: usize) {
        self.knobs.select(place);
        if let Some(knob) = self.selected().filter(|_| self.reading.on) {
            self.status = Some(format!("{} selected; i gives it the arrows", knob.label));
        }
    }

    /// Sets a knob to the value at the fraction `part` of its bar, 0 to 1.
    pub fn set_part(&mut self, place: usize, part: f64) {
        let Some(knob) = KNOBS.get(place) else { return };
        self.knobs.select(place);
        if let Some(value) = self.range(knob).and_then(|range| knob.near(range.at(part))) {
            self.set(knob, value);
        }
    }

    /// Replaces the scene by one with other knob values, as an undoable step.
    pub fn turn_to(&mut self, scene: CheckedScene) {
        if scene != self.scene {
            self.knobs.remember(self.past());
            self.set_turned_scene(scene);
        }
    }

    /// Sets a knob as an undoable step; returns false if the value was refused.
    pub fn set(&mut self, knob: &'static Knob, value: Value) -> bool {
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

    /// Restarts the run so that it takes every step one by one, or again skips those whose result is
    /// known.
    ///
    /// # Errors
    /// The event solver takes no steps.
    pub fn turn_plain(&mut self) -> Result<(), String> {
        if self.scene.solver.kind == SolverKind::Event {
            return Err("the event solver has no steps: nothing is skipped".into());
        }
        let mut scene = self.scene.clone().into_scene();
        scene.solver.plain = !scene.solver.plain;
        let how =
            if scene.solver.plain { "every step is taken" } else { "steps are skipped again" };
        self.turn_to(scene.checked().map_err(|error| error.to_string())?);
        self.status = Some(how.into());
        Ok(())
    }

    /// Applies a scene with other knob values: to the running motion in live mode if the change can
    /// act on it, otherwise by a restart.
    pub fn set_turned_scene(&mut self, scene: CheckedScene) {
        let can_act = self.failure().is_none() && self.run.film.has_room(self.now());
        let live = self.knobs.live && can_act && Change::acts_live(&self.scene, &scene);
        if self.knobs.live && !live && self.status.is_none() {
            self.status = Some("this change needs a new run: restarted".into());
        }
        self.set_scene(scene, live);
    }

    /// Undoes the last change of the scene, or redoes it.
    pub fn step_back(&mut self, redo: bool) {
        let now = self.past();
        let Knobs { undo, redo: undone, .. } = &mut self.knobs;
        let (from, to) = if redo { (undone, undo) } else { (undo, undone) };
        match from.pop() {
            Some(past) => {
                to.push(now);
                self.come_back(past);
            }
            None => {
                let word = if redo { "redo" } else { "undo" };
                self.status = Some(format!("nothing to {word}"));
            }
        }
    }

    /// Restores a state with its film. If only live changes differ, the motion goes on without those
    /// that are undone; another scene of the film restarts the run. Another lesson step goes on at
    /// the time that was shown.
    pub fn come_back(&mut self, past: Past) {
        self.knobs.refusal = None;
        let step = |lesson: Option<&LessonProgress>| {
            lesson.map(|now| (now.lesson, now.step, now.now().answer))
        };
        let same_step = step(past.lesson.as_ref()) == step(self.lessons.progress.as_ref());
        let same_file = past.source.as_ref() == self.files.source.as_ref();
        let is_here = past.opened == self.files.opened && same_file && same_step;
        if !is_here {
            (self.files.opened, self.files.source) = (past.opened, past.source);
            self.lessons.progress = past.lesson;
            self.knobs.live = past.live;
            self.play.tempo = past.tempo;
            let view = self.view();
            self.layout.views = past.views;
            if self.view() != view {
                self.keep_instant();
            }
            self.run.set_compare(past.compare);
        }
        if !is_here || past.film.scene != self.run.film.scene {
            self.set_scene(past.scene.clone(), false);
        }
        if !is_here {
            self.play.playing = past.playing;
            self.play.moves.push(Move::To(past.at_s));
        }
        self.show_film(past.film, past.scene);
    }
}

#[cfg(test)]
mod tests {
    use crate::tui::command::Command;

    #[test]
    fn undo_and_redo_come_back_and_a_new_change_forgets_what_was_undone() {
        let mut app = crate::tui::app::tests::on_screen();
        let mut speeds = Vec::new();
        let set = |speed: &str| Command::Set(0, speed.into());
        let (undo, redo) = (Command::Undo, Command::Redo);
        for command in [set("450"), undo.clone(), redo.clone(), undo, set("430"), redo] {
            app.update(command).unwrap();
            speeds.push(app.scene.operation.speed_rad_s);
        }
        assert_eq!(speeds, [450.0, 500.0, 450.0, 500.0, 430.0, 430.0]);
        assert_eq!(app.status.as_deref(), Some("nothing to redo"));
    }

    #[test]
    fn every_step_is_taken_until_asked_again_and_the_event_solver_has_none() {
        let mut app = crate::tui::app::tests::on_screen();
        app.turn_plain().unwrap();
        assert!(app.run.film.scene.solver.plain && !app.files.is_changed(&app.scene));
        assert_eq!(app.command_line().to_string(), "rubscope run paper-nd3 --plain");
        app.turn_plain().unwrap();
        assert!(!app.run.film.scene.solver.plain);
        app.update(Command::Undo).unwrap();
        assert!(app.scene.solver.plain);
        let event = app.scene.clone().into_scene();
        let event = event.with(&[("solver.contact", "unilateral"), ("solver.kind", "event")]);
        app.set_scene(event.unwrap(), false);
        assert!(app.turn_plain().unwrap_err().contains("has no steps"));
    }
}
