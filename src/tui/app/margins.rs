//! The margins from the keyboard: what Enter does at a limit and at a knob.

use super::App;
use crate::report::number::rounded;
use crate::scene::Value;
use crate::tui::app::cell_of;
use crate::tui::knobs::{knob_of, number, place_of};
use crate::tui::views::ViewId;
use crate::tui::views::margins::{COLUMNS, DIGITS, LiveMargins};

impl App {
    /// The margins on the screen, and whether they are of other knobs.
    pub fn margins(&self) -> Option<(&LiveMargins, bool)> {
        let live = self.results().found.margins.as_deref()?;
        Some((live, live.margins.scene != self.scene))
    }

    /// Column and row of the margins under the cursor; the first row is the upper one.
    pub fn margins_cell(&self) -> Option<[usize; 2]> {
        let cursor = self.cursor_in(ViewId::Margins)?;
        let rows = u32::try_from(self.margins()?.0.rows().len()).ok().filter(|rows| *rows > 0)?;
        let row = rows - 1 - cell_of(cursor.up, rows);
        Some([cell_of(cursor.across, COLUMNS), row].map(|cell| cell as usize))
    }

    /// Gives a knob exactly the value of a limit, and selects it to go on from there.
    pub(super) fn jump_to_limit(&mut self, path: &str, value: f64, to: &str) {
        let Some((place, knob)) = place_of(path).zip(knob_of(path)) else { return };
        self.knobs.select(place);
        if self.set(knob, Value::Real(value)) {
            let name = knob.label.split(' ').next().unwrap_or(knob.label);
            let jumped = format!("{name} {}: {to}", number(rounded(value, DIGITS), knob.unit()));
            // A message about what else the turn did stays.
            let more = self.status.take().map_or(String::new(), |said| format!("; {said}"));
            self.status = Some(jumped + &more);
        }
    }

    /// Selects a knob while a chart is read.
    pub(super) fn select_to_turn(&mut self, path: &str) {
        if self.select_path(path)
            && let Some(knob) = self.selected()
        {
            self.status = Some(format!("{} selected; i gives it the arrows", knob.label));
        }
    }
}
