//! A scene that has passed all checks; the solvers accept only this type.

use std::ops::Deref;

use serde::Serialize;

use super::keys::{self, LAW, MODEL, SOLVER};
use super::{
    ContactLaw, KEYS, ModelSize, Scene, SceneError, SolverChoice, SolverKind, check, modes,
};

/// A scene whose keys and combinations of keys are all allowed.
///
/// ```
/// use rubscope_solver::scene::Scene;
/// let mut scene = Scene::builtin("paper-nd3")?;
/// scene.operation.speed_rad_s = f64::NAN;
/// let refused = scene.checked().unwrap_err();
/// assert!(refused.to_string().starts_with("operation.speed_rad_s = NaN"));
/// # Ok::<(), rubscope_solver::scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedScene(Scene);

impl Serialize for CheckedScene {
    fn serialize<S: serde::Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        self.0.reported().serialize(out)
    }
}

impl Scene {
    /// Returns the scene as reports write it: with notes on missing modes and on a changed initial
    /// position.
    pub fn reported(&self) -> impl Serialize {
        #[derive(Serialize)]
        struct Reported<'a> {
            #[serde(flatten)]
            scene: &'a Scene,
            #[serde(skip_serializing_if = "Option::is_none")]
            modes_note: Option<String>,
            #[serde(skip_serializing_if = "Option::is_none")]
            start_note: Option<String>,
        }
        let (modes_note, start_note) = (self.modes_note(), self.start_note());
        Reported { scene: self, modes_note, start_note }
    }
}

impl Deref for CheckedScene {
    type Target = Scene;
    fn deref(&self) -> &Scene {
        &self.0
    }
}

impl CheckedScene {
    /// Checks that the event solver supports the contact law, the model size and the excitation.
    ///
    /// # Errors
    /// States in one line what is not supported.
    pub fn suits_events(&self) -> Result<(), SceneError> {
        check::event(&self.0)
    }

    /// Unwraps the scene, which can then be changed.
    #[must_use]
    pub fn into_scene(self) -> Scene {
        self.0
    }

    /// Returns this scene with every step to be computed one by one, to the end of the run.
    #[must_use]
    pub fn by_every_step(mut self) -> Self {
        self.0.solver.plain = true;
        self
    }

    /// Applies a change that cannot violate a check: one within round-off, or away from all bounds.
    pub(crate) fn perturbed(&self, change: impl FnOnce(&mut Scene)) -> Self {
        let mut scene = self.0.clone();
        change(&mut scene);
        Self(scene)
    }
}

/// Change of a key that another key made necessary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Adjustment {
    /// Dotted path of the key.
    pub key: &'static str,
    /// Old value.
    pub from: &'static str,
    /// New value.
    pub to: &'static str,
    /// Reason, worded to follow the old value in a sentence.
    pub why: &'static str,
}

impl Scene {
    /// Checks the scene completely.
    ///
    /// # Errors
    /// Names the first key out of bounds, or the first combination that is not allowed (clearance,
    /// time step, features that a solver lacks).
    pub fn checked(&self) -> Result<CheckedScene, SceneError> {
        modes::check(self)?;
        for key in KEYS {
            key.check(&(key.get)(self))?;
        }
        check::check(self)?;
        Ok(CheckedScene(self.clone()))
    }

    /// Changes solver, contact law and model so that they are compatible with the keys that the
    /// user set (`asked`), which themselves stay. Returns what was changed.
    pub fn make_compatible(&mut self, asked: impl Fn(&str) -> bool) -> Vec<Adjustment> {
        let mut made = Vec::new();
        let needs = [
            (keys::RADIAL_COUPLING, self.bladed_disk.radial_coupling, "takes no inclined tips"),
            (keys::FRICTION, self.contact.friction, "takes no friction"),
            (keys::RESTITUTION, self.contact.restitution, "takes no restitution"),
        ];
        let needs = needs.into_iter().find(|(key, value, _)| *value != 0.0 && asked(key));
        let mut change = |key, from, to, why| made.push(Adjustment { key, from, to, why });
        if let Some((_, _, why)) = needs
            && self.solver.contact == ContactLaw::Bilateral
            && !asked(LAW)
        {
            change(LAW, "bilateral", "unilateral", why);
            self.solver.contact = ContactLaw::Unilateral;
        }
        if self.solver.kind == SolverKind::Explicit {
            return made;
        }
        if !asked(SOLVER) {
            let refused = self.checked().err();
            let by_steps = SolverChoice { kind: SolverKind::Explicit, ..self.solver.clone() };
            let by_steps = Self { solver: by_steps, ..self.clone() };
            if let Some(SceneError::Refused { key, .. }) = refused
                && asked(&key)
                && by_steps.checked().is_ok()
            {
                *self = by_steps;
                change(SOLVER, "event", "explicit", "cannot do this");
            }
            return made;
        }
        let why = "the event solver does not know";
        if self.solver.contact.lacks_events().is_some() && !asked(LAW) {
            change(LAW, self.solver.contact.into(), "unilateral", why);
            self.solver.contact = ContactLaw::Unilateral;
        }
        if self.solver.model == ModelSize::Full && !asked(MODEL) {
            change(MODEL, "full", "modal", why);
            self.solver.model = ModelSize::Modal;
        }
        made
    }

    /// Returns the scene with the event solver and the unilateral law, the only one it supports.
    #[must_use]
    pub fn as_reference(&self) -> Self {
        let mut scene = self.clone();
        scene.solver.kind = SolverKind::Event;
        scene.solver.contact = ContactLaw::Unilateral;
        scene
    }
}
