//! Slow motion and pages of time: a page takes about four seconds to fill,
//! at any rate, then a new one starts.

use super::App;
use crate::tui::axis::nice_step;
use crate::tui::bindings::Action;
use crate::tui::engine::PageRecord;
use crate::tui::history::{Bin, BinHistory};
use rubscope_solver::scene::Scene;

/// Simulated time per wall-clock time, from 1e-5 to 1.
pub const RATES: &[f64] =
    &[1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 0.1, 0.2, 0.5, 1.0];

/// Five milliseconds of motion per second.
const FIRST_RATE: usize = 8;

/// Wall-clock seconds a page takes to fill.
const PAGE_SECONDS: f64 = 4.0;

/// Least rate that is called real time.
const REAL: f64 = 0.95;

/// Wall time that somebody watches a run, at most: the first page of a longer one is all of it
/// \[s\].
const WATCHED: f64 = 120.0;

/// Zoom steps in either direction.
const MOST_ZOOM: i32 = 12;

/// Returns the length of a page at a rate and a zoom, a round number \[s\].
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

/// Returns where a scene begins to play \[s\].
pub fn begin_s(scene: &Scene) -> f64 {
    scene.view.begin_s.min(scene.solver.end_s)
}

/// Playing, and the page of time.
#[derive(Clone, Debug, Default)]
pub struct Play {
    /// Whether time passes.
    pub playing: bool,
    /// Place in `RATES`.
    pub rate: usize,
    /// Page length relative to the usual one, in steps of about two.
    pub zoom: i32,
    /// Whether the motion slows down at changes of contact and hurries between.
    pub slow_at_events: bool,
    /// Instant in the middle of the page, where that is not the one that fills \[s\].
    pub middle_s: Option<f64>,
    /// Instant to which the motion goes at once \[s\].
    pub go_to_s: f64,
    pub goes: u64,
    pub steps: u64,
    pub jumps: u64,
    pub extensions: u64,
    /// Whether it stopped because the run has come to its end.
    stopped_by_end: bool,
    /// The page of the last snapshot.
    pub page: i64,
    /// Latest jump whose result was reported.
    met: u64,
    /// Number of times that the end of the run was reported.
    ends: u64,
}

/// Rate of play on the screen, to be restored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tempo {
    pub rate: usize,
    pub zoom: i32,
    pub slow_at_events: bool,
}

impl Play {
    /// Creates the state of playing a scene from where it begins.
    pub fn of(scene: &Scene) -> Self {
        let (playing, slow_at_events, go_to_s) = (true, true, begin_s(scene));
        let mut play =
            Self { playing, rate: FIRST_RATE, slow_at_events, go_to_s, ..Self::default() };
        play.open(scene);
        play
    }

    /// Shows the first page of a scene: the whole run, where nobody watches it to its end.
    pub fn open(&mut self, scene: &Scene) {
        let end = scene.solver.end_s;
        self.zoom = if end > WATCHED * self.rate() { self.zoom_for(end) } else { 0 };
    }

    /// Carries out an action on playing; returns the message, if there is one.
    pub fn act(&mut self, action: Action) -> Option<String> {
        match action {
            Action::Pause => {
                self.playing = !self.playing;
                self.stopped_by_end = false;
                // Told more often than gone on: the motion waits at the end.
                if self.playing {
                    self.extensions = self.extensions.max(self.ends);
                }
            }
            Action::Step => (self.playing, self.steps) = (false, self.steps + 1),
            Action::Jump => (self.playing, self.jumps) = (false, self.jumps + 1),
            Action::SlowAtEvents => {
                self.slow_at_events = !self.slow_at_events;
                return Some(match self.slow_at_events {
                    true => "slower at changes of contact, faster between".into(),
                    false => "the same pace all the time".to_string(),
                });
            }
            Action::Slower => self.rate = self.rate.saturating_sub(1),
            Action::Faster => self.rate = (self.rate + 1).min(RATES.len() - 1),
            _ => {}
        }
        None
    }

    /// Stops time by hand.
    pub fn pause(&mut self) {
        (self.playing, self.stopped_by_end) = (false, false);
    }

