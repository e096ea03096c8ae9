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
            ColumnLine::Heading(group) => heading(app, buffer, row, group),
            ColumnLine::Folded(group) => folded(app, buffer, row, group),
            ColumnLine::Knob(place) => {
                if let Some(knob) = KNOBS.get(place) {
                    self::knob(app, buffer, row, knob, place == app.knobs.selected);
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
    let cells = column::bar_cells(Rect { height: 1, ..area });
    let mut notes = notes(app, width, cells);
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
    let selected = ColumnLine::Knob(app.knobs.selected);
    if let Some(at) = lines.iter().position(|line| *line == selected) {
        refusal(app, buffer, area, u16::try_from(at).unwrap_or(0));
    }
}

/// Why the value of the knob in this row was refused, below it and over what is there.
fn refusal(app: &App, buffer: &mut Buffer, area: Rect, at: u16) {
    let Some(refusal) = &app.knobs.refusal else { return };
    let (look, width) = (&app.appearance, usize::from(area.width));
    for (row, line) in (at + 1..area.height).zip(wrap(&look.spell(refusal), width)) {
        print(buffer, area, row, &format!("{line:width$}"), look.style(Role::Trouble));
    }
}

/// A rule with the name of an open group.
fn heading(app: &App, buffer: &mut Buffer, row: Rect, group: Group) {
    let look = &app.appearance;
    let (rule, quiet) = (look.either("─", "-"), look.style(Role::Quiet));
    let text = format!(" {} ", group.name());
    let rest = rule.repeat(usize::from(row.width).saturating_sub(1 + columns(&text)));
    let parts = [(rule.to_string(), quiet), (text, look.style(Role::Text)), (rest, quiet)];
    pieces(buffer, row, 0, &parts);
}

/// A folded group: its name, how many knobs it has, and those that are not as in the scene,
/// as many as have room.
fn folded(app: &App, buffer: &mut Buffer, row: Rect, group: Group) {
    let look = &app.appearance;
    let head = look.spell(&format!(" {} {} ▸", group.name(), group.places().count()));
    let changed: Vec<String> = group
        .places()
        .filter_map(|place| KNOBS.get(place))
        .filter(|knob| knob.get(&app.scene) != knob.get(&app.files.opened))
        .map(|knob| look.spell(&format!(" {}* {}", knob.symbol(), knob.text(&app.scene))))
        .collect();
    let mut shown = changed.concat();
    let room = usize::from(row.width).saturating_sub(columns(&head));
    if columns(&shown) > room {
        let more = |count: usize| match count {
            0 => String::new(),
            count => format!(" +{count}*"),
        };
        let fits = |count: &usize| {
            let first = changed.iter().take(*count).map(|text| columns(text)).sum::<usize>();
            first + columns(&more(changed.len() - count)) <= room
        };
        let count = (0..changed.len()).rev().find(fits).unwrap_or(0);
        let first: Vec<String> = changed.iter().take(count).cloned().collect();
        shown = format!("{}{}", first.concat(), more(changed.len() - count));
    }
    let text = look.style(Role::Text);
    pieces(buffer, row, 0, &[(head, text), (shown, text.add_modifier(Modifier::BOLD))]);
}

/// A line with a knob.
fn knob(app: &App, buffer: &mut Buffer, row: Rect, knob: &Knob, selected: bool) {
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
}

/// What the selected knob does, its allowed values, and the letters on its bar.
fn notes(app: &App, width: usize, cells: Rect) -> Vec<(String, Role)> {
    let Some(knob) = app.selected() else { return Vec::new() };
    let of = |text: &str, role: Role| {
        let lines = wrap(&app.appearance.spell(text), width).into_iter();
        lines.map(move |line| (line, role)).collect::<Vec<_>>()
    };
    let mut lines = match knob.inert(&app.scene) {
        Some(reason) => of(&format!("no effect now: {reason}"), Role::Focus),
        None => Vec::new(),
    };
    lines.extend(of(&sentence(knob), Role::Quiet));
    lines.extend(bar::legend(app, cells, knob).iter().flat_map(|legend| of(legend, Role::Quiet)));
    lines
}

/// One sentence: what a knob does, and its range.
fn sentence(knob: &Knob) -> String {
    let mut text = knob.does.to_string();
    if let Some(first) = text.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    match knob.allowed() {
        // Their words are in it.
        Allowed::OneOf(_) => format!("{text}."),
        _ => format!("{text}; {}.", knob.range_words()),
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
    fn the_letters_that_are_drawn_on_a_bar_are_told_and_no_others() {
        let scene = crate::scene::Scene::base().checked().unwrap();
        let app = App::new(scene, crate::tui::Theme::Mono, crate::tui::Marker::Braille);
        let told = |width| bar::legend(&app, Rect::new(0, 0, width, 1), &KNOBS[0]).unwrap();
        let wide = told(200);
        for meaning in ["a adhesive limit", "x coincidence", "c Ω_c", "L Ω_lock"] {
            assert!(wide.contains(meaning), "{wide}");
        }
        // In one cell only the last can be seen.
        assert_eq!(told(1), "On its bar: L Ω_lock.");
    }

    #[test]
    fn every_note_on_a_knob_fits_below_the_knobs() {
        for knob in KNOBS {
            let lines = wrap(&sentence(knob), 26);
            assert!(lines.len() <= usize::from(column::NOTES), "{lines:#?}");
            assert!(sentence(knob).contains(knob.unit()));
            if let Allowed::OneOf(words) = knob.allowed() {
                assert!(words.iter().all(|word| sentence(knob).contains(word)));
            }
        }
    }
}
