//! The map, and the run of the cell under its cursor. Both run in background threads that stop
//! within about a millisecond once they are no longer wanted.

use std::sync::Arc;
use std::time::{Duration, Instant};

use rayon::iter::{ParallelBridge, ParallelIterator};

use super::study::{Given, Job, Sent, Study};
use crate::tui::engine::FORECAST_LIMIT;
use crate::tui::views::id::ViewId;
use crate::tui::views::map::plan::{CellRun, LiveMap, coarse_first};
use crate::tui::worker::background::{Background, on_spare_cores};
use rubscope_solver::motion::LAST_PART;
use rubscope_solver::motion::{GoOn, Motion, verdict_of};
use rubscope_solver::study::{Cell, MapPlan};

/// Longest wall-clock time of one cell; a typical one takes a hundredth of it.
const CELL_LIMIT: Duration = Duration::from_secs(1);
/// Largest number of cells collected per slice.
const MOST_TAKEN: usize = 4096;

/// Index and result of a cell; `None` if its run took too long or was stopped.
type Computed = (usize, Option<Cell>);

/// Computes the map of a plan.
#[derive(Debug)]
pub struct MapStudy;

impl Study for MapStudy {
    type Key = MapPlan;
    type Found = LiveMap;
    type Job = MapJob;
    const VIEW: ViewId = ViewId::Map;
    const BESIDE: bool = true;

    fn key(given: &Given) -> Option<MapPlan> {
        given.plan.clone()
    }

    fn begin(plan: &MapPlan, given: &Given) -> MapJob {
        MapJob::new(plan, given.most_cells.unwrap_or(usize::MAX))
    }
}

/// A map in progress.
#[derive(Debug)]
pub struct MapJob {
    live: Arc<LiveMap>,
    /// Indices of the cells, in order of computation.
    order: Vec<usize>,
    /// Number of cells after which the whole map is covered by coarse blocks.
    first: usize,
    /// Whether each cell was computed or given up, by its index.
    tried: Vec<bool>,
    /// The threads that compute; `None` before they start, and while they are not needed.
    threads: Option<Background<Computed>>,
}

impl Job for MapJob {
    type Found = LiveMap;

    fn is_done(&self) -> bool {
        self.live.tried >= self.order.len()
    }

    fn work(&mut self, patience: Duration) {
        // Threads that ended early leave cells uncomputed.
        if self.threads.as_ref().is_none_or(Background::is_done) && !self.is_done() {
            self.threads = Some(self.start());
        }
        let Some(threads) = &mut self.threads else { return };
        let began = Instant::now();
        let mut found = Vec::new();
        while found.len() < MOST_TAKEN
            && let Some(computed) =
                threads.receive(if found.is_empty() { patience } else { Duration::ZERO })
        {
            found.push(computed);
        }
        if found.is_empty() {
            return;
        }
        let live = Arc::make_mut(&mut self.live);
        for (index, cell) in found {
            live.map.cells.set(index, cell);
            live.map.runs += u64::from(cell.is_some());
            if let Some(tried) = self.tried.get_mut(index).filter(|tried| !**tried) {
                *tried = true;
                live.tried += 1;
            }
        }
        live.map.wall_s += began.elapsed().as_secs_f64();
    }

    fn found(&self) -> Option<&Arc<LiveMap>> {
        Some(&self.live).filter(|live| live.tried >= self.first)
    }

    fn first(&self) -> Option<&Arc<LiveMap>> {
        Some(&self.live)
    }

    fn pause(&mut self) {
        // This ends the threads; computed cells stay.
        self.threads = None;
    }
}

impl MapJob {
    /// Creates the map of `plan`; at most the `most` coarsest cells are computed.
    fn new(plan: &MapPlan, most: usize) -> Self {
        let (mut order, first) = coarse_first(plan);
        order.truncate(most.max(1));
        let live = LiveMap::of(plan.clone());
        Self {
            tried: vec![false; live.map.cells.len()],
            live: Arc::new(live),
            first: first.min(order.len()),
            order,
            threads: None,
        }
    }

    /// Starts to compute the cells that are left, on all spare cores, in the order of the map.
    fn start(&self) -> Background<Computed> {
        let left =
            self.order.iter().copied().filter(|index| self.tried.get(*index) == Some(&false));
        let (left, plan) = (left.collect::<Vec<usize>>(), self.live.map.plan.clone());
        Background::start(move |to, go_on| {
            let compute = |index| {
                let began = Instant::now();
                let cell = plan.compute(index, &|| go_on() && began.elapsed() < CELL_LIMIT);
                // A cell that takes too long stays empty. Sending fails only if the map was dropped.
                _ = to.send((index, cell));
            };
            on_spare_cores(|| left.into_iter().par_bridge().filter(|_| go_on()).for_each(compute));
        })
    }
}

/// Computes the run of the cell under the cursor.
#[derive(Debug)]
pub struct CellStudy;

impl Study for CellStudy {
    type Key = (MapPlan, [u32; 2]);
    type Found = CellRun;
    type Job = Sent<CellRun>;
    const VIEW: ViewId = ViewId::Map;
    const BESIDE: bool = true;
    const ENDS: bool = true;

    fn key(given: &Given) -> Option<Self::Key> {
        given.plan.clone().zip(given.order.cell)
    }

    fn begin((plan, cell): &Self::Key, _: &Given) -> Self::Job {
        let (plan, cell) = (plan.clone(), *cell);
        Sent::by(move |to, go_on| {
            let began = Instant::now();
            let go_on = || go_on() && began.elapsed() < FORECAST_LIMIT;
            if let Some(run) = run_of(plan, cell, &go_on) {
                _ = to.send(run);
            }
        })
    }
}

fn run_of(plan: MapPlan, cell: [u32; 2], go_on: GoOn<'_>) -> Option<CellRun> {
    let index = plan.index(cell[0], cell[1]);
    let scene = plan.scene_of(index).ok()?;
    let end = scene.solver.end_s;
    let mut motion = Motion::new(&scene);
    if motion.advance_while(end, go_on) == Ok(false) {
        return None;
    }
    let verdict = verdict_of(&motion, LAST_PART * end);
    let machine = motion.machine();
    let contacts = motion.multipliers().into_iter();
    let contacts = contacts.map(|(side, force)| (machine.first_of_side(side), force)).collect();
    Some(CellRun {
        verdict,
        since: verdict.keeps_contact().then_some(motion.contacts().since),
        contacts,
        impacts: motion.contacts().impact_count,
        plan,
        cell,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::views::map::plan::MapChoice;

    use rubscope_solver::scene::Scene;

    #[test]
    fn a_map_that_was_stopped_goes_on_and_has_the_cells_of_its_plan() {
        let mut scene = Scene::base().as_reference();
        scene.solver.end_s = 5e-3;
        let mut plan = MapChoice::default().plan(&scene).unwrap();
        (plan.x.count, plan.y.count) = (7, 5);
        let mut job = MapJob::new(&plan, usize::MAX);
        while !job.is_done() {
            job.work(Duration::from_millis(5));
            job.pause();
        }
        assert_eq!(job.live.tried, 35);
        for index in 0..plan.len() {
            assert_eq!(job.live.map.cells[index], plan.compute(index, &|| true), "{index}");
        }
        // A test can limit a map to its coarsest cells.
        let mut coarse = MapJob::new(&plan, 1);
        while !coarse.is_done() {
            coarse.work(Duration::from_millis(5));
        }
        assert!(coarse.found().is_some() && !coarse.live.is_complete());
    }
}
