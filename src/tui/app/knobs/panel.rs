//! The knobs: a column of groups with a note on the selected knob. The first group and that of the
//! selected knob are open; the others are folded and show only changed values. The selected knob has
//! a bar with marks at its limits.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};
use strum::VariantArray;

use crate::sheet::line::capital;
use crate::tui::app::model::{App, InputMode};
use crate::tui::command::Command;
use crate::tui::knobs::{Group, Knob};
use crate::tui::text::{columns, overlay, print, wrap};
use crate::tui::theme::Role;
use rubscope_solver::scene::Allowed;

/// A row of the column.
struct Row {
    /// Index of the knob that a click selects: the one of the row, or the first of a group.
    place: usize,
    /// The text; empty for the bar of the selected knob.
    text: String,
    style: Style,
}

/// Draws the knobs from the index `from` on as a column.
pub fn panel(app: &App, buffer: &mut Buffer, area: Rect, from: usize) {
    // Without the gap to the charts.
    let area = Rect { width: area.width.saturating_sub(1), ..area };
    let look = &app.appearance;
    let rows = rows(app, area, from);
    for (y, row) in (area.y..area.bottom()).zip(&rows) {
        let at = Rect { y, height: 1, ..area };
        app.note(at, Command::Select(row.place));
        print(buffer, at, 0, &row.text, row.style);
        if let Some(knob) = app.selected().filter(|_| row.text.is_empty()) {
            draw(app, buffer, Rect { x: at.x + 2, width: at.width.saturating_sub(3), ..at }, knob);
        }
    }
    let mut row = u16::try_from(rows.len()).unwrap_or(area.height);
    for (lines, role) in notes(app, usize::from(area.width)) {
        // A note that does not fit is omitted as a whole.
        if row + u16::try_from(lines.len()).unwrap_or(0) > area.height {
            continue;
        }
        for line in lines {
            print(buffer, area, row, &line, look.style(role));
            row += 1;
        }
    }
    if let Some(at) = place_of_selected(app, &rows) {
        refusal(app, buffer, area, u16::try_from(at).unwrap_or(0));
    }
}

/// Returns the index of the row of the selected knob, which is behind the heading of its group.
fn place_of_selected(app: &App, rows: &[Row]) -> Option<usize> {
    rows.iter().rposition(|row| row.place == app.knobs.selected && !row.text.is_empty())
}

/// Prints why the value of the knob in row `at` was refused, over the rows below it, or above it if
/// there are too few.
pub fn refusal(app: &App, buffer: &mut Buffer, area: Rect, at: u16) {
    let Some(refusal) = &app.knobs.refusal else { return };
    let look = &app.appearance;
    let lines = wrap(&look.spell(refusal), usize::from(area.width));
    let rows = u16::try_from(lines.len()).unwrap_or(area.height);
    let below = area.height.saturating_sub(at + 1);
    let top = if rows > below && rows <= at { at - rows } else { at + 1 };
    let area = Rect { y: area.y + top, height: area.height.saturating_sub(top), ..area };
    overlay(buffer, area, &lines, look.style(Role::Trouble));
}

/// Returns the row of an open group: its name in a rule.
fn heading(app: &App, width: usize, group: Group) -> (String, Style) {
    let rule = app.appearance.either("─", "-");
    let rest = width.saturating_sub(3 + columns(group.name()));
    (format!("{rule} {} {}", group.name(), rule.repeat(rest)), app.appearance.style(Role::Quiet))
}

/// Returns the row of a folded group: its name, and the values changed since the scene was opened, or
/// their number if they do not fit.
fn folded(app: &App, width: usize, group: Group) -> (String, Style) {
    let look = &app.appearance;
    let head = look.spell(&format!(" {} ▸", group.name()));
    let changed = group.knobs().map(|(_, knob)| knob).filter(|knob| is_changed(app, knob));
    let value = |knob: &Knob| look.spell(&format!(" {}* {}", knob.symbol(), knob.text(&app.scene)));
    let changed: Vec<String> = changed.map(value).collect();
    let mut shown = changed.concat();
    if columns(&head) + columns(&shown) > width {
        shown = format!(" {}*", changed.len());
    }
    let weight = if changed.is_empty() { Modifier::empty() } else { Modifier::BOLD };
    (head + &shown, look.style(Role::Text).add_modifier(weight))
}

