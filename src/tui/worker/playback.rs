//! The engine without clock or thread: it applies orders, plays the film, and makes snapshots.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::films::Films;
use crate::tui::engine::{Limit, Move, Order, SLICE, Snapshot};
use crate::tui::film::{
    Head, PER_TURN, Reached, Turned, longest_sample, next_change, rate_at, sample_length,
};
use crate::tui::trace::{Mark, Marks};
use crate::tui::views::id::ViewId;

/// Largest turn of the wave relative to the blades in the next part of a sample \[rad\]: as much as
/// that of a free wave in a whole sample, because a wave of small amplitude may turn faster.
const TURN: f64 = std::f64::consts::TAU / PER_TURN;
/// Parts of a sample in which the turn of the wave is followed.
const FINER: f64 = 8.0;
/// Longest wall-clock time of one call of `play` in the explorer.
pub const PLAY_TIME: Duration = Duration::from_millis(25);
/// Most wall-clock time that one tick makes up for, for example after a suspension.
const LONGEST_TICK: Duration = Duration::from_millis(100);
/// Longest wall-clock time of a jump; a second key press continues from there.
const JUMP_LIMIT: Duration = Duration::from_secs(1);

/// The films of an order, and the instant that is shown.
#[derive(Debug)]
pub struct Playback {
    order: Order,
    /// The films and the studies.
    pub films: Films,
    head: Head,
    /// Simulated time played to \[s\].
    t: f64,
    /// Time to go to once the film is computed so far \[s\]; `None` if there is none.
    going: Option<f64>,
    /// Whether the head is on the instant to be shown.
    is_there: bool,
    /// Number of the last move made.
    moved: u64,
    /// Number of the last jump, and the change of contact that it met; `None` if it met none.
    met: (u64, Option<Mark>),
    /// What kept the last call of `play` from reaching its target.
    limit: Limit,
    turned: Turned,
    reached: Reached,
    /// Longest wall-clock time of one call of `play`.
    time_limit: Duration,
}

impl Playback {
    /// Starts the film of an order, with a limit on the wall-clock time per call of `play`.
    pub fn new(order: Order, time_limit: Duration) -> Self {
        let films = Films::of(&order);
        let mut playback = Self {
            head: Head::of(&films.own),
            t: 0.0,
            going: None,
            is_there: order.cursor_s.is_none(),
            moved: 0,
            met: (0, None),
            limit: Limit::None,
            turned: Turned::default(),
            reached: Reached::default(),
            time_limit,
            films,
            order,
        };
        playback.make_moves();
        playback
    }

    /// Applies a newer order.
    pub fn apply(&mut self, order: &Order) {
        let before = std::mem::replace(&mut self.order, order.clone());
        if self.films.want(order, &before.scene, &self.head.at) {
            if order.run == before.run {
                // The instant shown stays until the next move.
                self.head.at = self.films.own.ahead.clone();
            } else {
                self.head = Head::of(&self.films.own);
            }
            self.going = self.going.or(Some(self.t));
        }
        if (order.rate, order.playing) != (before.rate, before.playing) {
            self.reached = Reached::default();
        }
        self.is_there &= order.cursor_s == before.cursor_s;
        self.make_moves();
    }

    /// Makes the moves that can be made now, but at most one jump.
    fn make_moves(&mut self) {
        loop {
            let next = self.order.moves.after(self.moved);
            if let Some((_, Move::To(t))) = next {
                self.going = Some(t);
            }
            let arrived = self.arrive();
            let Some((number, to)) = next.filter(|_| arrived) else { return };
            self.moved = number;
            match to {
                Move::To(_) => {}
                Move::Step => self.step(),
                Move::NextChange => return self.jump(number),
            }
        }
    }

    /// Puts the head on the instant to be shown, once the film is computed so far; a film that
    /// failed or was given up ends earlier. Returns whether it is there.
    fn arrive(&mut self) -> bool {
        let film = &self.films.own;
        let is_known = |t: f64| film.reach() >= t || film.is_done();
        if let Some(wanted) = self.going.filter(|wanted| is_known(*wanted)) {
            self.t = wanted.min(film.reach());
            (self.going, self.is_there) = (None, false);
        }
        let shown = self.order.cursor_s.unwrap_or(self.t);
        if self.going.is_none() && !self.is_there && is_known(shown) {
            let (began, limit) = (Instant::now(), self.time_limit.min(SLICE));
            let until = shown.min(film.reach());
            self.is_there = self.head.seek(film, until, &|| began.elapsed() < limit);
            self.turned = Turned::default();
            if self.order.cursor_s.is_none() && self.head.at.motion.failure().is_some() {
                self.t = self.t.min(self.head.at.motion.t_s());
            }
        }
        self.going.is_none() && self.is_there
    }

