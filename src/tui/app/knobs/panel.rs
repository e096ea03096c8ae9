//! The knobs: a column of groups with a note on the selected knob. The first group and that of the selected knob are open; the others are folded
//! and show only changed values. The selected knob has a bar with marks at its limits. The mouse
//! uses the same layout of lines.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};
use strum::VariantArray;

use crate::sheet::line::capital;
use crate::tui::app::model::{App, InputMode};
use crate::tui::command::Command;
use crate::tui::knobs::{Group, KNOBS, Knob};
use crate::tui::text::{columns, overlay, pieces, print, wrap};
use crate::tui::theme::Role;
use rubscope_solver::scene::Allowed;

/// Draws the knobs from the index `from` on as a column.
pub fn panel(app: &App, buffer: &mut Buffer, area: Rect, from: usize) {
    // Without the gap to the charts.
    let area = Rect { width: area.width.saturating_sub(1), ..area };
    let look = &app.appearance;
    let lines = lines(app, area.height, from);
    for (y, line) in (area.y..area.bottom()).zip(&lines) {
        let row = Rect { y, height: 1, ..area };
        match *line {
            ColumnLine::Heading(group) | ColumnLine::Folded(group) => {
                if let Some(first) = group.places().next() {
                    app.note(row, Command::Select(first));
                }
                match line {
                    ColumnLine::Heading(_) => heading(app, buffer, row, group),
                    _ => folded(app, buffer, row, group),
                }
            }
            ColumnLine::Knob(place) => {
                app.note(row, Command::Select(place));
                if let Some(knob) = KNOBS.get(place) {
                    self::knob(app, buffer, row, knob, place == app.knobs.selected);
                }
            }
            ColumnLine::Bar(place) => {
                app.note(row, Command::Select(place));
                if let Some(knob) = KNOBS.get(place) {
                    let cells = Rect { x: row.x + 2, width: row.width.saturating_sub(3), ..row };
                    draw(app, buffer, cells, knob);
                }
            }
        }
    }
    let used = u16::try_from(lines.len()).unwrap_or(area.height);
    let width = usize::from(area.width);
    let mut row = used;
    for (lines, role) in notes(app, width) {
        // A note that does not fit is omitted as a whole.
        if row + u16::try_from(lines.len()).unwrap_or(0) > area.height {
            continue;
        }
        for line in lines {
            print(buffer, area, row, &line, look.style(role));
            row += 1;
        }
    }
    let selected = ColumnLine::Knob(app.knobs.selected);
    if let Some(at) = lines.iter().position(|line| *line == selected) {
        refusal(app, buffer, area, u16::try_from(at).unwrap_or(0));
    }
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

/// Draws the heading of an open group, within a rule.
fn heading(app: &App, buffer: &mut Buffer, row: Rect, group: Group) {
    let look = &app.appearance;
    let (rule, quiet) = (look.either("─", "-"), look.style(Role::Quiet));
    let text = format!(" {} ", group.name());
    let rest = rule.repeat(usize::from(row.width).saturating_sub(1 + columns(&text)));
    let parts = [(rule.to_string(), quiet), (text, look.style(Role::Text)), (rest, quiet)];
    pieces(buffer, row, 0, &parts);
}

/// Draws a folded group: name, number of knobs, and the values changed since the scene was opened,
/// or their number if they do not fit.
fn folded(app: &App, buffer: &mut Buffer, row: Rect, group: Group) {
    let look = &app.appearance;
    let head = look.spell(&format!(" {} {} ▸", group.name(), group.places().count()));
    let changed: Vec<String> = group
        .places()
        .filter_map(|place| KNOBS.get(place))
        .filter(|knob| is_changed(app, knob))
        .map(|knob| look.spell(&format!(" {}* {}", knob.symbol(), knob.text(&app.scene))))
        .collect();
    let mut shown = changed.concat();
    if columns(&shown) > usize::from(row.width).saturating_sub(columns(&head)) {
        shown = format!(" {}*", changed.len());
    }
    let text = look.style(Role::Text);
    pieces(buffer, row, 0, &[(head, text), (shown, text.add_modifier(Modifier::BOLD))]);
}

/// Draws a knob: label and value.
fn knob(app: &App, buffer: &mut Buffer, row: Rect, knob: &Knob, selected: bool) {
    let [label, _] = parts(app, knob, selected, knob.label, 0);
    let width = usize::from(row.width);
    let room = width.saturating_sub(columns(&label) + 1);
    let [_, shown] = parts(app, knob, selected, knob.label, room);
    let pad = width.saturating_sub(columns(&label) + columns(&shown));
    let text = format!("{label}{}{shown}", " ".repeat(pad));
    print(buffer, row, 0, &text, style(app, knob, selected));
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
    let range = knob.range(&app.scene, &app.files.opened, &app.machine);
    let beside =
        range.zip(knob.number(&app.scene)).and_then(|(range, value)| range.near_mark(value));
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

/// A line of the column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnLine {
    /// The heading of an open group.
    Heading(Group),
    /// A folded group.
    Folded(Group),
    /// The knob with this index.
    Knob(usize),
    /// The bar of this knob, below its line.
    Bar(usize),
}

/// Rows kept free for the note on the selected knob.
pub const NOTES: u16 = 5;
/// Width of a note \[columns\].
const NOTE_WIDTH: usize = 26;

/// Returns the lines of the column for this height, including the selected knob, from the knob at
/// index `from` on.
pub fn lines(app: &App, height: u16, from: usize) -> Vec<ColumnLine> {
    let note = app.selected().map_or(0, |knob| wrap(&sentence(knob), NOTE_WIDTH).len());
    let rows =
        usize::from(height - NOTES.min(height / 2)) + usize::from(NOTES).saturating_sub(note);
    let chosen = app.selected().map_or(Group::Operation, |knob| knob.group);
    let with = |open: &[Group], telling: bool| all(app, open, telling, from);
    let ways = [(&[Group::Operation, chosen][..], true), (&[Group::Operation, chosen], false)];
    let fitting = ways.into_iter().map(|(open, telling)| with(open, telling));
    let fitting = fitting.into_iter().find(|lines| lines.len() <= rows);
    let lines = fitting.unwrap_or_else(|| with(&[chosen], false));
    let here = |line: &ColumnLine| *line == ColumnLine::Knob(app.knobs.selected);
    let selected = lines.iter().position(here).unwrap_or(0);
    // Its bar must be visible too.
    let last = (selected + 2).min(lines.len());
    let first = if lines.len() > rows { last.saturating_sub(rows) } else { 0 };
    lines.into_iter().skip(first).take(rows).collect()
}

/// Returns all lines with the groups in `open` unfolded. With `telling`, folded groups also list
/// the knobs by which the scene leaves the paper's model. A column that does not begin with the
/// first knob has no bar; the strip above it has.
fn all(app: &App, open: &[Group], telling: bool, from: usize) -> Vec<ColumnLine> {
    let mut lines = Vec::new();
    for &group in Group::VARIANTS {
        let open = open.contains(&group);
        match (open, group) {
            // The first group needs no heading.
            (true, Group::Operation) => {}
            (true, _) => lines.push(ColumnLine::Heading(group)),
            (false, _) => lines.push(ColumnLine::Folded(group)),
        }
        let shown = |place: &usize| {
            let knob = KNOBS.get(*place);
            open || (telling && knob.is_some_and(|knob| knob.leaves_the_paper(&app.scene)))
        };
        for place in group.places().filter(|place| *place >= from).filter(shown) {
            lines.push(ColumnLine::Knob(place));
            let range = |knob: &Knob| knob.range(&app.scene, &app.files.opened, &app.machine);
            let is_selected = place == app.knobs.selected;
            if from == 0 && is_selected && KNOBS.get(place).and_then(range).is_some() {
                lines.push(ColumnLine::Bar(place));
            }
        }
    }
    lines
}

/// Draws the bar of the selected knob into `cells`; its end marks are outside. Knobs without a
/// numeric range have no bar.
pub fn draw(app: &App, buffer: &mut Buffer, cells: Rect, knob: &Knob) {
    let Some(range) = knob.range(&app.scene, &app.files.opened, &app.machine) else { return };
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
                // A bar of several rows is drawn from its lowest row.
                _ => put(x, if y == last { empty } else { " " }, quiet),
            }
        }
        let marks = range.marks.iter().map(|(_, part)| cell(cells, *part));
        for x in marks.filter(|x| y == last && here != Some(*x)) {
            put(x, tick, look.style(Role::Text));
        }
    }
}

/// Returns the column at a fraction of the bar, 0 to 1.
fn cell(cells: Rect, part: f64) -> u16 {
    cells.x + (part * f64::from(cells.width - 1)).round() as u16
}

#[cfg(test)]
mod tests {
    use super::*;

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
