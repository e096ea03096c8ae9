//! The survey over all nodal diameters, shown instead of the margins of one: a table with a row per
//! number of nodal diameters, and above it what can lock now.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::sheet::number::speed_unit;
use crate::sheet::survey::{answer, notes, rows as rows_of};
use crate::tui::app::reading::cell_of;
use crate::tui::app::{App, Cursor};
use crate::tui::command::Command;
use crate::tui::text::wrap;
use crate::tui::theme::Role;
use crate::tui::views::map::text_style;
use crate::tui::views::panel::{ViewArea, lines_above, not_yet, title};
use crate::tui::views::table::{Rows, spelled};
use rubscope_solver::motion::Verdict;
use rubscope_solver::scene::keys::DIAMETERS;
use rubscope_solver::study::survey::{Survey, SurveyRow};

/// Height from which there is a summary above the table.
const TOLD_FROM: u16 = 6;
/// Largest number of lines of the summary.
const MOST_TOLD: usize = 2;

/// Draws the survey; `cell` is the index of the row under the cursor, `None` without one.
pub fn draw(app: &App, buffer: &mut Buffer, at: ViewArea, cell: Option<usize>) {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    let found = app.margins().and_then(|(live, old)| Some((live.survey.as_deref()?, old)));
    let mut legend = vec![(format!("speeds in {}, modes in Hz", speed_unit()), quiet)];
    legend.push(("can lock now".to_string(), text_style(look, Verdict::Locked)));
    let is_borrowed =
        |(survey, _): (&Survey, bool)| survey.shown(false).iter().any(|row| row.guessed);
    if found.is_some_and(is_borrowed) {
        legend.push(("? borrowed modes".to_string(), quiet));
    }
    if found.is_some_and(|(_, old)| old) {
        legend.insert(0, ("outdated".to_string(), look.style(Role::Focus)));
    }
    let inside = title(app, buffer, at, "survey", &legend);
    match found {
        Some((survey, _)) => table(app, buffer, at, inside, (survey, cell)),
        None => not_yet(app, buffer, inside),
    }
}

fn table(
    app: &App,
    buffer: &mut Buffer,
    at: ViewArea,
    area: Rect,
    (survey, cell): (&Survey, Option<usize>),
) {
    let look = &app.appearance;
    let (rows, width) = (survey.shown(false), usize::from(area.width.saturating_sub(1)));
    let (home, now) = (own(app, &rows), app.scene.operation.speed_rad_s);
    let lines = |text: &str| wrap(&look.spell(text), width);
    let mut told = lines(&answer(survey, false));
    told.truncate(if area.height >= TOLD_FROM { MOST_TOLD } else { 0 });
    // Keep the height of the summary while rows are read, so that the table does not move.
    let height = u16::try_from(told.len()).unwrap_or(0);
    let below = Rect { y: area.y + height, height: area.height - height, ..area };
    if let Some(row) = cell.and_then(|place| rows.get(place)) {
        let known = if row.guessed { ", no mode of its own" } else { "" };
        told = lines(&format!("n_d {}{known}: Enter selects it", row.nodal_diameters));
    }
    told.truncate(usize::from(height));
    lines_above(app, buffer, area, &told, Role::Focus);
    let drawn = Rows {
        table: spelled(app, rows_of(survey, &rows)),
        cursor: [1, 1],
        cell: cell.map(|row| [0, row]),
        home,
        marked: None,
    };
    let used = drawn.draw(app, buffer, (at, below), |place, column| match rows.get(place) {
        Some(_) if column == 0 && place == home => look.style(Role::Focus),
        Some(row) if row.guessed => look.style(Role::Quiet),
        Some(row) if column == 1 && row.locks_at(now) => text_style(look, Verdict::Locked),
        _ => look.style(Role::Text),
    });
    // Notes follow the table if they fit below an empty row.
    let notes = lines(&notes(survey, &rows).join(" "));
    let top = height + used + 1;
    if usize::from(top) + notes.len() <= usize::from(area.height) {
        let area = Rect { y: area.y + top, height: area.height - top, ..area };
        lines_above(app, buffer, area, &notes, Role::Quiet);
    }
}

/// Returns the index of the row of the scene's own nodal diameters; 0 if there is none.
fn own(app: &App, rows: &[&SurveyRow]) -> usize {
    let own = app.scene.operation.nodal_diameters;
    rows.iter().position(|row| row.nodal_diameters == own).unwrap_or(0)
}

/// Returns the index of the row under the cursor, from the top; `None` without a cursor or rows.
pub fn cell(app: &App) -> Option<usize> {
    let cursor = app.cursor_in(crate::tui::views::ViewId::Margins)?;
    let rows = rows(app);
    (rows > 0).then(|| rows as usize - 1 - cell_of(cursor.up, rows) as usize)
}

/// Returns the rows of the table.
fn shown(app: &App) -> Vec<&SurveyRow> {
    let survey = app.margins().and_then(|(live, _)| live.survey.as_deref());
    survey.map_or(Vec::new(), |survey| survey.shown(false))
}

/// Returns the number of rows of the table.
pub fn rows(app: &App) -> u32 {
    u32::try_from(shown(app).len()).unwrap_or(u32::MAX)
}

/// Returns the initial cursor: on the scene's own nodal diameters.
pub fn here(app: &App) -> Cursor {
    let (own, rows) = (own(app, &shown(app)), f64::from(rows(app).max(1)));
    Cursor { across: 0.5, up: 1.0 - (own as f64 + 0.5) / rows }
}

/// Returns what Enter does: it sets the nodal diameters of the row. `None` without a row under the
/// cursor.
pub fn opening(app: &App) -> Option<Command> {
    let diameters = shown(app).get(cell(app)?)?.nodal_diameters;
    let to = format!("{diameters} nodal diameters");
    Some(Command::JumpTo { path: DIAMETERS, value: f64::from(diameters), to })
}
