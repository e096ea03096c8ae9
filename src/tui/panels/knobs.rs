//! The knobs: a column with the selected one explained below, or a single line
//! if there is no room.

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier};

use crate::tui::app::{App, InputMode};
use crate::tui::knobs::{KNOBS, Knob};
use crate::tui::text::{print, wrap};
use crate::tui::theme::Role;

/// Rows below the list that explain the selected knob.
const NOTES: u16 = 4;

/// Draws the column.
pub fn panel(app: &App, buffer: &mut Buffer, area: Rect) {
    let area = Rect { width: area.width.saturating_sub(1), ..area };
    let notes = notes(app, usize::from(area.width));
    let wanted = u16::try_from(notes.len()).unwrap_or(NOTES).max(NOTES).min(area.height / 2);
    let rows = area.height.saturating_sub(wanted);
    // Keep the selected knob in sight.
    let first = (app.knob + 1).saturating_sub(usize::from(rows));
    for (row, (place, knob)) in (0..rows).zip(KNOBS.iter().enumerate().skip(first)) {
        line(app, buffer, Rect { y: area.y + row, height: 1, ..area }, place, knob);
    }
    for (row, (text, role)) in (rows..area.height).zip(notes) {
        print(buffer, area, row, &text, app.appearance.style(role));
    }
}

fn line(app: &App, buffer: &mut Buffer, area: Rect, place: usize, knob: &Knob) {
    let look = &app.appearance;
    let selected = place == app.knob;
    let value = knob.get(&app.scene);
    let changed = if value == knob.get(&app.opened) { ' ' } else { '*' };
    let sign = if selected { look.either('▸', '>') } else { ' ' };
    let label = look.spell(&format!("{sign}{}{changed}", knob.label));
    let shown = match (&app.mode, selected) {
        (InputMode::Typing(text), true) => format!("{text}_"),
        _ => look.spell(&knob.shown(&value)),
    };
    let width = usize::from(area.width);
    let room = width.saturating_sub(label.chars().count() + 1);
    // The end of a typed value must be visible.
    let skip = shown.chars().count().saturating_sub(room);
    let shown: String = shown.chars().skip(skip).collect();
    let pad = width.saturating_sub(label.chars().count() + shown.chars().count());
    let text = format!("{label}{}{shown}", " ".repeat(pad));
    let style = match (selected, changed == '*') {
        (true, _) => look.style(Role::Focus).add_modifier(Modifier::REVERSED),
        (false, true) => look.style(Role::Text).add_modifier(Modifier::BOLD),
        (false, false) => look.style(Role::Text),
    };
    print(buffer, area, 0, &text, style);
}

/// The meaning of the selected knob, its allowed values, and why a value was refused.
fn notes(app: &App, width: usize) -> Vec<(String, Role)> {
    let Some(knob) = app.selected() else { return Vec::new() };
    let mut lines = Vec::new();
    if let Some(refusal) = &app.refusal {
        lines.extend(
            wrap(&app.appearance.spell(refusal), width).into_iter().map(|l| (l, Role::Trouble)),
        );
        return lines;
    }
    let unit = if knob.unit().is_empty() { String::new() } else { format!(" [{}]", knob.unit()) };
    let what = app.appearance.spell(&format!("{}{unit}", knob.what()));
    lines.extend(wrap(&what, width).into_iter().map(|l| (l, Role::Quiet)));
    lines.extend(wrap(&knob.allowed().to_string(), width).into_iter().map(|l| (l, Role::Quiet)));
    lines
}

/// Draws the selected knob alone.
pub fn strip(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    if let Some(refusal) = &app.refusal {
        print(buffer, area, 0, &look.spell(refusal), look.style(Role::Trouble));
        return;
    }
    let Some(knob) = app.selected() else { return };
    let shown = match &app.mode {
        InputMode::Typing(text) => format!("{text}_"),
        _ => knob.shown(&knob.get(&app.scene)),
    };
    let changed = if knob.get(&app.scene) == knob.get(&app.opened) { "" } else { "*" };
    let text = format!("◄ {}{changed} {shown} ►  {}/{}", knob.label, app.knob + 1, KNOBS.len());
    let style = look.style(Role::Focus).add_modifier(Modifier::REVERSED);
    print(buffer, area, 0, &look.spell(&text), style);
}
