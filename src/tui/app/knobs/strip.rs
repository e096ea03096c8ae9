//! The knobs as a strip above the charts, on a screen that has no room for their column: the first
//! ones in a row, the bar of the selected one in the row below. The others are listed over the
//! charts while one of them is selected, if there is room.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::panel::{draw as draw_bar, parts, style};
use crate::sheet::number::rounded;
use crate::tui::app::model::App;
use crate::tui::axis::number;
use crate::tui::command::Command;
use crate::tui::knobs::{Group, KNOBS, Knob};
use crate::tui::text::{columns, print};
use crate::tui::theme::Role;

/// The entry that leads to the other knobs.
const MORE: &str = " more ▸";
/// Least width of the bar \[columns\].
const LEAST_BAR: u16 = 8;
/// Significant digits of the ends of the bar.
const DIGITS: usize = 3;
/// Width for a value that is being typed \[columns\].
const TYPED: usize = 12;

/// Returns the number of knobs in a strip of this width: those of the first group that fit beside
/// the entry that leads to the others.
pub fn count(app: &App, width: u16) -> usize {
    let mut used = columns(MORE);
    let fits = |knob: &&Knob| {
        // A value that is being typed moves no knob out of the strip.
        used += columns(&text(app, knob, false, knob.symbol())) + 1;
        used <= usize::from(width)
    };
    KNOBS.iter().take_while(|knob| knob.group == Group::Operation).take_while(fits).count()
}

/// Returns a knob as it stands in the strip.
fn text(app: &App, knob: &Knob, selected: bool, name: &str) -> String {
    let [label, value] = parts(app, knob, selected, name, TYPED);
    format!("{} {value}", label.trim_end())
}

/// Draws the strip. A selected knob that is not in it comes first if it is not `listed` either.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect, listed: bool) {
    let count = count(app, area.width);
    let entry = |place: usize| {
        let knob = KNOBS.get(place)?;
        let selected = place == app.knobs.selected;
        let name = if place < count { knob.symbol() } else { knob.label };
        Some((place, text(app, knob, selected, name), style(app, knob, selected)))
    };
    let look = &app.appearance;
    let first = (app.knobs.selected >= count && !listed).then_some(app.knobs.selected);
    let mut entries: Vec<_> = first.into_iter().chain(0..count).filter_map(entry).collect();
    let role = if listed { Role::Focus } else { Role::Text };
    entries.push((count, look.spell(MORE), look.style(role)));
    let mut rest = Rect { height: 1, ..area };
    for (place, text, style) in entries {
        let width = u16::try_from(columns(&text)).unwrap_or(u16::MAX);
        if width > rest.width {
            break;
        }
        app.note(Rect { width, ..rest }, Command::Select(place));
        print(buffer, rest, 0, &text, style);
        let used = (width + 1).min(rest.width);
        rest = Rect { x: rest.x + used, width: rest.width - used, ..rest };
    }
    if let Some(knob) = app.selected().filter(|_| area.height > 1) {
        bar(app, buffer, Rect { y: area.y + 1, height: 1, ..area }, knob);
    }
}

/// Draws the bar of a knob, and behind it why the knob has no effect, the limit that its value is
/// near, or the ends of the bar; of a knob without a bar its words.
fn bar(app: &App, buffer: &mut Buffer, row: Rect, knob: &Knob) {
    let look = &app.appearance;
    let range = app.range(knob);
    let value = knob.number(&app.scene);
    let inert = knob.inert(&app.scene).map(|why| format!("no effect now: {why}"));
    let near = || range.as_ref()?.near_mark(value?);
    let ends = || {
        let (low, high, _) = range.as_ref()?.ends(0.0);
        let [low, high] = [low, high].map(|end| number(rounded(end, DIGITS), knob.unit()));
        let unit = high.find(' ').map_or("", |at| &high[at..]);
        Some(format!("{} to {high}", low.strip_suffix(unit).unwrap_or(&low)))
    };
    let text = inert.or_else(near).or_else(ends).unwrap_or_else(|| knob.range_words());
    let text = format!(" {} ", look.spell(&text));
    let wide = u16::try_from(columns(&text)).unwrap_or(u16::MAX);
    let bar = row.width.checked_sub(wide + 3).filter(|bar| *bar >= LEAST_BAR && range.is_some());
    let mut rest = row;
    if let Some(width) = bar {
        draw_bar(app, buffer, Rect { x: row.x + 2, width, ..row }, knob);
        rest = Rect { x: row.x + width + 3, width: wide, ..row };
    }
    print(buffer, rest, 0, &text, look.style(Role::Quiet));
}
