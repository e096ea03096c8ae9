//! Dialogues: moving in lists, the command palette, and typed commands.

use super::Effect;
use crate::report::line::clean;
use crate::tui::app::{App, HelpState, InputMode, PaletteState};
use crate::tui::axis::{instant, readable};
use crate::tui::bindings::Action;
use crate::tui::commands::{self, Command};
use crate::tui::field::Edit;
use crate::tui::lessons;
use crate::tui::panels;

impl App {
    /// Moves the selection of the open list, or scrolls the help; returns false for other actions.
    pub(super) fn move_in_list(&mut self, action: Action) -> bool {
        let last = |count: usize| count.saturating_sub(1);
        let (from, last) = match &self.dialogue.mode {
            InputMode::Help(help) => (help.scroll, panels::help_bottom(self, help)),
            InputMode::Palette(palette) => {
                (palette.place, last(commands::found(self, &palette.typed.text()).len()))
            }
            InputMode::Lessons(place) => (*place, last(lessons::all().len())),
            InputMode::Scenes(chosen) => {
                let entries = self.scene_entries();
                (self.scene_place(&entries, *chosen), last(entries.len()))
            }
            _ => return false,
        };
        // A resize can leave the place past the end; then a key up would have no visible effect at
        // first.
        let from = from.min(last);
        let page = usize::from(panels::body(self).height.saturating_sub(2)).max(1);
        let to = match action {
            Action::KnobBelow => from + 1,
            Action::KnobAbove => from.saturating_sub(1),
            Action::PageForward => from + page,
            Action::PageBack => from.saturating_sub(page),
            Action::First => 0,
            Action::Last => last,
            _ => return false,
        };
        let to = to.min(last);
        match &mut self.dialogue.mode {
            InputMode::Help(HelpState { scroll: place, .. })
            | InputMode::Palette(PaletteState { place, .. })
            | InputMode::Lessons(place) => *place = to,
            InputMode::Scenes(place) => *place = Some(to),
            _ => {}
        }
        self.dialogue.note_page = 0;
        true
    }

    /// Edits the text field. Home and End, if they do not move the text cursor, move in the list.
    pub(super) fn edit(&mut self, edit: Edit) {
        match (self.dialogue.typed().is_some_and(|field| field.edit(edit)), edit) {
            (true, Edit::Left | Edit::Right | Edit::Start | Edit::End) => {}
            (false, Edit::Start) => _ = self.move_in_list(Action::First),
            (false, Edit::End) => _ = self.move_in_list(Action::Last),
            _ => self.typed_on(),
        }
    }

    /// Opens the command palette with `typed` as the search text.
    pub(super) fn look_for(&mut self, typed: &str) {
        self.dialogue.open(InputMode::Palette(PaletteState { typed: typed.into(), place: 0 }));
    }

    /// Executes the selected command. If nothing matches, the palette stays open and the status
    /// line says why.
    pub(super) fn choose_command(&mut self, palette: &PaletteState) -> Effect {
        let typed = palette.typed.text();
        let chosen = commands::found(self, &typed).into_iter().nth(palette.place);
        let chosen = chosen.map_or_else(|| commands::only(self, &typed), Ok);
        chosen.and_then(|found| self.obey(found.command)).unwrap_or_else(|reason| {
            self.status = Some(clean(&reason));
            Effect::None
        })
    }

    /// Executes a command.
    ///
    /// # Errors
    /// One line that says why: no such time or blade, or the knob refuses the value.
    pub fn obey(&mut self, command: Command) -> Result<Effect, String> {
        self.dialogue.close();
        match command {
            Command::Act(action) => return Ok(self.act(action)),
            Command::GoTo(t) => {
                let end = self.end_s();
                if !(0.0..=end).contains(&t) {
                    let [t, end] = [t, end].map(|t| readable(t, "s"));
                    return Err(format!("t = {t}: from 0 to {end}, the end of the run"));
                }
                self.go_to(t);
                self.status = Some(format!("paused at {}", instant(t)));
            }
            Command::Blade(blade) => self.go_to_blade(blade)?,
            Command::Axes(paths) => self.put_axes(paths),
            Command::Range(range) => {
                self.layout.range = range;
                self.show_survey(true);
            }
            Command::Scene(name) => {
                let entries = self.scene_entries();
                if let Some(entry) = entries.iter().find(|entry| entry.name == name) {
                    self.open_entry(entry)?;
                }
            }
            Command::Lesson(place) => self.begin_lesson(place),
            Command::Select(place) => self.knobs.select(place),
            Command::Theme(theme) => self.status = Some(self.appearance.use_theme(theme)),
            Command::Write(purpose, name) => return Ok(self.write(purpose, &name, false)),
            Command::Set(place, text) => {
                self.knobs.select(place);
                self.accept(&text);
                if let Some(refusal) = &self.knobs.refusal {
                    return Err(refusal.to_string());
                }
            }
        }
        Ok(Effect::None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::{Marker, Theme};
    use rubscope_solver::scene::Scene;

    fn app() -> App {
        App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Braille)
    }

    #[test]
    fn a_value_that_is_refused_changes_nothing_and_says_so() {
        let mut app = app();
        let before = app.scene.clone();
        app.choose_command(&PaletteState { typed: "blades 0".into(), place: 0 });
        assert_eq!(app.scene, before);
        assert!(app.status.is_some_and(|status| status.contains("blades N: 0 is not possible")));
    }

    #[test]
    fn what_is_no_command_says_why_and_the_list_stays_open() {
        let mut app = app();
        app.look_for("speed qqq");
        let open = app.dialogue.mode.clone();
        app.choose_command(&PaletteState { typed: "speed qqq".into(), place: 0 });
        assert_eq!(app.dialogue.mode, open);
        assert!(app.status.is_some_and(|status| status.contains("qqq")));
    }

    #[test]
    fn a_key_that_types_nothing_says_so_and_a_letter_ends_a_refusal() {
        use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
        let mut app = app();
        app.act(Action::Type);
        for code in [KeyCode::Char(' '), KeyCode::Tab] {
            app.key(&KeyEvent::new(code, KeyModifiers::NONE));
            assert!(app.status.take().is_some_and(|status| status.contains("no meaning here")));
        }
        app.key(&KeyEvent::new(KeyCode::Char('x'), KeyModifiers::NONE));
        app.act(Action::Accept);
        assert!(app.knobs.refusal.is_some());
        app.act(Action::Edit(Edit::DeleteBefore));
        assert!(app.knobs.refusal.is_none() && !app.dialogue.is_closed());
    }

    #[test]
    fn a_scene_that_is_opened_can_be_undone() {
        let mut app = app();
        let before = app.scene.clone();
        app.knobs.live = true;
        assert_eq!(app.obey(Command::Scene("rocking".into())), Ok(Effect::None));
        assert_eq!(*app.scene, Scene::builtin("rocking").unwrap());
        assert_eq!((&app.files.opened, app.knobs.live), (&app.scene, true));
        assert_eq!(app.files.source.as_ref().map(|source| source.name.as_str()), Some("rocking"));
        app.act(Action::Undo);
        assert_eq!(app.scene, before);
    }
}
