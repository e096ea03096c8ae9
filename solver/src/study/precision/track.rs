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

#[cfg(test)]
mod tests {
    use super::super::ways::reference;
    use super::super::{Effort, Measure, distance, ways};
    use super::*;
    use crate::motion::to_the_end;
    use crate::scene::{ModelSize, SolverKind};

    const EFFORT: Effort = Effort::QUICK;

    /// By a Runge-Kutta method of eighth order, with the full angles of the blades.
    #[test]
    fn a_reference_on_a_lining_is_that_of_a_method_of_high_order() {
        let mut scene = Scene::builtin("coincidence").unwrap();
        (scene.operation.speed_rad_s, scene.solver.end_s) = (410.0, 0.05);
        let way = reference(&scene, scene.solver.model, EFFORT).unwrap();
        assert_eq!((way.solver, way.step_s), (SolverKind::Explicit, Some(5e-7)));
        let track = Track::run(way, &scene, &to_the_end).unwrap().unwrap();
        let off = distance(track.at(0.05).unwrap(), [-2.684_877_616e-7, 4.302_712_028e-7]);
        // The casing moves by 5e-7 m.
        assert!(off < 1e-12, "{off:e}");
    }

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
