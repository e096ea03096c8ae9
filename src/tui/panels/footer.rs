//! The last line: what just happened, or the keys for where you are, from the
//! table of bindings.

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
        InputMode::Replacing(_, name) => Some(format!("{name} exists: y replaces it, n leaves it")),
        _ => None,
    };
    if let Some(question) = question {
        // The end, where the cursor is, must be seen.
        let skip = question.chars().count().saturating_sub(usize::from(area.width));
        let shown: String = question.chars().skip(skip).collect();
        print(buffer, area, 0, &shown, look.style(Role::Focus));
        return;
    }
    if let Some(status) = &app.status {
        print(buffer, area, 0, &look.spell(status), look.style(Role::Good));
        return;
    }
    let mut parts = Vec::new();
    for (keys, word) in bindings::of(app.context()).filter_map(|binding| binding.footer) {
        let gap = if parts.is_empty() { "" } else { "  " };
        parts.push((format!("{gap}{}", look.spell(keys)), look.style(Role::Focus)));
        parts.push((format!(" {word}"), look.style(Role::Quiet)));
    }
    // A key without its word says nothing: cut in pairs.
    let mut room = usize::from(area.width);
    let mut fitting = Vec::new();
    for pair in parts.chunks(2) {
        let wide: usize = pair.iter().map(|(text, _)| text.chars().count()).sum();
        if wide > room {
            break;
        }
        room -= wide;
        fitting.extend_from_slice(pair);
    }
    pieces(buffer, area, 0, &fitting);
}
