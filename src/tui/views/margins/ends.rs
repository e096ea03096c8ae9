//! What ends the lock of the run: for each quantity the nearest value at which a run has another
//! verdict, and the smallest lobes of the casing; without a lock, what would lock. View 8 shows
//! everything.

use ratatui::{buffer::Buffer, layout::Rect};

use crate::sheet::margins::robust::{smallest_lobes, tip_deviation};
use crate::sheet::margins::words::from_here;
use crate::sheet::number::{count, rounded};
use crate::sheet::table::{Heading, Table, TableCell};
use crate::tui::app::App;
use crate::tui::axis::number;
use crate::tui::knobs::knob_of;
use crate::tui::theme::Role;
use crate::tui::views::panel::{Lines, ViewArea, lines_above, message, not_yet, paragraph, title};
use rubscope_solver::motion::Verdict;
use rubscope_solver::scene::keys::{OUT_OF_ROUND, SPEED};
use rubscope_solver::study::margins::{ChangedVerdict, Margins, VerdictChange};

/// Significant digits of a value.
const DIGITS: usize = 3;

/// Keys of further views, and what they show.
const NEXT: &str = "4 wheel  5 map  g lessons";

/// Magnitude of a change, by which the rows are sorted (relative to the present value; for a length
/// relative to the clearance), and the cells: the quantity, its new value, and the relative change or,
/// if the present value is zero, `now 0`.
type Row = (f64, [String; 3]);

/// Draws the panel.
pub fn draw(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let known = app.margins();
    let old = known.as_ref().is_some_and(|(_, old)| *old);
    let locked = app.verdict() == Some(Verdict::Locked);
    let name = if locked { "what ends this lock" } else { "what would lock" };
    let legend = old.then(|| ("outdated".to_string(), look.style(Role::Focus)));
    let Some(margins) = known.map(|(live, _)| &live.margins) else {
        return message(app, buffer, at, (name, legend.as_slice()), not_yet(app));
    };
    let inside = title(app, buffer, at, name, legend.as_slice());
    let role = if old { Role::Quiet } else { Role::Text };
    let rows = rows(margins, locked).into_iter();
    let rows = rows.map(|(_, cells)| cells.map(TableCell::from).into()).collect();
    let table = Table::with_rows([""; 3].map(Heading::shown), rows);
    // Without the headings.
    let lines = table.lines(usize::MAX, 1, |text| look.spell(text)).into_iter().skip(1);
    let mut lines: Lines = lines.map(|cells| (cells.join(" "), role)).collect();
    // Every quantity was searched.
    let is_complete = margins.robust.as_ref().is_some_and(|of| of.changes.len() == of.rows);
    if lines.is_empty() && is_complete {
        lines = paragraph(app, &nothing(app, locked), inside, role);
    }
    let left = lines_above(app, buffer, inside, &lines);
    if left.height > 1 {
        let last = Rect { y: left.bottom() - 1, height: 1, ..left };
        lines_above(app, buffer, last, &vec![(NEXT.into(), Role::Quiet)]);
    }
}

/// Returns the rows, the smallest change first.
fn rows(margins: &Margins, locked: bool) -> Vec<Row> {
    let changes = margins.robust.iter().flat_map(|found| &found.changes);
    let mut rows: Vec<Row> = changes.filter_map(|change| changed(change, locked)).collect();
    let varied = margins.scene.casing.out_of_round_m != 0.0;
    rows.extend(lobes(margins).filter(|_| locked && !varied));
    rows.extend(tips(margins, locked));
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows
}

/// Returns the nearest change of one quantity that ends the lock or, without one, that locks;
/// `None` if none was found.
fn changed(row: &VerdictChange, locked: bool) -> Option<Row> {
    let part = |found: ChangedVerdict| (found.value - row.present) / row.present.abs();
    let both = [row.below, row.above].into_iter().flatten();
    let ends = both.filter(|found| (found.verdict == Verdict::Locked) != locked);
    let found = ends.min_by(|a, b| part(*a).abs().total_cmp(&part(*b).abs()))?;
    let knob = knob_of(row.path)?;
    // Symbols as in the strip of knobs, except where a word is easier to understand.
    let name = if [SPEED, OUT_OF_ROUND].contains(&row.path) { row.name } else { knob.symbol() };
    let doubt = if found.sensitive { "?" } else { "" };
    let value = number(rounded(found.value, DIGITS), knob.unit());
    let here = if row.present == 0.0 { "now 0".into() } else { from_here(part(found)) };
    Some((part(found).abs(), [format!("{name} to"), format!("{value}{doubt}"), here]))
}

/// Returns the smallest lobes that end the lock of a round casing; `None` if none are known to.
fn lobes(margins: &Margins) -> Option<Row> {
    let (_, height, lobes) = smallest_lobes(margins)?;
    Some(imperfection(&format!("{} of", count(lobes.into(), "lobe")), height, margins))
}

/// Returns the tip deviation that ends a lock or, without a lock, lets pushes hold one.
fn tips(margins: &Margins, locked: bool) -> Option<Row> {
    Some(imperfection("tips by ±", tip_deviation(margins, locked)?, margins))
}

/// Returns the row of a length \[m\] by which a machine is imperfect.
fn imperfection(what: &str, length: f64, margins: &Margins) -> Row {
    let cells = [what.to_string(), number(rounded(length, 2), "m"), "now 0".into()];
    (length / margins.scene.clearance(), cells)
}

/// Explains why there is no row.
fn nothing(app: &App, locked: bool) -> String {
    let exists = match app.lock_window().map(|window| rounded(window.from, DIGITS)) {
        _ if locked => return "No value that was tried changes the verdict.".into(),
        Some(from) => format!("A lock exists from {} on", number(from, "rad/s")),
        None if app.machine.knows_locks() => "No pair of blades locks".into(),
        None => "Whether a lock exists is not known".into(),
    };
    format!("{exists}; no run tried here locks.")
}
