//! What the explorer has in tests in place of a terminal and of the thread of its solver: a host
//! that writes files at once, and an engine that is driven by hand, so that a screen is the same
//! on every machine.

use std::io::Result;
use std::path::PathBuf;
use std::time::Duration;

use rubscope::tui::engine::{Engine, Limit, Order, Pace, Sensitive, Snapshot};
use rubscope::tui::events::ScreenEvent;
use rubscope::tui::files::{FileJob, FoundScenes};
use rubscope::tui::host::Host;
use rubscope::tui::worker::{Extent, Playback};

/// A host without a terminal; files are written at once.
#[derive(Debug, Default)]
pub struct NoHost;

impl Host for NoHost {
    fn suspend(&mut self, _: bool) -> Result<bool> {
        Ok(true)
    }
    fn resume(&mut self) -> Result<()> {
        Ok(())
    }
    fn copy(&mut self, _: &str) -> Result<()> {
        Ok(())
    }
    fn write(&mut self, job: FileJob) -> Option<ScreenEvent> {
        Some(ScreenEvent::Written(job.run()))
    }
    fn find_scenes(&mut self, directory: PathBuf) -> Option<ScreenEvent> {
        Some(ScreenEvent::Scenes(FoundScenes::of(&directory)))
    }
}

/// The engine driven by hand.
#[derive(Debug, Default)]
pub struct Stepwise {
    /// Motion between two snapshots \[s\].
    pub stride: f64,
    /// How much is computed: of a map all blocks of eight by eight, and some finer ones. What else
    /// changes the verdict, some hundred runs, is left to those who look at it.
    pub extent: Extent,
    /// Whether a run is checked for tiny changes, with four more runs, for those who look at it.
    pub checks: bool,
    order: Option<Order>,
    playback: Option<Playback>,
    fresh: bool,
}

impl Stepwise {
    /// Creates an engine that plays `stride` seconds of motion between two snapshots.
    pub fn new(stride: f64) -> Self {
        let extent = Extent { most_cells: 66, searches_changes: false, rest: Duration::ZERO };
        Self { stride, extent, ..Self::default() }
    }
}

impl Engine for Stepwise {
    fn order(&mut self, order: &Order) {
        self.order = Some(order.clone());
        self.fresh = true;
    }

    fn take(&mut self) -> Option<Snapshot> {
        let order = self.order.as_ref()?;
        let start = || Playback::new(order.clone(), Duration::MAX);
        let playback = self.playback.get_or_insert_with(start);
        playback.apply(order);
        playback.films.studies.extent = self.extent;
        if !self.checks {
            playback.films.sensitive = Some(Sensitive::Unknown);
        }
        while playback.is_computing() {
            playback.compute();
        }
        if order.playing {
            playback.play(self.stride, false);
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
