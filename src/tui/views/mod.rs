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
use super::command::Command;
pub use id::ViewId;
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
}
