//! The list of commands: what is typed, the commands that match it, and a note on the selected one.
//! It is also the list of scenes and that of lessons.

use ratatui::text::Line;
use ratatui::widgets::{HighlightSpacing, List, ListState, StatefulWidget};
use ratatui::{buffer::Buffer, layout::Rect, style::Modifier};

use super::model::{App, InputMode};
use super::words::{self, Found};
use crate::tui::command::Effect;
use crate::tui::field::Field;
use crate::tui::files::FoundScenes;
use crate::tui::text::{columns, first_lines, print, shorten, wrap};
use crate::tui::theme::Role;

impl App {
    /// Returns the entries that match the typed text behind `word`, and the index of the selected
    /// one: at first the best match, or in a list of scenes or lessons the open scene or the next
    /// lesson.
    pub fn palette(&self, word: &str, typed: &Field) -> (Vec<Found>, usize) {
        let found = words::found(self, &format!("{word}{}", typed.text()));
        let is_whole_list = !word.is_empty() && typed.text().is_empty();
        let first = || found.iter().position(|item| is_whole_list && item.first).unwrap_or(0);
        // A resize can leave the place past the end.
        let place = self.dialogue.place.unwrap_or_else(first).min(found.len().saturating_sub(1));
        (found, place)
    }

    /// Executes the command that is selected, or else typed.
    ///
    /// # Errors
    /// One line that says why nothing matches, in which case the palette stays open, or why the
    /// command is refused.
    pub fn choose_command(&mut self, word: &str, typed: &Field) -> Result<Effect, String> {
        let (found, place) = self.palette(word, typed);
        let only = || words::only(self, &format!("{word}{}", typed.text()));
        let chosen = found.into_iter().nth(place).map_or_else(only, Ok)?;
        self.dialogue.close();
        self.update(chosen.command)
    }

    /// Applies the list of scenes that were read; the selection stays on the same entry.
    pub fn scenes_found(&mut self, scenes: FoundScenes) {
        let (mode, place) = (self.dialogue.mode.clone(), self.dialogue.place);
        let (InputMode::Palette(word, typed), Some(_)) = (mode, place) else {
            self.files.found = scenes;
            return;
        };
        let (before, place) = self.palette(word, &typed);
        self.files.found = scenes;
        let chosen = before.get(place).map(|item| &item.command);
        let same = |item: &Found| Some(&item.command) == chosen;
        self.dialogue.place = self.palette(word, &typed).0.iter().position(same);
    }
}

/// Draws the list of commands.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect, word: &str, typed: &Field) {
    let look = &app.appearance;
    let (width, mark) = (usize::from(area.width), look.ellipsis());
    let (found, place) = app.palette(word, typed);
    let files = &app.files.found;
    let hint = match word {
        _ if !typed.text().is_empty() => "",
        "" => "t 0.3 ms, speed 450, blade 7, scene rub, or any words",
        "scene " if files.reading => "Scenes: reading the files of this folder",
        "scene " => files.missing.as_deref().unwrap_or("Scenes: Enter opens one, u returns"),
        "lesson " => "Lessons: Enter begins one, g goes on, B back, G leaves",
        _ => "",
    };
    let typed = typed.shown(width.saturating_sub(2 + word.len()));
    let head = shorten(&look.spell(&format!(": {word}{typed}  {hint}")), width, mark);
    print(buffer, area, 0, head.trim_end(), look.style(Role::Focus));
    let status = app.status.as_ref().map_or(Vec::new(), |text| wrap(&look.spell(text), width));
    let mut said: Vec<_> = status.into_iter().map(|line| (line, Role::Trouble)).collect();
    if found.is_empty() {
        said.push(("no command matches".into(), Role::Quiet));
    }
    let mut top = 1;
    for (line, role) in said {
        print(buffer, area, top, &line, look.style(role));
        top += 1;
    }
    let top = top.min(area.height);
    let below = Rect { y: area.y + top, height: area.height - top, ..area };
    let note = found.get(place).map_or("", |item| item.note.as_str());
    let notes = if note.is_empty() { Vec::new() } else { wrap(&look.spell(note), width) };
    let rows = if note.is_empty() { 0 } else { notes.len() + 1 };
    let rows = u16::try_from(rows).unwrap_or(u16::MAX).min(below.height / 2);
    let list = Rect { height: below.height - rows, ..below };
    let line = |item: &Found| {
        let kind = if item.kind.is_empty() { String::new() } else { format!("{} ", item.kind) };
        let beside = look.spell(&item.beside);
        // The list has its sign in the first column.
        let room = width.saturating_sub(columns(&beside) + 2);
        let what = shorten(&look.spell(&format!("{kind}{}", item.what)), room, mark);
        let pad = width.saturating_sub(columns(&what) + columns(&beside) + 1);
        Line::styled(format!("{what}{}{beside}", " ".repeat(pad)), look.style(Role::Text))
    };
    let lines = List::new(found.iter().map(line))
        .highlight_symbol(look.either("▸", ">"))
        .highlight_spacing(HighlightSpacing::Always)
        .highlight_style(look.style(Role::Focus).add_modifier(Modifier::REVERSED));
    let mut state = ListState::default().with_selected(Some(place));
    StatefulWidget::render(lines, list, buffer, &mut state);
    for (y, item) in (list.y..list.bottom()).zip(found.iter().skip(state.offset())) {
        app.note(Rect { y, height: 1, ..list }, item.command.clone());
    }
    let note = Rect { y: list.bottom(), height: rows, ..below };
    print(buffer, note, 0, &look.either("─", "-").repeat(width), look.style(Role::Quiet));
    let lines = first_lines(notes, width, usize::from(rows.saturating_sub(1)), mark);
    for (row, line) in (1..rows).zip(lines) {
        print(buffer, note, row, &line, look.style(Role::Text));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::command::Command;
    use crate::tui::field::Edit;
    use crate::tui::{Marker, Theme};
    use rubscope_solver::scene::Scene;

    fn app() -> App {
        App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Braille)
    }

    fn look_for(app: &mut App, typed: &str) {
        app.dialogue.open(InputMode::Palette("", typed.into()));
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
}
