//! View 5: the verdict over two knobs, one block or letter per run, with threshold speeds and the
//! current knobs as a cross. The cell under the cursor can be read and opened.

mod control;
mod picture;
pub use picture::{colour, sign};
pub mod plan;
mod words;

use ratatui::{buffer::Buffer, layout::Rect};

pub use words::value_text;

use super::panel::{ViewArea, ViewPanel, not_yet, title};
use crate::report::Sheet;
use crate::report::map::sheet;
use crate::report::table::WIDTH;
use crate::tui::app::{App, Cursor};
use crate::tui::command::Command;
use crate::tui::text::{pieces, print};
use crate::tui::theme::Role;
use plan::LiveMap;
use rubscope_solver::study::{Axis, MapPlan};
use words::Line;

/// Width from which the legend is a column beside the map.
const BESIDE_FROM: u16 = 92;
/// Width of the legend's column.
const BESIDE: u16 = 34;
/// Height from which there are two rows of text above the map.
const TWO_ROWS_FROM: u16 = 14;
/// Height from which there is one row of text above the map.
const ONE_ROW_FROM: u16 = 7;

/// The view of the verdict over two knobs.
pub struct MapView;

impl ViewPanel for MapView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let live = app.results().found.map.as_deref();
        let plan = app.map_plan();
        let entries = words::title(app, live, plan.as_ref().ok());
        let inside = title(app, buffer, at, "map", &entries);
        if let Err(reason) = plan {
            let text = format!("no map: {reason}");
            return print(buffer, inside, 1, &text, app.appearance.style(Role::Trouble));
        }
        let Some(live) = live else { return not_yet(app, buffer, inside) };
        let chart = explain(app, live, buffer, inside, at.large);
        picture::draw(app, live, buffer, chart, at);
    }

    fn grid(&self, app: &App) -> [u32; 2] {
        app.shown_plan().map_or([0, 0], |plan| [plan.x.count, plan.y.count])
    }

    fn here(&self, app: &App) -> Cursor {
        app.shown_plan().map_or(Cursor { across: 0.5, up: 0.5 }, |plan| here(app, &plan))
    }

    /// Opens the run of the cell under the cursor, with the map's law and solver. The cell of the
    /// scene keeps the scene's values, which may lie beside those of its middle.
    fn opening(&self, app: &App, _: Cursor) -> Option<Command> {
        let (plan, [column, row]) = (app.shown_plan()?, app.map_cell()?);
        let mut scene = plan.scene_of(plan.index(column, row)).ok()?;
        let is_in = |axis: &Axis, cell: u32| {
            (axis.place(picture::present(app, axis)) - f64::from(cell)).abs() <= 0.5
        };
        if is_in(&plan.x, column) && is_in(&plan.y, row) {
            let mut own = app.scene.clone().into_scene();
            own.solver = scene.solver.clone();
            scene = own.checked().ok()?;
        }
        Some(Command::OpenRun(Box::new(scene)))
    }

    fn sheet<'a>(&self, app: &'a App) -> Option<Sheet<'a>> {
        Some(sheet(&app.results().found.map.as_ref()?.map, WIDTH))
    }
}

/// Returns the centre of the map cell nearest to the current knobs.
pub fn here(app: &App, plan: &MapPlan) -> Cursor {
    let part = |axis: &Axis| {
        let count = f64::from(axis.count.max(1));
        let place = axis.place(picture::present(app, axis));
        let place = if place.is_finite() { place.round().clamp(0.0, count - 1.0) } else { 0.0 };
        (place + 0.5) / count
    };
    Cursor { across: part(&plan.x), up: part(&plan.y) }
}

/// Prints the legend and the cell under the cursor, beside the map or above it; returns the rest of
/// the area.
fn explain(app: &App, live: &LiveMap, buffer: &mut Buffer, inside: Rect, large: bool) -> Rect {
    let beside = large && inside.width >= BESIDE_FROM;
    let area = match beside {
        true => Rect { x: inside.right() - BESIDE + 1, width: BESIDE - 1, ..inside },
        false => Rect { x: inside.x + 1, width: inside.width.saturating_sub(1), ..inside },
    };
    let (width, reads) = (usize::from(area.width), large && app.map_cell().is_some());
    let lines: Vec<Line> = match inside.height {
        _ if beside => words::column(app, live, width),
        TWO_ROWS_FROM.. if large => vec![words::legend(app, live), words::row(app, live, width)],
        ONE_ROW_FROM.. if reads => vec![words::row(app, live, width)],
        ONE_ROW_FROM.. => vec![words::legend(app, live)],
        _ => Vec::new(),
    };
    let look = &app.appearance;
    for (row, line) in (0..area.height).zip(&lines) {
        let spelled = line.iter().map(|(text, style)| (look.spell(text), *style));
        pieces(buffer, area, row, &spelled.collect::<Vec<_>>());
    }
    if beside {
        return Rect { width: inside.width - BESIDE, ..inside };
    }
    let rows = u16::try_from(lines.len()).unwrap_or(0);
    Rect { y: inside.y + rows, height: inside.height.saturating_sub(rows), ..inside }
}
