//! An engine without thread and clock, for tests that must give the same
//! screens on every machine: every snapshot advances the motion by the same
//! time, and the speed of the solver is a fixed number.

use std::time::Duration;

use super::Playback;
use super::studies::Bounds;
use crate::tui::engine::{Engine, Limit, Order, Pace, Snapshot};

/// Cells of a map unless more are asked for: blocks of eight by eight.
const MAP_CELLS: usize = 66;

/// The engine driven by hand.
#[derive(Debug)]
pub struct Stepwise {
    /// Motion between two snapshots \[s\].
    pub stride: f64,
    /// Most cells of a map, the coarsest ones.
    pub map_cells: usize,
    /// Whether lasting pulses are searched, which takes seconds.
    pub searches: bool,
    order: Option<Order>,
    playback: Option<Playback>,
    fresh: bool,
}

impl Stepwise {
    /// An engine that plays `stride` seconds of motion between two snapshots.
    pub fn new(stride: f64) -> Self {
        Self {
            stride,
            map_cells: MAP_CELLS,
            searches: false,
            order: None,
            playback: None,
            fresh: false,
        }
    }
}

impl Engine for Stepwise {
    fn order(&mut self, order: &Order) {
        self.order = Some(order.clone());
        self.fresh = true;
    }

    fn take(&mut self) -> Option<Snapshot> {
        let order = self.order.as_ref()?;
        let start = || Playback::with_time_limit(order.clone(), Duration::MAX);
        let playback = self.playback.get_or_insert_with(start);
        playback.bound_studies(Bounds { cells: self.map_cells, searches: self.searches });
        playback.apply(order);
        while playback.is_computing() {
            playback.compute();
        }
        if order.playing {
            playback.play(self.stride);
        } else if !self.fresh {
            return None;
        }
        self.fresh = false;
        let mut snapshot = playback.snapshot();
        let pace = &mut snapshot.results.pace;
        let step_s = pace.step_s.map(|_| 42e-9);
        let reached = Some(order.rate);
        *pace = Pace { step_s, run_s: Some(42e-3), limit: Limit::None, reached, ..*pace };
        Some(snapshot)
    }
}
