//! Speed against error: every solver, law and model size on one scene, each
//! over its steps or tolerances, against the event solver as reference.
//!
//! An explicit run ends at its last step, up to a step before the end of the
//! scene, so the reference is evaluated at the time that each run really
//! reached. The reference itself is checked by halving its tolerance. Where a
//! tiny change of the pulse changes the outcome (a *sensitive* scene) end
//! states mean nothing, and only verdicts are compared.

mod track;
mod ways;

use serde::Serialize;

pub use ways::{Effort, Way, ways};

use crate::motion::{GoOn, Motion, Script, State, Verdict, VerdictReached, is_sensitive};
use crate::scene::{ContactLaw, ModelSize, Scene, SceneError, SolverKind};
use crate::tolerances;
use track::Track;

/// Impacts whose times are compared.
const FIRST_IMPACTS: usize = 4;

/// Result and cost of one way to solve the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// How it was solved.
    #[serde(flatten)]
    pub way: Way,
    /// `|u - u_ref|/g0` at the last instant this run reached; none on a
    /// sensitive scene, or where this run or the reference failed. Rates are
    /// not compared: in contact those of the explicit scheme are means over a
    /// step.
    pub error_final: Option<f64>,
    /// Largest error in the times of the first impacts \[s\]; none if the
    /// blades differ.
    pub error_impact_time_s: Option<f64>,
    /// Deepest penetration of an accepted state \[m\].
    pub max_penetration_m: f64,
    /// Median wall time \[s\].
    pub wall_s: f64,
    /// Wall time over the number of steps taken \[ns\].
    pub ns_per_step: Option<f64>,
    /// Time steps taken: computed one by one.
    pub steps: Option<u64>,
    /// Time steps skipped: done many at once; the run has the sum of both.
    pub steps_skipped: Option<u64>,
    /// Changes of mode.
    pub events: Option<u64>,
    /// The verdict.
    pub verdict: Verdict,
    /// Whether it equals the verdict of the reference.
    pub verdict_right: bool,
    /// Whether the contact law differs from that of the reference: a solution
    /// of another problem, which may correctly differ.
    pub other_law: bool,
}

impl Row {
    /// Whether it solves the same problem as the reference and has another
    /// verdict.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        !self.other_law && !self.verdict_right
    }
}

/// What everything is measured against.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reference {
    /// Always the event solver under unilateral contact.
    #[serde(flatten)]
    pub way: Way,
    /// Its verdict.
    pub verdict: Verdict,
    /// Its impacts.
    pub impact_count: u64,
    /// Whether the scene is sensitive.
    pub sensitive: bool,
    /// `|u - u_halved|/g0` at the end, with its tolerance halved; none where
    /// it failed.
    pub error_halved: Option<f64>,
    /// Median wall time \[s\].
    pub wall_s: f64,
}

/// The whole comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Precision {
    /// The scene; its solver settings are not used.
    pub scene: Scene,
    /// What everything is measured against.
    pub reference: Reference,
    /// One row a way.
    pub rows: Vec<Row>,
}

/// One run to the end.
struct TimedRun {
    motion: Motion,
    verdict: Verdict,
    failed: bool,
    wall_s: f64,
}

/// The reference for each model size.
pub struct Measure {
    scene: Scene,
    reference: Reference,
    tracks: [Track; 2],
}

/// The event solver on one model size.
fn by_events(model: ModelSize, tolerance: f64) -> Way {
    Way {
        solver: SolverKind::Event,
        contact: ContactLaw::Unilateral,
        model,
        step_s: None,
        tolerance: Some(tolerance),
    }
}

/// The model size of the reference for one size of a scene.
fn size_of_reference(model: ModelSize) -> ModelSize {
    if model == ModelSize::Rigid { ModelSize::Rigid } else { ModelSize::Modal }
}

impl Measure {
    /// Refuses a scene that the event solver does not support: then there is no
    /// reference.
    ///
    /// # Errors
    /// The key that the event solver does not know.
    pub fn check(scene: &Scene) -> Result<(), SceneError> {
        if scene.solver.contact == ContactLaw::Smooth {
            let allowed = "\"unilateral\" or \"bilateral\": the reference has rigid contact";
            return Err(SceneError::refused("solver.contact", "\"smooth\"", allowed));
        }
        by_events(size_of_reference(scene.solver.model), 0.0).of(scene).map(|_| ())
    }

    /// Solves the scene by the event solver, for rigid and for moving blades;
    /// none where `go_on` said no on the way.
    ///
    /// # Errors
    /// The key that the event solver does not support.
    pub fn new(scene: &Scene, go_on: GoOn<'_>) -> Result<Option<Self>, SceneError> {
        Self::check(scene)?;
        let model = size_of_reference(scene.solver.model);
        let finest = tolerances::EVENT;
        let chosen = by_events(model, finest);
        let resolved = chosen.of(scene)?;
        let halved = by_events(model, 0.5 * finest);
        let (Some(run), Some(halved)) = (chosen.run(scene, go_on)?, halved.run(scene, go_on)?)
        else {
            return Ok(None);
        };
        let reached = VerdictReached::of(&run.motion, run.verdict);
        let Some(sensitive) = is_sensitive(&resolved, &Script::default(), reached, go_on) else {
            return Ok(None);
        };
        let reference = Reference {
            way: chosen,
            verdict: run.verdict,
            impact_count: reached.impact_count,
            sensitive,
            error_halved: (!run.failed && !halved.failed).then(|| {
                distance(&run.motion.state(), &halved.motion.state())
                    / run.motion.machine().clearance()
            }),
            wall_s: run.wall_s,
        };
        let track = |model| Track::of(by_events(model, finest), scene, go_on);
        let tracks = track(ModelSize::Rigid)?.zip(track(ModelSize::Modal)?);
        Ok(tracks.map(|(rigid, modal)| Self {
            scene: scene.clone(),
            reference,
            tracks: [rigid, modal],
        }))
    }

