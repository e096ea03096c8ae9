//! The motion of the same scene under the other contact law, for comparison.

use super::full_run::FullRunJob;
use super::page::Page;
use super::reading::Copies;
use super::recorder::Recorder;
use rubscope_solver::motion::{GoOn, Motion};
use rubscope_solver::scene::{CheckedScene, Scene, SceneError, SolverKind};

/// The scene under the other contact law, played up to the time of the main motion.
#[derive(Debug)]
pub struct Comparison {
    /// The motion under the other law.
    pub motion: Motion,
    /// Recorder of its bins and forces.
    pub recorder: Recorder,
    /// The run under the other law to its end.
    pub full_run: FullRunJob,
    /// Record of the page on the screen.
    pub page: Page,
    copies: Copies,
}

impl Comparison {
    /// Starts the comparison, for pages of `page_s` seconds; `None` if the scene does not allow the
    /// other law.
    pub fn of(scene: &Scene, page_s: f64) -> Option<Self> {
        let scene = other_law(scene).ok()?;
        let motion = Motion::new(&scene);
        let full_run = FullRunJob::new(motion.clone(), scene.solver.end_s);
        let (copies, page) = (Copies::of(&motion, page_s), Page::default());
        Some(Self { motion, recorder: Recorder::default(), full_run, page, copies })
    }

    /// Restarts the forecast after a change of the motion; the new run is `length` seconds long.
    pub fn changed(&mut self, length: f64) {
        self.copies.changed(&self.motion);
        self.page.forget();
        self.forecast(length);
    }

    /// Starts a new full run of `length` seconds from the current time.
    pub fn forecast(&mut self, length: f64) {
        self.full_run = FullRunJob::new(self.motion.clone(), length);
    }

    /// Moves to the latest known copy of the motion at or before `t`, if that is ahead.
    pub fn go_to(&mut self, t: f64) {
        if let Some(ahead) = self.before(t).filter(|ahead| ahead.t_s() > self.motion.t_s()) {
            self.motion = ahead;
            self.recorder = Recorder::from(&self.motion);
        }
    }

    /// Returns the latest known copy of the motion at or before `t` \[s\]; `None` if all are later.
    pub fn before(&self, t: f64) -> Option<Motion> {
        self.full_run.before(t).or_else(|| self.copies.before(t, &self.motion))
    }

    /// Plays up to the time `until` of the main motion; returns false if `go_on` stopped it before.
    pub fn catch_up(&mut self, until: f64, sample: f64, bin: f64, go_on: GoOn<'_>) -> bool {
        loop {
            let state = self.motion.state();
            self.recorder.record(&mut self.motion, &state, bin);
            self.copies.follow(&self.motion);
            let before = self.motion.t_s();
            let next = (before + sample).min(until);
            if next <= before {
                return true;
            }
            match self.motion.advance_while(next, go_on) {
                Ok(true) if self.motion.t_s() > before && go_on() => {}
                Ok(true) => return self.motion.t_s() <= before,
                Ok(false) => return false,
                // The motion stores its failure; the full run reports it.
                Err(_) => return true,
            }
        }
    }
}

/// Returns the scene under the other contact law, with the explicit solver, which supports both.
///
/// # Errors
/// Says in one line why the scene does not allow the other law.
pub fn other_law(scene: &Scene) -> Result<CheckedScene, SceneError> {
    let mut scene = scene.clone();
    scene.solver.kind = SolverKind::Explicit;
    scene.solver.contact = scene.solver.contact.other();
    scene.checked()
}