/// Returns the row of a knob: label and value.
fn knob(app: &App, width: usize, knob: &Knob, selected: bool) -> (String, Style) {
    let [label, _] = parts(app, knob, selected, knob.label, 0);
    let room = width.saturating_sub(columns(&label));
    let [_, shown] = parts(app, knob, selected, knob.label, room.saturating_sub(1));
    let pad = room.saturating_sub(columns(&shown));
    (format!("{label}{}{shown}", " ".repeat(pad)), style(app, knob, selected))
}

/// Returns a knob under `name` with the signs for *selected* and *changed*, and its value, or what
/// is typed for it, in at most `room` columns.
pub fn parts(app: &App, knob: &Knob, selected: bool, name: &str, room: usize) -> [String; 2] {
    let sign = if selected { '▸' } else { ' ' };
    let label = format!("{sign}{name}{}", if is_changed(app, knob) { '*' } else { ' ' });
    let shown = match (&app.dialogue.mode, selected) {
        (InputMode::Typing(text), true) => knob.typed(text, room),
        // Brackets mark a knob without effect in themes without colour.
        _ if knob.inert(&app.scene).is_some() => format!("({})", knob.text(&app.scene)),
        _ => knob.text(&app.scene),
    };
    [label, shown].map(|text| app.appearance.spell(&text))
}

/// Returns the style of a knob.
pub fn style(app: &App, knob: &Knob, selected: bool) -> Style {
    let look = &app.appearance;
    match (selected, is_changed(app, knob)) {
        (true, _) => look.style(Role::Focus).add_modifier(Modifier::REVERSED),
        _ if knob.inert(&app.scene).is_some() => look.style(Role::Quiet),
        (false, true) => look.style(Role::Text).add_modifier(Modifier::BOLD),
        (false, false) => look.style(Role::Text),
    }
}

/// Returns whether a knob differs from the opened scene.
fn is_changed(app: &App, knob: &Knob) -> bool {
    knob.get(&app.scene) != knob.get(&app.files.opened)
}

/// Returns the notes on the selected knob: why it has no effect, what it does, and which limit it
/// is at.
fn notes(app: &App, width: usize) -> Vec<(Vec<String>, Role)> {
    let Some(knob) = app.selected() else { return Vec::new() };
    let value = knob.number(&app.scene);
    let beside = app.range(knob).zip(value).and_then(|(range, value)| range.near_mark(value));
    let notes = [
        knob.inert(&app.scene).map(|why| (format!("no effect now: {why}"), Role::Focus)),
        Some((sentence(knob), Role::Quiet)),
        beside.map(|beside| (format!("Now {beside}."), Role::Focus)),
    ];
    let lines = |(text, role): (String, Role)| (wrap(&app.appearance.spell(&text), width), role);
    notes.into_iter().flatten().map(lines).collect()
}

/// Describes a knob in one sentence: what it does, and its range.
fn sentence(knob: &Knob) -> String {
    let text = capital(knob.does);
    match knob.allowed() {
        // `does` lists the choices already, and a range beyond +-1e6 is no practical limit.
        Allowed::OneOf(_) => format!("{text}."),
        Allowed::Real { min, max, .. } if min == -max && max >= 1e6 => format!("{text}."),
        _ => format!("{text}; {}.", knob.range_words()),
    }
}

/// Rows kept free for the note on the selected knob.
pub const NOTES: u16 = 5;
/// Width of a note \[columns\].
const NOTE_WIDTH: usize = 26;

/// Returns the rows of the column that fit into an area, including that of the selected knob, from
/// the knob at index `from` on.
fn rows(app: &App, area: Rect, from: usize) -> Vec<Row> {
    let note = app.selected().map_or(0, |knob| wrap(&sentence(knob), NOTE_WIDTH).len());
    let kept = usize::from(NOTES.min(area.height / 2));
    let most = usize::from(area.height) - kept + usize::from(NOTES).saturating_sub(note);
    let chosen = app.selected().map_or(Group::Operation, |knob| knob.group);
    let open = [Group::Operation, chosen];
    let mut rows = Vec::new();
    for (open, telling) in [(&open[..], true), (&open[..], false), (&open[1..], false)] {
        rows = all(app, usize::from(area.width), open, telling, from);
        if rows.len() <= most {
            return rows;
        }
    }
    // The bar of the selected knob must be visible too.
    let last = (place_of_selected(app, &rows).unwrap_or(0) + 2).min(rows.len());
    rows.into_iter().skip(last.saturating_sub(most)).take(most).collect()
}

