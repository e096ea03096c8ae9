//! Studies for the views: the curves of the locked motion, the spectrum of the
//! whole run, the map and the comparison of solvers. Each is computed only
//! while its view is open, in slices, and kept while its inputs stay the same.

use std::sync::Arc;
use std::time::Duration;

use super::full_run::SLICE;
use super::map_job::{CellJob, MapJob};
use super::precision::PrecisionJob;
use crate::scene::Scene;
use crate::tui::engine::{Order, Results};
use crate::tui::views::ViewId;
use crate::tui::views::locked::curves::LockedCurves;
use crate::tui::views::map::LiveMap;
use crate::tui::views::spectrum::transform::Spectrum;

/// The studies of one scene.
#[derive(Debug, Default)]
pub struct Studies {
    locked: Option<(Scene, Arc<LockedCurves>)>,
    spectrum: Option<Arc<Spectrum>>,
    map: Option<MapJob>,
    /// The map before, until the whole of the new one can be seen.
    map_before: Option<Arc<LiveMap>>,
    cell: Option<CellJob>,
    /// Most cells of a map; none for all of them.
    most_cells: Option<usize>,
    precision: Option<PrecisionJob>,
}

impl Studies {
    /// The run has changed, so its spectrum must be computed again.
    pub fn forget_spectrum(&mut self) {
        self.spectrum = None;
    }

    /// Limits the cells of a map.
    pub fn limit_cells(&mut self, most: usize) {
        self.most_cells = Some(most);
    }

    /// Stops what the order does not want any more, so that its own work has the
    /// processor.
    pub fn stop_unwanted(&mut self, order: &Order) {
        let plan = order.map_plan();
        if let Some(job) = &mut self.map
            && plan.as_ref() != Some(job.plan())
        {
            job.pause();
        }
        let cell = plan.as_ref().zip(order.cell);
        if !self.cell.as_ref().is_some_and(|job| cell.is_some_and(|(plan, at)| job.is_of(plan, at)))
        {
            self.cell = None;
        }
    }

    /// Whether a study that is needed is missing.
    pub fn is_computing(&self, order: &Order) -> bool {
        self.locked_is_old(order)
            || (order.shows(ViewId::Spectrum) && self.spectrum.is_none())
            || !self.map_is_done(order)
            || (order.shows(ViewId::Precision) && !self.precision_is_done(order))
    }

    fn locked_is_old(&self, order: &Order) -> bool {
        self.locked.as_ref().is_none_or(|(scene, _)| *scene != *order.scene)
    }

    fn map_is_done(&self, order: &Order) -> bool {
        // A scene without a map has nothing left to compute.
        let Some(plan) = order.map_plan() else { return true };
        let map = self.map.as_ref().is_some_and(|job| job.is_done() && *job.plan() == plan);
        let run =
            |cell| self.cell.as_ref().is_some_and(|job| job.is_of(&plan, cell) && job.is_done());
        map && order.cell.is_none_or(run)
    }

    fn precision_is_done(&self, order: &Order) -> bool {
        let found = self.precision.as_ref();
        found.is_some_and(|found| found.is_of(&order.scene) && found.is_done())
    }

    /// Computes one slice. `signal` gives the finished run, `length` is its duration.
    pub fn compute(&mut self, order: &Order, signal: impl FnOnce() -> Vec<[f64; 2]>, length: f64) {
        if self.locked_is_old(order) {
            let curves = Arc::new(LockedCurves::of(&order.scene));
            self.locked = Some((order.scene.clone().into_scene(), curves));
        } else if order.shows(ViewId::Spectrum) && self.spectrum.is_none() {
            self.spectrum = Some(Arc::new(Spectrum::of(&signal(), length)));
        } else if !self.map_is_done(order) {
            self.compute_map(order);
        } else if order.shows(ViewId::Precision) {
            self.compute_precision(&order.scene);
        }
    }

    fn compute_map(&mut self, order: &Order) {
        let Some(plan) = order.map_plan() else { return };
        if let Some(cell) = order.cell {
            match self.cell.as_mut().filter(|job| job.is_of(&plan, cell)) {
                // An order waits for one of the two only.
                Some(job) => {
                    let other = self.map.as_ref().is_some_and(|map| !map.is_done());
                    job.receive(if other { Duration::ZERO } else { SLICE });
                }
                None => self.cell = Some(CellJob::of(&plan, cell)),
            }
        }
        if self.map.as_ref().is_none_or(|job| *job.plan() != plan) {
            let job = MapJob::new(&plan, self.most_cells.unwrap_or(usize::MAX));
            let before = self.map.replace(job);
            let shown = before.as_ref().and_then(MapJob::whole).cloned();
            self.map_before = shown.or(self.map_before.take());
        }
        if let Some(job) = &mut self.map {
            job.receive(SLICE);
        }
    }

    fn compute_precision(&mut self, scene: &Scene) {
        match self.precision.as_mut().filter(|found| found.is_of(scene)) {
            Some(found) => found.receive(SLICE),
            None => self.precision = Some(PrecisionJob::of(scene)),
        }
    }

    /// Adds the studies computed so far to the results.
    pub fn show(&self, results: &mut Results) {
        results.locked = self.locked.as_ref().map(|(_, curves)| Arc::clone(curves));
        results.spectrum.clone_from(&self.spectrum);
        // The map before stays until the whole of the new one can be seen.
        let job = self.map.as_ref();
        let whole = job.and_then(MapJob::whole);
        results.map = whole.or(self.map_before.as_ref()).or(job.map(MapJob::live)).cloned();
        results.cell = self.cell.as_ref().and_then(CellJob::found).cloned();
        results.precision = self.precision.as_ref().and_then(PrecisionJob::report).cloned();
    }
}
