//! The map and the margins: their axes and law, and what Enter opens.

use crate::report::number::rounded;
use crate::tui::app::App;
use crate::tui::axis::number;
use crate::tui::knobs::{Knob, knob_of, place_of};
use crate::tui::views::id::ViewId;
use crate::tui::views::map::plan::MapAxis;
use crate::tui::views::map::{here, value_text};
use crate::tui::views::margins::DIGITS;
use rubscope_solver::scene::{Allowed, CheckedScene, Value};
use rubscope_solver::study::Axis;

impl App {
    /// Makes a view the large one at the user's request. The map then gives the arrow keys to its
    /// cell cursor.
    pub(super) fn walk(&mut self, view: ViewId) {
        self.show(view);
        if view == ViewId::Map && self.dialogue.is_closed() && !self.reading.on {
            self.toggle_reading();
        }
    }

    pub(super) fn other_map_law(&mut self) {
        let law = self.map_law().other();
        self.map.law = Some(law).filter(|law| *law != self.scene.solver.contact);
        self.status = Some(match self.map_plan() {
            Ok(plan) => format!("the map: {law} law, {} solver", plan.scene.solver.kind),
            Err(reason) => format!("no map: {reason}"),
        });
    }

    /// Puts knobs on the axes of the map and shows it. If the knob is already on the other axis,
    /// the two axes are swapped.
    pub(super) fn put_axes(&mut self, [across, up]: [Option<&'static str>; 2]) {
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
    pub(super) fn open_run(&mut self, scene: CheckedScene) {
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

    /// Switches between the survey over all nodal diameters and the margins of one; from another
    /// view it opens the survey.
    pub(super) fn turn_survey(&mut self) {
        self.show_survey(!(self.is_large(ViewId::Margins) && self.layout.survey));
    }

    /// Shows the survey over all nodal diameters, or the margins of one.
    pub(super) fn show_survey(&mut self, on: bool) {
        let said = self.layout.turn_survey(on);
        self.stop_reading();
        self.walk(ViewId::Margins);
        self.status = Some(said);
    }

    /// Sets a knob exactly to a limit and selects it.
    pub(super) fn jump_to_limit(&mut self, path: &str, value: f64, to: &str) {
        let Some((place, knob)) = place_of(path).zip(knob_of(path)) else { return };
        self.knobs.select(place);
        let value_of = match knob.allowed() {
            Allowed::Whole { .. } => Value::Whole(value as u64),
            _ => Value::Real(value),
        };
        if self.set(knob, value_of) {
            let name = knob.label.split(' ').next().unwrap_or(knob.label);
            let jumped = format!("{name} {}: {to}", number(rounded(value, DIGITS), knob.unit()));
            // Keep the message about other effects of the turn.
            let more = self.status.take().map_or(String::new(), |said| format!("; {said}"));
            self.status = Some(jumped + &more);
        }
    }
}
