//! Speed against error, row by row, in a separate thread: a row can take
//! seconds, and neither the motion nor the next order waits for it.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

use super::thread::WORKER_NAME;
use crate::scene::Scene;
use crate::study::precision::{Effort, Measure, Precision, Reference, Row, ways};

/// One run per row, and no step finer than the paper's, for a quick result.
const EFFORT: Effort = Effort { repeats: 1, finest_s: 1e-7, seconds: 0.0 };

/// What the thread finds.
enum Found {
    Reference(Box<Reference>),
    Row(Box<Row>),
}

/// The comparison of the solvers on one scene. Dropping it ends the thread
/// after the current row.
#[derive(Debug)]
pub struct PrecisionJob {
    scene: Scene,
    rows: Option<Receiver<Found>>,
    report: Option<Arc<Precision>>,
}

impl PrecisionJob {
    /// Starts on a checked scene.
    pub fn of(scene: &Scene) -> Self {
        let (sender, rows) = channel();
        let theirs = scene.clone();
        // The panic hook leaves the screen alone for threads of this name.
        let thread = std::thread::Builder::new().name(WORKER_NAME.to_string());
        let started = thread.spawn(move || measure(&theirs, &sender)).is_ok();
        Self { scene: scene.clone(), rows: started.then_some(rows), report: None }
    }

    /// Whether it belongs to this scene.
    pub fn is_of(&self, scene: &Scene) -> bool {
        self.scene == *scene
    }

    /// Whether all rows are done.
    pub fn is_done(&self) -> bool {
        self.rows.is_none()
    }

    /// The rows so far.
    pub fn report(&self) -> Option<&Arc<Precision>> {
        self.report.as_ref()
    }

    /// Takes the next row, waiting for it no longer than `patience`.
    pub fn receive(&mut self, patience: Duration) {
        let Some(rows) = &self.rows else { return };
        match rows.recv_timeout(patience) {
            Ok(Found::Reference(reference)) => {
                self.report = Some(Arc::new(Precision {
                    scene: self.scene.clone(),
                    reference: *reference,
                    rows: Vec::new(),
                }));
            }
            Ok(Found::Row(row)) => {
                if let Some(report) = &mut self.report {
                    Arc::make_mut(report).rows.push(*row);
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            // Done, or the thread ended early: the existing rows stay.
            Err(RecvTimeoutError::Disconnected) => self.rows = None,
        }
    }
}

/// Measures until done, or until the receiver is dropped.
fn measure(scene: &Scene, found: &Sender<Found>) {
    let Ok(measure) = Measure::new(scene) else { return };
    let reference = Found::Reference(Box::new(measure.reference().clone()));
    if found.send(reference).is_err() {
        return;
    }
    for way in ways(scene, EFFORT) {
        let Ok(row) = measure.row(way, EFFORT) else { continue };
        if found.send(Found::Row(Box::new(row))).is_err() {
            return;
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
        assert_eq!(rows, ways(&scene, EFFORT));
    }
}