    /// What everything is measured against.
    #[must_use]
    pub fn reference(&self) -> &Reference {
        &self.reference
    }

    /// Solves the scene one way, repeatedly, and compares; none where `go_on`
    /// said no on the way.
    ///
    /// # Errors
    /// This way does not suit the scene.
    pub fn row(
        &self,
        way: Way,
        effort: Effort,
        go_on: GoOn<'_>,
    ) -> Result<Option<Row>, SceneError> {
        let Some(first) = way.run(&self.scene, go_on)? else { return Ok(None) };
        let mut walls = vec![first.wall_s];
        while walls.len() < effort.repeats as usize
            && walls.iter().sum::<f64>() < effort.seconds
            && let Some(again) = way.run(&self.scene, go_on)?
        {
            walls.push(again.wall_s);
        }
        let wall_s = median(&mut walls);
        let size = size_of_reference(way.model);
        let track = self.tracks.iter().find(|track| track.model == size);
        let comparable = !self.reference.sensitive && !first.failed;
        let clearance = first.motion.machine().clearance();
        let reached = first.motion.state();
        let error_final = track
            .filter(|_| comparable)
            .and_then(|track| track.at(reached.t_s))
            .map(|exact| distance(&exact, &reached) / clearance);
        let steps = first.motion.steps_taken();
        Ok(Some(Row {
            way,
            error_final,
            error_impact_time_s: track.and_then(|track| impact_error(&track.end, &first.motion)),
            max_penetration_m: first.motion.checks().max_penetration_m,
            wall_s,
            ns_per_step: steps.filter(|&n| n > 0).map(|n| 1e9 * wall_s / n as f64),
            steps,
            steps_skipped: first.motion.steps_skipped(),
            events: first.motion.events(),
            verdict: first.verdict,
            verdict_right: first.verdict == self.reference.verdict,
            other_law: way.contact != self.reference.way.contact,
        }))
    }

    /// Puts rows together.
    #[must_use]
    pub fn report(self, rows: Vec<Row>) -> Precision {
        let Self { scene, reference, .. } = self;
        Precision { scene, reference, rows }
    }
}

/// `|u_a - u_b|` \[m\].
fn distance(a: &State, b: &State) -> f64 {
    (a.u[0] - b.u[0]).hypot(a.u[1] - b.u[1])
}

/// Largest difference in the times of the first impacts, if they are of the
/// same blades \[s\].
fn impact_error(reference: &Motion, motion: &Motion) -> Option<f64> {
    let (expected, found) = (&reference.contacts().impacts, &motion.contacts().impacts);
    let count = expected.len().min(FIRST_IMPACTS);
    if count == 0 || found.len() < count {
        return None;
    }
    let pairs = || expected.iter().zip(found).take(count);
    pairs()
        .all(|(a, b)| a.side == b.side)
        .then(|| pairs().fold(0.0_f64, |worst, (a, b)| worst.max((a.t_s - b.t_s).abs())))
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values {
        [] => 0.0,
        _ if values.len() % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::to_the_end;

    fn quick() -> Effort {
        Effort { repeats: 1, finest_s: 1e-7, seconds: 0.0 }
    }

    fn rows(scene: &Scene, chosen: impl Fn(&Way) -> bool) -> (Reference, Vec<Row>) {
        let measure = Measure::new(scene, &to_the_end).unwrap().unwrap();
        let rows = ways(scene, quick())
            .into_iter()
            .filter(chosen)
            .map(|way| measure.row(way, quick(), &to_the_end).unwrap().unwrap())
            .collect();
        (measure.reference().clone(), rows)
    }

    #[test]
    fn errors_of_the_explicit_solver_fall_with_its_step() {
        let (reference, rows) = rows(&Scene::base(), |way| {
            way.model == ModelSize::Rigid
                && way.contact == ContactLaw::Unilateral
                && way.solver == SolverKind::Explicit
        });
        assert!(reference.error_halved.unwrap() < 1e-12 && !reference.sensitive);
        let errors: Vec<f64> = rows.iter().map(|row| row.error_final.unwrap()).collect();
        assert_eq!(errors.len(), 4);
        assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "{errors:?}");
        // Order one in contact: two decades of step, two decades of error.
        assert!((errors[0] / errors[3]).log10() > 1.7, "{errors:?}");
        assert!(rows.iter().all(|row| row.verdict_right));
    }

    #[test]
    fn the_event_solver_is_exact_at_every_tolerance_that_is_tight() {
        let (_, rows) = rows(&Scene::base(), |way| {
            way.solver == SolverKind::Event && way.tolerance <= Some(1e-9)
        });
        assert!(rows.iter().all(|row| row.error_final.unwrap() < 1e-8), "{rows:?}");
    }

    #[test]
    fn a_step_too_long_is_left_out() {
        let mut scene = Scene::base();
        scene.casing.modal_mass_kg = 2e-6;
        assert!(ways(&scene, quick()).iter().all(|way| way.step_s.is_none_or(|h| h < 1e-5)));
    }

    #[test]
    fn medians() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), 2.5);
    }
}
