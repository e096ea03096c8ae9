//! The reference motion at any time near the end of the scene: an explicit run ends at its last
//! step, up to one step before that end.

use std::time::Instant;

use super::ways::{LONGEST, Way};
use crate::motion::LAST_PART;
use crate::motion::{GoOn, Motion, Verdict, verdict_of};
use crate::scene::{Scene, SceneError};

/// Reference for one model size, at the end of the run and shortly before.
pub(super) struct Track {
    /// Solver settings of the reference.
    pub(super) way: Way,
    pub(super) end: Motion,
    pub(super) verdict: Verdict,
    /// Wall time of the run \[s\].
    pub(super) wall_s: f64,
    /// The reference motion slightly more than the longest step before the end.
    before: Motion,
}

impl Track {
    /// Runs the reference; `None` if `go_on` stopped it.
    pub(super) fn run(
        way: Way,
        scene: &Scene,
        go_on: GoOn<'_>,
    ) -> Result<Option<Self>, SceneError> {
        let end_s = scene.solver.end_s;
        let started = Instant::now();
        let mut before = way.start(scene)?;
        // A failure is stored in the motion; [`at`](Self::at) then returns `None`.
        let early = before.advance_while((end_s - 1.01 * LONGEST).max(0.0), go_on);
        let mut end = before.clone();
        if early == Ok(false) || end.advance_while(end_s, go_on) == Ok(false) {
            return Ok(None);
        }
        let wall_s = started.elapsed().as_secs_f64();
        let verdict = verdict_of(&end, LAST_PART * end_s);
        Ok(Some(Self { way, end, verdict, wall_s, before }))
    }

    /// Returns the casing displacement at the time `t` at which a run ended \[m\]; `None` if the
    /// reference failed before it.
    pub(super) fn at(&self, t: f64) -> Option<[f64; 2]> {
        if t < self.before.t_s() {
            return None;
        }
        let mut motion = self.before.clone();
        motion.advance(t).ok()?;
        Some(motion.state().u)
    }
}