/// Returns all rows with the groups in `open` unfolded. With `telling`, folded groups also list the
/// knobs by which the scene leaves the paper's model. A column that does not begin with the first
/// knob has no bar; the strip above it has.
fn all(app: &App, width: usize, open: &[Group], telling: bool, from: usize) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut push = |place, (text, style)| rows.push(Row { place, text, style });
    for &group in Group::VARIANTS {
        let is_open = open.contains(&group);
        let first = group.knobs().next().map_or(0, |(place, _)| place);
        match (is_open, group) {
            // The first group needs no heading.
            (true, Group::Operation) => {}
            (true, _) => push(first, heading(app, width, group)),
            (false, _) => push(first, folded(app, width, group)),
        }
        for (place, own) in group.knobs().filter(|(place, _)| *place >= from) {
            let is_shown = is_open || telling && own.leaves_the_paper(&app.scene);
            if !is_shown {
                continue;
            }
            let selected = place == app.knobs.selected;
            push(place, knob(app, width, own, selected));
            if from == 0 && selected && app.range(own).is_some() {
                push(place, (String::new(), Style::new()));
            }
        }
    }
    rows
}

/// Draws the bar of the selected knob into `cells` of one row; its end marks are outside. Knobs
/// without a numeric range have no bar.
pub fn draw(app: &App, buffer: &mut Buffer, cells: Rect, knob: &Knob) {
    let Some(range) = app.range(knob) else { return };
    if cells.width == 0 {
        return;
    }
    // The first and the last cell are the ends of the range.
    let half = 0.5 / f64::from(cells.width.max(2) - 1);
    let parts = [(-half, 1.0 + half), (0.0, 1.0)];
    app.note_part(cells, Command::SetPart(app.knobs.selected, 0.0), parts);
    let look = &app.appearance;
    let value = knob.number(&app.scene).and_then(|value| range.place(value));
    let here = value.map(|part| cell(cells, part));
    let quiet = look.style(Role::Quiet);
    let [left, right] = look.either(["▕", "▏"], ["[", "]"]);
    let [full, now, empty, tick] = look.either(["▒", "█", "▁", "┃"], ["=", "#", ".", "|"]);
    let mut put = |x: u16, sign: &str, style| {
        if let Some(cell) = buffer.cell_mut(Position::new(x, cells.y)) {
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
            _ => put(x, empty, quiet),
        }
    }
    let marks = range.marks.iter().map(|(_, part)| cell(cells, *part));
    marks.filter(|x| here != Some(*x)).for_each(|x| put(x, tick, look.style(Role::Text)));
}

/// Returns the column at a fraction of the bar, 0 to 1.
fn cell(cells: Rect, part: f64) -> u16 {
    cells.x + (part * f64::from(cells.width - 1)).round() as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::knobs::{KNOBS, knob_of};
    use crate::tui::{Marker, Theme};
    use rubscope_solver::scene::{Scene, keys};

    #[test]
    fn a_changed_knob_is_bold_and_so_is_its_folded_group() {
        let mut app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Ascii);
        let knob = knob_of(keys::BLADES).unwrap();
        let weights = |app: &App| {
            let styles = [style(app, knob, false), folded(app, 26, knob.group).1];
            styles.map(|style| style.add_modifier.contains(Modifier::BOLD))
        };
        assert_eq!(weights(&app), [false; 2]);
        let mut scene = Scene::base();
        scene.set(keys::BLADES, "23").unwrap();
        app.scene = scene.checked().unwrap();
        assert_eq!(weights(&app), [true; 2]);
    }

    #[test]
    fn every_note_on_a_knob_fits_below_the_knobs() {
        for knob in KNOBS.iter() {
            let lines = wrap(&sentence(knob), NOTE_WIDTH);
            assert!(lines.len() <= usize::from(NOTES), "{lines:#?}");
            let range = knob.range_words();
            let told = range.starts_with("one of") || sentence(knob).contains(&range);
            assert!(told || range.contains("-1e"), "{}", knob.label);
            if let Allowed::OneOf(words) = knob.allowed() {
                assert!(words.iter().all(|word| sentence(knob).contains(word)));
            }
        }
    }
}
