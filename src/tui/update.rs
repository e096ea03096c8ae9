//! Executes commands: each changes the state and returns its effect on the outside. A key is looked
//! up in the table of commands, or is a letter of the text being typed.

use std::path::Path;

use crossterm::event::{KeyCode, KeyEvent};

use super::app::{App, Cursor, InputMode, Writing};
use crate::file;
use crate::sheet::line::{self, clean};
use crate::tui::app::layout::MOST_BESIDE;
use crate::tui::app::play::SLOWEST;
use crate::tui::command::chord::Chord;
use crate::tui::command::table::{Group, lookup};
use crate::tui::command::{Command, Effect, Purpose};
use crate::tui::export;
use crate::tui::field::Field;
use crate::tui::files::FileJob;
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::keys::is_plain;

/// Longest text that can be typed \[characters\].
const LONGEST_TYPED: usize = 1000;

/// Flips a switch; returns the message for off or on.
fn flipped(switch: &mut bool, [off, on]: [&str; 2]) -> Option<String> {
    *switch = !*switch;
    Some(if *switch { on } else { off }.into())
}

impl App {
    /// Handles a key press: a command of the table, or a letter for the open text field.
    pub fn key(&mut self, event: &KeyEvent) -> Effect {
        self.files.disturb();
        self.dialogue.is_new = false;
        let chord = Chord::of(event);
        if let Some(command) = lookup(self.keyboard(), chord) {
            let before = self.dialogue.is_closed().then(|| self.seen());
            let effect = self.act(command.clone());
            self.check_lesson();
            if self.status.is_none() && effect == Effect::None && before == Some(self.seen()) {
                self.status = Some(self.nothing(chord, &command));
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
            self.status = (!room).then(|| format!("no room: at most {LONGEST_TYPED} characters"));
            self.typed_on();
        } else {
            let way = match self.dialogue.is_closed() {
                true => "? lists the keys",
                false if self.keyboard() == Group::Filter => {
                    "the list is filtered, Esc clears the filter"
                }
                false if self.dialogue.typed().is_some() => "Enter accepts the text, Esc cancels",
                false => "Esc closes this",
            };
            self.status = Some(clean(&format!("{chord} has no meaning here; {way}")));
        }
        Effect::None
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
    fn nothing(&self, chord: Chord, command: &Command) -> String {
        match command {
            Command::Close if self.lessons.progress.is_some() => "G leaves the lesson".into(),
            Command::Close => "nothing is open; q quits".into(),
            Command::LeaveLesson => "no lesson is open; g lists them".into(),
            Command::Turn { .. } => "this knob is at the end of its range".into(),
            _ => format!("{chord} changes nothing here"),
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

    /// Executes a command on the screen and returns its effect. A refusal goes to the status line.
    pub fn act(&mut self, command: Command) -> Effect {
        let before = std::mem::discriminant(&self.dialogue.mode);
        let effect = self.update(command).unwrap_or_else(|why| {
            self.status = Some(clean(&why));
            Effect::None
        });
        if std::mem::discriminant(&self.dialogue.mode) != before {
            // What is still drawn belongs to another dialogue, and a click must not reach it.
            self.forget_drawn();
        }
        effect
    }

    /// Executes a command and returns its effect.
    ///
    /// # Errors
    /// One line that says why: no such time or blade, or a value or a file that is refused.
    pub fn update(&mut self, command: Command) -> Result<Effect, String> {
        self.status = None;
        self.appearance.use_units();
        if command != Command::Jump {
            self.play.begun_s = None;
        }
        match command {
            Command::Quit => return Ok(Effect::Quit),
            Command::Leave => return Ok(self.leave()),
            Command::Suspend => return Ok(Effect::Suspend),
            Command::Redraw => return Ok(Effect::Redraw),
            Command::Mouse => {
                let said = [
                    "mouse off: it selects text",
                    "mouse on: click, wheel; with Shift it selects text",
                ];
                self.status = flipped(&mut self.mouse.on, said);
                return Ok(Effect::Mouse(self.mouse.on));
            }
            Command::Copy => return Ok(Effect::Copy(self.copied())),
            Command::Palette(word) => {
                self.dialogue.open(InputMode::Palette(word, Field::default()));
                return Ok(self.find_scenes());
            }
            command if self.move_in_list(&command) => {}
            Command::Accept => return self.accept(),
            Command::Write(purpose, name) => return self.write(purpose, &name, false),
            Command::Open => return self.open_cursor(),
            Command::PutCursor([across, up]) => return self.click_cursor(Cursor { across, up }),
            Command::GoTo(t) => self.go_to_asked(t)?,
            Command::GoToEnd => self.go_to_asked(self.end_s())?,
            Command::Blade(blade) => self.go_to_blade(blade)?,
            Command::Scene(name) => {
                let entries = self.scene_entries();
                let named = entries.iter().find(|entry| entry.name == name);
                named.map_or(Ok(()), |entry| self.open_entry(entry))?;
            }
            Command::Set(place, text) => {
                self.knobs.select(place);
                self.take_typed(&text);
                self.knobs.refusal.clone().map_or(Ok(()), Err)?;
            }
            Command::Plain => self.turn_plain()?,
            Command::Nothing(why) => return Err(why),
            Command::Close => self.close(),
            Command::Help => self.dialogue.open(InputMode::Help(Field::default())),
            Command::Search => self.dialogue.open(InputMode::Search(Field::default())),
            Command::Edit(edit) => self.edit(edit),
            Command::Ask(purpose) => self.ask_name(purpose),
            Command::Theme(theme) => self.status = Some(self.appearance.use_theme(theme)),
            Command::NextTheme => return self.update(Command::Theme(self.appearance.theme.next())),
            Command::SpeedUnit => {
                let look = &mut self.appearance;
                self.status = flipped(&mut look.rpm, ["speeds in rad/s", "speeds in rpm"]);
                look.use_units();
            }
            Command::Marker => {
                self.appearance.marker = self.appearance.marker.next();
                self.status = Some(format!("marker {}", self.appearance.marker));
            }
            Command::Guide => self.guide(),
            Command::Lesson(place) => self.begin_lesson(place),
            Command::LessonBack => self.lesson_back(),
            Command::LessonScene(name, scene) => self.open_lesson_scene(name, *scene),
            Command::Answer(place) => self.answer(place),
            Command::LeaveLesson => self.leave_lesson(),
            Command::Above if self.is_asked() => self.choose_answer(true),
            Command::Below if self.is_asked() => self.choose_answer(false),
            Command::Above => self.knobs.walk(true),
            Command::Below => self.knobs.walk(false),
            Command::Turn { up, coarse } => self.turn(up, coarse),
            Command::Type => {
                self.knobs.refusal = None;
                self.dialogue.open(InputMode::Typing(Field::default()));
            }
            Command::Reset => self.reset(),
            Command::Undo => self.step_back(false),
            Command::Redo => self.step_back(true),
            Command::Live => {
                let said = ["a knob restarts the run", "live: knobs act on the running motion"];
                self.status = flipped(&mut self.knobs.live, said);
            }
            Command::Select(place) => self.select(place),
            Command::SetPart(place, part) => self.set_part(place, part),
            Command::Pause | Command::Step | Command::Jump => self.go_on(&command),
            Command::SlowAtEvents => {
                let said =
                    ["the same pace all the time", "slower at changes of contact, faster between"];
                self.status = flipped(&mut self.play.tempo.slow_at_events, said);
            }
            Command::Faster(by) => {
                self.play.tempo.rate = (self.play.tempo.rate + by).clamp(SLOWEST, 0);
            }
            Command::Restart => {
                self.stop_reading();
                self.restart();
                self.play.begun_s = Some(self.scene.view.begin_s);
                self.status = Some("restarted".into());
            }
            Command::Fire => self.fire(),
            Command::ZoomIn | Command::ZoomOut | Command::Page(_) => self.zoom(command),
            Command::PageBack => self.pan(true),
            Command::PageForward => self.pan(false),
            Command::View(view) => self.walk(view),
            Command::NextView(by) => self.walk(self.layout.neighbour(by)),
            Command::Charts => self.layout.beside = (self.layout.beside + 1) % (MOST_BESIDE + 1),
            Command::FullScreen => self.layout.full_screen = !self.layout.full_screen,
            Command::Autoscale => {
                let said = ["scales stay fixed", "scales follow the data"];
                self.status = flipped(&mut self.run.ranges.follow, said);
            }
            Command::Pin => self.pin(),
            Command::OtherLaw if self.is_large(ViewId::Map) => self.other_map_law(),
            Command::OtherLaw => self.compare(),
            Command::Compare(on) => self.run.set_compare(on),
            Command::Behind(view) => self.layout.put_behind(view),
            Command::Axes(paths) => self.put_axes(paths),
            Command::Survey => self.turn_survey(),
            Command::Range { ends, doubt } => {
                self.layout.range = ends;
                self.show_survey(true);
                self.status = doubt.or(self.status.take());
            }
            Command::Read => self.toggle_reading(),
            Command::Cursor { right, up, coarse } => self.move_cursor(right, up, coarse),
            Command::OpenRun(scene) => self.open_run(*scene),
            Command::JumpTo { path, value, to } => self.jump_to_limit(path, value, &to),
            Command::First | Command::Last => {}
        }
        Ok(Effect::None)
    }

    /// Starts writing a file. If it exists and `replace` is false, the result will ask the user.
    ///
    /// # Errors
    /// One line that says why nothing is written: the name, another file being written, or no data.
    pub fn write(&mut self, purpose: Purpose, name: &str, replace: bool) -> Result<Effect, String> {
        let name = name.trim();
        if ["", ".", "..", ".toml"].contains(&name.rsplit('/').next().unwrap_or_default()) {
            return Err("a file name is missing".into());
        }
        if !name.chars().all(is_plain) {
            return Err("a file name may have visible characters only".into());
        }
        let path = Path::new(name);
        if purpose == Purpose::Save && file::ending(path, &["toml"]).is_none() {
            return self.write(purpose, &format!("{name}.toml"), replace);
        }
        let figure = file::ending(path, &["csv", "svg"]);
        if purpose == Purpose::Export && figure.is_none() {
            return Err(format!("{name}: allowed is a name that ends in .csv or .svg"));
        }
        self.dialogue.close();
        if let Some(writing) = &self.files.writing {
            return Err(format!("{name} not written: still writing {}", writing.name));
        }
        let content = match purpose {
            Purpose::Save => Ok(self.scene_to_save().to_toml()),
            // No figure has the wheel.
            Purpose::Export if figure == Some("svg") && self.is_large(ViewId::Frame) => {
                Ok(export::svg(self))
            }
            Purpose::Export => self.panel().file(self, figure.unwrap_or("csv")),
        };
        let content = content.map_err(|reason| format!("nothing exported: {reason}"))?;
        self.status = Some(format!("writing {name} ..."));
        if purpose == Purpose::Save {
            self.files.saved = Some(self.scene.clone());
        }
        self.files.writing = Some(Writing { name: name.into(), purpose, undisturbed: true });
        Ok(Effect::Write(FileJob { path: self.files.directory.join(name), content, replace }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::app::tests::on_screen;
    use crate::tui::command::table::valid;
    use crate::tui::{Marker, Theme};
    use crossterm::event::KeyModifiers;
    use rubscope_solver::scene::Scene;

    #[test]
    fn a_live_change_acts_at_the_time_shown() {
        let mut app = on_screen();
        app.act(Command::Live);
        for (t, change) in [(5e-3, Command::Set(0, "450".into())), (8e-3, Command::Fire)] {
            app.update(Command::GoTo(t)).unwrap();
            assert_eq!(app.now(), t);
            app.update(change).unwrap();
            // The motion is not there yet, but goes there.
            assert_eq!((app.reading.at_s, app.now(), app.run.film.from_s), (None, t, t));
        }
        let times: Vec<f64> = app.run.film.arguments().iter().map(|(t, _)| *t).collect();
        assert_eq!(times, [5e-3, 8e-3]);
    }

    #[test]
    fn a_key_that_changes_nothing_says_so() {
        let scene = Scene::base().checked().unwrap();
        let mut silent = std::collections::BTreeSet::new();
        for reads in [false, true] {
            for view in ViewId::all() {
                let mut app = App::new(scene.clone(), Theme::Mono, Marker::Braille);
                app.act(Command::View(view));
                if app.reading.on != reads {
                    app.act(Command::Read);
                }
                let unbound = [Chord::from('d')];
                let keys = valid(app.keyboard()).flat_map(|binding| binding.keys);
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
        for (letter, says) in [('d', "no meaning here"), ('1', "changes no"), ('G', "no lesson")] {
            app.key(&KeyEvent::new(KeyCode::Char(letter), KeyModifiers::NONE));
            assert!(app.status.as_ref().is_some_and(|status| status.contains(says)), "{letter}");
        }
    }
}
