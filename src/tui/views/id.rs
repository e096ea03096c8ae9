//! The identifiers of the views, with their digits and words. What they draw is in the table of
//! `views`.

use rubscope_solver::scene::keys::CHARTS;

/// A view; the order is that of the digit keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewId {
    /// `u_c`, `u_s`, `alpha_c` and `alpha_s` against time.
    Response,
    /// The gap of every blade.
    Gaps,
    /// Multipliers of the locked motion against speed.
    Locked,
    /// The disk as a wheel, and the wave as a point in the frame of the blades.
    Frame,
    /// Verdicts over two knobs, by default speed and pulse.
    Map,
    /// Spectrum of the run, and the lines of the Campbell diagram.
    Spectrum,
    /// Computing time against error of every solver.
    Precision,
    /// Distance of the scene to every limit, and the parameters that matter most.
    Margins,
    /// Effect of the blade/casing coincidence during contact.
    Coincidence,
}

/// Every view in the order of the digit keys, with its description.
const VIEWS: [(ViewId, &str); CHARTS.len()] = [
    (ViewId::Response, "response"),
    (ViewId::Gaps, "gaps"),
    (ViewId::Locked, "locked motion"),
    (ViewId::Frame, "wheel, and the wave as the blades see it"),
    (ViewId::Map, "map of the verdict over two knobs"),
    (ViewId::Spectrum, "spectrum and Campbell lines"),
    (ViewId::Precision, "precision: speed against error"),
    (ViewId::Margins, "margins: how robust the run is, how far every limit is, what moves it"),
    (ViewId::Coincidence, "coincidence: how large a wave grows"),
];

impl ViewId {
    /// The charts of the overview, in the order of the screen; of the margins it has what ends the
    /// lock.
    pub const OVERVIEW: [Self; 4] = [Self::Response, Self::Gaps, Self::Locked, Self::Margins];

    pub fn all() -> impl Iterator<Item = Self> {
        VIEWS.iter().map(|(id, _)| *id)
    }

    /// Returns the word for the view in scene files, lessons and file names.
    pub fn word(self) -> &'static str {
        CHARTS[self as usize]
    }

    /// Returns the view of a word; `None` if no view has it.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::all().find(|view| view.word() == word)
    }

    pub fn digit(self) -> u8 {
        self as u8 + 1
    }

    /// Returns the description of the view, for the help.
    pub fn what(self) -> &'static str {
        VIEWS[self as usize].1
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
