//! Keys and actions: each changes the state and returns its effect on the outside. There is one
//! file for each part of the state in `app`.

mod dialogue;
mod files;
mod knobs;
mod lesson;
mod map;
mod mouse;
mod reading;

use rubscope_solver::scene::keys::PULSE;
use std::path::PathBuf;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use super::app::{App, HelpState, InputMode, Purpose, Reading};
use crate::report::line::{self, clean};
use crate::tui::axis::instant;
use crate::tui::bindings::{Action, Chord, lookup};
use crate::tui::commands::Command;
use crate::tui::field::Field;
use crate::tui::files::FileJob;
use crate::tui::knobs::knob_of;
use crate::tui::views::id::ViewId;
use crate::tui::worker::other_law;

/// An effect outside the state, which the event loop carries out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Effect {
    /// No effect except a redraw.
    None,
    /// Quit the explorer.
    Quit,
    /// Suspend the job.
    Suspend,
    /// Redraw the whole screen.
    Redraw,
    /// Switch the terminal's mouse reports on or off.
    Mouse(bool),
    /// Put a text on the clipboard of the terminal.
    Copy(String),
    /// Write a file.
    Write(FileJob),
    /// Read the scenes of a directory.
    FindScenes(PathBuf),
}

/// Longest text that can be typed \[characters\].
const LONGEST_TYPED: usize = 1000;

impl App {
    /// Handles a key press: an action of the current context, or a letter for the open text field.
    pub fn key(&mut self, event: &KeyEvent) -> Effect {
        self.files.disturb();
        self.dialogue.is_new = false;
        if event.modifiers.contains(KeyModifiers::ALT) && event.code != KeyCode::Esc {
            // Escape followed quickly by a key arrives as Alt with that key.
            self.act(Action::Close);
        }
        let chord = Chord::of(event);
        if let Some(action) = lookup(self.context(), chord) {
            let before = self.dialogue.is_closed().then(|| self.seen());
            let effect = self.act(action);
            self.check_lesson();
            if self.status.is_none() && effect == Effect::None && before == Some(self.seen()) {
                self.status = Some(self.nothing(chord, action));
            }
            return effect;
        }
        let typed = match (self.dialogue.typed(), chord.code, chord.ctrl) {
            // A leading space would be invisible.
            (Some(text), KeyCode::Char(' '), false) if text.text().is_empty() => None,
            (Some(text), KeyCode::Char(letter), false) if line::harmless(letter) == letter => {
                Some(text.insert(letter.encode_utf8(&mut [0; 4]), LONGEST_TYPED))
            }
            _ => None,
        };
        if let Some(room) = typed {
            self.status = (!room).then(|| format!("no room: at most {LONGEST_TYPED} letters"));
            self.typed_on();
        } else {
            let way = match self.dialogue.is_closed() {
                true => "? lists the keys",
                false if self.dialogue.typed().is_some() => "Enter takes what is typed, Esc leaves",
                false => "Esc leaves",
            };
            self.status = Some(clean(&format!("{chord} has no meaning here; {way}")));
        }
        Effect::None
    }

    /// Updates what depends on the typed text: the refusal and the place in the list.
    fn typed_on(&mut self) {
        self.knobs.refusal = None;
        self.dialogue.look_again();
    }

    /// Returns everything visible of the state except the status line, to detect a key without
    /// effect.
    fn seen(&self) -> impl PartialEq + use<> {
        let shown = (self.order(), self.layout.clone(), self.appearance);
        let open = (self.dialogue.mode.clone(), self.lessons.progress.clone());
        let read = (self.reading.cursor, self.reading.on);
        (shown, open, read, self.selected().map(|knob| knob.path), self.knobs.refusal.clone())
    }

    /// Returns the status message for a key without effect.
    fn nothing(&self, chord: Chord, action: Action) -> String {
        match action {
            Action::Close if self.lessons.progress.is_some() => "G leaves the lesson".into(),
            Action::Close => "nothing is open; q quits".into(),
            Action::LeaveLesson => "no lesson is open; g lists them".into(),
            Action::Turn { .. } => "this knob goes no further".into(),
            _ => format!("{chord}: as it was, nothing to change here"),
        }
    }