    /// Resets what belongs to the former run.
    pub fn restart(&mut self, go_to_s: f64) {
        self.playing |= std::mem::take(&mut self.stopped_by_end);
        (self.page, self.go_to_s) = (0, go_to_s);
        (self.ends, self.extensions) = (0, 0);
        // Nobody waits for a jump of the motion before.
        self.met = self.jumps;
    }

    /// Returns how fast time passes on the screen.
    pub fn tempo(&self) -> Tempo {
        Tempo { rate: self.rate, zoom: self.zoom, slow_at_events: self.slow_at_events }
    }

    /// Slows down at changes of contact, on pages of this length at least, or of the usual one
    /// \[s\].
    pub fn show_closely(&mut self, page_s: Option<f64>) {
        self.slow_at_events = true;
        self.zoom = page_s.map_or(0, |length| self.zoom_for(length));
    }

    /// Returns whether this snapshot is the first with the result of the latest jump.
    pub fn is_met(&mut self, jumps: u64) -> bool {
        let is_new = jumps == self.jumps && jumps > self.met;
        if is_new {
            self.met = jumps;
        }
        is_new
    }

    /// Stops where the run has come to its end once more; whether time passed until then.
    pub fn stop_at_end(&mut self, ends: u64) -> bool {
        let is_new = ends > self.ends;
        if is_new {
            self.ends = ends;
            self.stopped_by_end = std::mem::take(&mut self.playing);
        }
        is_new && self.stopped_by_end
    }

    /// Returns the motion per wall-clock time.
    fn rate(&self) -> f64 {
        RATES.get(self.rate).copied().unwrap_or(5e-3)
    }

    /// Returns the zoom at which a page is as long as this, or a little longer.
    fn zoom_for(&self, length: f64) -> i32 {
        let mut all = (-MOST_ZOOM..=MOST_ZOOM).rev();
        let long = |zoom: &i32| page_length(self.rate(), *zoom) >= length * (1.0 - 1e-9);
        all.find(long).unwrap_or(-MOST_ZOOM)
    }
}

impl App {
    /// Returns the motion per wall-clock time.
    pub fn rate(&self) -> f64 {
        self.play.rate()
    }

    /// Returns the length of a page, at most that of the run \[s\].
    pub fn page_s(&self) -> f64 {
        page_length(self.rate(), self.play.zoom).min(self.end_s())
    }

    /// Returns the instant that is shown: that of the cursor, or how far the motion is \[s\].
    pub fn now(&self) -> f64 {
        self.reading.at_s.unwrap_or(self.played_s())
    }

    /// Returns how far the motion is \[s\].
    pub fn played_s(&self) -> f64 {
        self.moment().map_or(0.0, |moment| moment.state.t_s)
    }

    /// Returns the end of the forecast \[s\].
    pub fn end_s(&self) -> f64 {
        let end = self.results().end_s;
        if end > 0.0 { end } else { self.scene.solver.end_s }
    }

    /// Returns the page that is shown, from and to \[s\].
    pub fn page(&self) -> (f64, f64) {
        let length = self.page_s();
        let start = match self.play.middle_s {
            Some(middle) => (middle - 0.5 * length).min(self.end_s() - length).max(0.0),
            None => self.page_number() as f64 * length,
        };
        (start, start + length)
    }

    /// Returns the instant in the middle of the page \[s\].
    pub fn middle_s(&self) -> f64 {
        let (from, to) = self.page();
        0.5 * (from + to)
    }

    /// Returns the record of the page that is shown: computed again at its zoom, with what is to
    /// come, or until that is done what was played at a zoom like it.
    pub fn record(&self) -> &[Bin] {
        self.recorded(self.results().page.as_deref(), &self.run.history)
    }

    /// Returns a record of the page that is shown, or what was played of it.
    pub fn recorded<'a>(&self, page: Option<&'a PageRecord>, played: &'a BinHistory) -> &'a [Bin] {
        let (from, to) = self.page();
        match page.filter(|known| known.page == (from, to)) {
            Some(known) => known.record.between(from, to),
            None => played.fine_between(from, to),
        }
    }

