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

impl App {
    /// Returns the implementation of a view.
    pub fn panel_of(&self, view: ViewId) -> &'static dyn ViewPanel {
        match view {
            ViewId::Margins if self.layout.survey => &margins::SurveyView,
            view => VIEWS[view as usize].1,
        }
    }

    /// Returns the implementation of the large view.
    pub fn panel(&self) -> &'static dyn ViewPanel {
        self.panel_of(self.view())
    }

    /// Returns column and row of the cell under the cursor, both from 0, row 0 at the bottom.
    /// `None` without cells, and if the cursor is not in the view.
    pub fn cell_in(&self, view: ViewId) -> Option<[u32; 2]> {
        let (cursor, [across, up]) = (self.cursor_in(view)?, self.panel_of(view).grid(self));
        (across > 0).then(|| [cell_of(cursor.across, across), cell_of(cursor.up, up)])
    }

    /// Returns the command of Enter at the cursor; `None` without a cursor, and if the large view
    /// has nothing to open there.
    pub fn opening(&self) -> Option<Command> {
        self.panel().opening(self, self.reading.cursor?)
    }
}
