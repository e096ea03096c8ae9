//! The views by their names: digits, words, and what each shows. What a view draws is in the
//! table of `views`.

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
    /// Margins of the scene to every limit, and the parameters that move them.
    Margins,
    /// Effect of the coincidence of blades and casing while they touch.
    Coincidence,
}

/// Every view in the order of the digits, and what it shows.
const VIEWS: [(ViewId, &str); CHARTS.len()] = [
    (ViewId::Response, "response"),
    (ViewId::Gaps, "gaps"),
    (ViewId::Locked, "locked motion"),
    (ViewId::Frame, "wheel, and the wave as the blades see it"),
    (ViewId::Map, "map of the verdict over two knobs"),
    (ViewId::Spectrum, "spectrum and Campbell lines"),
    (ViewId::Precision, "speed against error"),
    (ViewId::Margins, "margins: is it robust, how far is every limit, what moves it"),
    (ViewId::Coincidence, "coincidence: how large a wave becomes"),
];

impl ViewId {
    /// Returns all views.
    pub fn all() -> impl Iterator<Item = Self> {
        VIEWS.iter().map(|(id, _)| *id)
    }

    /// Returns its word in scene files, lessons and file names.
    pub fn word(self) -> &'static str {
        CHARTS[self as usize]
    }

    /// Returns the view a word stands for.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::all().find(|view| view.word() == word)
    }

    /// Returns the digit key that opens it.
    pub fn digit(self) -> u8 {
        self as u8 + 1
    }

    /// Returns what it shows, for the help.
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
