//! The knobs: a column in groups with the selected one explained below, or a
//! single line if there is no room.

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier};

use super::bar;
use super::column::{self, ColumnLine};
use crate::scene::Allowed;
use crate::tui::app::{App, InputMode};
use crate::tui::knobs::{Group, KNOBS, Knob};
use crate::tui::text::{columns, pieces, print, shorten, wrap};
use crate::tui::theme::Role;

/// Draws the column.
pub fn panel(app: &App, buffer: &mut Buffer, area: Rect) {
    let area = column::inside(area);
    let look = &app.appearance;
    let lines = column::lines(app, area.height);
    for (y, line) in (area.y..area.bottom()).zip(&lines) {
        let row = Rect { y, height: 1, ..area };
        match *line {
            ColumnLine::Heading(group, open) => heading(app, buffer, row, group, open),
            ColumnLine::Folded(first, second) => folded(app, buffer, row, [first, second]),
            ColumnLine::Knob(place) => {
                let own = lines.contains(&ColumnLine::Bar(place));
                if let Some(knob) = KNOBS.get(place) {
                    self::knob(app, buffer, row, knob, place == app.knobs.selected, !own);
                }
            }
            ColumnLine::Bar(place) => {
                if let Some(knob) = KNOBS.get(place) {
                    bar::draw(app, buffer, column::bar_cells(row), knob);
                }
            }
        }
    }
    let used = u16::try_from(lines.len()).unwrap_or(area.height);
    let width = usize::from(area.width);
    let mut notes = notes(app, width);
    let room = usize::from(area.height.saturating_sub(used));
    if notes.len() > room {
        notes.truncate(room);
        if let Some((text, _)) = notes.last_mut() {
            let more = look.ellipsis();
            *text = shorten(&format!("{text}{more}"), width, more);
        }
    }
    for (row, (text, role)) in (used..area.height).zip(notes) {
        print(buffer, area, row, &text, look.style(role));
    }
}

/// A rule with the name of a group; how many knobs it has if they are folded.
fn heading(app: &App, buffer: &mut Buffer, row: Rect, group: Group, open: bool) {
    let look = &app.appearance;
    let (rule, quiet) = (look.either("─", "-"), look.style(Role::Quiet));
    let text = match open {
        true => format!(" {} ", group.name()),
        false => look.spell(&format!(" {} ▸ {} ", group.name(), group.places().count())),
    };
    let rest = rule.repeat(usize::from(row.width).saturating_sub(1 + columns(&text)));
    let parts = [(rule.to_string(), quiet), (text, look.style(Role::Text)), (rest, quiet)];
    pieces(buffer, row, 0, &parts);
}

/// A rule with the names of two folded groups.
fn folded(app: &App, buffer: &mut Buffer, row: Rect, groups: [Group; 2]) {
    let look = &app.appearance;
    let (rule, quiet) = (look.either("─", "-"), look.style(Role::Quiet));
    let [first, second] = groups
        .map(|group| look.spell(&format!(" {} ▸ {} ", group.short_name(), group.places().count())));
    let between = usize::from(column::SECOND).saturating_sub(columns(&first)).max(1);
    let used = between + columns(&first) + 1 + columns(&second);
    let rest = rule.repeat(usize::from(row.width).saturating_sub(used));
    let text = look.style(Role::Text);
    let parts = [
        (rule.repeat(between), quiet),
        (first, text),
        (rule.to_string(), quiet),
        (second, text),
        (rest, quiet),
    ];
    pieces(buffer, row, 0, &parts);
}

