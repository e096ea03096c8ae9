//! The margins of one scene in the background: first those of its own nodal diameters, then
//! the survey of all of them, then by many runs the nearest changes of its verdict.

use std::sync::Arc;
use std::time::Duration;

use super::{Given, Study};
use crate::tui::views::id::ViewId;
use crate::tui::views::margins::live::LiveMargins;
use crate::tui::worker::background::{Background, on_spare_cores};
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::study::margins::Margins;
use rubscope_solver::study::survey::Survey;

/// The margins that are being found. Dropping them ends the thread.
#[derive(Debug)]
pub struct MarginsStudy {
    coming: Background<LiveMargins>,
    live: Option<Arc<LiveMargins>>,
}

impl Study for MarginsStudy {
    type Key = CheckedScene;
    type Found = LiveMargins;
    const VIEW: ViewId = ViewId::Margins;
    const BESIDE: bool = true;

    fn key(given: &Given) -> Option<CheckedScene> {
        given.order.shows(ViewId::Margins).then(|| given.order.scene.clone())
    }

    fn begin(scene: &CheckedScene, _: &Given) -> Self {
        let theirs = scene.clone();
        let coming = Background::start(move |to, go_on| {
            let mut live = LiveMargins { margins: Margins::of(&theirs), survey: None };
            // Without a receiver nobody asks any more.
            let _ = to.send(live.clone());
            live.survey = Survey::of(&theirs, None, None).ok().map(Arc::new);
            let _ = to.send(live.clone());
            let LiveMargins { mut margins, survey } = live;
            on_spare_cores(|| {
                margins.ask_runs(go_on, &mut |margins| {
                    let (margins, survey) = (margins.clone(), survey.clone());
                    let _ = to.send(LiveMargins { margins, survey });
                })
            });
        });
        Self { coming, live: None }
    }

    fn is_done(&self) -> bool {
        self.coming.is_done()
    }

    fn work(&mut self, patience: Duration) {
        if let Some(live) = self.coming.receive(patience) {
            self.live = Some(Arc::new(live));
        }
    }

    fn found(&self) -> Option<&Arc<LiveMargins>> {
        self.live.as_ref()
    }

    fn wait(&mut self) -> bool {
        self.is_done()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::with_given;
    use super::*;
    use rubscope_solver::scene::Scene;

    #[test]
    fn the_margins_come_first_then_the_survey_and_last_what_runs_say() {
        let scene = Scene::builtin("paper-nd3").unwrap().checked().unwrap();
        let start = |given: &Given| MarginsStudy::begin(&scene, given);
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
