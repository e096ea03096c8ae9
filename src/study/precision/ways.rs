//! The ways to solve a scene: solver, contact law, model size, and a step or
//! a tolerance.

use std::time::Instant;

use serde::Serialize;

use super::TimedRun;
use crate::motion::{Event, GoOn, Motion, verdict_of};
use crate::scene::{CheckedScene, ContactLaw, ModelSize, Scene, SceneError, SolverKind};
use crate::tolerances::{self, LAST_PART};

/// Longest time step tried \[s\].
pub(super) const LONGEST: f64 = 1e-5;
/// Time steps tried \[s\].
const STEPS: [f64; 5] = [LONGEST, 1e-6, 5e-7, 1e-7, 1e-8];
/// Tolerances of the event solver tried, relative to the size of the motion.
const TOLERANCES: [f64; 4] = [1e-6, 1e-9, 1e-12, 1e-15];
/// One way to solve the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Way {
    /// Which solver.
    pub solver: SolverKind,
    /// Which contact law.
    pub contact: ContactLaw,
    /// Which model size.
    pub model: ModelSize,
    /// Time step; none for the event solver \[s\].
    pub step_s: Option<f64>,
    /// Tolerance; none for the explicit solver.
    pub tolerance: Option<f64>,
}

/// How much effort to spend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Runs a row, for the median.
    pub repeats: u32,
    /// Smallest time step tried \[s\].
    pub finest_s: f64,
    /// Seconds after which a row is no longer repeated.
    pub seconds: f64,
}

impl Default for Effort {
    fn default() -> Self {
        Self { repeats: 5, finest_s: 1e-8, seconds: 0.5 }
    }
}

/// Every way to solve a scene, coarse to fine. Refused combinations, such as steps
/// beyond the stability limit or the end, are left out.
#[must_use]
pub fn ways(scene: &Scene, effort: Effort) -> Vec<Way> {
    let mut ways = Vec::new();
    for model in [ModelSize::Rigid, ModelSize::Modal, ModelSize::Full] {
        for contact in [ContactLaw::Unilateral, ContactLaw::Bilateral] {
            for step in STEPS.into_iter().filter(|&step| step >= effort.finest_s) {
                let solver = SolverKind::Explicit;
                ways.push(Way { solver, contact, model, step_s: Some(step), tolerance: None });
            }
        }
    }
    for model in [ModelSize::Rigid, ModelSize::Modal] {
        for tolerance in TOLERANCES {
            let (solver, contact) = (SolverKind::Event, ContactLaw::Unilateral);
            ways.push(Way { solver, contact, model, step_s: None, tolerance: Some(tolerance) });
        }
    }
    ways.retain(|way| match way.of(scene) {
        // Beyond the paper the event solver has one tolerance, its own.
        Ok(scene) if scene.goes_beyond() => {
            way.tolerance.is_none_or(|tolerance| tolerance <= tolerances::EVENT)
        }
        found => found.is_ok(),
    });
    ways
}

impl Way {
    /// The scene solved this way.
    ///
    /// # Errors
    /// This way does not suit the scene.
    pub fn of(&self, scene: &Scene) -> Result<CheckedScene, SceneError> {
        let mut scene = scene.clone();
        scene.solver.kind = self.solver;
        scene.solver.contact = self.contact;
        scene.solver.model = self.model;
        if let Some(step) = self.step_s {
            scene.solver.step_s = step;
        }
        scene.checked()
    }

    pub(super) fn start(&self, scene: &Scene) -> Result<Motion, SceneError> {
        let scene = self.of(scene)?;
        Ok(match self.tolerance {
            Some(tolerance) if !scene.goes_beyond() => {
                Event::new(&scene)?.with_tolerance(tolerance).into()
            }
            _ => Motion::new(&scene),
        })
    }

    /// Runs to the end and times it; none where `go_on` said no on the way.
    pub(super) fn run(
        &self,
        scene: &Scene,
        go_on: GoOn<'_>,
    ) -> Result<Option<TimedRun>, SceneError> {
        let started = Instant::now();
        let mut motion = self.start(scene)?;
        let reached = motion.advance_while(scene.solver.end_s, go_on);
        if reached == Ok(false) {
            return Ok(None);
        }
        let wall_s = started.elapsed().as_secs_f64();
        let verdict = verdict_of(&motion, LAST_PART * scene.solver.end_s);
        Ok(Some(TimedRun { verdict, failed: reached.is_err(), wall_s, motion }))
    }
}
