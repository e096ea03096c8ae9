//! Playback in slow motion, and pages of time. A page takes about four seconds to fill at any rate;
//! then a new one starts.

use super::model::{App, Play, Tempo};
use crate::sheet::number::rounded;
use crate::tui::command::Command;
use crate::tui::engine::{Move, PageRecord};
use crate::tui::history::{Bin, between, fine_between};
use rubscope_solver::scene::Scene;

/// The slowest rate of playback and the first one, as places of [`round_number`]: simulated time over
/// wall-clock time. The fastest is real time, place 0.
pub const SLOWEST: i32 = -15;
const FIRST_RATE: i32 = -7;

/// A page at zoom 0 is so many places longer than the rate: it takes four or five seconds to fill.
const PAGE: i32 = 2;

/// Rates from here on are called real time.
const REAL: f64 = 0.95;

/// A run that would play longer than this is shown whole on its first page \[wall-clock s\].
const WATCHED: f64 = 120.0;

/// Largest zoom, in or out.
const MOST_ZOOM: i32 = 12;

/// Returns the number at a place of the sequence ..., 0.5, 1, 2, 5, 10, ...; place 0 is 1.
fn round_number(place: i32) -> f64 {
    let digit = match place.rem_euclid(3) {
        0 => 1,
        1 => 2,
        _ => 5,
    };
    // Parsing gives the double nearest to the decimal number; a product would not.
    format!("{digit}e{}", place.div_euclid(3)).parse().unwrap_or(1.0)
}

/// Returns the time at which a scene starts to play \[s\].
pub fn begin_s(scene: &Scene) -> f64 {
    scene.view.begin_s.min(scene.solver.end_s)
}

impl Play {
    /// Creates the playback of a scene, playing from its start.
    pub fn of(scene: &Scene) -> Self {
        let tempo = Tempo { rate: FIRST_RATE, zoom: 0, slow_at_events: true };
        let mut play = Self { playing: true, tempo, ..Self::default() };
        play.open(scene);
        play.restart(begin_s(scene));
        play
    }

    /// Sets the zoom for a scene's first page: the whole run if nobody would watch it to the end.
    pub fn open(&mut self, scene: &Scene) {
        let end = scene.solver.end_s;
        self.tempo.zoom = if end > WATCHED * self.rate() { self.zoom_for(end) } else { 0 };
    }

    /// Pauses at the user's request, so that a restart does not resume.
    pub fn pause(&mut self) {
        (self.playing, self.stopped_by_end) = (false, false);
    }

    /// Goes to the time at which a new run begins \[s\]; resumes if only the end of the run before
    /// had stopped playback.
    pub fn restart(&mut self, begin_s: f64) {
        self.playing |= std::mem::take(&mut self.stopped_by_end);
        // A jump requested in the previous run needs no answer.
        self.jump = None;
        self.moves.push(Move::To(begin_s));
    }

    /// Returns simulated time over wall-clock time.
    pub fn rate(&self) -> f64 {
        round_number(self.tempo.rate)
    }

    /// Returns the length of a page at this zoom, in a run of any length \[s\].
    fn page_length(&self, zoom: i32) -> f64 {
        round_number(self.tempo.rate + PAGE - zoom)
    }

    /// Returns the largest zoom whose page is at least `length` seconds long, or the smallest zoom
    /// if no page is.
    pub fn zoom_for(&self, length: f64) -> i32 {
        let mut all = (-MOST_ZOOM..=MOST_ZOOM).rev();
        let long = |zoom: &i32| self.page_length(*zoom) >= length * (1.0 - 1e-9);
        all.find(long).unwrap_or(-MOST_ZOOM)
    }
}

impl App {
    /// Returns the length of a page, limited to the run \[s\].
    pub fn page_s(&self) -> f64 {
        self.play.page_length(self.play.tempo.zoom).min(self.end_s())
    }

    /// Returns the time shown: that of the cursor, or of the playing motion \[s\].
    pub fn now(&self) -> f64 {
        self.reading.at_s.unwrap_or(self.played_s())
    }

    /// Returns the time played to, or to which the motion is going \[s\]; 0 before the first
    /// snapshot.
    pub fn played_s(&self) -> f64 {
        self.play.moves.target().unwrap_or(self.run.latest.t_s)
    }

    /// Returns the end of the run, with extensions \[s\].
    pub fn end_s(&self) -> f64 {
        self.run.film.end_s
    }

    /// Returns whether the run is played to its end.
    pub fn is_at_end(&self) -> bool {
        self.play.moves.is_empty() && self.played_s() >= self.end_s()
    }

    /// Returns start and end of the page on the screen \[s\].
    pub fn page(&self) -> (f64, f64) {
        let length = self.page_s();
        let start = match self.play.middle_s {
            Some(middle) => (middle - 0.5 * length).min(self.end_s() - length).max(0.0),
            None => self.page_number() as f64 * length,
        };
        (start, start + length)
    }

    /// Returns the centre of the page \[s\].
    pub fn middle_s(&self) -> f64 {
        let (from, to) = self.page();
        0.5 * (from + to)
    }

    /// Returns the curves of the page on the screen, including the future.
    pub fn record(&self) -> &[Bin] {
        self.recorded(self.results().page.as_deref())
    }

