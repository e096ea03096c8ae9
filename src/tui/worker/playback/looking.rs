//! What is computed again of the motion, from copies: the page on the screen, and the
//! instant of the reading cursor.

use super::Playback;
use crate::motion::Motion;
use crate::tui::worker::full_run::SLICE;

impl Playback {
    /// The latest motion by `t` that is known: a copy of the run ahead, or of the past.
    fn before(&self, t: f64) -> Option<Motion> {
        self.forecasts.before(t).or_else(|| self.copies.before(t, &self.motion))
    }

    /// Begins the page on the screen, once its zoom or its part of the run is another.
    pub(super) fn want_page(&mut self) {
        let (order, step) = (&self.order, self.order.scene.solver.step_s);
        let mut wanted = std::mem::take(&mut self.page);
        let end = self.forecasts.end();
        wanted.want(order.page, order.bin_s, (step, end), || self.before(order.page.0));
        self.page = wanted;
        if let Some(theirs) = &mut self.comparison {
            let mut wanted = std::mem::take(&mut theirs.page);
            let end = theirs.full_run.end();
            wanted.want(order.page, order.bin_s, (step, end), || theirs.before(order.page.0));
            theirs.page = wanted;
        }
    }

    /// Begins to compute the instant of the reading cursor.
    pub(super) fn read(&mut self) {
        let at = self.order.cursor_s;
        let from = at.and_then(|t| Some((t, self.before(t)?)));
        self.reading.begin(from);
        self.reading.go_on(self.time_limit.min(SLICE));
    }

    /// Whether the pages on the screen are computed.
    pub(super) fn pages_are_done(&self) -> bool {
        self.page.is_done() && self.comparison.as_ref().is_none_or(|theirs| theirs.page.is_done())
    }

    /// Computes a slice of the pages on the screen; false where the runs to the end, which
    /// take turns with them, come first.
    pub(super) fn compute_page(&mut self) -> bool {
        let theirs = self.comparison.as_mut().map(|theirs| &mut theirs.page);
        let mut pages = std::iter::once(&mut self.page).chain(theirs);
        let Some(page) = pages.find(|page| !page.is_done()) else { return false };
        // The page is another one after arriving.
        let first =
            self.going.is_none() && self.forecasts.wall().is_none_or(|wall| page.wall() <= wall);
        if first {
            page.compute();
        }
        first
    }
}
