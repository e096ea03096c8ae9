//! Slow motion and pages of time: a page takes about four seconds to fill,
//! at any rate, then a new one starts.

use super::App;
use crate::tui::axis::{instant, nice_step, readable};
use crate::tui::engine::PageRecord;
use crate::tui::history::{Bin, BinHistory};

/// Simulated time per wall-clock time, from 1e-5 to 1.
pub const RATES: &[f64] =
    &[1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 0.1, 0.2, 0.5, 1.0];

/// Five milliseconds of motion per second.
pub(super) const FIRST_RATE: usize = 8;

/// Wall-clock seconds a page takes to fill.
const PAGE_SECONDS: f64 = 4.0;

/// From this rate on it is real time, to two digits.
const REAL: f64 = 0.95;

/// Zoom steps in either direction.
pub(super) const MOST_ZOOM: i32 = 12;

/// Length of a page at a rate and a zoom, a round number \[s\].
pub fn page_length(rate: f64, zoom: i32) -> f64 {
    let usual = nice_step(PAGE_SECONDS * rate, 1).unwrap_or(PAGE_SECONDS * rate);
    // Every zoom step is one place in the sequence 1, 2, 5, 10, 20, 50, ...
    let power = (usual.log10() + 1e-9).floor();
    let digit = match usual / 10f64.powf(power) {
        x if x < 1.5 => 0,
        x if x < 3.5 => 1,
        _ => 2,
    };
    let place = 3 * power as i32 + digit - zoom;
    let mantissa = ["1", "2", "5"].get(place.rem_euclid(3) as usize).copied().unwrap_or("1");
    // Text gives the double nearest to the decimal number.
    format!("{mantissa}e{}", place.div_euclid(3)).parse().unwrap_or(usual)
}

impl App {
    /// Motion per wall-clock time.
    pub fn rate(&self) -> f64 {
        RATES.get(self.rate).copied().unwrap_or(5e-3)
    }

    /// Length of a page \[s\].
    pub fn page_s(&self) -> f64 {
        page_length(self.rate(), self.zoom)
    }

    /// The zoom at which a page is as long as this, or a little longer.
    pub(super) fn zoom_for(&self, length: f64) -> i32 {
        let mut all = (-MOST_ZOOM..=MOST_ZOOM).rev();
        let long = |zoom: &i32| page_length(self.rate(), *zoom) >= length * (1.0 - 1e-9);
        all.find(long).unwrap_or(-MOST_ZOOM)
    }

    /// Motion time now \[s\].
    pub fn now(&self) -> f64 {
        self.latest.moment.as_ref().map_or(0.0, |moment| moment.state.t_s)
    }

    /// The end of the forecast \[s\].
    pub fn end_s(&self) -> f64 {
        let end = self.latest.results.end_s;
        if end > 0.0 { end } else { self.scene.solver.end_s }
    }

    /// The page that is shown, from and to \[s\].
    pub fn page(&self) -> (f64, f64) {
        let length = self.page_s();
        let number = (self.page_number() - self.pages_back).max(0);
        let start = number as f64 * length;
        (start, start + length)
    }

    /// The record of the page that is shown: computed again at its zoom, with what is to
    /// come, or until that is done what was played at a zoom like it.
    pub fn record(&self) -> &[Bin] {
        self.recorded(self.latest.results.page.as_deref(), &self.history)
    }

    /// The same under the other contact law.
    pub fn comparison_record(&self) -> &[Bin] {
        let results = &self.latest.results;
        self.recorded(results.comparison_page.as_deref(), &self.comparison_history)
    }

    fn recorded<'a>(&self, page: Option<&'a PageRecord>, played: &'a BinHistory) -> &'a [Bin] {
        let (from, to) = self.page();
        match page.filter(|known| known.page == (from, to)) {
            Some(known) => known.record.between(from, to),
            None => played.fine_between(from, to),
        }
    }

