//! The margins on the screen, the survey in their place, and the jump to a limit.

use super::DIGITS;
use super::live::LiveMargins;
use crate::report::number::{rounded, speed_unit};
use crate::tui::app::App;
use crate::tui::axis::number;
use crate::tui::knobs::{knob_of, place_of};
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::{Allowed, Value};

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

impl App {
    /// Switches between the survey over all nodal diameters and the margins of one; from another
    /// view it opens the survey.
    pub fn turn_survey(&mut self) {
        self.show_survey(!(self.is_large(ViewId::Margins) && self.layout.survey));
    }

    /// Shows the survey over all nodal diameters, or the margins of one.
    pub fn show_survey(&mut self, on: bool) {
        self.layout.survey = on;
        let ends = if speed_unit() == "rpm" { "2000:6000" } else { "200:600" };
        self.stop_reading();
        self.walk(ViewId::Margins);
        self.status = Some(match on {
            true => {
                format!("margins of all diameters; : range {ends} gives the speeds of a machine")
            }
            false => "margins of n_d alone".to_string(),
        });
    }

    /// Sets a knob exactly to a limit and selects it.
    pub fn jump_to_limit(&mut self, path: &str, value: f64, to: &str) {
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
