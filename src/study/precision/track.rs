//! The reference motion at any time near the end. This is needed because an
//! explicit run ends at its last step, up to one step before the end of the scene.

use super::ways::{LONGEST, Way};
use crate::motion::{Motion, State};
use crate::scene::{ModelSize, Scene, SceneError};

/// The reference for one model size, at its end and a little before.
pub(super) struct Track {
    pub(super) model: ModelSize,
    /// A time after which every explicit run has at least one more step.
    before: Motion,
    pub(super) end: Motion,
}

impl Track {
    pub(super) fn of(way: Way, scene: &Scene) -> Result<Self, SceneError> {
        let end_s = scene.solver.end_s;
        let mut before = way.start(scene)?;
        // The motion stores a failure, and `at` returns none.
        let _ = before.advance((end_s - 1.01 * LONGEST).max(0.0));
        let mut end = before.clone();
        let _ = end.advance(end_s);
        Ok(Self { model: way.model, before, end })
    }

    /// The state at the instant `t` near the end \[s\]; none if it failed by
    /// then, or if that instant is not near the end.
    pub(super) fn at(&self, t: f64) -> Option<State> {
        if t < self.before.state().t_s {
            return None;
        }
        let mut motion = self.before.clone();
        motion.advance(t).ok()?;
        Some(motion.state())
    }
}