    /// Inserts a pasted text into the open text field. It never acts as keys.
    pub fn paste(&mut self, text: &str) {
        self.files.disturb();
        // A line break parts words; what comes of a last one, and control characters, are dropped.
        let text: String = text
            .trim_end()
            .replace("\r\n", "\n")
            .chars()
            .map(|letter| if letter.is_whitespace() { ' ' } else { letter })
            .filter(|&letter| line::harmless(letter) == letter)
            .collect();
        let refused = match self.dialogue.typed() {
            None => Some("the pasted text is ignored: no field is open"),
            Some(field) => (!field.insert(&text, LONGEST_TYPED))
                .then_some("the pasted text is ignored: it is too long"),
        };
        self.typed_on();
        self.status = refused.map(String::from);
    }

    /// Performs an action and returns its effect.
    pub fn act(&mut self, action: Action) -> Effect {
        self.status = None;
        self.appearance.use_speeds();
        match (self.dialogue.mode.clone(), action) {
            (_, Action::Quit) => return Effect::Quit,
            (_, Action::Suspend) => return Effect::Suspend,
            (_, Action::Redraw) => return Effect::Redraw,
            (_, Action::Theme) => {
                self.status = Some(self.appearance.use_theme(self.appearance.theme.next()));
            }
            (_, Action::SpeedUnit) => self.status = Some(self.appearance.next_speeds()),
            (InputMode::Main, Action::Marker) => {
                self.status = Some(self.appearance.next_marker());
            }
            (InputMode::Main, Action::Mouse) => {
                self.status = Some(self.mouse.toggle());
                return Effect::Mouse(self.mouse.on);
            }
            (_, action) if self.move_in_list(action) => {}
            (InputMode::Palette(palette), Action::Accept) => return self.choose_command(&palette),
            (InputMode::Naming(purpose, name), Action::Accept) => {
                return self.write(purpose, &name.text(), false);
            }
            // A key typed before the question was drawn does not answer it.
            (InputMode::Replacing(..), Action::Yes) if !self.dialogue.asked => {}
            (InputMode::Replacing(purpose, name), Action::Yes) => {
                return self.write(purpose, &name, true);
            }
            (_, Action::Edit(edit)) => self.edit(edit),
            (InputMode::Main, Action::KnobAbove) if self.is_asked() => self.choose_answer(true),
            (InputMode::Main, Action::KnobBelow) if self.is_asked() => self.choose_answer(false),
            (InputMode::Main, Action::Accept) => self.answer_chosen(),
            (InputMode::Scenes(_), Action::TurnNote) => {
                self.dialogue.note_page = self.dialogue.note_page.wrapping_add(1);
            }
            (InputMode::Lessons(_), Action::Search) => self.look_for("lesson "),
            (InputMode::Scenes(_), Action::Search) => self.look_for("scene "),
            (_, Action::Search) => {
                let searching = HelpState { searches: true, ..HelpState::default() };
                self.dialogue.open(InputMode::Help(searching));
            }
            (InputMode::Help(help), Action::Close)
                if !help.filter.text().is_empty() || help.searches =>
            {
                self.dialogue.open(InputMode::Help(HelpState::default()));
            }
            (InputMode::Lessons(place), Action::Accept) => self.begin_lesson(place),
            (InputMode::Main, Action::Scenes) => {
                self.dialogue.open(InputMode::Scenes(None));
                return self.find_scenes();
            }
            (InputMode::Main, Action::Palette) => {
                self.look_for("");
                return self.find_scenes();
            }
            (InputMode::Scenes(chosen), Action::Accept) => {
                let entries = self.scene_entries();
                if let Some(entry) = entries.get(self.scene_place(&entries, chosen)) {
                    self.open_entry(entry).unwrap_or_else(|why| self.status = Some(why));
                }
            }
            (_, Action::Copy) => return Effect::Copy(self.copied()),
            (InputMode::Typing(text), Action::Accept) => self.accept(&text.text()),
            (_, Action::Close) => self.close(),
            _ => self.act_main(action),
        }
        Effect::None
    }

    fn close(&mut self) {
        self.knobs.refusal = None;
        if !self.dialogue.is_closed() {
            self.dialogue.close();
        } else if self.reading != Reading::default() || self.play.middle_s.is_some() {
            self.stop_reading();
        } else {
            self.layout.act(Action::Close);
        }
    }

