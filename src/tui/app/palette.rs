//! The command palette: what is typed, the commands that match it, and their list.

use ratatui::{buffer::Buffer, layout::Rect};

use super::model::App;
use super::words::{self, Found};
use crate::tui::command::Effect;
use crate::tui::field::Field;
use crate::tui::list::draw_list;
use crate::tui::text::{columns, print, shorten, wrap};
use crate::tui::theme::Role;

impl App {
    /// Executes the command that is selected, or else typed.
    ///
    /// # Errors
    /// One line that says why nothing matches, in which case the palette stays open, or why the
    /// command is refused.
    pub fn choose_command(&mut self, typed: &str) -> Result<Effect, String> {
        let place = self.dialogue.place.unwrap_or(0);
        let chosen = words::found(self, typed).into_iter().nth(place);
        let chosen = chosen.map_or_else(|| words::only(self, typed), Ok)?;
        self.dialogue.close();
        self.update(chosen.command)
    }
}

/// Draws the command palette.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect, typed: &Field) {
    let look = &app.appearance;
    let (width, mark) = (usize::from(area.width), look.ellipsis());
    let found = words::found(app, &typed.text());
    let hint = match typed.text().as_str() {
        "" => "  t 0.3 ms, speed 450, blade 7, scene rub, or any words",
        _ => "",
    };
    let typed = typed.shown(width.saturating_sub(2));
    let head = shorten(&format!(": {typed}{hint}"), width, mark);
    print(buffer, area, 0, &head, look.style(Role::Focus));
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
    let below = Rect { y: area.y + top.min(area.height), ..area };
    let below = Rect { height: area.bottom() - below.y, ..below };
    let line = |item: &Found| {
        let kind = if item.kind.is_empty() { String::new() } else { format!("{} ", item.kind) };
        let beside = look.spell(&item.beside);
        // The list has its sign in the first column.
        let room = width.saturating_sub(columns(&beside) + 2);
        let what = shorten(&look.spell(&format!("{kind}{}", item.what)), room, mark);
        let pad = width.saturating_sub(columns(&what) + columns(&beside) + 1);
        (format!("{what}{}{beside}", " ".repeat(pad)), Role::Text)
    };
    let place = app.dialogue.place.unwrap_or(0).min(found.len().saturating_sub(1));
    draw_list(look, buffer, below, found.iter().map(line), place);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::app::InputMode;
    use crate::tui::command::Command;
    use crate::tui::field::Edit;
    use crate::tui::{Marker, Theme};
    use rubscope_solver::scene::Scene;

    fn app() -> App {
        App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Braille)
    }

    fn look_for(app: &mut App, typed: &str) {
        app.dialogue.open(InputMode::Palette(typed.into()));
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
