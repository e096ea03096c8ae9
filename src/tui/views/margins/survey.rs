//! The survey over all nodal diameters, shown instead of the margins of one: a table with a row per
//! number of nodal diameters, and above it what can lock now.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::sheet::Sheet;
use crate::sheet::number::speed_unit;
use crate::sheet::survey::{answer, notes, rows, sheet};
use crate::tui::app::{App, Cursor};
use crate::tui::command::Command;
use crate::tui::theme::Role;
use crate::tui::views::id::ViewId;
use crate::tui::views::map::text_style;
use crate::tui::views::panel::{
    ViewArea, ViewPanel, cursor_at, lines_above, message, not_yet, paragraph, title,
};
use crate::tui::views::table::Rows;
use rubscope_solver::motion::Verdict;
use rubscope_solver::scene::keys::DIAMETERS;
use rubscope_solver::study::survey::{Survey, SurveyRow};

/// Height from which there is a summary above the table.
const TOLD_FROM: u16 = 6;
/// Largest number of lines of the summary.
const MOST_TOLD: usize = 2;

/// The view of the survey.
pub struct SurveyView;

impl ViewPanel for SurveyView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let look = &app.appearance;
        let quiet = look.style(Role::Quiet);
        let mut legend = vec![(format!("speeds in {}, modes in Hz", speed_unit()), quiet)];
        legend.push(("can lock now".to_string(), text_style(look, Verdict::Locked)));
        let Some(survey) = survey(app) else {
            return message(app, buffer, at, ("survey", &legend), not_yet(app));
        };
        if survey.shown(false).iter().any(|row| row.guessed) {
            legend.push(("? borrowed modes".to_string(), quiet));
        }
        if app.margins().is_some_and(|(_, old)| old) {
            legend.insert(0, ("outdated".to_string(), look.style(Role::Focus)));
        }
        let inside = title(app, buffer, at, "survey", &legend);
        table(app, buffer, at, inside, survey);
    }

    fn grid(&self, app: &App) -> [u32; 2] {
        u32::try_from(shown(app).len())
            .ok()
            .filter(|rows| *rows > 0)
            .map_or([0, 0], |rows| [1, rows])
    }

    /// Returns a cursor on the scene's own nodal diameters.
    fn here(&self, app: &App) -> Cursor {
        let [_, rows] = self.grid(app);
        cursor_at([0, rows.saturating_sub(1 + own(app, &shown(app)) as u32)], [1, rows])
    }

    /// Enter sets the nodal diameters of the row under the cursor.
    fn opening(&self, app: &App, _: Cursor) -> Option<Command> {
        let diameters = shown(app).get(cell(app)?)?.nodal_diameters;
        let to = format!("{diameters} nodal diameters");
        Some(Command::JumpTo { path: DIAMETERS, value: f64::from(diameters), to })
    }

    fn sheet<'a>(&self, app: &'a App) -> Option<Sheet<'a>> {
        Some(sheet(survey(app)?, false, app.view_command()))
    }
}

fn table(app: &App, buffer: &mut Buffer, at: ViewArea, area: Rect, survey: &Survey) {
    let (look, shown) = (&app.appearance, survey.shown(false));
    let (home, now) = (own(app, &shown), app.scene.operation.speed_rad_s);
    let lines = |text: &str, role| paragraph(app, text, area, role);
    let mut told = lines(&answer(survey, false), Role::Focus);
    told.truncate(if area.height >= TOLD_FROM { MOST_TOLD } else { 0 });
    // Keep the height of the summary while rows are read, so that the table does not move.
    let height = u16::try_from(told.len()).unwrap_or(0);
    let below = Rect { y: area.y + height, height: area.height - height, ..area };
    let cell = cell(app).filter(|_| at.large);
    if let Some(row) = cell.and_then(|place| shown.get(place)) {
        let known = if row.guessed { ", no mode of its own" } else { "" };
        let text = format!("n_d {}{known}: Enter selects it", row.nodal_diameters);
        told = lines(&text, Role::Focus);
    }
    told.truncate(usize::from(height));
    lines_above(app, buffer, area, &told);
    let drawn = Rows {
        table: rows(survey, &shown),
        cursor: [1, 1],
        cell: cell.map(|row| [0, row]),
        home,
        marked: None,
    };
    let used = drawn.draw(app, buffer, (at, below), |place, column| match shown.get(place) {
        Some(_) if column == 0 && place == home => look.style(Role::Focus),
        Some(row) if row.guessed => look.style(Role::Quiet),
        Some(row) if column == 1 && row.locks_at(now) => text_style(look, Verdict::Locked),
        _ => look.style(Role::Text),
    });
    // Notes follow the table if they fit below an empty row.
    let notes = lines(&notes(survey, &shown).join(" "), Role::Quiet);
    let top = height + used + 1;
    if usize::from(top) + notes.len() <= usize::from(area.height) {
        let area = Rect { y: area.y + top, height: area.height - top, ..area };
        lines_above(app, buffer, area, &notes);
    }
}

/// Returns the index of the row of the scene's own nodal diameters; 0 if there is none.
fn own(app: &App, rows: &[&SurveyRow]) -> usize {
    let own = app.scene.operation.nodal_diameters;
    rows.iter().position(|row| row.nodal_diameters == own).unwrap_or(0)
}

/// Returns the index of the row under the cursor, from the top; `None` without a cursor or rows.
fn cell(app: &App) -> Option<usize> {
    let [_, from_below] = app.cell_in(ViewId::Margins)?;
    shown(app).len().checked_sub(1 + from_below as usize)
}

fn survey(app: &App) -> Option<&Survey> {
    app.margins()?.0.survey.as_deref()
}

/// Returns the rows of the table.
fn shown(app: &App) -> Vec<&SurveyRow> {
    survey(app).map_or(Vec::new(), |survey| survey.shown(false))
}
