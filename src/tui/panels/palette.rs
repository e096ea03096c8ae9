//! The list of commands: what is typed, and what fits it.

use ratatui::{buffer::Buffer, layout::Rect};

use super::list::{first_in_sight, look_of};
use crate::tui::app::{App, PaletteState};
use crate::tui::commands;
use crate::tui::text::{columns, print, shorten};
use crate::tui::theme::Role;

/// Draws the palette.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect, palette: &PaletteState) {
    let look = &app.appearance;
    let (width, mark) = (usize::from(area.width), look.ellipsis());
    let found = commands::found(app, &palette.typed);
    let hint = if palette.typed.is_empty() {
        "  t 0.3 ms, speed 450, blade 7, scene rub, or any words"
    } else {
        ""
    };
    // The end of what is typed, where the cursor is, must be visible.
    let skip = (palette.typed.chars().count() + 4).saturating_sub(width);
    let typed: String = palette.typed.chars().skip(skip).collect();
    let head = shorten(&format!(": {typed}_{hint}"), width, mark);
    print(buffer, area, 0, &head, look.style(Role::Focus));
    let said = match &app.status {
        Some(status) => Some((look.spell(status), Role::Trouble)),
        None => found.is_empty().then(|| ("nothing has these words".into(), Role::Quiet)),
    };
    let top = 1 + u16::from(said.is_some());
    if let Some((said, role)) = said {
        print(buffer, area, 1, &said, look.style(role));
    }
    let rows = usize::from(area.height.saturating_sub(top));
    let place = palette.place.min(found.len().saturating_sub(1));
    let first = first_in_sight(place, rows);
    for (row, (index, item)) in (top..area.height).zip(found.iter().enumerate().skip(first)) {
        let (sign, style) = look_of(look, index == place, Role::Text);
        let kind = if item.kind.is_empty() { String::new() } else { format!("{} ", item.kind) };
        let beside = look.spell(&item.beside);
        let room = width.saturating_sub(columns(&beside) + 1);
        let what = shorten(&look.spell(&format!("{sign}{kind}{}", item.what)), room, mark);
        let pad = width.saturating_sub(columns(&what) + columns(&beside));
        print(buffer, area, row, &format!("{what}{}{beside}", " ".repeat(pad)), style);
    }
}
