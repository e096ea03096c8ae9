//! View 5: the verdict over two knobs, one block or letter per run, with threshold speeds and the
//! current knobs as a cross. The cell under the cursor can be read and opened. Its axes and its law
//! are chosen here.

mod picture;
pub use picture::{colour, text_style};
pub mod plan;
mod words;

use ratatui::{buffer::Buffer, layout::Rect};

use super::panel::{ViewArea, ViewPanel, cursor_at, message, not_yet, title};
use crate::sheet::Sheet;
use crate::sheet::map::sheet;
use crate::sheet::table::WIDTH;
use crate::tui::app::{App, Cursor};
use crate::tui::command::Command;
use crate::tui::knobs::{Knob, knob_of};
use crate::tui::text::pieces;
use crate::tui::theme::Role;
use crate::tui::views::id::ViewId;
use plan::{LiveMap, MapAxis, MapChoice};
use rubscope_solver::scene::{CheckedScene, ContactLaw};
use rubscope_solver::study::{Axis, MapPlan};
use words::{Line, value_text};

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
        if let Err(reason) = plan {
            let text = format!("no map: {reason}");
            return message(app, buffer, at, ("map", &entries), (&text, Role::Trouble));
        }
        let Some(live) = live else {
            return message(app, buffer, at, ("map", &entries), not_yet(app));
        };
        let inside = title(app, buffer, at, "map", &entries);
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
        let (plan, [column, row]) = (app.shown_plan()?, app.cell_in(ViewId::Map)?);
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
fn here(app: &App, plan: &MapPlan) -> Cursor {
    // A place that is not a number becomes cell 0.
    let cell = |axis: &Axis| axis.place(picture::present(app, axis)).round() as u32;
    cursor_at([cell(&plan.x), cell(&plan.y)], [plan.x.count, plan.y.count])
}

/// Prints the legend and the cell under the cursor, beside the map or above it; returns the rest of
/// the area.
fn explain(app: &App, live: &LiveMap, buffer: &mut Buffer, inside: Rect, large: bool) -> Rect {
    let beside = large && inside.width >= BESIDE_FROM;
    let area = match beside {
        true => Rect { x: inside.right() - BESIDE + 1, width: BESIDE - 1, ..inside },
        false => Rect { x: inside.x + 1, width: inside.width.saturating_sub(1), ..inside },
    };
    let (width, reads) = (usize::from(area.width), large && app.cell_in(ViewId::Map).is_some());
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

impl App {
    /// Builds the plan of the map from the chosen axes and the scene.
    ///
    /// # Errors
    /// One line that says why the scene has no such map.
    pub fn map_plan(&self) -> Result<MapPlan, String> {
        self.map_choice().plan(&self.scene)
    }

    /// Returns the chosen axes and law of the map, with the speed unit of the screen.
    pub fn map_choice(&self) -> MapChoice {
        MapChoice { rpm: self.appearance.rpm, ..self.map }
    }

    /// Returns the plan of the map on the screen, which is the previous map until a new one covers
    /// it. `None` if there is no map yet and the scene allows none.
    pub fn shown_plan(&self) -> Option<MapPlan> {
        let shown = self.results().found.map.as_ref().map(|live| live.map.plan.clone());
        shown.or_else(|| self.map_plan().ok())
    }

    /// Returns the contact law of the map: the chosen one, or that of the scene.
    pub fn map_law(&self) -> ContactLaw {
        self.map.law.unwrap_or(self.scene.solver.contact)
    }

    /// Makes the map one of the other contact law, or of the scene's again.
    pub fn other_map_law(&mut self) {
        let law = self.map_law().other();
        self.map.law = Some(law).filter(|law| *law != self.scene.solver.contact);
        self.status = Some(match self.map_plan() {
            Ok(plan) => format!("the map: {law} law, {} solver", plan.scene.solver.kind),
            Err(reason) => format!("no map: {reason}"),
        });
    }

    /// Puts knobs on the axes of the map and shows it. If the knob is already on the other axis,
    /// the two axes are swapped.
    pub fn put_axes(&mut self, [across, up]: [Option<&'static str>; 2]) {
        let axis = |path: &'static str| {
            let anchor = knob_of(path).and_then(|knob| knob.number(&self.scene)).unwrap_or(0.0);
            MapAxis { path, anchor }
        };
        let (before, mut map) = (self.map, self.map);
        map.x = across.map_or(before.x, axis);
        map.y = up.map_or(before.y, axis);
        if map.x.path == map.y.path {
            match across {
                Some(_) => map.y = before.x,
                None => map.x = before.y,
            }
        }
        self.map = map;
        self.walk(ViewId::Map);
        let plan = self.map_plan();
        self.status = Some(match &plan {
            Ok(plan) => {
                let named = |axis: &Axis| {
                    let label = knob_of(&axis.path).map_or(axis.path.as_str(), |knob| knob.label);
                    let [from, to] = [axis.from, axis.to].map(|end| value_text(&axis.path, end));
                    format!("{label} {from} to {to}")
                };
                format!("the map: {} across, {} up", named(&plan.x), named(&plan.y))
            }
            Err(reason) => format!("no such map: {reason}"),
        });
        if let (Some(_), Ok(plan)) = (self.reading.cursor, plan) {
            // The map on the screen is still the previous one, so place the cursor by the new plan.
            self.reading.cursor = Some(here(self, &plan));
        }
    }

    /// Opens the run of a map cell. It always restarts, also in live mode, because only a run from
    /// the start has the verdict of its cell.
    pub fn open_run(&mut self, scene: CheckedScene) {
        let opened = self.shown_plan().map(|plan| {
            let values = [&plan.x, &plan.y].map(|axis| {
                let text = |knob: &Knob| format!("{} {}", knob.label, knob.text(&scene));
                knob_of(&axis.path).map_or_else(String::new, text)
            });
            values.join(", ")
        });
        let law = scene.solver.contact;
        let live = self.knobs.live;
        self.knobs.live = false;
        if scene == self.scene {
            self.restart();
        } else {
            self.turn_to(scene);
        }
        self.knobs.live = live;
        self.status = opened.map(|values| format!("opened {values}, {law}; u undoes"));
    }
}
