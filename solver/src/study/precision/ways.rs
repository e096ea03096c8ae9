//! The solver settings that are compared: combinations of solver, contact law, model size, and step
//! or tolerance.

use std::time::Instant;

use serde::Serialize;

use super::TimedRun;
use crate::motion::{EVENT, Events, GoOn, LAST_PART, Motion, verdict_of};
use crate::scene::{CheckedScene, ContactLaw, ModelSize, Scene, SceneError, SolverKind};

/// Longest time step used \[s\].
pub(super) const LONGEST: f64 = 1e-5;
/// Time steps used \[s\].
const STEPS: [f64; 5] = [LONGEST, 1e-6, 5e-7, 1e-7, 1e-8];
/// Tolerances used with the event solver, relative to the magnitude of the motion.
const TOLERANCES: [f64; 4] = [1e-6, 1e-9, 1e-12, 1e-15];

/// Solver settings for one row of the comparison.
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
    /// Tolerance of the event solver for closed gaps, relative to the magnitude of the motion; `None`
    /// for the explicit solver.
    pub tolerance: Option<f64>,
    /// Whether every step is computed one by one.
    pub plain: bool,
}

/// Effort to spend on a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Number of runs of each row, for the median.
    pub repeats: u32,
    /// Smallest time step used \[s\].
    pub finest_s: f64,
    /// Total time after which a row is not repeated again \[s\].
    pub seconds: f64,
    /// Largest number of steps of a reference.
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

/// Returns all solver settings for a scene, coarse to fine, without the ones that the scene does not
/// allow (such as steps beyond the stability limit). If the reference is the explicit solver, its
/// step is the finest.
#[must_use]
pub fn ways(scene: &Scene, effort: Effort) -> Vec<Way> {
    let laws: &[ContactLaw] = match scene.solver.contact {
        ContactLaw::Smooth => &[ContactLaw::Smooth],
        _ => &[ContactLaw::Unilateral, ContactLaw::Bilateral],
    };
    let mut ways = Vec::new();
    for model in [ModelSize::Rigid, ModelSize::Modal, ModelSize::Full] {
        let Some(compared) = reference(scene, model, effort) else { continue };
        let finest = compared.step_s.unwrap_or(effort.finest_s);
        let allowed = finest..=scene.solver.end_s;
        let steps: Vec<f64> = STEPS.into_iter().filter(|step| allowed.contains(step)).collect();
        for &contact in laws {
            ways.extend(steps.iter().map(|&step| by_steps(contact, model, step)));
            // The same run with every step computed, to compare its time and error with skipping.
            let own = (scene.solver.contact, scene.solver.model) == (contact, model);
            if own && allowed.contains(&scene.solver.step_s) {
                let own = by_steps(contact, model, scene.solver.step_s);
                ways.push(Way { plain: true, ..own });
            }
        }
    }
    for model in [ModelSize::Rigid, ModelSize::Modal] {
        if reference(scene, model, effort).is_some_and(|way| way.solver == SolverKind::Event) {
            ways.extend(TOLERANCES.map(|tolerance| by_events(model, tolerance)));
        }
    }
    ways.retain(|way| way.of(scene).is_ok());
    ways
}

/// Returns settings of the explicit solver; the step is in \[s\].
fn by_steps(contact: ContactLaw, model: ModelSize, step: f64) -> Way {
    let solver = SolverKind::Explicit;
    Way { solver, contact, model, step_s: Some(step), tolerance: None, plain: false }
}

/// Returns settings of the event solver.
pub(super) fn by_events(model: ModelSize, tolerance: f64) -> Way {
    Way {
        solver: SolverKind::Event,
        contact: ContactLaw::Unilateral,
        model,
        step_s: None,
        tolerance: Some(tolerance),
        plain: false,
    }
}

/// Returns the settings of the reference for one model size: the event solver if it supports the
/// scene, otherwise the explicit solver at the finest step within `effort`; `None` if the run is too
/// long for that. For the full model the event solver uses the modes of the disk, which is valid
/// unless contact depends on single blades.
pub(super) fn reference(scene: &Scene, model: ModelSize, effort: Effort) -> Option<Way> {
    let smooth = scene.solver.contact == ContactLaw::Smooth;
    let contact = if smooth { ContactLaw::Smooth } else { ContactLaw::Unilateral };
    let mut blades = scene.clone();
    (blades.solver.model, blades.solver.contact) = (model, contact);
    blades.contact.restitution = 0.0;
    let own = model == ModelSize::Full && blades.has_other_tips();
    let size = if model == ModelSize::Rigid { ModelSize::Rigid } else { ModelSize::Modal };
    let exact = by_events(size, EVENT);
    if !smooth && !own && exact.of(scene).is_ok() {
        return Some(exact);
    }
    let end = scene.solver.end_s;
    let allowed = effort.finest_s.max(end / effort.most_steps)..=end;
    let steps = STEPS.into_iter().rev().filter(|step| allowed.contains(step));
    let mut ways = steps.map(|step| by_steps(contact, model, step));
    ways.find(|way| way.of(scene).is_ok())
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
        let scene = scene.checked()?;
        Ok(if self.plain { scene.by_every_step() } else { scene })
    }

    pub(super) fn start(&self, scene: &Scene) -> Result<Motion, SceneError> {
        let scene = self.of(scene)?;
        Ok(match self.tolerance {
            Some(tolerance) => Events::new(&scene)?.with_tolerance(tolerance).into(),
            None => Motion::new(&scene),
        })
    }

    /// Runs to the end, and measures the wall time; `None` if `go_on` stopped it.
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

#[cfg(test)]
mod tests {
    use super::super::Measure;
    use super::*;

    const EFFORT: Effort = Effort::QUICK;

    /// With inclined or rubbing tips single blades affect the contact, so two disk modes are no
    /// reference.
    #[test]
    fn single_blades_beyond_the_paper_are_their_own_reference() {
        let by_events = |changes: &[(&str, &str)]| {
            let scene = Scene::builtin("paper-nd3").unwrap().with(changes).unwrap();
            [ModelSize::Rigid, ModelSize::Modal, ModelSize::Full]
                .map(|model| reference(&scene, model, EFFORT).unwrap().solver == SolverKind::Event)
        };
        let pushes = ("solver.contact", "unilateral");
        assert_eq!(by_events(&[]), [true; 3]);
        assert_eq!(by_events(&[pushes, ("contact.restitution", "0.5")]), [true; 3]);
        for key in ["bladed_disk.radial_coupling", "contact.friction"] {
            assert_eq!(by_events(&[pushes, (key, "0.1")]), [true, true, false], "{key}");
        }
        assert_eq!(by_events(&[("solver.contact", "smooth")]), [false; 3]);
        let ramp = [pushes, ("operation.speed_ramp_rad_s2", "10"), ("contact.friction", "0.1")];
        assert_eq!(by_events(&ramp), [true, false, false]);
        // The full model is too long for a reference with halved steps and has no rows; the others
        // stay.
        let mut long = Scene::builtin("friction-lock").unwrap().as_reference();
        long.solver.end_s = 200.0;
        let models: Vec<_> = ways(&long, EFFORT).iter().map(|way| way.model).collect();
        assert!(models.contains(&ModelSize::Modal) && !models.contains(&ModelSize::Full));
        assert_eq!(Measure::check(&long, EFFORT), Ok(()));
    }
}
