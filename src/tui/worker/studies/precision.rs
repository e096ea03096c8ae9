//! Speed against error, row by row, in the background: a row can take seconds.

use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Duration;

use super::{Given, Study};
use crate::tui::views::id::ViewId;
use crate::tui::worker::background::Background;
use rubscope_solver::motion::GoOn;
use rubscope_solver::scene::Scene;
use rubscope_solver::study::precision::{Effort, Measure, Precision, Reference, Row, ways};

/// What the thread finds.
enum Part {
    Reference(Box<Reference>),
    Row(Box<Row>),
}

/// The comparison of the solvers on one scene. Dropping it ends its thread.
#[derive(Debug)]
pub struct PrecisionStudy {
    scene: Scene,
    rows: Background<Part>,
    report: Option<Arc<Precision>>,
}

impl Study for PrecisionStudy {
    type Key = Scene;
    type Found = Precision;
    const VIEW: ViewId = ViewId::Precision;

    fn key(given: &Given) -> Option<Scene> {
        given.order.shows(ViewId::Precision).then(|| given.order.scene.clone().into_scene())
    }

    fn begin(scene: &Scene, _: &Given) -> Self {
        let theirs = scene.clone();
        let rows = Background::start(move |found, go_on| measure(&theirs, found, go_on));
        Self { scene: scene.clone(), rows, report: None }
    }

    fn is_done(&self) -> bool {
        self.rows.is_done()
    }

    fn work(&mut self, patience: Duration) {
        match self.rows.receive(patience) {
            Some(Part::Reference(reference)) => {
                self.report = Some(Arc::new(Precision {
                    scene: self.scene.clone(),
                    reference: *reference,
                    rows: Vec::new(),
                }));
            }
            Some(Part::Row(row)) => {
                if let Some(report) = &mut self.report {
                    Arc::make_mut(report).rows.push(*row);
                }
            }
            None => {}
        }
    }

    fn part(&self) -> Option<f64> {
        let done = self.report.as_ref()?.rows.len();
        Some(done as f64 / ways(&self.scene, Effort::QUICK).len().max(1) as f64)
    }

    fn found(&self) -> Option<&Arc<Precision>> {
        self.report.as_ref()
    }
}

/// Measures until done, or until told not to go on.
fn measure(scene: &Scene, found: &Sender<Part>, go_on: GoOn<'_>) {
    let Ok(Some(measure)) = Measure::new(scene, Effort::QUICK, go_on) else { return };
    // Without a receiver nothing is asked for any more, and `go_on` says so.
    let _ = found.send(Part::Reference(Box::new(measure.reference().clone())));
    for way in ways(scene, Effort::QUICK) {
        let row = measure.row(way, Effort::QUICK, go_on);
        if !go_on() {
            return;
        }
        if let Ok(Some(row)) = row {
            let _ = found.send(Part::Row(Box::new(row)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::with_given;
    use super::*;

    #[test]
    fn rows_come_in_the_order_of_the_ways_and_nothing_waits_for_them() {
        let mut scene = Scene::base();
        scene.solver.end_s = 1e-3;
        let start = |given: &Given| PrecisionStudy::begin(&scene, given);
        let mut job = with_given(&scene, ViewId::Precision, start);
        assert!(!job.is_done());
        while !job.is_done() {
            job.work(Duration::from_millis(50));
        }
        let rows: Vec<_> = job.found().unwrap().rows.iter().map(|row| row.way).collect();
        assert_eq!(rows, ways(&scene, Effort::QUICK));
    }
}
