//! Keys and actions: each changes the state and returns an effect outside it.

use std::path::PathBuf;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use super::time::MOST_ZOOM;
use super::{App, Baseline, HelpState, InputMode, PaletteState, Purpose, RATES};
use crate::report::line::{self, clean};
use crate::tui::axis::readable;
use crate::tui::bindings::{Action, Chord, lookup};
use crate::tui::files::FileJob;
use crate::tui::knobs::knob_of;
use crate::tui::lessons;
use crate::tui::views::ViewId;
use crate::tui::worker::other_law;

/// An effect outside the state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Nothing but a redraw.
    None,
    /// Leave.
    Quit,
    /// Suspend the job.
    Suspend,
    /// Draw everything again.
    Redraw,
    /// Ask the terminal for the mouse, or no longer.
    Mouse(bool),
    /// Put a text on the clipboard of the terminal.
    Copy(String),
    /// Write a file.
    Write(FileJob),
    /// Read the scenes of a directory.
    FindScenes(PathBuf),
}

/// Longest text of a typed value.
const LONGEST_TYPED: usize = 200;

impl App {
    /// Handles a key press.
    pub fn key(&mut self, event: &KeyEvent) -> Effect {
        self.disturb();
        self.stop_sweep();
        self.is_new = false;
        if event.modifiers.contains(KeyModifiers::ALT) && event.code != KeyCode::Esc {
            // Escape and a key that arrive together look like Alt and that key.
            self.act(Action::Close);
        }
        let chord = Chord::of(event);
        if self.is_second_answer(chord) {
            self.status = Some("answered already: g goes on, B goes back".into());
            return Effect::None;
        }
        if let Some(action) = lookup(self.context(), chord) {
            let effect = self.act(action);
            self.check_lesson();
            return effect;
        }
        if let (Some(text), KeyCode::Char(letter), false) = (self.typed(), chord.code, chord.ctrl)
            && line::harmless(letter) == letter
        {
            let room = text.len() < LONGEST_TYPED;
            if room {
                text.push(letter);
            }
            self.status = (!room).then(|| format!("no room: at most {LONGEST_TYPED} letters"));
            self.look_again();
        }
        Effect::None
    }

    /// Takes a pasted text into the field that is open. It never acts as keys.
    pub fn paste(&mut self, text: &str) {
        self.disturb();
        // Breaks of lines and other characters that act have no place in a field.
        let text: String =
            text.chars().filter(|&letter| line::harmless(letter) == letter).collect();
        let refused = match self.typed() {
            None => Some("the pasted text is ignored: no field is open"),
            Some(field) if field.len().saturating_add(text.len()) > LONGEST_TYPED => {
                Some("the pasted text is ignored: it is too long")
            }
            Some(field) => {
                field.push_str(&text);
                None
            }
        };
        self.look_again();
        self.status = refused.map(String::from);
    }

    /// The text that is being typed.
    fn typed(&mut self) -> Option<&mut String> {
        match &mut self.mode {
            InputMode::Typing(text) | InputMode::Sweeping(text) | InputMode::Naming(_, text) => {
                Some(text)
            }
            InputMode::Help(help) => Some(&mut help.filter),
            InputMode::Palette(palette) => Some(&mut palette.typed),
            _ => None,
        }
    }

    /// After a change of what is looked for, the list begins at its top.
    fn look_again(&mut self) {
        match &mut self.mode {
            InputMode::Help(help) => help.scroll = 0,
            InputMode::Palette(palette) => palette.place = 0,
            _ => {}
        }
    }

