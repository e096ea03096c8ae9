//! The axes and the law of the map: its plan, the cell under the cursor, and what keys do with them.

use super::plan::{MapAxis, MapChoice};
use super::{here, value_text};
use crate::tui::app::App;
use crate::tui::app::reading::cell_of;
use crate::tui::knobs::{Knob, knob_of};
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::{CheckedScene, ContactLaw};
use rubscope_solver::study::{Axis, MapPlan};

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