    /// Returns the bins of a record that are behind motion and cursor, and those ahead of both.
    pub fn past_and_future<'a>(&self, record: &'a [Bin]) -> (&'a [Bin], &'a [Bin]) {
        let known = self.known_s();
        record.split_at(record.partition_point(|bin| bin.from < known))
    }

    /// Returns the later one of cursor and motion: from there on the run is still to come \[s\].
    pub fn known_s(&self) -> f64 {
        self.played_s().max(self.now())
    }

    /// Returns the page of the motion: one that has just become full is shown full.
    pub fn page_number(&self) -> i64 {
        // The last step may pass the end of the run.
        let pages = self.played_s().min(self.end_s()) / self.page_s();
        (pages - 1e-9).floor().max(0.0) as i64
    }

    /// Returns the part of the page that is before the instant that is shown, 0 to 1.
    pub fn part_of_page(&self) -> f64 {
        let (from, to) = self.page();
        ((self.now() - from) / (to - from)).clamp(0.0, 1.0)
    }

    /// Changes the length of the page. The cursor, or where time is paused, is in its middle, and
    /// no page leaves the run.
    pub fn zoom(&mut self, action: Action) {
        let middle = self.reading.at_s.or(self.play.middle_s);
        let middle = middle.or((!self.play.playing).then(|| self.played_s()));
        let whole = page_length(self.rate(), self.play.zoom) >= self.end_s();
        (self.play.zoom, self.play.middle_s) = match action {
            Action::ZoomIn => ((self.play.zoom + 1).min(MOST_ZOOM), middle),
            Action::ZoomOut if whole => return,
            Action::ZoomOut => ((self.play.zoom - 1).max(-MOST_ZOOM), middle),
            _ => (0, self.reading.at_s),
        };
    }

    /// Returns the rate that is reached, in words: `200x slower` than real time; while nothing
    /// plays the one that is asked for.
    pub fn rate_text(&self) -> String {
        let rate = if self.play.playing { self.results().pace.reached } else { Some(self.rate()) };
        let Some(rate) = rate else { return self.appearance.ellipsis().into() };
        match rate {
            rate if rate >= REAL => "real time".into(),
            // Two digits: the pace is not the same all the time.
            rate => {
                let times = 1.0 / rate;
                let unit = 10f64.powf(times.log10().floor() - 1.0).max(1.0);
                format!("{:.0}x slower", (times / unit).round() * unit)
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
    fn at_the_end_of_the_run_time_stops_once_and_goes_on_when_asked() {
        let mut play = Play::of(&Scene::base());
        assert!(play.stop_at_end(1) && !play.playing && !play.stop_at_end(1));
        play.act(Action::Pause);
        assert_eq!((play.playing, play.extensions), (true, 1));
        assert!(play.stop_at_end(2));
        // Another run plays again, but not where the user has stopped it.
        play.restart(0.0);
        assert!(play.playing && play.extensions == 0);
        play.act(Action::Step);
        play.restart(0.0);
        assert!(!play.playing && play.steps == 1);
        play.act(Action::Jump);
        assert!(play.is_met(1) && !play.is_met(1));
        play.act(Action::Jump);
        play.restart(0.0);
        assert!(!play.is_met(2), "nobody waits for a jump of the motion before");
    }

    #[test]
    fn the_rate_in_words_is_the_one_that_is_reached() {
        let scene = rubscope_solver::scene::Scene::base().checked().unwrap();
        let mut app = App::new(scene, crate::tui::Theme::Mono, crate::tui::Marker::Ascii);
        // Not known yet: what was asked for is no answer.
        assert_eq!(app.rate_text(), "..");
        for (rate, text) in
            [(1.0 / 83.4, "83x slower"), (1.0 / 1234.0, "1200x slower"), (0.97, "real time")]
        {
            app.run.latest.results.pace.reached = Some(rate);
            assert_eq!(app.rate_text(), text);
        }
        // While nothing plays there is only the one that is asked for.
        app.play.playing = false;
        assert_eq!(app.rate_text(), "200x slower");
    }

    #[test]
    fn a_last_step_that_passes_the_end_stays_on_the_last_page() {
        let scene = rubscope_solver::scene::Scene::base().checked().unwrap();
        let mut app = App::new(scene, crate::tui::Theme::Mono, crate::tui::Marker::Ascii);
        let mut moment =
            crate::tui::engine::Moment::of(&rubscope_solver::motion::Motion::new(&app.scene));
        moment.state.t_s = app.end_s() + 1e-6;
        app.run.latest.moment = Some(moment);
        let (from, to) = app.page();
        assert!(from < app.end_s() && (to - app.end_s()).abs() < 1e-12, "{from} {to}");
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
