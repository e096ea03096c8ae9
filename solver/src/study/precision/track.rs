//! Reference motion at any time near the end, which is needed because an explicit run ends at its
//! last step, up to one step before the end of the scene. A reference with halved steps is known
//! only at an instant that all its steps reach.

use std::f64::consts::TAU;
use std::time::Instant;

use super::halving::{self, Halved, Settled};
use super::ways::{Effort, LONGEST, Way};
use crate::motion::{GoOn, Motion, Verdict, VerdictReached, verdict_of};
use crate::scene::{ContactLaw, Scene, SceneError};
use crate::tolerances::{LAST_PART, LOCK_MOMENT, STEP_ROUND_OFF};

/// Reference for one model size, at the end of the run and shortly before.
pub(super) struct Track {
    /// Event solver, or explicit solver with the finest of the halved steps.
    pub(super) way: Way,
    pub(super) end: Motion,
    /// Verdict; for halved steps, that of the finest one.
    pub(super) verdict: Verdict,
    /// Wall time of the run \[s\].
    pub(super) wall_s: f64,
    solution: Solution,
}

enum Solution {
    /// Event solver: the motion at a time before which no explicit run ends.
    Events(Motion),
    /// Halved steps, and the time at which final states are compared \[s\].
    Steps(Settled, f64),
}

impl Track {
    /// Runs the event solver; `None` if `go_on` stopped it.
    pub(super) fn by_events(
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
        Ok(Some(Self { way, end, verdict, wall_s, solution: Solution::Events(before) }))
    }

    /// Runs the explicit solver with halved steps; `None` if `go_on` stopped it.
    pub(super) fn by_steps(
        way: Way,
        scene: &Scene,
        effort: Effort,
        go_on: GoOn<'_>,
    ) -> Result<Option<Self>, SceneError> {
        halving::check(way, scene, effort)?;
        let steps = halving::steps(way, scene, effort);
        let longest = steps.iter().fold(0.0, |most: f64, step| most.max(*step));
        let look_s = longest * (scene.solver.end_s / longest + STEP_ROUND_OFF).floor();
        let mut runs = Vec::new();
        let mut finest = None;
        for step_s in steps {
            let way = way.at_step(step_s);
            let Some(run) = way.run(scene, look_s, go_on)? else { return Ok(None) };
            let reached = (!run.failed).then(|| VerdictReached::of(&run.motion, run.verdict));
            runs.push(Halved { step_s, u: run.state.u, reached });
            finest = Some((way, run));
        }
        let Some((way, run)) = finest else { return Ok(None) };
        let machine = run.motion.machine();
        let moment = LOCK_MOMENT * TAU / machine.omega_c;
        let rigid = scene.solver.contact != ContactLaw::Smooth;
        let settled = halving::settle(&runs, machine.clearance().abs(), moment, rigid);
        let (verdict, wall_s) = (run.verdict, run.wall_s);
        let solution = Solution::Steps(settled, look_s);
        Ok(Some(Self { way, end: run.motion, verdict, wall_s, solution }))
    }

    /// Returns whether this is the reference for that solver, law and model size, whatever the
    /// step.
    pub(super) fn is_of(&self, reference: Result<Way, Way>) -> bool {
        let (Ok(way) | Err(way)) = reference;
        Way { step_s: None, ..self.way } == way
    }

    /// Returns the correct verdict; `None` if the halved steps disagree.
    pub(super) fn right(&self) -> Option<Verdict> {
        let one = self.settled().is_none_or(|settled| settled.one_verdict);
        one.then_some(self.verdict)
    }

    /// Returns the evaluation of the halved steps, if these are the reference.
    pub(super) fn settled(&self) -> Option<&Settled> {
        match &self.solution {
            Solution::Events(_) => None,
            Solution::Steps(settled, _) => Some(settled),
        }
    }

    /// Returns the time at which a run is compared with this reference \[s\].
    pub(super) fn look_s(&self, scene: &Scene) -> f64 {
        match &self.solution {
            Solution::Events(_) => scene.solver.end_s,
            Solution::Steps(_, look_s) => *look_s,
        }
    }