    /// Takes one time step, or one sample if the solver has no steps.
    fn step(&mut self) {
        let (motion, end) = (&self.head.at.motion, self.films.own.plan.end_s);
        let now = motion.t_s();
        // Half a step more, because round-off could leave the motion where it is.
        let until = match motion.steps() {
            Some(_) => now + 1.5 * self.order.scene.solver.step_s,
            None => now + sample_length(motion, self.order.page),
        };
        let (began, limit) = (Instant::now(), self.time_limit);
        self.head.play(until.min(end), &|| began.elapsed() < limit);
        self.t = self.head.at.motion.t_s();
        self.head.show();
    }

    /// Moves to the next change of contact, if one comes soon.
    fn jump(&mut self, number: u64) {
        let (began, limit) = (Instant::now(), self.time_limit.max(JUMP_LIMIT));
        let go_on = || began.elapsed() < limit;
        self.met = (number, None);
        if let Some(until) = next_change(&self.head.at, self.films.own.plan.end_s, &go_on) {
            let mut marks = Marks::from(self.head.at.motion.contacts());
            self.head.play(until, &go_on);
            // The step of the change, which may be a round-off later.
            self.t = self.head.at.motion.t_s();
            self.head.show();
            marks.look(self.head.at.motion.contacts());
            self.met.1 = marks.seen.last().copied();
        }
    }

    /// Reports that a frame was drawn: the wave may turn further.
    pub fn drawn(&mut self) {
        self.turned.drawn();
    }

    /// Plays what is due after `wall`: at the requested rate, slower near changes of contact if
    /// wanted, and never so far that a turning picture could not be followed. Returns whether the
    /// motion advanced.
    pub fn play_paced(&mut self, wall: Duration) -> bool {
        let due = wall.min(LONGEST_TICK).as_secs_f64();
        let (now, rate) = (self.t, self.order.rate);
        let rate = match self.order.slow_at_events {
            true => rate_at(now, rate, self.films.own.marks()),
            false => rate,
        };
        let turns = self.order.shows(ViewId::Frame) || self.order.shows(ViewId::Gaps);
        self.play(due * rate, turns);
        let played = self.t - now;
        self.reached.add(wall.as_secs_f64(), played);
        played != 0.0
    }

    /// Plays `seconds` of simulated time, or less if the solver is too slow; if a picture `turns` with
    /// the wave, never so far that it could not be followed.
    pub fn play(&mut self, seconds: f64, turns: bool) {
        self.limit = Limit::None;
        if !self.arrive() || self.order.cursor_s.is_some() {
            return;
        }
        let film = &self.films.own;
        let (began, limit) = (Instant::now(), self.time_limit);
        let go_on = || began.elapsed() < limit;
        let target = (self.t + seconds).min(film.plan.end_s);
        let (before, longest) = (self.t, longest_sample(&self.head.at.motion));
        let sample = if turns { longest / FINER } else { longest };
        while self.t < target {
            if turns && self.turned.must_wait(TURN) {
                self.limit = Limit::Wave;
                break;
            }
            let next = (self.t + sample).min(target);
            if next > film.reach() || !go_on() {
                self.limit = Limit::Solver;
                break;
            }
            if !self.head.play(next, &go_on) {
                self.t = self.head.at.motion.t_s().max(self.t);
                break;
            }
            self.t = next;
            let state = self.head.at.motion.state();
            self.turned.follow(&self.head.at.motion, &state);
        }
        if self.t > before {
            self.head.show();
        }
    }

    /// Returns whether the playback has come to the end of a film that was given up: it is computed
    /// as far as it is watched.
    fn is_starved(&self) -> bool {
        let film = &self.films.own;
        let is_given_up = film.is_done() && film.result.is_none();
        self.order.playing && self.limit == Limit::Solver && is_given_up
    }

    /// Returns whether anything is left to compute.
    pub fn is_computing(&self) -> bool {
        self.going.is_some()
            || !self.is_there
            || self.order.moves.after(self.moved).is_some()
            || self.is_starved()
            || self.films.is_computing(&self.order)
    }

    /// Computes for one slice of wall-clock time.
    pub fn compute(&mut self) {
        self.make_moves();
        if self.is_starved() {
            self.films.own.compute();
        }
        self.films.compute(&self.order);
    }

    /// Returns the instant shown and the results.
    pub fn snapshot(&mut self) -> Snapshot {
        let mut results = self.films.results(&self.order);
        results.pace.limit = self.limit;
        results.pace.reached = self.reached.rate();
        Snapshot {
            number: self.order.number,
            run: self.order.run,
            t_s: self.t,
            moment: Some(Arc::clone(&self.head.moment)),
            moved: self.moved,
            met: self.met,
            results,
            trouble: None,
        }
    }
}

#[cfg(test)]
#[path = "playback_tests.rs"]
mod tests;
