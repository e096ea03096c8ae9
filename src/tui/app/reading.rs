//! The cursor: a time in the run, which every panel then shows instead of the playing motion, and a
//! position in the large chart. Each view decides what it reads at that position.

use super::App;
use crate::tui::views::id::ViewId;

/// A position in the large chart, as fractions 0 to 1 of its width and height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cursor {
    /// Fraction of the width, from the left.
    pub across: f64,
    /// Fraction of the height, from the bottom.
    pub up: f64,
}

/// Step of the cursor in charts without cells, as a fraction of the width or height.
pub const STEP: f64 = 0.01;

/// State of the cursor.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Position in the large chart; `None` if there is no cursor.
    pub cursor: Option<Cursor>,
    /// Whether the arrow keys move the cursor instead of turning and selecting knobs.
    pub on: bool,
    /// Time that all panels show \[s\]; `None` follows the playing motion.
    pub at_s: Option<f64>,
}

impl App {
    /// Returns the cursor; `None` if there is none, or `view` is not the large chart.
    pub fn cursor_in(&self, view: ViewId) -> Option<Cursor> {
        self.reading.cursor.filter(|_| self.is_large(view))
    }

    /// Removes the cursor, so that the page follows the motion again.
    pub fn stop_reading(&mut self) {
        (self.reading, self.play.middle_s) = (Reading::default(), None);
    }
}

/// Returns the index of the cell at the fraction `part`, 0 to 1, of a row of `cells` cells.
pub fn cell_of(part: f64, cells: u32) -> u32 {
    ((part * f64::from(cells)) as u32).min(cells.saturating_sub(1))
}
