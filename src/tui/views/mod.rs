//! The views: one folder or file each, and the one table of them. To add a
//! view, write its file, add it to the two lists here, and add its word to
//! `CHARTS`, the words that a scene file may hold.

pub mod coincidence;
mod frame;
mod gaps;
pub mod locked;
pub mod map;
pub mod margins;
mod panel;
mod precision;
mod response;
pub mod spectrum;
mod table;

pub use panel::{LEAST_ROWS, Opening, ViewArea, ViewPanel};

use rubscope_solver::scene::keys::CHARTS;

/// Names a view, in the order of the digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewId {
    /// `u_c`, `u_s`, `alpha_c`, `alpha_s` against time.
    Response,
    /// The gap of every blade.
    Gaps,
    /// Multipliers of the locked motion against speed.
    Locked,
    /// The wave as a point in the frame of the blades, and the wheel.
    Frame,
    /// Verdicts over speed and pulse.
    Map,
    /// Spectrum of the run, and Campbell lines.
    Spectrum,
    /// Speed against error of every solver.
    Precision,
    /// How far the scene is from every limit, and what moves it.
    Margins,
    /// What the coincidence of blades and casing does while they touch.
    Coincidence,
}

/// The table of views.
const VIEWS: [(ViewId, &dyn ViewPanel); CHARTS.len()] = [
    (ViewId::Response, &response::ResponseView),
    (ViewId::Gaps, &gaps::GapsView),
    (ViewId::Locked, &locked::LockedView),
    (ViewId::Frame, &frame::FrameView),
    (ViewId::Map, &map::MapView),
    (ViewId::Spectrum, &spectrum::SpectrumView),
    (ViewId::Precision, &precision::PrecisionView),
    (ViewId::Margins, &margins::MarginsView),
    (ViewId::Coincidence, &coincidence::CoincidenceView),
];

impl ViewId {
    /// All views.
    pub fn all() -> impl Iterator<Item = Self> {
        VIEWS.iter().map(|(id, _)| *id)
    }

    /// What it draws and exports.
    pub fn panel(self) -> &'static dyn ViewPanel {
        VIEWS[self as usize].1
    }

    /// Its word in scene files, lessons and file names.
    pub fn word(self) -> &'static str {
        CHARTS[self as usize]
    }

    /// The view a word stands for.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::all().find(|view| view.word() == word)
    }

    /// The digit key that opens it.
    pub fn digit(self) -> u8 {
        self as u8 + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_view_stands_at_its_place_in_the_table() {
        for (place, view) in ViewId::all().enumerate() {
            assert_eq!(view as usize, place);
            assert_eq!(ViewId::from_word(CHARTS[place]), Some(view));
        }
    }
}
