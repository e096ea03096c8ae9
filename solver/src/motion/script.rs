//! Changes during a run: what a user does to a running motion, as data, so that it
//! can be repeated without a screen.

use super::{Failure, GoOn, Motion};
use crate::scene::keys::{self, Live};
use crate::scene::{CheckedScene, ContactLaw, Scene, SolverKind};

/// One change of a running motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// The pulse is fired again.
    Pulse,
    /// From now on, the rotor turns with another acceleration, from this speed or
    /// from the one it has.
    Rotor {
        /// \[rad/s\]
        speed: Option<f64>,
        /// \[rad/s^2\]
        ramp: f64,
    },
    /// From now on, the motion has the parameters of this checked scene.
    Parameters(Box<CheckedScene>),
}

impl Change {
    /// Whether a running motion of one scene can go on with the parameters of another:
    /// by time steps, where no key differs that makes another motion, nor where one goes
    /// beyond the paper or has a lining and the other has not.
    #[must_use]
    pub fn is_live(before: &Scene, now: &Scene) -> bool {
        now.solver.kind == SolverKind::Explicit
            && Self::crosses(before, now).is_none()
            && keys::differing(before, now).all(|key| key.live != Live::Never)
    }

    /// What is allowed instead, where one of two scenes goes beyond the paper's model, or has a
    /// lining, and the other has not: a motion has the steps of one of them from its start on.
    #[must_use]
    pub fn crosses(before: &Scene, now: &Scene) -> Option<&'static str> {
        let lined = |scene: &Scene| scene.solver.contact == ContactLaw::Smooth;
        match (before.goes_beyond(), now.goes_beyond()) {
            _ if lined(before) != lined(now) => {
                Some("the law of the start: a running motion keeps its lining, or has none")
            }
            (false, true) => Some(
                "a value that stays in the paper's model: a running motion does not leave it \
                 (start beyond it, such as with bladed_disk.radial_coupling = 1e-9)",
            ),
            (true, false) => Some(
                "a value that stays beyond the paper's model: a running motion does not return \
                 to it (such as 1e-9 in place of 0)",
            ),
            _ => None,
        }
    }

    /// Whether what differs acts on a running motion, and nothing of it needs another one.
    #[must_use]
    pub fn acts_live(before: &Scene, now: &Scene) -> bool {
        let mut differing = keys::differing(before, now).map(|key| key.live);
        if differing.clone().all(|live| live == Live::Always) {
            return true;
        }
        Self::is_live(before, now) && differing.all(|live| live != Live::Start)
    }

    /// What a running motion of one scene takes over from another. A ramp that
    /// is changed alone goes on from the speed there is.
    #[must_use]
    pub fn between(before: &CheckedScene, now: &CheckedScene) -> Vec<Self> {
        let (old, new) = (&before.operation, &now.operation);
        let speed = (old.speed_rad_s != new.speed_rad_s).then_some(new.speed_rad_s);
        let ramp = new.speed_ramp_rad_s2;
        let turns = speed.is_some() || old.speed_ramp_rad_s2 != ramp;
        let rotor = turns.then_some(Self::Rotor { speed, ramp });
        rotor.into_iter().chain([Self::Parameters(Box::new(now.clone()))]).collect()
    }
}

impl Motion {
    /// Changes the motion from now on.
    pub fn apply(&mut self, change: &Change) {
        match change {
            Change::Pulse => self.fire(),
            Change::Rotor { speed, ramp } => {
                let now = self.rotor().speed(self.t_s());
                self.set_speed(speed.unwrap_or(now), *ramp);
            }
            Change::Parameters(scene) => self.set_parameters(scene),
        }
    }
}

/// Changes in order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Script {
    changes: Vec<(f64, Change)>,
}

impl Script {
    /// These changes, each at its time \[s\]; those at one instant in the order
    /// given.
    #[must_use]
    pub fn new(mut changes: Vec<(f64, Change)>) -> Self {
        changes.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        Self { changes }
    }

    /// The changes, in order of time \[s\].
    #[must_use]
    pub fn changes(&self) -> &[(f64, Change)] {
        &self.changes
    }

    /// The same times with other changes.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(Change) -> Change) -> Self {
        let changes = self.changes.iter().map(|(t, change)| (*t, map(change.clone())));
        Self { changes: changes.collect() }
    }
}

/// A motion that goes through a script.
#[derive(Clone, Debug)]
pub(super) struct Scripted<'a> {
    pub motion: Motion,
    to_come: &'a [(f64, Change)],
}

impl<'a> Scripted<'a> {
    pub fn new(motion: Motion, script: &'a Script) -> Self {
        Self { motion, to_come: &script.changes }
    }

    /// Advances to `until` \[s\], through the changes due by then; false where
    /// `go_on` said no on the way.
    ///
    /// # Errors
    /// The run has failed, now or before.
    pub fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        while let Some(((t, change), rest)) = self.to_come.split_first()
            && *t <= until
        {
            if !self.motion.advance_while(*t, go_on)? {
                return Ok(false);
            }
            self.to_come = rest;
            self.motion.apply(change);
        }
        self.motion.advance_while(until, go_on)
    }

    /// Whether every change has been made.
    pub fn is_through(&self) -> bool {
        self.to_come.is_empty()
    }
}
