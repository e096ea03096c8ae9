//! The views: one file or folder each, and the table of them. To add a view, write its file, add it
//! here and to the table in `id`, and add its word to `CHARTS`.

mod chart;
mod frame;
mod gaps;
pub mod id;
pub mod map;
pub mod margins;
mod panel;
mod precision;
mod response;
pub mod spectrum;
pub mod steady;
mod table;

pub use panel::{ViewArea, ViewPanel};

use super::app::App;
use super::app::reading::cell_of;
use super::command::Command;
pub use id::ViewId;
use margins::COLUMNS;
use rubscope_solver::scene::keys::CHARTS;

/// The views in the order of their digits.
const VIEWS: [(ViewId, &dyn ViewPanel); CHARTS.len()] = [
    (ViewId::Response, &response::ResponseView),
    (ViewId::Gaps, &gaps::GapsView),
    (ViewId::Locked, &steady::locked::LockedView),
    (ViewId::Frame, &frame::FrameView),
    (ViewId::Map, &map::MapView),
    (ViewId::Spectrum, &spectrum::SpectrumView),
    (ViewId::Precision, &precision::PrecisionView),
    (ViewId::Margins, &margins::MarginsView),
    (ViewId::Coincidence, &steady::coincidence::CoincidenceView),
];

impl ViewId {
    /// Returns the implementation of the view.
    pub fn panel(self) -> &'static dyn ViewPanel {
        VIEWS[self as usize].1
    }
}

impl App {
    /// Returns the implementation of the large view.
    pub fn panel(&self) -> &'static dyn ViewPanel {
        self.view().panel()
    }

    /// Returns the command of Enter at the cursor; `None` without a cursor, and if the large view
    /// has nothing to open there.
    pub fn opening(&self) -> Option<Command> {
        self.panel().opening(self, self.reading.cursor?)
    }

    /// Returns column and row of the margins under the cursor; row 0 is at the top. `None` without
    /// a cursor in the margins, and until there are margins.
    pub fn margins_cell(&self) -> Option<[usize; 2]> {
        let cursor = self.cursor_in(ViewId::Margins)?;
        let rows =
            u32::try_from(self.margins()?.0.margins.limits.len()).ok().filter(|rows| *rows > 0)?;
        let row = rows - 1 - cell_of(cursor.up, rows);
        Some([cell_of(cursor.across, COLUMNS), row].map(|cell| cell as usize))
    }
}
