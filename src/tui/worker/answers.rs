//! The latest verdict, and the run of an older scene that goes on to get one: while a knob is
//! turned faster than a run takes, the answers come as often as runs can.

use std::sync::Arc;
use std::time::Duration;

use super::full_run::FullRunJob;
use crate::scene::CheckedScene;
use crate::tui::engine::{Answer, FullRunState};

/// Wall time that an older run may still take after the last turn of a knob. A held key
/// comes again sooner, at any usual rate; somebody who has let go waits this much longer.
const HELD: Duration = Duration::from_millis(200);

/// The latest answer, and the run for the next.
#[derive(Debug, Default)]
pub struct Answers {
    latest: Option<Arc<Answer>>,
    older: Option<(CheckedScene, FullRunJob)>,
    left: Duration,
}

impl Answers {
    /// A run is not wanted any more: it goes on, unless another one does.
    pub fn turned_on(&mut self, scene: &CheckedScene, run: FullRunJob) {
        self.left = HELD;
        if self.older.is_none() && !run.is_done() && !run.wall().is_zero() {
            self.older = Some((scene.clone(), run));
        }
    }

    /// Whether an older run goes on.
    pub fn is_computing(&self) -> bool {
        self.older.is_some()
    }

    /// Computes a slice of the older run; false where none goes on.
    pub fn compute(&mut self) -> bool {
        let Some((_, run)) = &mut self.older else { return false };
        let before = run.wall();
        run.compute();
        let spent = run.wall().saturating_sub(before);
        self.spend(spent);
        true
    }

    /// So much wall time went into the older run: its result is noted, or it is given up.
    fn spend(&mut self, spent: Duration) {
        let Some((scene, run)) = &self.older else { return };
        self.left = self.left.saturating_sub(spent);
        let nearly = run.left().is_some_and(|left| left <= HELD);
        if run.is_done() || (self.left.is_zero() && !nearly) {
            let (scene, state) = (scene.clone(), run.state());
            self.older = None;
            self.note(&scene, &state);
        }
    }

    /// Notes the result of a run, if it is one.
    pub fn note(&mut self, scene: &CheckedScene, state: &FullRunState) {
        if let FullRunState::Done(run) = state {
            self.latest = Some(Arc::new(Answer { scene: scene.clone(), verdict: run.verdict }));
        }
    }

    /// The latest answer.
    pub fn latest(&self) -> Option<Arc<Answer>> {
        self.latest.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Motion;
    use crate::scene::Scene;

    fn run(speed: f64) -> (CheckedScene, FullRunJob) {
        let mut scene = Scene::builtin("slip").unwrap();
        scene.operation.speed_rad_s = speed;
        let scene = scene.checked().unwrap();
        let motion = Motion::new(&scene);
        (scene, FullRunJob::new(motion, 0.02).in_slices_of(Duration::from_micros(20)))
    }

    #[test]
    fn a_held_key_gets_the_answer_of_a_run_that_was_begun() {
        let mut answers = Answers::default();
        // Each run has a slice before the next turn of the knob, and takes many.
        let mut told = Vec::new();
        for turn in 0..100_000 {
            let (scene, mut run) = run(400.0 + 1e-3 * f64::from(turn));
            if !answers.compute() {
                run.compute();
            }
            answers.turned_on(&scene, run);
            let speed = answers.latest().map(|answer| answer.scene.operation.speed_rad_s);
            if told.last().copied() != speed {
                told.extend(speed);
            }
            if told.len() > 2 {
                break;
            }
        }
        // Not those of all values, but the next one begins when one is done.
        assert!(told.len() > 2 && told.is_sorted(), "{told:?}");
    }

    #[test]
    fn a_long_run_does_not_keep_a_key_that_was_let_go_waiting() {
        let mut answers = Answers::default();
        let scene = Scene::builtin("undamped").unwrap().as_reference().checked().unwrap();
        let mut run = FullRunJob::new(Motion::new(&scene), 1e6);
        run.compute();
        answers.turned_on(&scene, run);
        answers.spend(HELD / 2);
        assert!(answers.is_computing());
        answers.spend(HELD / 2);
        assert!(!answers.is_computing() && answers.latest().is_none());
    }

    #[test]
    fn the_run_that_was_begun_first_goes_on_and_one_that_was_not_begun_does_not() {
        let mut answers = Answers::default();
        let (scene, never) = run(399.0);
        answers.turned_on(&scene, never);
        assert!(!answers.is_computing());
        for speed in [400.0, 401.0] {
            let (scene, mut run) = run(speed);
            run.compute();
            assert!(!run.is_done());
            answers.turned_on(&scene, run);
        }
        answers.left = Duration::MAX;
        while answers.compute() {}
        assert_eq!(answers.latest().unwrap().scene.operation.speed_rad_s, 400.0);
    }
}