    /// The bins of a record that are behind the motion, and those ahead of it.
    pub fn past_and_future<'a>(&self, record: &'a [Bin]) -> (&'a [Bin], &'a [Bin]) {
        let now = self.now();
        record.split_at(record.partition_point(|bin| bin.from < now))
    }

    pub(super) fn page_number(&self) -> i64 {
        self.page_of(self.now())
    }

    /// The page of an instant: one that has just become full is shown full.
    fn page_of(&self, t: f64) -> i64 {
        (t / self.page_s() - 1e-9).floor().max(0.0) as i64
    }

    /// Part of the page that is before the instant that is read, or now, 0 to 1.
    pub fn part_of_page(&self) -> f64 {
        let (from, to) = self.page();
        ((self.read_s.unwrap_or(self.now()) - from) / (to - from)).clamp(0.0, 1.0)
    }

    /// Where the scene begins to play \[s\].
    pub(super) fn begin_s(&self) -> f64 {
        self.scene.view.begin_s.min(self.scene.solver.end_s)
    }

    /// Goes to an instant: what is read, while a chart is read, otherwise the motion, which
    /// begins again where that is behind.
    pub(super) fn go_to(&mut self, t: f64) {
        let end = self.end_s();
        if !(0.0..=end).contains(&t) {
            let end = readable(end, "s");
            self.status =
                Some(format!("t = {}: from 0 to {end}, the end of the run", readable(t, "s")));
            return;
        }
        if self.reading {
            self.read_s = Some(t);
            let page = self.page_of(t);
            self.pages_back = self.page_number() - page;
            self.cursor = Some(self.view.panel().here(self));
            return;
        }
        if t < self.now() {
            self.restart();
        }
        (self.go_to_s, self.pages_back) = (t, 0);
        self.counters.goes += 1;
        self.status = Some(format!("on to {}", instant(t)));
    }

    /// Goes a page back, or forward, as far as the forecast.
    pub(super) fn pan(&mut self, back: bool) {
        let last = self.page_of(self.end_s());
        let now = self.page_number();
        let pages = self.pages_back + if back { 1 } else { -1 };
        self.pages_back = pages.clamp((now - last).min(0), now);
    }

    /// The rate that is reached, or until that is known the one that is asked for, in words:
    /// `1/200` of real time.
    pub fn rate_text(&self) -> String {
        let reached = self.latest.results.pace.reached.filter(|_| self.playing);
        match reached.unwrap_or(self.rate()) {
            rate if rate >= REAL => "real time".into(),
            // Two digits: the pace is not the same all the time.
            rate => {
                let times = 1.0 / rate;
                let unit = 10f64.powf(times.log10().floor() - 1.0).max(1.0);
                format!("1/{:.0}", (times / unit).round() * unit)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_page_is_twenty_milliseconds_at_five_a_second() {
        assert_eq!(RATES[FIRST_RATE], 5e-3);
        assert_eq!(page_length(5e-3, 0), 0.02);
        assert_eq!((RATES[0], RATES[RATES.len() - 1]), (1e-5, 1.0));
    }

    #[test]
    fn the_rate_in_words_is_the_one_that_is_reached() {
        let scene = crate::scene::Scene::base().checked().unwrap();
        let mut app = App::new(scene, crate::tui::Theme::Mono, crate::tui::Marker::Ascii);
        assert_eq!(app.rate_text(), "1/200");
        for (rate, text) in [(1.0 / 83.4, "1/83"), (1.0 / 1234.0, "1/1200"), (0.97, "real time")] {
            app.latest.results.pace.reached = Some(rate);
            assert_eq!(app.rate_text(), text);
        }
        // While nothing plays there is only the one that is asked for.
        app.playing = false;
        assert_eq!(app.rate_text(), "1/200");
    }

    #[test]
    fn pages_grow_with_the_rate_and_shrink_with_the_zoom() {
        for pair in RATES.windows(2) {
            assert!(page_length(pair[1], 0) > page_length(pair[0], 0));
        }
        for zoom in -MOST_ZOOM..MOST_ZOOM {
            assert!(page_length(5e-3, zoom + 1) < page_length(5e-3, zoom));
        }
    }
}
