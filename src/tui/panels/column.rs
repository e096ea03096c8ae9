//! Which lines the column of knobs has: the operation and the group of the selected knob are
//! open, or that group alone where both have no room, and the others are folded, with what
//! is changed in them. Only the selected knob has a bar. The mouse asks it too.

use ratatui::layout::Rect;

use crate::tui::app::App;
use crate::tui::knobs::{Group, KNOBS};

/// A line of the column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnLine {
    /// The heading of an open group.
    Heading(Group),
    /// A folded group.
    Folded(Group),
    /// A knob.
    Knob(usize),
    /// The bar of the knob above.
    Bar(usize),
}

/// Rows kept free for the note on the selected knob.
pub const NOTES: u16 = 5;

/// The lines of the column in an area of this height, with the selected knob in
/// sight.
pub fn lines(app: &App, height: u16) -> Vec<ColumnLine> {
    let rows = usize::from(height - NOTES.min(height / 2));
    let chosen = app.selected().map_or(Group::Operation, |knob| knob.group);
    let with = |open: &[Group], telling: bool| all(app, open, telling);
    let ways = [(&[Group::Operation, chosen][..], true), (&[Group::Operation, chosen], false)];
    let fitting = ways.into_iter().map(|(open, telling)| with(open, telling));
    let fitting = fitting.into_iter().find(|lines| lines.len() <= rows);
    let lines = fitting.unwrap_or_else(|| with(&[chosen], false));
    let here = |line: &ColumnLine| *line == ColumnLine::Knob(app.knobs.selected);
    let selected = lines.iter().position(here).unwrap_or(0);
    // The bar below it is in sight, too.
    let last = (selected + 2).min(lines.len());
    let first = if lines.len() > rows { last.saturating_sub(rows) } else { 0 };
    lines.into_iter().skip(first).take(rows).collect()
}

/// All lines with these groups open; of what goes beyond the paper, the knobs by which the
/// scene leaves it are told where there is room.
fn all(app: &App, open: &[Group], telling: bool) -> Vec<ColumnLine> {
    let mut lines = Vec::new();
    for group in Group::ALL {
        let open = open.contains(&group);
        match (open, group) {
            // The first one, where everybody begins, needs no name.
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

/// Whether a knob turns through a range.
fn has_bar(app: &App, place: usize) -> bool {
    let (scene, opened) = (&app.scene, &app.files.opened);
    KNOBS.get(place).is_some_and(|knob| knob.range(scene, opened, &app.machine).is_some())
}

/// The columns of the cells of a bar in a line of the panel.
pub fn bar_cells(area: Rect) -> Rect {
    Rect { x: area.x + 2, width: area.width.saturating_sub(3), ..area }
}

/// The part of the screen that knobs are drawn in, without the gap to the charts.
pub fn inside(area: Rect) -> Rect {
    Rect { width: area.width.saturating_sub(1), ..area }
}
