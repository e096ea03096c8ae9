//! The plan of the map, and the margins on the screen.

use crate::tui::app::{App, cell_of};
use crate::tui::views::id::ViewId;
use crate::tui::views::map::plan::MapChoice;
use crate::tui::views::margins::live::LiveMargins;
use rubscope_solver::scene::ContactLaw;
use rubscope_solver::study::MapPlan;

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

    /// Returns column and row of the map cell under the cursor, both from 0, row 0 at the bottom.
    /// `None` without a map, and if the cursor is not in it.
    pub fn map_cell(&self) -> Option<[u32; 2]> {
        let cursor = self.cursor_in(ViewId::Map)?;
        let plan = self.shown_plan()?;
        Some([cell_of(cursor.across, plan.x.count), cell_of(cursor.up, plan.y.count)])
    }

    /// Returns the contact law of the map: the chosen one, or that of the scene.
    pub fn map_law(&self) -> ContactLaw {
        self.map.law.unwrap_or(self.scene.solver.contact)
    }
}

impl App {
    /// Returns the latest margins, and whether they are outdated (another scene or speed range);
    /// `None` if none were computed yet.
    pub fn margins(&self) -> Option<(&LiveMargins, bool)> {
        let live = self.results().found.margins.as_deref()?;
        let range = live.survey.as_ref().map(|survey| survey.range_rad_s);
        let other = range.is_some_and(|range| range != self.layout.range);
        Some((live, other || live.margins.scene != self.scene))
    }
}
