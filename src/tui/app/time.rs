//! Slow motion and pages of time: a page takes about four seconds to fill,
//! at any rate, then a new one starts.

use super::App;
use crate::tui::axis::nice_step;

/// Simulated time per wall-clock time, from 1e-5 to 1.
pub const RATES: &[f64] =
    &[1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 0.1, 0.2, 0.5, 1.0];

/// Five milliseconds of motion per second.
pub(super) const FIRST_RATE: usize = 8;

/// Wall-clock seconds a page takes to fill.
const PAGE_SECONDS: f64 = 4.0;

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

    pub(super) fn page_number(&self) -> i64 {
        // A page that has just become full is shown full.
        ((self.now() / self.page_s()) - 1e-9).floor().max(0.0) as i64
    }

    /// Part of the page that is behind the motion, 0 to 1.
    pub fn part_of_page(&self) -> f64 {
        let (from, to) = self.page();
        ((self.now() - from) / (to - from)).clamp(0.0, 1.0)
    }

    /// Goes a page back, or forward, as far as the forecast.
    pub(super) fn pan(&mut self, back: bool) {
        let last = (self.end_s() / self.page_s() - 1e-9).floor().max(0.0) as i64;
        let now = self.page_number();
        let pages = self.pages_back + if back { 1 } else { -1 };
        self.pages_back = pages.clamp((now - last).min(0), now);
    }

    /// The rate in words: `1/200 of real time`.
    pub fn rate_text(&self) -> String {
        let rate = self.rate();
        if rate >= 1.0 { "real time".into() } else { format!("1/{:.0}", 1.0 / rate) }
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
    fn pages_grow_with_the_rate_and_shrink_with_the_zoom() {
        for pair in RATES.windows(2) {
            assert!(page_length(pair[1], 0) > page_length(pair[0], 0));
        }
        for zoom in -MOST_ZOOM..MOST_ZOOM {
            assert!(page_length(5e-3, zoom + 1) < page_length(5e-3, zoom));
        }
    }
}
