//! The cursor: an instant of the run, which every panel shows instead of the motion as it plays,
//! and a place in the large chart, moved by keys or the mouse. What it reads there is up to the
//! view.

use super::App;
use crate::tui::views::id::ViewId;

/// A place in the large chart, as parts of its width from the left and of its
/// height from below, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cursor {
    /// Distance from the left.
    pub across: f64,
    /// Distance from below.
    pub up: f64,
}

/// One step of the cursor where the chart has no cells.
pub const STEP: f64 = 0.01;

/// Instant that is shown, and place that is read in the large chart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// The place.
    pub cursor: Option<Cursor>,
    /// Whether the arrows move it, not the knobs.
    pub on: bool,
    /// The instant, while time is paused there and not where the motion is \[s\].
    pub at_s: Option<f64>,
}

impl App {
    /// Returns the cursor in a view, while that is the large chart.
    pub fn cursor_in(&self, view: ViewId) -> Option<Cursor> {
        self.reading.cursor.filter(|_| self.is_large(view))
    }

    /// Removes the cursor: the motion is shown as it plays, and its page.
    pub fn stop_reading(&mut self) {
        (self.reading, self.play.middle_s) = (Reading::default(), None);
    }
}

/// Returns the cell of a part, 0 to 1, of a row of cells.
pub fn cell_of(part: f64, cells: u32) -> u32 {
    ((part * f64::from(cells)) as u32).min(cells.saturating_sub(1))
}