/// A line with a knob; where it has no bar of its own, its place in its range is
/// underlined.
fn knob(app: &App, buffer: &mut Buffer, row: Rect, knob: &Knob, selected: bool, underlined: bool) {
    let look = &app.appearance;
    let value = knob.get(&app.scene);
    let changed = value != knob.get(&app.files.opened);
    let inert = knob.inert(&app.scene).is_some();
    let sign = if selected { '▸' } else { ' ' };
    let label = look.spell(&format!("{sign}{}{}", knob.label, if changed { '*' } else { ' ' }));
    let shown = match (&app.dialogue.mode, selected) {
        (InputMode::Typing(text), true) => format!("{text}_"),
        // A sign beside the dim colour, for themes without colour.
        _ if inert => look.spell(&format!("({})", knob.shown(&value))),
        _ => look.spell(&knob.shown(&value)),
    };
    let width = usize::from(row.width);
    let room = width.saturating_sub(columns(&label) + 1);
    // The end of a typed value must be visible.
    let skip = shown.chars().count().saturating_sub(room);
    let shown: String = shown.chars().skip(skip).collect();
    let pad = width.saturating_sub(columns(&label) + columns(&shown));
    let style = match (selected, changed) {
        (true, _) => look.style(Role::Focus).add_modifier(Modifier::REVERSED),
        _ if inert => look.style(Role::Quiet),
        (false, true) => look.style(Role::Text).add_modifier(Modifier::BOLD),
        (false, false) => look.style(Role::Text),
    };
    print(buffer, row, 0, &format!("{label}{}{shown}", " ".repeat(pad)), style);
    if !underlined || inert {
        return;
    }
    let range = knob.range(&app.scene, &app.files.opened, &app.machine);
    let place = range.zip(knob.number(&app.scene)).and_then(|(range, x)| range.place(x));
    if let Some(part) = place {
        let width = (part * f64::from(row.width)).round() as u16;
        buffer.set_style(Rect { width, ..row }, style.add_modifier(Modifier::UNDERLINED));
    }
}

/// What the selected knob does and its allowed values, or why a value was refused.
fn notes(app: &App, width: usize) -> Vec<(String, Role)> {
    let Some(knob) = app.selected() else { return Vec::new() };
    let of = |text: &str, role: Role| {
        let lines = wrap(&app.appearance.spell(text), width).into_iter();
        lines.map(move |line| (line, role)).collect::<Vec<_>>()
    };
    if let Some(refusal) = &app.knobs.refusal {
        return of(refusal, Role::Trouble);
    }
    let mut lines = match knob.inert(&app.scene) {
        Some(reason) => of(&format!("no effect now: {reason}"), Role::Focus),
        None => Vec::new(),
    };
    lines.extend(of(&sentence(knob), Role::Quiet));
    lines
}

/// One sentence: what a knob does, its unit, and its allowed values.
fn sentence(knob: &Knob) -> String {
    let allowed = match knob.allowed() {
        Allowed::OneOf(words) => words.join(", "),
        other => other.to_string().trim_start_matches("a number ").to_string(),
    };
    match knob.unit() {
        "" => format!("{} ({allowed})", knob.does),
        unit => format!("{} ({unit}, {allowed})", knob.does),
    }
}

/// Draws the selected knob alone, with its bar where there is room.
pub fn strip(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    let width = usize::from(area.width);
    if let Some(refusal) = &app.knobs.refusal {
        let refusal = shorten(&look.spell(refusal), width, look.ellipsis());
        print(buffer, area, 0, &refusal, look.style(Role::Trouble));
        return;
    }
    let Some(knob) = app.selected() else { return };
    let text = strip_text(app, knob);
    let style = look.style(Role::Focus).add_modifier(Modifier::REVERSED);
    print(buffer, area, 0, &shorten(&text, width, look.ellipsis()), style);
    if let Some(cells) = strip_bar(app, area) {
        bar::draw(app, buffer, cells, knob);
    }
}

fn strip_text(app: &App, knob: &Knob) -> String {
    let shown = match &app.dialogue.mode {
        InputMode::Typing(text) => format!("{text}_"),
        _ => knob.text(&app.scene),
    };
    let changed = if knob.get(&app.scene) == knob.get(&app.files.opened) { "" } else { "*" };
    let text =
        format!("◄ {}{changed} {shown} ►  {}/{}", knob.label, app.knobs.selected + 1, KNOBS.len());
    app.appearance.spell(&text)
}

/// The fewest cells of a bar in the line of the selected knob.
const LEAST_BAR: u16 = 8;
/// The room that the text of that line has at least, so that the bar stays in its
/// place while the value changes.
const TEXT: u16 = 27;

/// The cells of the bar in the line of the selected knob, where there is room.
pub fn strip_bar(app: &App, area: Rect) -> Option<Rect> {
    let text = u16::try_from(columns(&strip_text(app, app.selected()?))).ok()?;
    let start = text.max(TEXT) + 2;
    let width = area.width.checked_sub(start + 1).filter(|width| *width >= LEAST_BAR)?;
    Some(Rect { x: area.x + start, width, height: 1, ..area })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_note_on_a_knob_fits_below_the_knobs() {
        for knob in KNOBS {
            let lines = wrap(&sentence(knob), 26);
            assert!(lines.len() <= usize::from(column::NOTES), "{lines:#?}");
            assert!(sentence(knob).contains(knob.unit()));
        }
    }
}
