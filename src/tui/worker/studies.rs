//! Studies for the views: the curves of the locked motion, the spectrum of the
//! whole run, the map, the margins and the comparison of solvers. Each is computed only
//! while its view is open, in slices, and kept while its inputs stay the same.

use std::sync::Arc;
use std::time::Duration;

use super::coincidence::{CoincidenceJob, Found};
use super::full_run::SLICE;
use super::map_job::{CellJob, MapJob};
use super::margins::MarginsJob;
use super::precision::PrecisionJob;
use crate::scene::Scene;
use crate::tui::engine::{Order, Results};
use crate::tui::views::ViewId;
use crate::tui::views::locked::curves::LockedCurves;
use crate::tui::views::map::LiveMap;
use crate::tui::views::margins::LiveMargins;
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
    /// Whether lasting pulses stay unknown.
    no_searches: bool,
    precision: Option<PrecisionJob>,
    margins: Option<MarginsJob>,
    /// The margins before, until there are new ones.
    margins_before: Option<Arc<LiveMargins>>,
    coincidence: Option<CoincidenceJob>,
    /// The curves before, until there are new ones.
    coincidence_before: Option<Found>,
}

impl Studies {
    /// The run has changed, so its spectrum must be computed again.
    pub fn forget_spectrum(&mut self) {
        self.spectrum = None;
    }

    /// Limits the cells of a map, and whether lasting pulses are searched.
    pub fn limit(&mut self, most_cells: usize, searches: bool) {
        (self.most_cells, self.no_searches) = (Some(most_cells), !searches);
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
        let wanted = |job: &MarginsJob| order.shows(ViewId::Margins) && job.is_of(&order.scene);
        if self.margins.as_ref().is_some_and(|job| !job.is_done() && !wanted(job)) {
            self.drop_margins();
        }
    }

    /// Ends the search; what it found stays to be seen.
    fn drop_margins(&mut self) {
        if let Some(live) = self.margins.take().as_ref().and_then(MarginsJob::live) {
            self.margins_before = Some(Arc::clone(live));
        }
    }

    /// Whether a study that is needed is missing.
    pub fn is_computing(&self, order: &Order) -> bool {
        self.locked_is_old(order)
            || (order.shows(ViewId::Spectrum) && self.spectrum.is_none())
            || !self.map_is_done(order)
            || !self.margins_are_done(order)
            || !self.coincidence_is_done(order)
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

    fn margins_are_done(&self, order: &Order) -> bool {
        let done = |job: &MarginsJob| job.is_of(&order.scene) && job.is_done();
        !order.shows(ViewId::Margins) || self.margins.as_ref().is_some_and(done)
    }

    fn coincidence_is_done(&self, order: &Order) -> bool {
        let done = |job: &CoincidenceJob| job.is_of(&order.scene) && job.is_done();
        !order.shows(ViewId::Coincidence) || self.coincidence.as_ref().is_some_and(done)
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
        } else if !self.coincidence_is_done(order) {
            self.compute_coincidence(&order.scene);
        } else if !self.margins_are_done(order) {
            self.compute_margins(order);
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

    fn compute_margins(&mut self, order: &Order) {
        // A map that is not done has its own threads to wait for.
        let patience = if self.map_is_done(order) { SLICE } else { Duration::ZERO };
        match self.margins.as_mut().filter(|job| job.is_of(&order.scene)) {
            Some(job) => job.receive(patience),
            None => {
                self.drop_margins();
                self.margins = Some(MarginsJob::of(&order.scene, !self.no_searches));
            }
        }
        if !self.map_is_done(order) {
            self.compute_map(order);
        }
    }

    fn compute_coincidence(&mut self, scene: &Scene) {
        match self.coincidence.as_mut().filter(|job| job.is_of(scene)) {
            Some(job) => job.receive(SLICE),
            None => {
                let before = self.coincidence.replace(CoincidenceJob::of(scene));
                let found = before.as_ref().and_then(CoincidenceJob::found).cloned();
                self.coincidence_before = found.or(self.coincidence_before.take());
            }
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
        let margins = self.margins.as_ref().and_then(MarginsJob::live);
        results.margins = margins.or(self.margins_before.as_ref()).cloned();
        let coincidence = self.coincidence.as_ref().and_then(CoincidenceJob::found);
        results.coincidence = coincidence.or(self.coincidence_before.as_ref()).cloned();
        results.precision = self.precision.as_ref().and_then(PrecisionJob::report).cloned();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::{App, Marker, Theme};

    #[test]
    fn a_search_ends_with_its_view_and_what_was_known_stays() {
        let scene = Scene::base().checked().unwrap();
        let app = App::new(scene, Theme::Mono, Marker::Ascii);
        let mut order = Order { open: vec![ViewId::Margins], ..app.order() };
        let mut studies = Studies::default();
        let shown = |studies: &Studies| {
            let mut results = Results::default();
            studies.show(&mut results);
            results.margins
        };
        while shown(&studies).is_none() {
            studies.compute(&order, Vec::new, 1.0);
        }
        assert!(studies.is_computing(&order));
        order.open.clear();
        studies.stop_unwanted(&order);
        assert!(studies.margins.is_none() && !studies.is_computing(&order));
        assert!(shown(&studies).is_some());
        // Of another scene the old ones stay until there are new ones.
        order.open.push(ViewId::Margins);
        let mut other = order.scene.clone().into_scene();
        other.casing.damping_ratio = 0.1;
        order.scene = other.checked().unwrap();
        studies.compute(&order, Vec::new, 1.0);
        studies.compute(&order, Vec::new, 1.0);
        assert!(shown(&studies).is_some());
        while shown(&studies).is_none_or(|live| live.margins.scene != order.scene) {
            studies.compute(&order, Vec::new, 1.0);
        }
        assert!(studies.is_computing(&order));
    }
}
