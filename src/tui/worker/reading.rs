//! The instant of the reading cursor, computed in slices, so that neither the playback nor the
//! next order waits for it; and the copies of the motion from which any instant of the run can
//! be computed again exactly.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::tui::engine::Moment;
use rubscope_solver::motion::Motion;

/// The instant that is read.
#[derive(Debug, Default)]
pub struct Reading {
    done: Option<Arc<Moment>>,
    /// Instant to reach, and the motion on its way.
    under_way: Option<(f64, Motion)>,
}

impl Reading {
    /// Begins another one, from a motion before it; the one before stays until
    /// this one is done. None if there is nothing to read.
    pub fn begin(&mut self, from: Option<(f64, Motion)>) {
        if from.is_none() {
            self.done = None;
        }
        self.under_way = from;
    }

    /// Computes for this much wall time at most.
    pub fn go_on(&mut self, limit: Duration) {
        let Some((until, motion)) = &mut self.under_way else { return };
        let began = Instant::now();
        match motion.advance_while(*until, &|| began.elapsed() < limit) {
            Ok(true) => self.done = Some(Arc::new(Moment::of(motion))),
            Ok(false) => return,
            // After a failure there is nothing to look at.
            Err(_) => self.done = None,
        }
        self.under_way = None;
    }

    /// Returns whether it is complete.
    pub fn is_done(&self) -> bool {
        self.under_way.is_none()
    }

    /// Returns the latest that is complete.
    pub fn moment(&self) -> Option<Arc<Moment>> {
        self.done.clone()
    }
}

/// Most copies between changes; above, every second one goes.
const MOST: usize = 128;
/// Most changes from outside that are remembered.
const MOST_CHANGES: usize = 500;
/// Time between two copies at the start, in the length given.
const PART: f64 = 1.0 / 64.0;

/// The motion at some instants.
#[derive(Debug)]
pub struct Copies {
    /// In order of time; whether the motion was changed from outside just then.
    copies: Vec<(Motion, bool)>,
    spacing: f64,
}

impl Copies {
    /// Creates the copies from the start of a motion of which `length` seconds matter.
    pub fn of(motion: &Motion, length: f64) -> Self {
        Self { copies: vec![(motion.clone(), true)], spacing: length * PART }
    }

    /// Keeps a copy if the last one is old.
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

    /// Records that the motion was changed from outside, which earlier copies do not have.
    pub fn changed(&mut self, motion: &Motion) {
        let now = motion.t_s();
        self.copies.retain(|(copy, _)| copy.t_s() < now);
        self.copies.push((motion.clone(), true));
        if self.copies.iter().filter(|(_, changed)| *changed).count() > MOST_CHANGES {
            self.copies.remove(0);
        }
    }

    /// Returns the last copy by `t`, to be advanced from there; none before what is remembered.
    pub fn before(&self, t: f64, now: &Motion) -> Option<Motion> {
        let copies = self.copies.iter().map(|(copy, _)| copy).chain([now]);
        copies.take_while(|copy| copy.t_s() <= t).last().cloned()
    }
}
