//! The margins of one scene, in the background: the closed forms at once, the
//! smallest lasting pulses when they are found, which takes seconds.

use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Duration;

use super::background::{Background, spare_threads};
use super::thread::WORKER_NAME;
use crate::motion::GoOn;
use crate::scene::{CheckedScene, Scene};
use crate::study::margins::Margins;
use crate::tui::views::margins::LiveMargins;

/// The margins that are being found. Dropping them ends the thread.
#[derive(Debug)]
pub struct MarginsJob {
    scene: Scene,
    searches: bool,
    found: Background<LiveMargins>,
    live: Option<Arc<LiveMargins>>,
}

impl MarginsJob {
    /// Starts on a scene; whether lasting pulses are searched, too.
    pub fn of(scene: &CheckedScene, searches: bool) -> Self {
        let theirs = scene.clone();
        let found = Background::start(move |to, go_on| {
            let live = LiveMargins::of(Margins::of(&theirs));
            // Without a receiver nobody asks any more, and `go_on` says so.
            let _ = to.send(live.clone());
            if searches {
                search(live, to, go_on);
            }
        });
        Self { scene: scene.clone().into_scene(), searches, found, live: None }
    }

    /// Whether they belong to this scene.
    pub fn is_of(&self, scene: &Scene) -> bool {
        self.scene == *scene
    }

    /// Whether nothing more comes.
    pub fn is_done(&self) -> bool {
        self.found.is_done()
    }

    /// What is known so far.
    pub fn live(&self) -> Option<&Arc<LiveMargins>> {
        self.live.as_ref()
    }

    /// Takes what is found next, waiting for it no longer than `patience`.
    pub fn receive(&mut self, patience: Duration) {
        if let Some(live) = self.found.receive(patience) {
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
}

/// Searches under one law after the other.
fn search(mut live: LiveMargins, to: &Sender<LiveMargins>, go_on: GoOn<'_>) {
    let mut search = || {
        while let Some(law) = live.awaited.first().copied() {
            if !live.margins.search(law, go_on) {
                return;
            }
            live.awaited.remove(0);
            let _ = to.send(live.clone());
        }
    };
    // Not every core: the motion plays on. The panic hook knows these threads, too.
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(spare_threads())
        .thread_name(|_| WORKER_NAME.to_string())
        .build();
    match pool {
        Ok(pool) => pool.install(search),
        Err(_) => search(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::margins::LimitName;

    #[test]
    fn the_closed_forms_come_first_and_then_one_law_after_the_other() {
        let mut scene = Scene::base();
        scene.solver.end_s = 2e-3;
        scene.solver.step_s = 1e-6;
        let scene = scene.checked().unwrap();
        let mut job = MarginsJob::of(&scene, true);
        assert!(job.is_of(&scene) && !job.is_done());
        let mut awaited = Vec::new();
        while !job.is_done() {
            job.receive(Duration::from_millis(20));
            if let Some(live) = job.live() {
                assert_eq!(live.margins.scene, scene);
                awaited.push(live.awaited.len());
            }
        }
        awaited.dedup();
        assert_eq!(awaited, [2, 1, 0]);
        let margins = &job.live().unwrap().margins;
        assert!(margins.limit(LimitName::LastingPulse).is_some());
        let mut whole = Margins::of(&scene);
        assert!(margins.laws().into_iter().all(|law| whole.search(law, &|| true)));
        assert_eq!(margins.limits, whole.limits);
    }
}
