//! The run of the map's cell under the cursor, in a thread of its own.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::{Given, Study};
use crate::motion::{GoOn, Motion, verdict_of};
use crate::study::MapPlan;
use crate::tolerances::LAST_PART;
use crate::tui::engine::FORECAST_LIMIT;
use crate::tui::views::ViewId;
use crate::tui::views::map::CellRun;
use crate::tui::worker::background::Background;

/// The run of the cell under the cursor.
#[derive(Debug)]
pub struct CellStudy {
    run: Background<CellRun>,
    found: Option<Arc<CellRun>>,
}

impl Study for CellStudy {
    type Key = (MapPlan, [u32; 2]);
    type Found = CellRun;
    const VIEW: ViewId = ViewId::Map;
    const BESIDE: bool = true;

    fn key(given: &Given) -> Option<Self::Key> {
        given.plan.clone().zip(given.order.cell)
    }

    fn begin((plan, cell): &Self::Key, _: &Given) -> Self {
        let (plan, cell) = (plan.clone(), *cell);
        let run = Background::start(move |to, go_on| {
            let began = Instant::now();
            let go_on = || go_on() && began.elapsed() < FORECAST_LIMIT;
            if let Some(run) = run_of(plan, cell, &go_on) {
                // Without a receiver nobody asks any more.
                let _ = to.send(run);
            }
        });
        Self { run, found: None }
    }

    fn is_done(&self) -> bool {
        self.found.is_some() || self.run.is_done()
    }

    fn work(&mut self, patience: Duration) {
        if let Some(run) = self.run.receive(patience) {
            self.found = Some(Arc::new(run));
        }
    }

    fn found(&self) -> Option<&Arc<CellRun>> {
        self.found.as_ref()
    }

    fn wait(&mut self) -> bool {
        false
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
    let polygon = &motion.machine().polygon;
    let contacts = motion.multipliers().into_iter();
    let contacts = contacts.map(|(side, force)| (polygon.blades_of_side(side), force)).collect();
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
    use super::super::tests::with_given;
    use super::*;
    use crate::motion::Verdict;
    use crate::scene::Scene;
    use crate::tui::views::ViewId;

    #[test]
    fn the_run_of_a_cell_says_what_holds_it() {
        let scene = Scene::builtin("paper-nd3").unwrap();
        // 502.5 rad/s and 1 MN.
        let mut job = with_given(&scene, ViewId::Map, |given| {
            CellStudy::begin(&(given.plan.clone().unwrap(), [67, 30]), given)
        });
        while !job.is_done() {
            job.work(Duration::from_millis(5));
        }
        let run = job.found().unwrap();
        assert_eq!(run.verdict, Verdict::Locked);
        let blades: Vec<_> = run.contacts.iter().map(|(blades, _)| blades.clone()).collect();
        assert_eq!(blades, [[19], [12]]);
        assert!(run.since.unwrap() < 1e-4 && run.contacts.iter().all(|(_, force)| *force < 0.0));
    }
}
