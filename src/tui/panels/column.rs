//! Which lines the column of knobs has: groups with headings, some of them folded
//! where there is no room, and bars with their own lines. What goes beyond the paper
//! is folded longest, but the knobs by which a scene leaves the paper are shown. The
//! mouse asks it too.

use crate::scene::keys::{PULSE, SPEED};
use ratatui::layout::Rect;

use crate::tui::app::App;
use crate::tui::knobs::{Group, KNOBS};

/// A line of the column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnLine {
    /// The heading of a group, and whether all its knobs follow.
    Heading(Group, bool),
    /// The headings of two folded groups; the second begins at `SECOND`.
    Folded(Group, Group),
    /// A knob.
    Knob(usize),
    /// The bar of the knob above.
    Bar(usize),
}

/// The column of the second of two headings in one line.
pub const SECOND: u16 = 13;

/// Rows kept free for the note on the selected knob.
pub const NOTES: u16 = 5;

/// Knobs whose bars have lines of their own where there is room.
const BARS: [&str; 2] = [SPEED, PULSE];

/// How much of a group is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Shown {
    Heading,
    /// The knobs by which the scene leaves the paper.
    Telling,
    All,
}

/// Groups in the order in which they get what room there is.
const ORDER: [(Group, Shown); 6] = [
    (Group::Operation, Shown::All),
    (Group::Beyond, Shown::Telling),
    (Group::Solver, Shown::All),
    (Group::Machine, Shown::All),
    (Group::Start, Shown::All),
    (Group::Beyond, Shown::All),
];

/// The lines of the column in an area of this height, with the selected knob in
/// sight.
pub fn lines(app: &App, height: u16) -> Vec<ColumnLine> {
    let rows = usize::from(height - NOTES.min(height / 2));
    let chosen = app.selected().map_or(Group::Operation, |knob| knob.group);
    let mut shown =
        Group::ALL.map(|group| if group == chosen { Shown::All } else { Shown::Heading });
    let fits = |shown, bars| all(app, shown, bars).len() <= rows;
    let mut bars = fits(shown, true);
    for (group, how) in ORDER {
        let mut more = shown;
        if let Some(shown) = more.get_mut(group as usize) {
            *shown = how.max(*shown);
        }
        // The bars of the operation do without lines of their own where that shows it,
        // and what the scene has beyond the paper.
        let worth = group == Group::Operation || how == Shown::Telling;
        if fits(more, bars) {
            shown = more;
        } else if worth && fits(more, false) {
            (shown, bars) = (more, false);
        }
    }
    let lines = all(app, shown, bars);
    let selected =
        lines.iter().position(|line| *line == ColumnLine::Knob(app.knobs.selected)).unwrap_or(0);
    let first = if lines.len() > rows { (selected + 1).saturating_sub(rows) } else { 0 };
    lines.into_iter().skip(first).take(rows).collect()
}

fn all(app: &App, shown: [Shown; Group::ALL.len()], bars: bool) -> Vec<ColumnLine> {
    let mut lines = Vec::new();
    for (group, shown) in Group::ALL.into_iter().zip(shown) {
        let knobs: Vec<usize> = match shown {
            Shown::All => group.places().collect(),
            Shown::Telling => {
                group.places().filter(|place| leaves_the_paper(app, *place)).collect()
            }
            Shown::Heading => Vec::new(),
        };
        match lines.last_mut() {
            Some(last)
                if *last == ColumnLine::Heading(Group::Beyond, false) && knobs.is_empty() =>
            {
                *last = ColumnLine::Folded(Group::Beyond, group);
            }
            _ => lines.push(ColumnLine::Heading(group, shown == Shown::All)),
        }
        for place in knobs {
            lines.push(ColumnLine::Knob(place));
            if bars && KNOBS.get(place).is_some_and(|knob| BARS.contains(&knob.path)) {
                lines.push(ColumnLine::Bar(place));
            }
        }
    }
    lines
}

fn leaves_the_paper(app: &App, place: usize) -> bool {
    KNOBS.get(place).is_some_and(|knob| knob.leaves_the_paper(&app.scene))
}

/// The columns of the cells of a bar in a line of the panel.
pub fn bar_cells(area: Rect) -> Rect {
    Rect { x: area.x + 2, width: area.width.saturating_sub(3), ..area }
}

/// The part of the screen that knobs are drawn in, without the gap to the charts.
pub fn inside(area: Rect) -> Rect {
    Rect { width: area.width.saturating_sub(1), ..area }
}
