//! The spectrum of the full run. Studies run after it, so its samples are complete unless it was
//! given up.

use std::sync::Arc;

use super::study::{Given, Study};
use crate::tui::views::id::ViewId;
use crate::tui::views::spectrum::lines::Spectrum;

/// Computes the spectrum of the casing's motion in the full run.
#[derive(Debug)]
pub struct SpectrumStudy;

impl Study for SpectrumStudy {
    /// Number of the film.
    type Key = u64;
    type Found = Spectrum;
    type Job = Arc<Spectrum>;
    const VIEW: ViewId = ViewId::Spectrum;
    const STAYS: bool = false;

    fn key(given: &Given) -> Option<u64> {
        let shown = given.order.shows(ViewId::Spectrum);
        shown.then_some(given.order.number)
    }

    fn begin(_: &u64, given: &Given) -> Self::Job {
        let length = given.order.scene.solver.end_s;
        Arc::new(Spectrum::of(&given.run.signal(), length))
    }
}
