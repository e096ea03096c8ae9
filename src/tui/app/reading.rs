//! The reading cursor: a place in the large chart, moved by keys or the mouse.
//! What it reads there is up to the view.

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

/// Place and instant that are read in the large chart.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// The reading cursor.
    pub cursor: Option<Cursor>,
    /// Whether the arrows move it, not the knobs.
    pub on: bool,
    /// The instant that it reads, where it was put in a chart over time \[s\].
    pub at_s: Option<f64>,
}

impl Reading {
    /// Returns whether there is something to leave.
    pub fn is_open(&self) -> bool {
        self.on || self.cursor.is_some()
    }

    /// Stops reading.
    pub fn stop(&mut self) {
        *self = Self::default();
    }
}

impl App {
    /// Returns the cursor in a view, while that is the large chart.
    pub fn cursor_in(&self, view: ViewId) -> Option<Cursor> {
        self.reading.cursor.filter(|_| self.is_large(view))
    }

    /// Returns the instant that is read: that of the cursor in the chart over time where it was
    /// last \[s\].
    pub fn cursor_time(&self) -> Option<f64> {
        self.reading.at_s.filter(|_| self.reading.cursor.is_some())
    }

    /// Stops reading.
    pub fn stop_reading(&mut self) {
        self.reading.stop();
    }
}

/// Returns the cell of a part, 0 to 1, of a row of cells.
pub fn cell_of(part: f64, cells: u32) -> u32 {
    ((part * f64::from(cells)) as u32).min(cells.saturating_sub(1))
}
