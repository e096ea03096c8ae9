//! The state at the time of the cursor, computed in slices, so that neither the playback nor the
//! next order waits for it; and the copies of the motion from which any time of the run can be
//! recomputed exactly.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::tui::engine::Moment;
use rubscope_solver::motion::Motion;

/// The state at the time of the cursor.
#[derive(Debug, Default)]
pub struct Reading {
    done: Option<Arc<Moment>>,
    /// Time of the cursor \[s\], and the motion on its way there.
    under_way: Option<(f64, Motion)>,
}

impl Reading {
    /// Starts to compute the state at a time \[s\], from a motion at or before it. The previous
    /// state stays until the new one is complete; `None` removes it.
    pub fn begin(&mut self, from: Option<(f64, Motion)>) {
        if from.is_none() {
            self.done = None;
        }
        self.under_way = from;
    }

    /// Continues for at most `limit` of wall-clock time.
    pub fn go_on(&mut self, limit: Duration) {
        let Some((until, motion)) = &mut self.under_way else { return };
        let began = Instant::now();
        match motion.advance_while(*until, &|| began.elapsed() < limit) {
            Ok(true) => self.done = Some(Arc::new(Moment::of(motion))),
            Ok(false) => return,
            // A failed motion has no state to show.
            Err(_) => self.done = None,
        }
        self.under_way = None;
    }

    /// Returns whether no computation is under way.
    pub fn is_done(&self) -> bool {
        self.under_way.is_none()
    }

    /// Returns the latest complete state; `None` without a cursor, before the first state is
    /// complete, and if the motion failed on the way.
    pub fn moment(&self) -> Option<Arc<Moment>> {
        self.done.clone()
    }
}

/// Largest number of copies besides those at changes; beyond it, every second one is dropped.
const MOST: usize = 128;
/// Largest number of copies at changes.
const MOST_CHANGES: usize = 500;
/// Initial time between two copies, as a fraction of the length given to [`Copies::of`].
const PART: f64 = 1.0 / 64.0;

/// Copies of the motion at some times.
#[derive(Debug)]
pub struct Copies {
    /// In order of time; the flag marks copies made at a change of the motion.
    copies: Vec<(Motion, bool)>,
    /// Smallest time between a copy and the next, except at changes \[s\].
    spacing: f64,
}

impl Copies {
    /// Creates the copies for a motion of which the next `length` seconds matter.
    pub fn of(motion: &Motion, length: f64) -> Self {
        Self { copies: vec![(motion.clone(), true)], spacing: length * PART }
    }

    /// Adds a copy if the last one is at least the spacing earlier. If there are then too many, the
    /// spacing is doubled and the copies are thinned out.
    pub fn follow(&mut self, motion: &Motion) {
        let last = self.copies.last().map_or(f64::NEG_INFINITY, |(last, _)| last.t_s());
        if motion.t_s() - last < self.spacing {
            return;
        }
        self.copies.push((motion.clone(), false));
        if self.copies.iter().filter(|(_, changed)| !changed).count() > MOST {
            self.spacing *= 2.0;
            let mut odd = false;
            self.copies.retain(|(_, changed)| {
                odd = !odd;
                *changed || odd
            });
        }
    }

    /// Adds a copy after a change of the motion and drops the copies at or after that time, which
    /// lack the change.
    pub fn changed(&mut self, motion: &Motion) {
        let now = motion.t_s();
        self.copies.retain(|(copy, _)| copy.t_s() < now);
        self.copies.push((motion.clone(), true));
        if self.copies.iter().filter(|(_, changed)| *changed).count() > MOST_CHANGES {
            self.copies.remove(0);
        }
    }

    /// Returns the last copy at or before `t` \[s\], or the motion `now` itself if that is nearer;
    /// `None` if the first remaining copy is after `t`.
    pub fn before(&self, t: f64, now: &Motion) -> Option<Motion> {
        let copies = self.copies.iter().map(|(copy, _)| copy).chain([now]);
        copies.take_while(|copy| copy.t_s() <= t).last().cloned()
    }
}
