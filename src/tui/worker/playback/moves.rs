//! Moves that are not played at the rate: a step, a jump to the next change of contact, and a
//! go-to. Also what is recomputed from copies of the motion: the page on the screen and the time of
//! the cursor.

use std::time::{Duration, Instant};

use crate::tui::engine::Order;
use crate::tui::trace::Marks;
use crate::tui::worker::full_run::SLICE;
use crate::tui::worker::jump::{met, next_change};
use crate::tui::worker::page::{longest_sample, next_sample};
use crate::tui::worker::playback::Playback;
use crate::tui::worker::recorder::Recorder;
use rubscope_solver::motion::Motion;

/// Largest number of samples recorded during a jump.
const JUMP_SAMPLES: f64 = 20_000.0;
/// Longest wall-clock time of a jump; a second key press continues from there.
pub(super) const JUMP_LIMIT: Duration = Duration::from_secs(1);

impl Playback {
    /// Executes the steps and jumps requested since the order `before`, at most 1000 steps and 10
    /// jumps; postponed while a go-to is under way.
    pub(super) fn owe(&mut self, before: &Order) {
        let Self { order, owed: [steps, jumps], .. } = self;
        *steps += order.steps.saturating_sub(before.steps).min(1000);
        *jumps += order.jumps.saturating_sub(before.jumps).min(10);
        self.met.0 = before.jumps;
        if self.going.is_some() {
            return;
        }
        let [steps, jumps] = std::mem::take(&mut self.owed);
        (0..steps).for_each(|_| self.step());
        (0..jumps).for_each(|_| self.jump());
        self.met.0 = self.order.jumps;
    }

    /// Takes one time step, or one sample if the solver has no steps.
    pub(super) fn step(&mut self) {
        let step = match self.motion.steps() {
            Some(_) => self.order.scene.solver.step_s,
            None => self.sample_length(),
        };
        let (began, limit) = (Instant::now(), self.time_limit);
        let until = self.motion.t_s() + step;
        let step = self.order.scene.solver.step_s;
        _ = next_sample(&mut self.motion, until, step, &|| began.elapsed() < limit);
        self.record();
        self.target = self.motion.t_s();
        self.play_comparison(self.time_limit);
    }

    /// Plays to the next change of contact, if one comes soon.
    pub(super) fn jump(&mut self) {
        let (began, limit) = (Instant::now(), self.time_limit.max(JUMP_LIMIT));
        let go_on = || began.elapsed() < limit;
        let marks = Marks::from(self.motion.contacts());
        let found = next_change(&self.motion, longest_sample(&self.motion), &go_on);
        if let Some(until) = found {
            let length = until - self.motion.t_s();
            let sample = self.sample_length().max(length / JUMP_SAMPLES);
            while self.motion.t_s() < until {
                let now = self.motion.t_s();
                let (next, step) = ((now + sample).min(until), self.order.scene.solver.step_s);
                let moved = next_sample(&mut self.motion, next, step, &go_on).is_ok();
                self.record();
                // The explicit solver may already be at its last step before `until`.
                if !moved || self.motion.t_s() <= now || !go_on() {
                    break;
                }
            }
        }
        self.met.1 = found.and_then(|_| met(marks, &self.motion));
        self.target = self.motion.t_s();
        if self.is_at_end() {
            self.forecast();
        }
        self.play_comparison(self.time_limit);
    }

    /// Continues a go-to; returns false while the full run has not reached the target, or without a
    /// go-to.
    pub(super) fn arrive(&mut self) -> bool {
        let Some(wanted) = self.going else { return false };
        let run = &self.forecasts.full_run;
        let reached = run.t_s();
        if reached < wanted && !run.is_done() {
            return false;
        }
        // A run that failed or was given up ends earlier.
        let until = wanted.min(reached);
        if let Some(ahead) = run.before(until)
            && ahead.t_s() > self.motion.t_s()
        {
            self.motion = ahead;
        }
        let began = Instant::now();
        let go_on = || began.elapsed() < self.time_limit.min(SLICE);
        if self.motion.advance_while(until, &go_on) == Ok(false) {
            return true;
        }
        (self.going, self.target) = (None, self.motion.t_s());
        // The recorder has nothing of the time in between; the page is recomputed anyway.
        self.recorder = Recorder::from(&self.motion);
        self.record();
        self.ends += u64::from(self.is_at_end());
        if let Some(theirs) = &mut self.comparison {
            theirs.go_to(until);
        }
        self.play_comparison(self.time_limit);
        self.owe(&self.order.clone());
        self.want_page();
        true
    }
}

impl Playback {
    /// Returns the latest known copy of the motion at or before `t` \[s\], from the full run or
    /// otherwise from the past; `None` if the copies of that time were dropped.
    fn before(&self, t: f64) -> Option<Motion> {
        self.forecasts.full_run.before(t).or_else(|| self.copies.before(t, &self.motion))
    }

    /// Requests the page on the screen, for both motions if there is a comparison.
    pub(super) fn want_page(&mut self) {
        let (order, step) = (&self.order, self.order.scene.solver.step_s);
        let mut wanted = std::mem::take(&mut self.page);
        let end = self.forecasts.full_run.end();
        wanted.want(order.page, order.bin_s, (step, end), || self.before(order.page.0));
        self.page = wanted;
        if let Some(theirs) = &mut self.comparison {
            let mut wanted = std::mem::take(&mut theirs.page);
            let end = theirs.full_run.end();
            wanted.want(order.page, order.bin_s, (step, end), || theirs.before(order.page.0));
            theirs.page = wanted;
        }
    }

    /// Starts to compute the state at the time of the cursor.
    pub(super) fn read(&mut self) {
        let at = self.order.cursor_s;
        let from = at.and_then(|t| Some((t, self.before(t)?)));
        self.reading.begin(from);
        self.reading.go_on(self.time_limit.min(SLICE));
    }

    /// Returns whether the pages on the screen are complete.
    pub(super) fn pages_are_done(&self) -> bool {
        self.page.is_done() && self.comparison.as_ref().is_none_or(|theirs| theirs.page.is_done())
    }

    /// Computes a slice of the pages; returns false if the full runs, with which they alternate,
    /// come first.
    pub(super) fn compute_page(&mut self) -> bool {
        let theirs = self.comparison.as_mut().map(|theirs| &mut theirs.page);
        let mut pages = std::iter::once(&mut self.page).chain(theirs);
        let Some(page) = pages.find(|page| !page.is_done()) else { return false };
        // After a go-to the page will be another one. Otherwise a page gets a third of the time.
        let run = &self.forecasts.full_run;
        let first = self.going.is_none() && (run.is_done() || 2 * page.wall() < run.wall());
        if first {
            page.compute();
        }
        first
    }
}
