//! Speed against error, row by row, in the background: a row can take seconds.

use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Duration;

use super::background::Background;
use crate::motion::GoOn;
use crate::scene::Scene;
use crate::study::precision::{Effort, Measure, Precision, Reference, Row, ways};

/// What the thread finds.
enum Found {
    Reference(Box<Reference>),
    Row(Box<Row>),
}

/// The comparison of the solvers on one scene. Dropping it ends its thread.
#[derive(Debug)]
pub struct PrecisionJob {
    scene: Scene,
    rows: Background<Found>,
    report: Option<Arc<Precision>>,
}

impl PrecisionJob {
    /// Starts on a checked scene.
    pub fn of(scene: &Scene) -> Self {
        let theirs = scene.clone();
        let rows = Background::start(move |found, go_on| measure(&theirs, found, go_on));
        Self { scene: scene.clone(), rows, report: None }
    }

    /// Whether it belongs to this scene.
    pub fn is_of(&self, scene: &Scene) -> bool {
        self.scene == *scene
    }

    /// Whether all rows are done.
    pub fn is_done(&self) -> bool {
        self.rows.is_done()
    }

    /// The rows so far.
    pub fn report(&self) -> Option<&Arc<Precision>> {
        self.report.as_ref()
    }

    /// Takes the next row, waiting for it no longer than `patience`.
    pub fn receive(&mut self, patience: Duration) {
        match self.rows.receive(patience) {
            Some(Found::Reference(reference)) => {
                self.report = Some(Arc::new(Precision {
                    scene: self.scene.clone(),
                    reference: *reference,
                    rows: Vec::new(),
                }));
            }
            Some(Found::Row(row)) => {
                if let Some(report) = &mut self.report {
                    Arc::make_mut(report).rows.push(*row);
                }
            }
            None => {}
        }
    }
}

/// Measures until done, or until told not to go on.
fn measure(scene: &Scene, found: &Sender<Found>, go_on: GoOn<'_>) {
    let Ok(Some(measure)) = Measure::new(scene, Effort::QUICK, go_on) else { return };
    // Without a receiver nothing is asked for any more, and `go_on` says so.
    let _ = found.send(Found::Reference(Box::new(measure.reference().clone())));
    for way in ways(scene, Effort::QUICK) {
        let row = measure.row(way, Effort::QUICK, go_on);
        if !go_on() {
            return;
        }
        if let Ok(Some(row)) = row {
            let _ = found.send(Found::Row(Box::new(row)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_in_the_order_of_the_ways_and_nothing_waits_for_them() {
        let mut scene = Scene::base();
        scene.solver.end_s = 1e-3;
        let mut job = PrecisionJob::of(&scene);
        assert!(job.is_of(&scene) && !job.is_done());
        while !job.is_done() {
            job.receive(Duration::from_millis(50));
        }
        let rows: Vec<_> = job.report().unwrap().rows.iter().map(|row| row.way).collect();
        assert_eq!(rows, ways(&scene, Effort::QUICK));
    }
}
