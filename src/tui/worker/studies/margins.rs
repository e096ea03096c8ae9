//! The margins of a scene, in the background: first for its own nodal diameters, then the survey
//! over all nodal diameters, then the nearest changes of the verdict, which take many runs.

use std::sync::Arc;

use super::study::{Given, Sent, Study};
use crate::tui::views::id::ViewId;
use crate::tui::views::margins::live::LiveMargins;
use crate::tui::worker::background::on_spare_cores;
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::study::margins::Margins;
use rubscope_solver::study::survey::Survey;

/// Computes the margins of a scene, and the survey over a speed range.
#[derive(Debug)]
pub struct MarginsStudy;

impl Study for MarginsStudy {
    /// The scene, and the speed range of the survey \[rad/s\]; `None` covers all speeds.
    type Key = (CheckedScene, Option<[f64; 2]>);
    type Found = LiveMargins;
    type Job = Sent<LiveMargins>;
    const VIEW: ViewId = ViewId::Margins;
    const BESIDE: bool = true;
    const ENDS: bool = true;

    fn key(given: &Given) -> Option<Self::Key> {
        let order = given.order;
        order.shows(ViewId::Margins).then(|| (order.scene.clone(), order.range))
    }

    fn begin((scene, range): &Self::Key, _: &Given) -> Self::Job {
        let (theirs, range) = (scene.clone(), *range);
        Sent::by(move |to, go_on| {
            let mut live = LiveMargins { margins: Margins::of(&theirs), survey: None };
            let _ = to.send(live.clone());
            live.survey = Survey::of(&theirs, range, None).ok().map(Arc::new);
            let _ = to.send(live.clone());
            let LiveMargins { mut margins, survey } = live;
            on_spare_cores(|| {
                margins.ask_runs(go_on, &mut |margins| {
                    let (margins, survey) = (margins.clone(), survey.clone());
                    let _ = to.send(LiveMargins { margins, survey });
                })
            });
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::study::Job;
    use super::super::tests::with_given;
    use super::*;
    use rubscope_solver::scene::Scene;
    use std::time::Duration;

    #[test]
    fn the_margins_come_first_then_the_survey_and_last_what_runs_say() {
        let scene = Scene::builtin("paper-nd3").unwrap().checked().unwrap();
        let start = |given: &Given| MarginsStudy::begin(&(scene.clone(), None), given);
        let mut job = with_given(&scene, ViewId::Margins, start);
        while !job.is_done() {
            job.work(Duration::from_millis(20));
        }
        let live = job.found().unwrap();
        assert_eq!(live.margins.limits, Margins::of(&scene).limits);
        assert!(live.survey.is_some());
        let told =
            [&live.margins.robust, &live.margins.pushes_only].map(|law| law.clone().unwrap());
        assert!(told.iter().all(|law| law.changes.len() == law.rows), "{told:?}");
    }
}
