//! The map from the keyboard: its law, its axes, the cell under the cursor and
//! the run that this opens.

use super::App;
use crate::scene::{CheckedScene, ContactLaw};
use crate::study::MapPlan;
use crate::tui::app::cell_of;
use crate::tui::knobs::{Knob, knob_of};
use crate::tui::views::ViewId;
use crate::tui::views::map::{MapAxis, here, numeric, value_text};

impl App {
    /// Makes a view the large one by a key. The map gives the arrows to its cell
    /// cursor at once.
    pub(super) fn walk(&mut self, view: ViewId) {
        self.show(view);
        if view == ViewId::Map && self.dialogue.is_closed() && !self.reading.is_on() {
            self.toggle_reading();
        }
    }

    /// The plan of the map.
    ///
    /// # Errors
    /// The scene has no such map; the reason in one line.
    pub fn map_plan(&self) -> Result<MapPlan, String> {
        self.map.plan(&self.scene)
    }

    /// The plan of the map on the screen: the last one, until a new one can be seen.
    pub fn shown_plan(&self) -> Option<MapPlan> {
        let shown = self.results().found.map.as_ref().map(|live| live.map.plan.clone());
        shown.or_else(|| self.map_plan().ok())
    }

    /// Column and row of the cell under the cursor.
    pub fn map_cell(&self) -> Option<[u32; 2]> {
        let cursor = self.cursor_in(ViewId::Map)?;
        let plan = self.shown_plan()?;
        Some([cell_of(cursor.across, plan.x.count), cell_of(cursor.up, plan.y.count)])
    }

    /// The contact law of the map.
    pub fn map_law(&self) -> ContactLaw {
        self.map.law.unwrap_or(self.scene.solver.contact)
    }

    pub(super) fn other_map_law(&mut self) {
        let law = self.map_law().other();
        self.map.law = Some(law).filter(|law| *law != self.scene.solver.contact);
        self.status = Some(match self.map_plan() {
            Ok(plan) => format!("the map: {law} law, {} solver", plan.scene.solver.kind),
            Err(reason) => format!("no map: {reason}"),
        });
    }

    /// Puts the next numeric knob on an axis.
    pub(super) fn next_map_axis(&mut self, up: bool) {
        if !self.is_large(ViewId::Map) {
            self.status = Some("X and Y choose the axes of the map (view 5)".into());
            return;
        }
        let (axis, other) =
            if up { (&mut self.map.y, self.map.x) } else { (&mut self.map.x, self.map.y) };
        let knobs: Vec<&Knob> = numeric().filter(|knob| knob.path != other.path).collect();
        let place = knobs.iter().position(|knob| knob.path == axis.path).map_or(0, |at| at + 1);
        let Some(knob) = knobs.get(place % knobs.len().max(1)) else { return };
        let anchor = knob.number(&self.scene).unwrap_or(0.0);
        *axis = MapAxis { path: knob.path, anchor };
        let place = if up { "up" } else { "across" };
        self.status = Some(match self.map_plan() {
            Ok(plan) => {
                let axis = if up { &plan.y } else { &plan.x };
                let [from, to] = [axis.from, axis.to].map(|end| value_text(&axis.path, end));
                format!("{place} the map: {}, {from} to {to}", knob.label)
            }
            Err(reason) => format!("no map over {}: {reason}", knob.label),
        });
        if self.reading.cursor().is_some()
            && let Ok(plan) = self.map_plan()
        {
            // The map on the screen is still the one before.
            self.reading.move_to(here(self, &plan));
        }
    }

    /// Opens a run of the map from its start, also where knobs act live: only
    /// then it has the verdict of its cell.
    pub(super) fn open_run(&mut self, scene: CheckedScene) {
        let opened = self.shown_plan().map(|plan| {
            let values = [&plan.x, &plan.y].map(|axis| {
                let text = |knob: &Knob| format!("{} {}", knob.label, knob.text(&scene));
                knob_of(&axis.path).map_or_else(String::new, text)
            });
            values.join(", ")
        });
        let law = scene.solver.contact;
        let live = self.knobs.is_live();
        self.knobs.set_live(false);
        if scene == self.scene {
            self.restart();
        } else {
            self.turn_to(scene);
        }
        self.knobs.set_live(live);
        self.status = opened.map(|values| format!("opened {values}, {law}; u undoes"));
    }
}
