//! The margins of one scene, in the background: the closed forms at once, the
//! smallest lasting pulses when they are found, which takes seconds.

use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Duration;

use super::{Given, Study};
use crate::tui::views::id::ViewId;
use crate::tui::views::margins::live::LiveMargins;
use crate::tui::worker::background::{Background, on_spare_cores};
use rubscope_solver::motion::GoOn;
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::study::margins::Margins;
use rubscope_solver::study::survey::Survey;

/// The margins that are being found. Dropping them ends the thread.
#[derive(Debug)]
pub struct MarginsStudy {
    searches: bool,
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

    fn begin(scene: &CheckedScene, given: &Given) -> Self {
        let (theirs, searches) = (scene.clone(), given.bounds.searches);
        let coming = Background::start(move |to, go_on| {
            let mut live = LiveMargins::of(Margins::of(&theirs));
            // Without a receiver nobody asks any more, and `go_on` says so.
            let _ = to.send(live.clone());
            live.survey = Some(Arc::new(Survey::of(&theirs, None, None)));
            let _ = to.send(live.clone());
            if searches {
                search(live, to, go_on);
            }
        });
        Self { searches, coming, live: None }
    }

    fn is_done(&self) -> bool {
        self.coming.is_done()
    }

    fn work(&mut self, patience: Duration) {
        if let Some(live) = self.coming.receive(patience) {
            self.live = Some(Arc::new(live));
        } else if self.is_done()
            && self.searches
            && let Some(live) = &mut self.live
            && !live.awaited.is_empty()
        {
            // The thread ended early: nobody searches any more.
            Arc::make_mut(live).awaited.clear();
        }
    }

    fn part(&self) -> Option<f64> {
        let live = self.live.as_ref()?;
        // The closed forms, and then one law after the other.
        let all = 1 + live.margins.laws().len();
        Some((all - live.awaited.len()) as f64 / all as f64)
    }

    fn found(&self) -> Option<&Arc<LiveMargins>> {
        self.live.as_ref()
    }

    fn wait(&mut self) -> bool {
        self.is_done()
    }
}

/// Searches under one law after the other.
fn search(mut live: LiveMargins, to: &Sender<LiveMargins>, go_on: GoOn<'_>) {
    on_spare_cores(|| {
        while let Some(law) = live.awaited.first().copied() {
            if !live.margins.search(law, go_on) {
                return;
            }
            live.awaited.remove(0);
            let _ = to.send(live.clone());
        }
    });
}

#[cfg(test)]
mod tests {
    use super::super::tests::with_given;
    use super::*;
    use rubscope_solver::scene::Scene;
    use rubscope_solver::study::margins::LimitName;

    #[test]
    fn the_closed_forms_come_first_and_then_one_law_after_the_other() {
        let mut scene = Scene::base();
        scene.solver.end_s = 2e-3;
        scene.solver.step_s = 1e-6;
        let scene = scene.checked().unwrap();
        let start = |given: &Given| MarginsStudy::begin(&scene, given);
        let mut job = with_given(&scene, ViewId::Margins, start);
        assert!(!job.is_done());
        let mut awaited = Vec::new();
        while !job.is_done() {
            job.work(Duration::from_millis(20));
            if let Some(live) = job.found() {
                assert_eq!(live.margins.scene, scene);
                awaited.push(live.awaited.len());
            }
        }
        awaited.dedup();
        assert_eq!(awaited, [2, 1, 0]);
        let margins = &job.found().unwrap().margins;
        assert!(margins.limit(LimitName::LastingPulse).is_some());
        let mut whole = Margins::of(&scene);
        assert!(margins.laws().into_iter().all(|law| whole.search(law, &|| true)));
        assert_eq!(margins.limits, whole.limits);
    }
}
