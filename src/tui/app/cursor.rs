//! The reading cursor: a place in the large chart, moved by keys or the mouse.
//! What it reads there is up to the view.

use super::App;
use crate::tui::views::Opening;

/// A place in the large chart, as parts of its width from the left and of its
/// height from below, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cursor {
    /// From the left.
    pub across: f64,
    /// From below.
    pub up: f64,
}

/// One step of the cursor where the chart has no cells, and a large one.
const STEP: f64 = 0.01;
const LARGE_STEP: f64 = 0.1;
/// Cells of a large step in a chart of cells.
const LARGE_CELLS: i64 = 5;

impl App {
    /// The instant under the reading cursor, where the large chart is over time
    /// \[s\].
    pub fn cursor_time(&self) -> Option<f64> {
        let (from, to) = self.page();
        let cursor = self.cursor.filter(|_| self.view.panel().is_over_time(self))?;
        Some(from + cursor.across * (to - from))
    }

    /// The arrows move the cursor from now on, or no longer.
    pub(super) fn toggle_reading(&mut self) {
        self.reading = !self.reading;
        self.cursor = match self.reading {
            true => self.cursor.or_else(|| Some(self.view.panel().here(self))),
            false => None,
        };
    }

    /// Moves the cursor by some steps; it appears where the motion is.
    pub(super) fn move_cursor(&mut self, right: i64, up: i64, coarse: bool) {
        let panel = self.view.panel();
        let cursor = self.cursor.unwrap_or_else(|| panel.here(self));
        let [across, high] = panel.grid(self);
        let moved = |part: f64, by: i64, cells: u32| match cells {
            0 => (part + by as f64 * if coarse { LARGE_STEP } else { STEP }).clamp(0.0, 1.0),
            cells => {
                let by = if coarse { by * LARGE_CELLS } else { by };
                let last = i64::from(cells) - 1;
                let cell = (cell_of(part, cells) as i64 + by).clamp(0, last);
                (cell as f64 + 0.5) / f64::from(cells)
            }
        };
        let (across, up) = (moved(cursor.across, right, across), moved(cursor.up, up, high));
        self.cursor = Some(Cursor { across, up });
    }

    /// Does what the large chart does at the cursor.
    pub(super) fn open_cursor(&mut self) {
        match self.opening() {
            None => {}
            Some(Opening::Run(scene)) => self.open_run(*scene),
            Some(Opening::Jump { path, value, to }) => self.jump_to_limit(path, value, &to),
            Some(Opening::Select(path)) => self.select_to_turn(path),
            Some(Opening::Nothing(reason)) => self.status = Some(reason),
        }
    }

    /// What Enter does at the reading cursor.
    pub fn opening(&self) -> Option<Opening> {
        self.view.panel().opening(self, self.cursor?)
    }
}

/// The cell of a part, 0 to 1, of a row of cells.
pub fn cell_of(part: f64, cells: u32) -> u32 {
    ((part * f64::from(cells)) as u32).min(cells.saturating_sub(1))
}
