//! The last line: the effect of the last key, or the keys that can be pressed
//! now, from the table of bindings.

use ratatui::{buffer::Buffer, layout::Rect};

use crate::tui::app::{App, InputMode, Purpose};
use crate::tui::bindings;
use crate::tui::text::{pieces, print};
use crate::tui::theme::Role;

/// Draws the line.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    let question = match &app.mode {
        InputMode::Naming(Purpose::Save, name) => Some(format!("save the scene as: {name}_")),
        InputMode::Naming(Purpose::Export, name) => {
            Some(format!("export as (.csv data, .svg picture): {name}_"))
        }
        InputMode::Sweeping(text) => app.sweep_question(text),
        InputMode::Replacing(_, name) => Some(format!("{name} exists: y replaces it, n leaves it")),
        _ => None,
    };
    if let Some(question) = question.filter(|_| app.status.is_none()) {
        // The end, where the cursor is, must be visible.
        let skip = question.chars().count().saturating_sub(usize::from(area.width));
        let shown: String = question.chars().skip(skip).collect();
        print(buffer, area, 0, &shown, look.style(Role::Focus));
        return;
    }
    if let Some(status) = &app.status {
        print(buffer, area, 0, &look.spell(status), look.style(Role::Good));
        return;
    }
    // A key and its word are shown together or not at all.
    let mut rest = area;
    for (keys, word) in bindings::of(app.context()).filter_map(|binding| binding.footer) {
        let gap = if rest == area { "" } else { "  " };
        let keys = format!("{gap}{}", look.spell(keys));
        let wide =
            u16::try_from(keys.chars().count() + 1 + word.chars().count()).unwrap_or(u16::MAX);
        if wide > rest.width {
            return;
        }
        let word = (format!(" {word}"), look.style(Role::Quiet));
        pieces(buffer, rest, 0, &[(keys, look.style(Role::Focus)), word]);
        rest = Rect { x: rest.x + wide, width: rest.width - wide, ..rest };
    }
}
