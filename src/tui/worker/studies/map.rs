//! The map, and the run of the cell under its cursor. Both run in background threads that stop
//! within about a millisecond once they are no longer wanted.

use std::sync::Mutex;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use rayon::iter::{ParallelBridge, ParallelIterator};

use super::study::{Given, Study};
use crate::tui::engine::FORECAST_LIMIT;
use crate::tui::views::id::ViewId;
use crate::tui::views::map::plan::{CellRun, LiveMap, coarse_first};
use crate::tui::worker::background::{Job, on_spare_cores};
use rubscope_solver::motion::LAST_PART;
use rubscope_solver::motion::{GoOn, Motion, verdict_of};
use rubscope_solver::study::MapPlan;

/// Longest wall-clock time of one cell; a typical one takes a hundredth of it.
const CELL_LIMIT: Duration = Duration::from_secs(1);
/// Wall-clock time between two states of the map that are sent.
const EVERY: Duration = Duration::from_millis(20);

/// Computes the map of a plan.
#[derive(Debug)]
pub struct MapStudy;

impl Study for MapStudy {
    type Key = MapPlan;
    type Found = LiveMap;
    const VIEW: ViewId = ViewId::Map;
    const SLOW: bool = true;

    fn key(given: &Given) -> Option<MapPlan> {
        given.plan.clone()
    }

    /// Goes on with the cells of an earlier map of the plan.
    fn begin(plan: &MapPlan, given: &Given, before: Option<&LiveMap>) -> Job<LiveMap> {
        let same = before.filter(|live| live.map.plan == *plan).cloned();
        let live = same.unwrap_or_else(|| LiveMap::of(plan.clone()));
        let most = given.extent.most_cells;
        Job::by(move |to, go_on| on_spare_cores(|| compute(live, most, to, go_on)))
    }

    /// A map replaces the previous one once it covers it.
    fn replaces(live: &LiveMap) -> bool {
        live.is_covered()
    }
}

/// Computes the cells that are left, in the order of the map; `most` is the largest number of cells
/// of the map, for tests.
fn compute(mut live: LiveMap, most: usize, to: &Sender<LiveMap>, go_on: GoOn<'_>) {
    let plan = live.map.plan.clone();
    let mut left = coarse_first(&plan);
    left.truncate(most.max(1));
    left.retain(|index| live.map.cells[*index].is_none());
    live.tried = live.map.cells.iter().flatten().count();
    let (began, wall_s) = (Instant::now(), live.map.wall_s);
    let live = Mutex::new((live, Instant::now()));
    left.into_iter().par_bridge().filter(|_| go_on()).for_each(|index| {
        let since = Instant::now();
        let cell = plan.compute(index, &|| go_on() && since.elapsed() < CELL_LIMIT);
        let Ok(mut live) = live.lock() else { return };
        let (live, sent) = &mut *live;
        // A cell that takes too long stays empty.
        live.map.cells[index] = cell;
        live.map.runs += u64::from(cell.is_some());
        live.map.wall_s = wall_s + began.elapsed().as_secs_f64();
        live.tried += 1;
        if sent.elapsed() > EVERY {
            *sent = Instant::now();
            _ = to.send(live.clone());
        }
    });
    if let Ok((live, _)) = live.into_inner() {
        _ = to.send(live);
    }
}

/// Computes the run of the cell under the cursor.
#[derive(Debug)]
pub struct CellStudy;

impl Study for CellStudy {
    type Key = (MapPlan, [u32; 2]);
    type Found = CellRun;
    const VIEW: ViewId = ViewId::Map;
    const SLOW: bool = true;

    fn key(given: &Given) -> Option<Self::Key> {
        given.plan.clone().zip(given.order.cell)
    }

    fn begin((plan, cell): &Self::Key, _: &Given, _: Option<&CellRun>) -> Job<CellRun> {
        let (plan, cell) = (plan.clone(), *cell);
        Job::by(move |to, go_on| {
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
    use std::sync::Arc;

    use super::super::tests::with_given;
    use super::*;
    use crate::tui::views::map::plan::MapChoice;

    use rubscope_solver::scene::Scene;

    #[test]
    fn a_map_that_was_stopped_goes_on_and_has_the_cells_of_its_plan() {
        let mut scene = Scene::base().as_reference();
        scene.solver.end_s = 5e-3;
        let mut plan = MapChoice::default().plan(&scene).unwrap();
        (plan.x.count, plan.y.count) = (7, 5);
        let mut live: Option<Arc<LiveMap>> = None;
        while !live.as_ref().is_some_and(|live| live.is_complete()) {
            let begin = |given: &Given| MapStudy::begin(&plan, given, live.as_deref());
            let mut job = with_given(&scene, ViewId::Map, begin);
            while !job.is_done() && job.found.is_none() {
                job.work(Duration::from_millis(5));
            }
            live = job.found.take();
        }
        let map = &live.unwrap().map;
        assert_eq!(map.runs, 35);
        for index in 0..plan.len() {
            assert_eq!(map.cells[index], plan.compute(index, &|| true), "{index}");
        }
    }
}