    /// Returns the bins of the page on the screen. Of an earlier page they are those that both have
    /// in common, if they are fine enough.
    pub fn recorded<'a>(&self, page: Option<&'a PageRecord>) -> &'a [Bin] {
        let (from, to) = self.page();
        match page {
            Some(known) if known.page == (from, to) => between(&known.bins, from, to),
            Some(known) => fine_between(&known.bins, from, to),
            None => &[],
        }
    }

    /// Splits a record at [`Self::known_s`].
    pub fn past_and_future<'a>(&self, record: &'a [Bin]) -> (&'a [Bin], &'a [Bin]) {
        let known = self.known_s();
        record.split_at(record.partition_point(|bin| bin.from < known))
    }

    /// Returns the later of cursor and motion: what comes after it is drawn as the future \[s\].
    pub fn known_s(&self) -> f64 {
        self.played_s().max(self.now())
    }

    /// Returns the number of the page that the motion is on, from 0. A page that is exactly full is
    /// still the current one.
    pub fn page_number(&self) -> i64 {
        // The last step may go past the end of the run.
        let pages = self.played_s().min(self.end_s()) / self.page_s();
        (pages - 1e-9).floor().max(0.0) as i64
    }

    /// Returns the part of the page before the time shown, 0 to 1.
    pub fn part_of_page(&self) -> f64 {
        let (from, to) = self.page();
        ((self.now() - from) / (to - from)).clamp(0.0, 1.0)
    }

    /// Changes the zoom. The page is centred on the cursor or the paused motion; it never extends
    /// past the run.
    pub fn zoom(&mut self, command: Command) {
        let middle = self.reading.at_s.or(self.play.middle_s);
        let middle = middle.or((!self.play.playing).then(|| self.played_s()));
        let whole = self.play.page_length(self.play.tempo.zoom) >= self.end_s();
        (self.play.tempo.zoom, self.play.middle_s) = match command {
            Command::ZoomIn => ((self.play.tempo.zoom + 1).min(MOST_ZOOM), middle),
            Command::ZoomOut if whole => return,
            Command::ZoomOut => ((self.play.tempo.zoom - 1).max(-MOST_ZOOM), middle),
            Command::Page(Some(length)) => (self.play.zoom_for(length), self.reading.at_s),
            _ => (0, self.reading.at_s),
        };
    }

    /// Plays on or pauses, or moves by a step or to the next change of contact, from the time
    /// shown. At the end of the run, playing on continues it.
    pub fn go_on(&mut self, command: &Command) {
        self.depart();
        let was_playing = std::mem::take(&mut self.play.playing);
        match command {
            Command::Step => _ = self.play.moves.push(Move::Step),
            Command::Jump => {
                // Playback has passed the first impact before a hand can press the next key.
                if let Some(begin) = self.play.begun_s.take() {
                    self.play.moves.push(Move::To(begin));
                }
                self.play.jump = Some(self.play.moves.push(Move::NextChange));
            }
            _ => (self.play.playing, self.play.stopped_by_end) = (!was_playing, false),
        }
        if self.play.playing && self.is_at_end() {
            self.run.extend();
        }
    }

    /// Moves the page by its own length, within the run.
    pub fn pan(&mut self, back: bool) {
        let by = if back { -self.page_s() } else { self.page_s() };
        self.play.middle_s = Some(self.middle_s() + by);
        let (from, to) = self.page();
        if self.reading.at_s.is_none() && (from..to).contains(&self.played_s()) {
            self.play.middle_s = None;
        }
    }

    /// Returns the rate as text, e.g. `200x slower`: the rate reached, or, while paused, the one
    /// requested.
    pub fn rate_text(&self) -> String {
        let rate =
            if self.play.playing { self.results().pace.reached } else { Some(self.play.rate()) };
        let Some(rate) = rate else { return self.appearance.ellipsis().into() };
        match rate {
            rate if rate >= REAL => "real time".into(),
            // Two digits are enough, because the pace fluctuates.
            rate => format!("{:.0}x slower", rounded(1.0 / rate, 2)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_restart_resumes_unless_the_user_had_paused_and_needs_no_answer_to_a_jump() {
        let mut play = Play::of(&Scene::base());
        (play.playing, play.stopped_by_end) = (false, true);
        play.restart(0.0);
        assert!(play.playing);
        play.pause();
        play.restart(0.0);
        assert!(!play.playing);
        play.jump = Some(play.moves.push(Move::NextChange));
        play.restart(0.0);
        assert_eq!(play.jump, None, "nobody waits for a jump of the motion before");
    }

    #[test]
    fn the_rate_in_words_is_the_one_that_is_reached() {
        let scene = rubscope_solver::scene::Scene::base().checked().unwrap();
        let mut app = App::new(scene, crate::tui::Theme::Mono, crate::tui::Marker::Ascii);
        // The rate reached is not known yet.
        assert_eq!(app.rate_text(), "..");
        for (rate, text) in
            [(1.0 / 83.4, "83x slower"), (1.0 / 1234.0, "1200x slower"), (0.97, "real time")]
        {
            app.run.latest.results.pace.reached = Some(rate);
            assert_eq!(app.rate_text(), text);
        }
        // While paused, the requested rate is shown.
        app.play.playing = false;
        assert_eq!(app.rate_text(), "200x slower");
    }
}
