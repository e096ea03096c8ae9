//! The ways to solve a scene: combinations of solver, contact law, model size, and step or
//! tolerance.

use std::time::Instant;

use serde::Serialize;

use super::{TimedRun, halving};
use crate::motion::{ExactEvents, GoOn, Motion, verdict_of};
use crate::scene::{CheckedScene, ContactLaw, ModelSize, Scene, SceneError, SolverKind};
use crate::tolerances::{self, LAST_PART};

/// Longest time step used \[s\].
pub(super) const LONGEST: f64 = 1e-5;
/// Time steps used \[s\].
const STEPS: [f64; 5] = [LONGEST, 1e-6, 5e-7, 1e-7, 1e-8];
/// Tolerances used with the event solver, relative to the magnitude of the motion.
const TOLERANCES: [f64; 4] = [1e-6, 1e-9, 1e-12, 1e-15];
/// A way to solve the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Way {
    /// Solver.
    pub solver: SolverKind,
    /// Contact law.
    pub contact: ContactLaw,
    /// Model size.
    pub model: ModelSize,
    /// Time step; `None` for the event solver \[s\].
    pub step_s: Option<f64>,
    /// Tolerance; `None` for the explicit solver.
    pub tolerance: Option<f64>,
}

/// Effort to spend on a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Number of runs of each row, for the median.
    pub repeats: u32,
    /// Smallest time step used \[s\].
    pub finest_s: f64,
    /// Total time after which a row is not repeated any more \[s\].
    pub seconds: f64,
    /// Largest number of steps of a run if the reference uses halved steps.
    pub most_steps: f64,
}

impl Default for Effort {
    fn default() -> Self {
        Self { repeats: 5, finest_s: 1e-8, seconds: 0.5, most_steps: 3e6 }
    }
}

impl Effort {
    /// One run for each row and no step below that of the paper, for a quick result.
    pub const QUICK: Self = Self { repeats: 1, finest_s: 1e-7, seconds: 0.0, most_steps: 5e5 };
}

/// Returns every way to solve a scene, from coarse to fine, without steps beyond the stability
/// limit or the end, and without other combinations that are not allowed. If the reference uses
/// halved steps, their finest ones except the last are used.
#[must_use]
pub fn ways(scene: &Scene, effort: Effort) -> Vec<Way> {
    let laws: &[ContactLaw] = match scene.solver.contact {
        ContactLaw::Smooth => &[ContactLaw::Smooth],
        _ => &[ContactLaw::Unilateral, ContactLaw::Bilateral],
    };
    let mut ways = Vec::new();
    let allowed = effort.finest_s..=scene.solver.end_s;
    for model in [ModelSize::Rigid, ModelSize::Modal, ModelSize::Full] {
        let mut steps: Vec<f64> = STEPS.into_iter().filter(|step| allowed.contains(step)).collect();
        if let Err(by_steps) = reference(scene, model) {
            steps = halving::rows(by_steps, scene, effort);
        }
        for &contact in laws {
            let solver = SolverKind::Explicit;
            ways.extend(steps.iter().map(|&step| Way {
                solver,
                contact,
                model,
                step_s: Some(step),
                tolerance: None,
            }));
        }
    }
    for model in [ModelSize::Rigid, ModelSize::Modal] {
        if reference(scene, model).is_ok() {
            ways.extend(TOLERANCES.map(|tolerance| by_events(model, tolerance)));
        }
    }
    ways.retain(|way| match way.of(scene) {
        // Beyond the paper the event solver has a fixed tolerance.
        Ok(scene) if scene.has_other_tips() => {
            way.tolerance.is_none_or(|tolerance| tolerance <= tolerances::EVENT)
        }
        found => found.is_ok(),
    });
    ways
}

/// Returns the event solver with a model size and a tolerance.
pub(super) fn by_events(model: ModelSize, tolerance: f64) -> Way {
    Way {
        solver: SolverKind::Event,
        contact: ContactLaw::Unilateral,
        model,
        step_s: None,
        tolerance: Some(tolerance),
    }
}

/// Returns the reference for runs of a model size: the event solver. It represents the blades of
/// the full model by two modes, which is valid as long as single blades do not affect the contact.
///
/// # Errors
/// The event solver does not support this scene; returns the explicit solver to be used with halved
/// steps.
pub(super) fn reference(scene: &Scene, model: ModelSize) -> Result<Way, Way> {
    let smooth = scene.solver.contact == ContactLaw::Smooth;
    let contact = if smooth { ContactLaw::Smooth } else { ContactLaw::Unilateral };
    let by_steps =
        Way { solver: SolverKind::Explicit, contact, model, step_s: None, tolerance: None };
    let mut blades = scene.clone();
    (blades.solver.model, blades.solver.contact) = (model, contact);
    blades.contact.restitution = 0.0;
    let own = model == ModelSize::Full && blades.has_other_tips();
    let size = if model == ModelSize::Rigid { ModelSize::Rigid } else { ModelSize::Modal };
    let exact = by_events(size, tolerances::EVENT);
    if smooth || own || exact.of(scene).is_err() { Err(by_steps) } else { Ok(exact) }
}

impl Way {
    /// Returns the scene with these solver settings.
    ///
    /// # Errors
    /// The scene does not allow them.
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

    /// Returns the same way with another time step.
    pub(super) fn at_step(self, step_s: f64) -> Self {
        Self { step_s: Some(step_s), ..self }
    }

    pub(super) fn start(&self, scene: &Scene) -> Result<Motion, SceneError> {
        let scene = self.of(scene)?;
        Ok(match self.tolerance {
            Some(tolerance) if !scene.has_other_tips() => {
                ExactEvents::new(&scene)?.with_tolerance(tolerance).into()
            }
            _ => Motion::new(&scene),
        })
    }

    /// Runs to the end, records the state at time `look_s`, and measures the wall time; `None` if
    /// `go_on` stopped it.
    pub(super) fn run(
        &self,
        scene: &Scene,
        look_s: f64,
        go_on: GoOn<'_>,
    ) -> Result<Option<TimedRun>, SceneError> {
        let started = Instant::now();
        let mut motion = self.start(scene)?;
        let looked = motion.advance_while(look_s, go_on);
        let state = motion.state();
        let reached = looked.and_then(|_| motion.advance_while(scene.solver.end_s, go_on));
        if reached == Ok(false) {
            return Ok(None);
        }
        let wall_s = started.elapsed().as_secs_f64();
        let verdict = verdict_of(&motion, LAST_PART * scene.solver.end_s);
        Ok(Some(TimedRun { verdict, failed: reached.is_err(), state, wall_s, motion }))
    }
}
