//! The type of a scene that can be solved; the solvers take only this.

use super::{keys, modes};
use std::ops::Deref;

use serde::Serialize;

use super::{ContactLaw, KEYS, ModelSize, Scene, SceneError, SolverKind, check};

/// A scene whose keys and their combinations are all allowed.
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
    /// Returns the scene as reports write it: with a note where a diameter has no mode.
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
    /// Checks that the event solver supports the contact law, the model size and the
    /// excitation.
    ///
    /// # Errors
    /// It does not; the reason in one line.
    pub fn suits_events(&self) -> Result<(), SceneError> {
        check::event(&self.0)
    }

    /// Checks that nothing goes beyond the paper's model.
    ///
    /// # Errors
    /// It does, in one line.
    pub fn is_of_the_paper(&self) -> Result<(), SceneError> {
        if !self.has_other_tips() {
            return Ok(());
        }
        let allowed = "one without what goes beyond the paper, for the paper's own solver";
        Err(SceneError::refused("scene", &self.title, allowed))
    }

    /// Returns the scene, to be changed.
    #[must_use]
    pub fn into_scene(self) -> Scene {
        self.0
    }

    /// Returns this scene, run by every step: one by one, and to the end.
    #[must_use]
    pub fn by_every_step(mut self) -> Self {
        self.0.solver.plain = true;
        self
    }

    /// Returns this scene after a change that cannot break a bound: by round-off, or away from
    /// all bounds.
    pub(crate) fn perturbed(&self, change: impl FnOnce(&mut Scene)) -> Self {
        let mut scene = self.0.clone();
        change(&mut scene);
        Self(scene)
    }
}

/// A key that was changed to suit another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Adjustment {
    /// Dotted path.
    pub key: &'static str,
    /// The word it had.
    pub from: &'static str,
    /// The word it has.
    pub to: &'static str,
    /// The end of the sentence that begins with the word it had.
    pub why: &'static str,
}

impl Scene {
    /// Returns this scene as one that can be solved.
    ///
    /// # Errors
    /// The first key out of bounds, or the first combination that is not allowed
    /// (clearance, stable step, solver pairs), in one line.
    pub fn checked(&self) -> Result<CheckedScene, SceneError> {
        modes::check(self)?;
        for key in KEYS {
            key.check(&(key.get)(self))?;
        }
        check::check(self)?;
        Ok(CheckedScene(self.clone()))
    }

    /// Takes the nearest solver, contact law and model that are possible with what was asked
    /// for: one of these three, or the slope of the tips. What was asked for itself stays.
    /// Returns what was changed.
    pub fn make_compatible(&mut self, asked: impl Fn(&str) -> bool) -> Vec<Adjustment> {
        const KIND: &str = keys::SOLVER;
        const CONTACT: &str = keys::LAW;
        const MODEL: &str = keys::MODEL;
        let mut made = Vec::new();
        let inclined = self.bladed_disk.radial_coupling != 0.0;
        let solver = &mut self.solver;
        if inclined
            && solver.contact == ContactLaw::Bilateral
            && asked(keys::RADIAL_COUPLING)
            && !asked(CONTACT)
        {
            let why = "takes no inclined tips";
            made.push(Adjustment { key: CONTACT, from: "bilateral", to: "unilateral", why });
            solver.contact = ContactLaw::Unilateral;
        }
        if solver.kind != SolverKind::Event {
            return made;
        }
        let law = solver.contact.lacks_events().map(|_| solver.contact.into());
        let why = "the event solver does not know";
        let full = solver.model == ModelSize::Full;
        if asked(KIND) {
            if let Some(from) = law
                && !asked(CONTACT)
            {
                made.push(Adjustment { key: CONTACT, from, to: "unilateral", why });
                solver.contact = ContactLaw::Unilateral;
            }
            if full && !asked(MODEL) {
                made.push(Adjustment { key: MODEL, from: "full", to: "modal", why });
                solver.model = ModelSize::Modal;
            }
        } else if (asked(CONTACT) && law.is_some()) || (asked(MODEL) && full) {
            let why = "cannot do what the options ask";
            made.push(Adjustment { key: KIND, from: "event", to: "explicit", why });
            solver.kind = SolverKind::Explicit;
        }
        made
    }

    /// Returns this scene for the event solver, which knows one contact law.
    #[must_use]
    pub fn as_reference(&self) -> Self {
        let mut scene = self.clone();
        scene.solver.kind = SolverKind::Event;
        scene.solver.contact = ContactLaw::Unilateral;
        scene
    }
}
