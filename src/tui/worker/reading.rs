//! The instant of the reading cursor, computed from a copy of the motion in
//! slices, so that neither the playback nor the next order waits for it.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::motion::Motion;
use crate::tui::engine::Moment;

/// The instant that is read.
#[derive(Debug, Default)]
pub struct Reading {
    done: Option<Arc<Moment>>,
    /// Until when, and how far it is.
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

    /// Whether it is complete.
    pub fn is_done(&self) -> bool {
        self.under_way.is_none()
    }

    /// The latest that is complete.
    pub fn moment(&self) -> Option<Arc<Moment>> {
        self.done.clone()
    }
}
