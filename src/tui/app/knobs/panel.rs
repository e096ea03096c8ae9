//! The knobs: a column of groups with a note on the selected knob, or, without room, a line with
//! that knob alone. The first group and that of the selected knob are open; the others are folded
//! and show only changed values. The selected knob has a bar with marks at its limits. The mouse
//! uses the same layout of lines.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Modifier;
use strum::VariantArray;

use crate::report::line::capital;
use crate::tui::app::{App, InputMode};
use crate::tui::command::Command;
use crate::tui::knobs::{Group, KNOBS, Knob};
use crate::tui::text::{columns, overlay, pieces, print, shorten, wrap};
use crate::tui::theme::Role;
use rubscope_solver::scene::Allowed;

/// Draws the knobs as a column.
pub fn panel(app: &App, buffer: &mut Buffer, area: Rect) {
    let area = inside(area);
    let look = &app.appearance;
    let lines = lines(app, area.height);
    for (y, line) in (area.y..area.bottom()).zip(&lines) {
        let row = Rect { y, height: 1, ..area };
        match *line {
            ColumnLine::Heading(group) | ColumnLine::Folded(group) => {
                if let Some(first) = group.places().next() {
                    app.note(row, Command::Unfold(first));
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
                    draw(app, buffer, bar_cells(row), knob);
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
fn refusal(app: &App, buffer: &mut Buffer, area: Rect, at: u16) {
    let Some(refusal) = &app.knobs.refusal else { return };
    let look = &app.appearance;
    let lines = wrap(&look.spell(refusal), usize::from(area.width));
    let rows = u16::try_from(lines.len()).unwrap_or(area.height);
    let below = area.height.saturating_sub(at + 1);
    let top = if rows > below && rows <= at { at - rows } else { at + 1 };
    let area = Rect { y: area.y + top, height: area.height.saturating_sub(top), ..area };
    overlay(buffer, area, &lines, look.style(Role::Trouble));
}

/// Prints why the value of the selected knob was refused, over its line and as many rows of `area`
/// as it takes.
pub fn strip_refusal(app: &App, buffer: &mut Buffer, area: Rect) {
    let Some(refusal) = &app.knobs.refusal else { return };
    let look = &app.appearance;
    let lines = wrap(&look.spell(refusal), usize::from(area.width));
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
        .filter(|knob| knob.get(&app.scene) != knob.get(&app.files.opened))
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
    let look = &app.appearance;
    let value = knob.get(&app.scene);
    let changed = value != knob.get(&app.files.opened);
    let inert = knob.inert(&app.scene).is_some();
    let sign = if selected { '▸' } else { ' ' };
    let label = look.spell(&format!("{sign}{}{}", knob.label, if changed { '*' } else { ' ' }));
    let width = usize::from(row.width);
    let room = width.saturating_sub(columns(&label) + 1);
    let shown = match (&app.dialogue.mode, selected) {
        (InputMode::Typing(text), true) => look.spell(&knob.typed(text, room)),
        // Brackets mark a knob without effect in themes without colour.
        _ if inert => look.spell(&format!("({})", knob.shown(&value))),
        _ => look.spell(&knob.shown(&value)),
    };
    let pad = width.saturating_sub(columns(&label) + columns(&shown));
    let style = match (selected, changed) {
        (true, _) => look.style(Role::Focus).add_modifier(Modifier::REVERSED),
        _ if inert => look.style(Role::Quiet),
        (false, true) => look.style(Role::Text).add_modifier(Modifier::BOLD),
        (false, false) => look.style(Role::Text),
    };
    print(buffer, row, 0, &format!("{label}{}{shown}", " ".repeat(pad)), style);
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

/// Draws the selected knob as a single line, with its bar if there is room.
pub fn strip(app: &App, buffer: &mut Buffer, area: Rect) {
    app.note(area, Command::Select(app.knobs.selected));
    let look = &app.appearance;
    let width = usize::from(area.width);
    let Some(knob) = app.selected() else { return };
    let text = strip_text(app, knob);
    let style = look.style(Role::Focus).add_modifier(Modifier::REVERSED);
    print(buffer, area, 0, &shorten(&text, width, look.ellipsis()), style);
    if let Some(cells) = strip_bar(app, area) {
        draw(app, buffer, cells, knob);
    }
}

fn strip_text(app: &App, knob: &Knob) -> String {
    let shown = match &app.dialogue.mode {
        InputMode::Typing(text) => knob.typed(text, usize::from(TEXT)),
        _ => knob.text(&app.scene),
    };
    let changed = if knob.get(&app.scene) == knob.get(&app.files.opened) { "" } else { "*" };
    let text =
        format!("◄ {}{changed} {shown} ►  {}/{}", knob.label, app.knobs.selected + 1, KNOBS.len());
    app.appearance.spell(&text)
}

/// Least width of the bar beside a single knob.
const LEAST_BAR: u16 = 8;
/// Least width of the text of a single knob, so that its bar does not move while the value changes.
const TEXT: u16 = 27;

/// Returns the area of the bar in the single line; `None` if there is no room for it.
pub fn strip_bar(app: &App, area: Rect) -> Option<Rect> {
    let text = u16::try_from(columns(&strip_text(app, app.selected()?))).ok()?;
    let start = text.max(TEXT) + 2;
    let width = area.width.checked_sub(start + 1).filter(|width| *width >= LEAST_BAR)?;
    Some(Rect { x: area.x + start, width, height: 1, ..area })
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

/// Returns the lines of the column for this height, including the selected knob.
pub fn lines(app: &App, height: u16) -> Vec<ColumnLine> {
    let note = app.selected().map_or(0, |knob| wrap(&sentence(knob), NOTE_WIDTH).len());
    let rows =
        usize::from(height - NOTES.min(height / 2)) + usize::from(NOTES).saturating_sub(note);
    let chosen = app.selected().map_or(Group::Operation, |knob| knob.group);
    let with = |open: &[Group], telling: bool| all(app, open, telling);
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
/// the knobs by which the scene leaves the paper's model.
fn all(app: &App, open: &[Group], telling: bool) -> Vec<ColumnLine> {
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
        for place in group.places().filter(shown) {
            lines.push(ColumnLine::Knob(place));
            if place == app.knobs.selected && has_bar(app, place) {
                lines.push(ColumnLine::Bar(place));
            }
        }
    }
    lines
}

/// Returns whether the knob at this index has a numeric range, and so a bar.
fn has_bar(app: &App, place: usize) -> bool {
    let (scene, opened) = (&app.scene, &app.files.opened);
    KNOBS.get(place).is_some_and(|knob| knob.range(scene, opened, &app.machine).is_some())
}

/// Returns the area of the bar in a line of the column.
pub fn bar_cells(area: Rect) -> Rect {
    Rect { x: area.x + 2, width: area.width.saturating_sub(3), ..area }
}

/// Returns the area of the knobs without the gap to the charts.
pub fn inside(area: Rect) -> Rect {
    Rect { width: area.width.saturating_sub(1), ..area }
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
        for knob in KNOBS {
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
