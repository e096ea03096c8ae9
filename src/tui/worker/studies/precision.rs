//! Speed against error of the solvers, row by row in the background: a row can take seconds.

use super::study::{Given, Sent, Study};
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::Scene;
use rubscope_solver::study::precision::{Effort, Measure, Precision, ways};

/// Measures the solvers on the scene of the order.
#[derive(Debug)]
pub struct PrecisionStudy;

impl Study for PrecisionStudy {
    type Key = Scene;
    type Found = Precision;
    type Job = Sent<Precision>;
    const VIEW: ViewId = ViewId::Precision;

    fn key(given: &Given) -> Option<Scene> {
        given.order.shows(ViewId::Precision).then(|| given.order.scene.clone().into_scene())
    }

    fn begin(scene: &Scene, _: &Given) -> Self::Job {
        let theirs = scene.clone();
        Sent::by(move |to, go_on| {
            let Ok(Some(measure)) = Measure::new(&theirs, Effort::QUICK, go_on) else { return };
            let reference = measure.reference().clone();
            let mut report = Precision { scene: theirs.clone(), reference, rows: Vec::new() };
            let _ = to.send(report.clone());
            for way in ways(&theirs, Effort::QUICK) {
                let row = measure.row(way, Effort::QUICK, go_on);
                if !go_on() {
                    return;
                }
                if let Ok(Some(row)) = row {
                    report.rows.push(row);
                    let _ = to.send(report.clone());
                }
            }
        })
    }

    fn part(found: &Precision) -> Option<f64> {
        let all = ways(&found.scene, Effort::QUICK).len().max(1);
        Some(found.rows.len() as f64 / all as f64)
    }
}
