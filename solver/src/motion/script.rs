//! Changes of parameters during a run as data, so that an interactive session can be repeated.

use std::sync::Arc;

use super::{Failure, GoOn, Motion};
use crate::scene::keys::{self, Live};
use crate::scene::{CheckedScene, ContactLaw, Scene, SolverKind};

/// A change of a running motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Fires the pulse again.
    Pulse,
    /// Sets the acceleration of the rotor, and its speed unless that continues.
    Rotor {
        /// Rotor speed; `None` keeps the present one \[rad/s\].
        speed: Option<f64>,
        /// Rotor acceleration \[rad/s^2\].
        ramp: f64,
    },
    /// Applies the parameters of this scene.
    Parameters(Arc<CheckedScene>),
}

impl Change {
    /// Returns whether a running motion of one scene can continue with the parameters of another:
    /// only with the explicit solver, if no key differs that requires a new motion, and if both
    /// scenes are within or beyond the paper's model and both have a lining or none.
    #[must_use]
    pub fn is_live(before: &Scene, now: &Scene) -> bool {
        now.solver.kind == SolverKind::Explicit
            && Self::crosses(before, now).is_none()
            && keys::differing(before, now).all(|key| key.live != Live::Never)
    }

    /// Returns what is allowed instead, if one of two scenes is beyond the paper's model, or has a
    /// lining, and the other is not. The stepping algorithm of a motion is chosen at its start.
    #[must_use]
    pub fn crosses(before: &Scene, now: &Scene) -> Option<&'static str> {
        let lined = |scene: &Scene| scene.solver.contact == ContactLaw::Smooth;
        match (before.goes_beyond(), now.goes_beyond()) {
            _ if lined(before) != lined(now) => {
                Some("the initial law: a running motion cannot gain or lose a lining")
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

    /// Returns whether a running motion can take over all differences between two scenes. A
    /// difference in the initial state needs a new motion.
    #[must_use]
    pub fn acts_live(before: &Scene, now: &Scene) -> bool {
        let mut differing = keys::differing(before, now).map(|key| key.live);
        if differing.clone().all(|live| live == Live::Always) {
            return true;
        }
        Self::is_live(before, now) && differing.all(|live| live != Live::Start)
    }

    /// Returns the changes that take a running motion from one scene to another. If only the ramp
    /// differs, the present speed continues.
    #[must_use]
    pub fn between(before: &CheckedScene, now: &CheckedScene) -> Vec<Self> {
        let (old, new) = (&before.operation, &now.operation);
        let speed = (old.speed_rad_s != new.speed_rad_s).then_some(new.speed_rad_s);
        let ramp = new.speed_ramp_rad_s2;
        let turns = speed.is_some() || old.speed_ramp_rad_s2 != ramp;
        let rotor = turns.then_some(Self::Rotor { speed, ramp });
        rotor.into_iter().chain([Self::Parameters(Arc::new(now.clone()))]).collect()
    }
}

impl Motion {
    /// Applies a change at the present instant.
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

/// Changes in order of time, which copies of the script share.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Script {
    changes: Arc<Vec<(f64, Change)>>,
}

impl Script {
    /// Creates a script from changes with their times \[s\]; changes at the same time keep their
    /// order.
    #[must_use]
    pub fn new(mut changes: Vec<(f64, Change)>) -> Self {
        changes.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        Self { changes: Arc::new(changes) }
    }

    /// Returns the changes in order of time \[s\].
    #[must_use]
    pub fn changes(&self) -> &[(f64, Change)] {
        &self.changes
    }

    /// Replaces each change and keeps the times.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(Change) -> Change) -> Self {
        let changes = self.changes.iter().map(|(t, change)| (*t, map(change.clone())));
        Self { changes: Arc::new(changes.collect()) }
    }

    /// Returns the number of changes with which both scripts begin.
    #[must_use]
    pub fn common(&self, other: &Self) -> usize {
        let pairs = self.changes.iter().zip(other.changes.iter());
        pairs.take_while(|(own, theirs)| own == theirs).count()
    }
}

/// A motion that follows a script.
#[derive(Clone, Debug)]
pub struct Scripted {
    /// The motion, with the changes up to its time.
    pub motion: Motion,
    script: Script,
    /// Number of changes that the motion has.
    applied: usize,
}

impl Scripted {
    /// Starts a script with a motion that has none of its changes.
    #[must_use]
    pub fn new(motion: Motion, script: &Script) -> Self {
        Self { motion, script: script.clone(), applied: 0 }
    }

    /// Advances to `until` \[s\] and applies the changes due by then; returns false if `go_on` did.
    ///
    /// # Errors
    /// The run has failed, now or before.
    pub fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        Ok(self.apply_due(until, go_on)? && self.motion.advance_while(until, go_on)?)
    }

    /// As [`advance_while`](Self::advance_while), with [`approach`](super::Solver::approach) after
    /// the changes.
    ///
    /// # Errors
    /// The run has failed, now or before.
    pub fn approach(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        Ok(self.apply_due(until, go_on)? && self.motion.approach(until, go_on)?)
    }

    fn apply_due(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        while let Some((t, change)) = self.script.changes.get(self.applied)
            && *t <= until
        {
            if !self.motion.advance_while(*t, go_on)? {
                return Ok(false);
            }
            self.motion.apply(change);
            self.applied += 1;
        }
        Ok(true)
    }

    /// Returns whether all changes have been applied.
    #[must_use]
    pub fn is_through(&self) -> bool {
        self.applied >= self.script.changes.len()
    }

    /// Returns a copy that goes on with another script, of which the first `common` changes are
    /// those of this one. `None` if the motion has a change that the other script lacks, or is past
    /// a change that it does not have.
    #[must_use]
    pub fn under(&self, script: &Script, common: usize) -> Option<Self> {
        let next = script.changes.get(self.applied);
        let is_ahead = next.is_none_or(|(t, _)| *t >= self.motion.t_s());
        let shared = self.applied <= common && is_ahead;
        shared.then(|| Self { script: script.clone(), ..self.clone() })
    }
}