    /// Carries out an action.
    pub fn act(&mut self, action: Action) -> Effect {
        self.status = None;
        match (self.mode.clone(), action) {
            (_, Action::Quit) => return Effect::Quit,
            (_, Action::Suspend) => return Effect::Suspend,
            (_, Action::Redraw) => return Effect::Redraw,
            (_, Action::Theme) => {
                self.appearance.theme = self.appearance.theme.next();
                self.status = Some(format!("theme {}", self.appearance.theme.name()));
            }
            (InputMode::Main, Action::Marker) => {
                self.appearance.marker = self.appearance.marker.next(self.octants);
                self.status = Some(format!("marker {}", self.appearance.marker));
                // Some terminals leave parts of octants behind.
                return Effect::Redraw;
            }
            (InputMode::Main, Action::Mouse) => {
                self.toggle_mouse();
                return Effect::Mouse(self.mouse);
            }
            (InputMode::Help(help), action) if self.scroll_help(&help, action) => {}
            (InputMode::Palette(palette), Action::Accept) => return self.choose_command(&palette),
            (InputMode::Palette(palette), action) if self.move_choice(&palette, action) => {}
            (_, Action::DeleteLast) => {
                _ = self.typed().and_then(String::pop);
                self.look_again();
            }
            (InputMode::Naming(purpose, name), Action::Accept) => {
                return self.write(purpose, &name, false);
            }
            // What was typed before the question was seen is no answer to it.
            (InputMode::Replacing(..), Action::Yes) if !self.asked => {}
            (InputMode::Replacing(purpose, name), Action::Yes) => {
                return self.write(purpose, &name, true);
            }
            (InputMode::Lessons(place), Action::KnobBelow) => {
                let last = lessons::all().len().saturating_sub(1);
                self.mode = InputMode::Lessons((place + 1).min(last));
            }
            (InputMode::Lessons(place), Action::KnobAbove) => {
                self.mode = InputMode::Lessons(place.saturating_sub(1));
            }
            (InputMode::Lessons(place), Action::Accept) => self.begin_lesson(place),
            (InputMode::Main, Action::Scenes) => return self.list_scenes(),
            (InputMode::Scenes(_), Action::KnobBelow) => self.move_in_scenes(1),
            (InputMode::Scenes(_), Action::KnobAbove) => self.move_in_scenes(-1),
            (InputMode::Scenes(_), Action::PageForward) => {
                self.note_page = self.note_page.wrapping_add(1);
            }
            (InputMode::Scenes(_), Action::Accept) => self.open_chosen_scene(),
            (_, Action::Copy) => return Effect::Copy(self.copied()),
            (InputMode::Typing(text), Action::Accept) => self.accept(&text),
            (InputMode::Sweeping(text), Action::Accept) => self.begin_sweep(&text),
            (_, Action::Close) => self.close(),
            _ => self.act_main(action),
        }
        Effect::None
    }

    fn close(&mut self) {
        self.refusal = None;
        if self.mode != InputMode::Main {
            self.mode = InputMode::Main;
        } else if self.reading || self.cursor.is_some() || self.pages_back != 0 {
            self.stop_reading();
            self.pages_back = 0;
        } else if self.presenting {
            self.present(false);
        } else {
            self.full_screen = false;
        }
    }

