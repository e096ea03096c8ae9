//! Which lines the column of knobs has: groups with headings, some of them folded
//! where there is no room, and bars with their own lines. The mouse asks it too.

use ratatui::layout::Rect;

use crate::tui::app::App;
use crate::tui::knobs::{Group, KNOBS};

/// A line of the column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnLine {
    /// The heading of a group, and whether its knobs follow.
    Heading(Group, bool),
    /// A knob.
    Knob(usize),
    /// The bar of the knob above.
    Bar(usize),
}

/// Rows kept free for the note on the selected knob.
pub const NOTES: u16 = 5;

/// Knobs whose bars have lines of their own where there is room.
const BARS: [&str; 2] = ["operation.speed_rad_s", "operation.pulse_n"];

/// The lines of the column in an area of this height, with the selected knob in
/// sight.
pub fn lines(app: &App, height: u16) -> Vec<ColumnLine> {
    let rows = usize::from(height - NOTES.min(height / 2));
    let chosen = app.selected().map_or(Group::Operation, |knob| knob.group);
    let mut open = Group::ALL.map(|group| group == chosen);
    let fits = |open, bars| all(open, bars).len() <= rows;
    let mut bars = fits(open, true);
    for group in Group::ALL {
        let mut more = open;
        if let Some(open) = more.get_mut(group as usize) {
            *open = true;
        }
        // The bars of the operation do without lines of their own where that opens it.
        if fits(more, bars) {
            open = more;
        } else if group == Group::Operation && fits(more, false) {
            (open, bars) = (more, false);
        }
    }
    let lines = all(open, bars);
    let selected = lines.iter().position(|line| *line == ColumnLine::Knob(app.knob)).unwrap_or(0);
    let first = if lines.len() > rows { (selected + 1).saturating_sub(rows) } else { 0 };
    lines.into_iter().skip(first).take(rows).collect()
}

fn all(open: [bool; Group::ALL.len()], bars: bool) -> Vec<ColumnLine> {
    let mut lines = Vec::new();
    for (group, open) in Group::ALL.into_iter().zip(open) {
        lines.push(ColumnLine::Heading(group, open));
        for place in group.places().filter(|_| open) {
            lines.push(ColumnLine::Knob(place));
            if bars && KNOBS.get(place).is_some_and(|knob| BARS.contains(&knob.path)) {
                lines.push(ColumnLine::Bar(place));
            }
        }
    }
    lines
}

/// The columns of the cells of a bar in a line of the panel.
pub fn bar_cells(area: Rect) -> Rect {
    Rect { x: area.x + 2, width: area.width.saturating_sub(3), ..area }
}

/// The part of the screen that knobs are drawn in, without the gap to the charts.
pub fn inside(area: Rect) -> Rect {
    Rect { width: area.width.saturating_sub(1), ..area }
}
