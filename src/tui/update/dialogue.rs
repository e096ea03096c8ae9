//! Dialogues: moving in lists, editing the text, and the command palette.

use crate::tui::app::{App, HelpState, InputMode, PaletteState};
use crate::tui::command::{Command, Effect};
use crate::tui::field::Edit;
use crate::tui::lessons;
use crate::tui::panels;
use crate::tui::words;

impl App {
    /// Moves the selection of the open list, or scrolls the help; returns false for other
    /// commands.
    pub(super) fn move_in_list(&mut self, command: &Command) -> bool {
        let last = |count: usize| count.saturating_sub(1);
        let (from, last) = match &self.dialogue.mode {
            InputMode::Help(help) => (help.scroll, panels::help_bottom(self, help)),
            InputMode::Palette(palette) => {
                (palette.place, last(words::found(self, &palette.typed.text()).len()))
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
        let to = match command {
            Command::Below => from + 1,
            Command::Above => from.saturating_sub(1),
            Command::PageForward => from + page,
            Command::PageBack => from.saturating_sub(page),
            Command::First => 0,
            Command::Last => last,
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
            (false, Edit::Start) => _ = self.move_in_list(&Command::First),
            (false, Edit::End) => _ = self.move_in_list(&Command::Last),
            _ => self.typed_on(),
        }
    }

    /// Executes the selected command.
    ///
    /// # Errors
    /// One line that says why nothing matches, in which case the palette stays open, or why the
    /// command is refused.
    pub(super) fn choose_command(&mut self, palette: &PaletteState) -> Result<Effect, String> {
        let typed = palette.typed.text();
        let chosen = words::found(self, &typed).into_iter().nth(palette.place);
        let chosen = chosen.map_or_else(|| words::only(self, &typed), Ok)?;
        self.dialogue.close();
        self.update(chosen.command)
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

    fn look_for(app: &mut App, typed: &str) {
        app.dialogue.open(InputMode::Palette(PaletteState::typing(typed)));
    }

    #[test]
    fn a_value_that_is_refused_changes_nothing_and_says_so() {
        let mut app = app();
        let before = app.scene.clone();
        look_for(&mut app, "blades 0");
        app.act(Command::Accept);
        assert_eq!(app.scene, before);
        assert!(app.status.is_some_and(|status| status.contains("blades N: 0 is not possible")));
    }

    #[test]
    fn what_is_no_command_says_why_and_the_list_stays_open() {
        let mut app = app();
        look_for(&mut app, "speed qqq");
        let open = app.dialogue.mode.clone();
        app.act(Command::Accept);
        assert_eq!(app.dialogue.mode, open);
        assert!(app.status.is_some_and(|status| status.contains("qqq")));
    }

    #[test]
    fn a_key_that_types_nothing_says_so_and_a_letter_ends_a_refusal() {
        use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
        let mut app = app();
        app.act(Command::Type);
        for code in [KeyCode::Char(' '), KeyCode::Tab] {
            app.key(&KeyEvent::new(code, KeyModifiers::NONE));
            assert!(app.status.take().is_some_and(|status| status.contains("no meaning here")));
        }
        app.key(&KeyEvent::new(KeyCode::Char('x'), KeyModifiers::NONE));
        app.act(Command::Accept);
        assert!(app.knobs.refusal.is_some());
        app.act(Command::Edit(Edit::DeleteBefore));
        assert!(app.knobs.refusal.is_none() && !app.dialogue.is_closed());
    }

    #[test]
    fn a_scene_that_is_opened_can_be_undone() {
        let mut app = app();
        let before = app.scene.clone();
        app.knobs.live = true;
        assert_eq!(app.update(Command::Scene("rocking".into())), Ok(Effect::None));
        assert_eq!(*app.scene, Scene::builtin("rocking").unwrap());
        assert_eq!((&app.files.opened, app.knobs.live), (&app.scene, true));
        assert_eq!(app.files.source.as_ref().map(|source| source.name.as_str()), Some("rocking"));
        app.act(Command::Undo);
        assert_eq!(app.scene, before);
    }
}
