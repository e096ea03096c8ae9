//! The bar of a knob: where its value stands in its range, with the limits on it.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Modifier;

use crate::tui::app::App;
use crate::tui::knobs::{Knob, KnobRange, meaning};
use crate::tui::theme::Role;

/// Draws the bar of a knob over an area, its two ends outside of it; nothing for
/// knobs of words.
pub fn draw(app: &App, buffer: &mut Buffer, cells: Rect, knob: &Knob) {
    let Some(range) = knob.range(&app.scene, &app.files.opened, &app.machine) else { return };
    if cells.width == 0 {
        return;
    }
    let look = &app.appearance;
    let value = knob.number(&app.scene).and_then(|value| range.place(value));
    let here = value.map(|part| cell(cells, part));
    let quiet = look.style(Role::Quiet);
    let [left, right] = look.either(["▕", "▏"], ["[", "]"]);
    let [full, now, empty] = look.either(["▒", "█", "▁"], ["=", "#", "."]);
    let last = cells.bottom().saturating_sub(1);
    for y in cells.y..cells.bottom() {
        let mut put = |x: u16, sign: &str, style| {
            if let Some(cell) = buffer.cell_mut(Position::new(x, y)) {
                cell.reset();
                cell.set_symbol(sign).set_style(style);
            }
        };
        put(cells.x.saturating_sub(1), left, quiet);
        put(cells.right(), right, quiet);
        for x in cells.x..cells.right() {
            match here {
                Some(here) if x < here => put(x, full, quiet),
                Some(here) if x == here => put(x, now, look.style(Role::Focus)),
                // A bar of several rows stands on its lowest one.
                _ => put(x, if y == last { empty } else { " " }, quiet),
            }
        }
        for (letter, x) in letters(&range, cells).filter(|_| y == last) {
            let style = look.style(Role::Text).add_modifier(Modifier::BOLD);
            let style =
                if here == Some(x) { style.add_modifier(Modifier::REVERSED) } else { style };
            put(x, letter.encode_utf8(&mut [0; 4]), style);
        }
    }
}

/// The letters that are drawn, and their columns: of those in one cell the last.
fn letters(range: &KnobRange, cells: Rect) -> impl Iterator<Item = (char, u16)> {
    let places = range.marks.iter().map(move |(letter, part)| (*letter, cell(cells, *part)));
    let hidden = move |place: usize, x: u16| {
        range.marks.iter().skip(place + 1).any(|(_, part)| cell(cells, *part) == x)
    };
    places.enumerate().filter(move |(place, (_, x))| !hidden(*place, *x)).map(|(_, mark)| mark)
}

/// What the letters on the bar of a knob mean, those that are drawn: `On its bar: c Ω_c.`
pub fn legend(app: &App, cells: Rect, knob: &Knob) -> Option<String> {
    let range = knob.range(&app.scene, &app.files.opened, &app.machine)?;
    let named: Vec<String> =
        letters(&range, cells).map(|(letter, _)| format!("{letter} {}", meaning(letter))).collect();
    (!named.is_empty() && cells.width > 0).then(|| format!("On its bar: {}.", named.join(", ")))
}

/// The column of a part, 0 to 1, of a bar.
fn cell(cells: Rect, part: f64) -> u16 {
    cells.x + (part * f64::from(cells.width - 1)).round() as u16
}

/// The part of a bar at a column.
pub fn part(cells: Rect, x: u16) -> f64 {
    let along = f64::from(x.saturating_sub(cells.x)) / f64::from(cells.width.max(2) - 1);
    along.clamp(0.0, 1.0)
}