    fn act_main(&mut self, action: Action) {
        match action {
            Action::Help => self.mode = InputMode::Help(HelpState::default()),
            Action::Palette => self.mode = InputMode::Palette(PaletteState::default()),
            Action::NextView => self.walk(self.neighbour(1)),
            Action::PreviousView => self.walk(self.neighbour(-1)),
            Action::View(view) => self.walk(view),
            Action::KnobAbove => self.select(true),
            Action::KnobBelow => self.select(false),
            Action::Turn { up, coarse } => self.turn(up, coarse),
            Action::Type => {
                self.refusal = None;
                self.mode = InputMode::Typing(String::new());
            }
            Action::Reset => self.reset(),
            Action::Undo => self.step_back(false),
            Action::Redo => self.step_back(true),
            Action::Pause => {
                self.playing = !self.playing;
                self.stopped_by_end = false;
                // Told more often than gone on: the motion waits at the end.
                if self.playing && self.counters.ends > self.counters.extensions {
                    self.counters.extensions = self.counters.ends;
                }
            }
            Action::Step => {
                self.playing = false;
                self.counters.steps += 1;
            }
            Action::Jump => {
                self.playing = false;
                self.counters.jumps += 1;
            }
            Action::Pin => self.pin(),
            Action::OtherLaw if self.view == ViewId::Map => self.other_map_law(),
            Action::MapAxis { up } => self.next_map_axis(up),
            Action::OtherLaw => match other_law(&self.scene) {
                Err(why) if !self.compare => {
                    let law = self.scene.solver.contact.other();
                    self.status = Some(clean(&format!("no {law} law beside this: {why}")));
                }
                _ => self.set_compare(!self.compare),
            },
            Action::Save => self.mode = InputMode::Naming(Purpose::Save, "scene.toml".into()),
            Action::Export => {
                let name = format!("{}.csv", self.view.word());
                self.mode = InputMode::Naming(Purpose::Export, name);
            }
            Action::Lesson => self.lesson_key(),
            Action::LessonBack => self.lesson_back(),
            Action::Answer(place) => self.answer(place),
            Action::LeaveLesson => self.leave_lesson(),
            Action::Heat => {
                self.turn_gaps();
                let how = if self.heat { "against time" } else { "of this instant" };
                self.status = Some(format!("gaps {how}"));
            }
            Action::Charts => self.companions_shown = (self.companions_shown + 1) % 4,
            Action::PageBack => self.pan(true),
            Action::PageForward => self.pan(false),
            Action::GoToEnd => self.go_to(self.end_s()),
            Action::Read => self.toggle_reading(),
            Action::Cursor { right, up, coarse } => self.move_cursor(right, up, coarse),
            Action::OpenPlace => self.open_cursor(),
            Action::Restart => {
                self.restart();
                self.status = Some("restarted".into());
            }
            Action::Fire => {
                self.counters.pulses += 1;
                self.forget_forecasts();
                let pulse = knob_of("operation.pulse_n").map(|knob| knob.text(&self.scene));
                self.status = pulse.map(|pulse| format!("pulse of {pulse} fired"));
            }
            Action::Sweep => self.ask_sweep(),
            Action::SlowAtEvents => {
                self.slow_at_events = !self.slow_at_events;
                self.status = Some(match self.slow_at_events {
                    true => "slower at changes of contact, faster between".into(),
                    false => "the same pace all the time".to_string(),
                });
            }
            Action::Slower => self.rate = self.rate.saturating_sub(1),
            Action::Faster => self.rate = (self.rate + 1).min(RATES.len() - 1),
            Action::ZoomIn => self.zoom = (self.zoom + 1).min(MOST_ZOOM),
            Action::ZoomOut => self.zoom = (self.zoom - 1).max(-MOST_ZOOM),
            Action::ZoomReset => self.zoom = 0,
            Action::Autoscale => {
                self.ranges.follow = !self.ranges.follow;
                let how = if self.ranges.follow { "follow the data" } else { "stay fixed" };
                self.status = Some(format!("scales {how}"));
            }
            Action::Present => self.present(!self.presenting),
            Action::FullScreen => self.full_screen = !self.full_screen,
            Action::Live => {
                self.live = !self.live;
                self.status = Some(if self.live {
                    "live: knobs act on the running motion".into()
                } else {
                    "a knob restarts the run".to_string()
                });
            }
            _ => {}
        }
    }

    /// The screen for a projector, or the usual one.
    pub(super) fn present(&mut self, on: bool) {
        if on && self.lesson.is_some() {
            self.status = Some("a lesson needs the usual screen; G leaves it".into());
            return;
        }
        (self.presenting, self.appearance.wide) = (on, on);
        self.status = on.then(|| "P or Esc: back to the usual screen".into());
    }

    fn neighbour(&self, by: i64) -> ViewId {
        let views: Vec<ViewId> = ViewId::all().collect();
        let place = (self.view as i64 + by).rem_euclid(views.len() as i64);
        views.get(place as usize).copied().unwrap_or(self.view)
    }

    fn pin(&mut self) {
        if self.baseline.take().is_some() {
            self.status = Some("baseline removed".into());
            return;
        }
        let (history, scene) = (self.history.clone(), self.scene.clone());
        let words = self.verdict();
        let what = format!("{} at {}", words.word, readable(self.speed(), "rad/s"));
        self.baseline = Some(Baseline { history, words, scene });
        self.status = Some(format!("pinned behind the next runs: {what}"));
    }

    /// Makes a view the large one; the former one takes its place.
    pub(super) fn show(&mut self, view: ViewId) {
        if view == self.view {
            return;
        }
        for companion in &mut self.companions {
            if *companion == view {
                *companion = self.view;
            }
        }
        self.view = view;
        self.keep_instant();
    }
}
