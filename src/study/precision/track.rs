//! The reference motion at any time near the end. This is needed because an
//! explicit run ends at its last step, up to one step before the end of the scene.

use super::ways::{LONGEST, Way};
use crate::motion::{GoOn, Motion, State};
use crate::scene::{ModelSize, Scene, SceneError};

/// The reference for one model size, at its end and a little before.
pub(super) struct Track {
    pub(super) model: ModelSize,
    /// A time after which every explicit run has at least one more step.
    before: Motion,
    pub(super) end: Motion,
}

impl Track {
    /// None where `go_on` said no on the way.
    pub(super) fn of(way: Way, scene: &Scene, go_on: GoOn<'_>) -> Result<Option<Self>, SceneError> {
        let end_s = scene.solver.end_s;
        let mut before = way.start(scene)?;
        // The motion stores a failure, and `at` returns none.
        let early = before.advance_while((end_s - 1.01 * LONGEST).max(0.0), go_on);
        let mut end = before.clone();
        if early == Ok(false) || end.advance_while(end_s, go_on) == Ok(false) {
            return Ok(None);
        }
        Ok(Some(Self { model: way.model, before, end }))
    }

    /// The state at the instant `t` near the end \[s\]; none if it failed by
    /// then, or if that instant is not near the end.
    pub(super) fn at(&self, t: f64) -> Option<State> {
        if t < self.before.t_s() {
            return None;
        }
        let mut motion = self.before.clone();
        motion.advance(t).ok()?;
        Some(motion.state())
    }
}
