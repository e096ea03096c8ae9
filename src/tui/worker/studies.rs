//! Studies for the views: the curves of the locked motion, the spectrum of the
//! whole run, the map and the comparison of solvers. Each is computed only
//! while its view is open, in slices, and kept while its inputs stay the same.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::full_run::SLICE;
use super::precision::PrecisionJob;
use crate::scene::{ContactLaw, ModelSize, Scene, SolverKind};
use crate::study::{Axis, Map, MapPlan};
use crate::tui::engine::{Order, Results};
use crate::tui::views::ViewId;
use crate::tui::views::locked::curves::{LockedCurves, speed_range};
use crate::tui::views::spectrum::transform::Spectrum;

/// Cells of the map, across and up.
const CELLS: (u32, u32) = (60, 24);
/// Pulses of the map \[N\].
const PULSES: (f64, f64) = (1e3, 1e7);
/// Longest wall time of one cell of the map: an ordinary one takes a thousandth
/// of it.
const CELL_LIMIT: Duration = Duration::from_millis(100);

/// The studies of one scene.
#[derive(Debug, Default)]
pub struct Studies {
    locked: Option<(Scene, Arc<LockedCurves>)>,
    spectrum: Option<Arc<Spectrum>>,
    map: Option<Arc<Map>>,
    map_next: usize,
    precision: Option<PrecisionJob>,
}

impl Studies {
    /// The run has changed, so its spectrum must be computed again.
    pub fn forget_spectrum(&mut self) {
        self.spectrum = None;
    }

    /// Whether a study that is needed is missing.
    pub fn is_computing(&self, order: &Order) -> bool {
        self.locked_is_old(order)
            || (order.shows(ViewId::Spectrum) && self.spectrum.is_none())
            || (order.shows(ViewId::Map) && !self.map_is_done(order))
            || (order.shows(ViewId::Precision) && !self.precision_is_done(order))
    }

    fn locked_is_old(&self, order: &Order) -> bool {
        self.locked.as_ref().is_none_or(|(scene, _)| *scene != *order.scene)
    }

    fn map_is_done(&self, order: &Order) -> bool {
        // A scene without a map has nothing left to compute.
        let Some(plan) = plan(&order.scene) else { return true };
        let complete = |map: &Arc<Map>| self.map_next >= map.cells.len() && plan == map.plan;
        self.map.as_ref().is_some_and(complete)
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
        } else if order.shows(ViewId::Map) && !self.map_is_done(order) {
            self.compute_map(&order.scene);
        } else if order.shows(ViewId::Precision) {
            self.compute_precision(&order.scene);
        }
    }

    fn compute_map(&mut self, scene: &Scene) {
        let Some(plan) = plan(scene) else { return };
        if self.map.as_ref().is_none_or(|map| map.plan != plan) {
            self.map = Some(Arc::new(Map::empty(plan)));
            self.map_next = 0;
        }
        let Some(map) = &mut self.map else { return };
        let map = Arc::make_mut(map);
        let began = Instant::now();
        let count = map.cells.len();
        while self.map_next < count && began.elapsed() < SLICE {
            // A stride without a common divisor visits every cell, spread over
            // the whole map.
            let index = (self.map_next * stride(count)) % count;
            let cell_began = Instant::now();
            let cell = map.plan.compute(index, &|| cell_began.elapsed() < CELL_LIMIT);
            // A cell that takes too long stays empty.
            map.runs += u64::from(cell.is_some());
            map.cells.set(index, cell);
            self.map_next += 1;
        }
        map.wall_s += began.elapsed().as_secs_f64();
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
        results.map.clone_from(&self.map);
        results.precision = self.precision.as_ref().and_then(PrecisionJob::report).cloned();
    }
}

/// The map of a scene: speed from zero to above all thresholds, pulse over four
/// decades, by the event solver with rigid blades.
fn plan(scene: &Scene) -> Option<MapPlan> {
    let mut scene = scene.clone();
    let speed = scene.operation.speed_rad_s.abs();
    let machine = scene.machine();
    let thresholds = [machine.lock_speed(), machine.dangerous_speed(), machine.critical_speed()];
    // The range does not depend on the speed, unless the speed is far outside.
    scene.operation.speed_rad_s = 1.3 * thresholds.into_iter().flatten().fold(1.0, f64::max);
    let usual = speed_range(&scene);
    scene.operation.speed_rad_s = speed;
    let fastest = if speed > usual { speed_range(&scene) } else { usual };
    scene.solver.kind = SolverKind::Event;
    scene.solver.contact = ContactLaw::Unilateral;
    scene.solver.model = ModelSize::Rigid;
    scene.operation.speed_rad_s = 0.0;
    scene.operation.pulse_n = 0.0;
    let x = Axis::new("operation.speed_rad_s", 0.0, fastest, CELLS.0, false).ok()?;
    let y = Axis::new("operation.pulse_n", PULSES.0, PULSES.1, CELLS.1, true).ok()?;
    let plan = MapPlan { scene, x, y, sensitivity: false };
    plan.check().is_ok().then_some(plan)
}

/// A stride near the golden section of `count` without a common divisor.
fn stride(count: usize) -> usize {
    let gcd = |mut a: usize, mut b: usize| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let start = (count as f64 * 0.618) as usize;
    (start.max(1)..).find(|stride| gcd(*stride, count) == 1).unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stride_visits_every_cell_once() {
        for count in [1, 2, 60 * 24, 97] {
            let mut seen = vec![false; count];
            (0..count).for_each(|k| seen[(k * stride(count)) % count] = true);
            assert!(seen.iter().all(|cell| *cell), "{count}");
        }
    }

    #[test]
    fn the_map_does_not_depend_on_the_knobs_it_sweeps() {
        let mut scene = Scene::base();
        let before = plan(&scene).unwrap();
        scene.operation.pulse_n = 5.0;
        scene.operation.speed_rad_s = 100.0;
        assert_eq!(plan(&scene).unwrap(), before);
    }
}