    fn act_main(&mut self, action: Action) {
        match action {
            Action::Help => self.dialogue.open(InputMode::Help(HelpState::default())),
            Action::NextView => self.walk(self.layout.neighbour(1)),
            Action::PreviousView => self.walk(self.layout.neighbour(-1)),
            Action::View(view) => self.walk(view),
            Action::KnobAbove => self.knobs.walk(true),
            Action::KnobBelow => self.knobs.walk(false),
            Action::Turn { up, coarse } => self.turn(up, coarse),
            Action::Type => {
                self.knobs.refusal = None;
                self.dialogue.open(InputMode::Typing(Field::default()));
            }
            Action::Reset => self.reset(),
            Action::Undo => self.step_back(false),
            Action::Redo => self.step_back(true),
            Action::Pause | Action::Step | Action::Jump => {
                self.depart();
                self.status = self.play.act(action);
            }
            Action::SlowAtEvents | Action::Slower | Action::Faster => {
                self.status = self.play.act(action);
            }
            Action::ZoomIn | Action::ZoomOut | Action::ZoomReset => self.zoom(action),
            Action::Charts | Action::FullScreen => self.layout.act(action),
            Action::Pin => self.pin(),
            Action::OtherLaw if self.is_large(ViewId::Map) => self.other_map_law(),
            Action::MapAxis { up } => self.look_for(if up { "up " } else { "across " }),
            Action::OtherLaw => match other_law(&self.scene) {
                Err(why) if !self.run.compare => {
                    let law = self.scene.solver.contact.other();
                    self.status = Some(clean(&format!("no {law} law beside this: {why}")));
                }
                _ => {
                    self.run.set_compare(!self.run.compare);
                    if self.run.compare {
                        self.show(ViewId::Response);
                    }
                }
            },
            Action::Save => {
                self.dialogue.open(InputMode::Naming(Purpose::Save, "scene.toml".into()));
            }
            Action::Export => {
                let name = format!("{}.csv", self.view().word());
                self.dialogue.open(InputMode::Naming(Purpose::Export, name.into()));
            }
            Action::Lesson => self.lesson_key(),
            Action::LessonBack => self.lesson_back(),
            Action::Answer(place) => self.answer(place),
            Action::LeaveLesson => self.leave_lesson(),
            Action::Survey => self.turn_survey(),
            Action::PageBack => self.pan(true),
            Action::PageForward => self.pan(false),
            Action::GoToEnd => _ = self.obey(Command::GoTo(self.end_s())),
            Action::Read => self.toggle_reading(),
            Action::Cursor { right, up, coarse } => self.move_cursor(right, up, coarse),
            Action::OpenPlace => self.open_cursor(),
            Action::Restart => {
                self.stop_reading();
                self.restart();
                self.status = Some("restarted".into());
            }
            Action::Fire => {
                // The pulse acts on the playing motion, not at the cursor.
                self.stop_reading();
                self.run.fire();
                let pulse = knob_of(PULSE).map(|knob| knob.text(&self.scene));
                let at = instant(self.now());
                self.status = pulse.map(|pulse| format!("pulse of {pulse} fired at {at}"));
            }
            Action::Autoscale => self.status = Some(self.run.autoscale()),
            Action::Live => self.status = Some(self.knobs.turn_live()),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::bindings::{Context, of};
    use crate::tui::{Marker, Theme};
    use rubscope_solver::scene::Scene;

    #[test]
    fn a_key_that_changes_nothing_says_so() {
        let scene = Scene::base().checked().unwrap();
        let mut silent = std::collections::BTreeSet::new();
        for reads in [false, true] {
            for view in ViewId::all() {
                let mut app = App::new(scene.clone(), Theme::Mono, Marker::Braille);
                app.act(Action::View(view));
                if app.reading.on != reads {
                    app.act(Action::Read);
                }
                let context = app.context();
                let others = of(Context::Main).filter(|_| context != Context::Main);
                let unbound = [Chord::from('d')];
                let keys = of(context).chain(others).flat_map(|binding| binding.keys);
                for chord in keys.chain(&unbound) {
                    let mut modifiers = KeyModifiers::NONE;
                    modifiers.set(KeyModifiers::CONTROL, chord.ctrl);
                    modifiers.set(KeyModifiers::SHIFT, chord.shift);
                    let mut after = app.clone();
                    let effect = after.key(&KeyEvent::new(chord.code, modifiers));
                    if effect == Effect::None && format!("{after:?}") == format!("{app:?}") {
                        silent.insert(format!("{chord} in {} ({reads})", view.word()));
                    }
                }
            }
        }
        assert!(silent.is_empty(), "{silent:?}");
        let mut app = App::new(scene, Theme::Mono, Marker::Braille);
        for (letter, says) in [('d', "no meaning here"), ('4', "as it was"), ('G', "no lesson")] {
            app.key(&KeyEvent::new(KeyCode::Char(letter), KeyModifiers::NONE));
            assert!(app.status.as_ref().is_some_and(|status| status.contains(says)), "{letter}");
        }
    }
}