    /// Returns the casing displacement at time `t` of the run to be compared \[m\]; `None` if the
    /// reference failed before, or is not known at that time.
    pub(super) fn at(&self, t: f64) -> Option<[f64; 2]> {
        match &self.solution {
            Solution::Steps(settled, _) => settled.end.map(|(u, _)| u),
            Solution::Events(before) if t >= before.t_s() => {
                let mut motion = before.clone();
                motion.advance(t).ok()?;
                Some(motion.state().u)
            }
            Solution::Events(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::ways::reference;
    use super::super::{Measure, Method, distance, ways};
    use super::*;
    use crate::motion::to_the_end;
    use crate::scene::ModelSize;

    const EFFORT: Effort = Effort::QUICK;

    fn by_steps(scene: &Scene) -> (Track, Settled, f64) {
        let way = reference(scene, scene.solver.model).unwrap_err();
        let track = Track::by_steps(way, scene, EFFORT, &to_the_end).unwrap().unwrap();
        let settled = track.settled().unwrap().clone();
        let look_s = track.look_s(scene);
        (track, settled, look_s)
    }

    /// A negligible excitation excludes the event solver, which supplies the exact result without
    /// it.
    #[test]
    fn a_reference_by_steps_is_as_near_to_the_event_solver_as_it_says() {
        let mut found = Vec::new();
        for pulse in [3e3, 5e3, 1e4, 2e4, 2.5e4, 4e4, 6e4] {
            for speed in [350.0, 420.0, 500.0] {
                let mut scene = Scene::base().as_reference();
                scene.solver.end_s = 0.02;
                (scene.operation.pulse_n, scene.operation.speed_rad_s) = (pulse, speed);
                let exact = reference(&scene, ModelSize::Modal).unwrap();
                let exact = Track::by_events(exact, &scene, &to_the_end).unwrap().unwrap();
                scene.excitation.amplitude_nm = 1e-300;
                let (_, settled, look_s) = by_steps(&scene);
                let Some((u, error)) = settled.end else {
                    found.push(None);
                    continue;
                };
                let off = distance(u, exact.at(look_s).unwrap()) / scene.clearance();
                assert!(off <= error, "{pulse} N, {speed} rad/s: {off:e}, {error:e}, {settled:?}");
                found.push(Some(settled.method));
            }
        }
        // Most scenes have a reference, some with an order and some without.
        let of = |method| found.iter().filter(|other| **other == method).count();
        assert!(of(None) < 8 && of(Some(Method::FinestStep)) > 3, "{found:?}");
        assert!(of(Some(Method::Extrapolated)) > 0, "{found:?}");
    }

    /// The expected values come from a Runge-Kutta method of eighth order with the blade angles in
    /// the gaps.
    #[test]
    fn a_reference_on_a_lining_is_that_of_a_method_of_high_order() {
        let mut scene = Scene::builtin("coincidence").unwrap();
        (scene.operation.speed_rad_s, scene.solver.end_s) = (410.0, 0.05);
        let (track, settled, look_s) = by_steps(&scene);
        assert!((look_s - 0.05).abs() < 1e-12);
        let (u, error) = settled.end.unwrap();
        let off = distance(u, [-2.684_877_616e-7, 4.302_712_028e-7]);
        // The expected values have ten digits.
        assert!(off < 1e-15 && error < 1e-9, "{off:e} {error:e}");
        assert_eq!(settled.method, Method::Extrapolated);
        assert!((settled.order.unwrap() - 2.0).abs() < 0.01, "{settled:?}");
        assert_eq!(track.right(), Some(track.verdict));
    }

    /// With inclined or rubbing tips single blades affect the contact, so two disk modes are no
    /// reference.
    #[test]
    fn single_blades_beyond_the_paper_are_their_own_reference() {
        let by_events = |changes: &[(&str, &str)]| {
            let scene = Scene::builtin("paper-nd3").unwrap().with(changes).unwrap();
            [ModelSize::Rigid, ModelSize::Modal, ModelSize::Full]
                .map(|model| reference(&scene, model).is_ok())
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
