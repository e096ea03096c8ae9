//! Accuracy against cost: every combination of solver, contact law and model size for one scene,
//! with several steps or tolerances, compared with a reference. The reference is the event solver
//! or, if that does not support the scene (a lining, an excitation, speed ramps and single blades
//! beyond the paper), halved time steps.
//!
//! An explicit run ends at its last step, up to a step before the end of the scene, so the
//! reference is evaluated at the time that each run reached. The error of the reference is
//! estimated by halving its tolerance or its step. If a tiny change of the pulse alters the outcome
//! (a *sensitive* scene), or if halving the step keeps changing the final state, final states are
//! not meaningful and only verdicts are compared.

mod halving;
mod track;
mod ways;

use serde::Serialize;
use strum::IntoStaticStr;

pub use ways::{Effort, Way, ways};

use crate::motion::{GoOn, Motion, State, Verdict, VerdictReached, certainty};
use crate::scene::{Scene, SceneError};
use crate::tolerances;
use track::Track;
use ways::{by_events, reference};

/// Number of impacts whose times are compared.
const FIRST_IMPACTS: usize = 4;

/// Result and cost of one way to solve the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Solver, law, model size, and step or tolerance.
    #[serde(flatten)]
    pub way: Way,
    /// Error `|u - u_ref|/g0` at the last instant that this run reached; `None` for a sensitive
    /// scene, or if this run or the reference failed. Velocities are not compared, because in
    /// contact those of the explicit scheme are averages over a step.
    pub error_final: Option<f64>,
    /// Largest error of the times of the first impacts; `None` if they involve other blades \[s\].
    pub error_impact_time_s: Option<f64>,
    /// Deepest penetration of a corrected state \[m\].
    pub max_penetration_m: f64,
    /// Median wall time \[s\].
    pub wall_s: f64,
    /// Wall time divided by the number of computed steps \[ns\].
    pub ns_per_step: Option<f64>,
    /// Number of time steps computed one by one.
    pub steps: Option<u64>,
    /// Number of time steps skipped; the run consists of both.
    pub steps_skipped: Option<u64>,
    /// Number of events.
    pub events: Option<u64>,
    /// Verdict of the run.
    pub verdict: Verdict,
    /// Whether it equals the verdict of the reference of this model size; `None` if that has none.
    pub verdict_right: Option<bool>,
    /// Whether the contact law differs from that of the reference. The run then solves another
    /// problem and may correctly have another result.
    pub other_law: bool,
}

impl Row {
    /// Returns whether the run solves the same problem as the reference with another verdict.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        !self.other_law && self.verdict_right == Some(false)
    }
}

/// Method of computing a reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, IntoStaticStr, Serialize)]
#[serde(into = "&'static str")]
#[strum(serialize_all = "snake_case")]
pub enum Method {
    /// Event solver.
    Events,
    /// Final states at halved steps, with a clear order of convergence, extrapolated to a step of
    /// zero.
    Extrapolated,
    /// Final state at the finest step; halving the step changes it less and less.
    FinestStep,
    /// No reference exists.
    None(Lack),
}

/// Reason why there is no reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lack {
    /// Halving the step changes the final state no less than before.
    NotFalling,
    /// The changes decrease, but are still too large at the finest step.
    TooFar,
    /// The changes decrease, but impacts or verdict depend on the step.
    OtherMotions,
    /// Too few steps are short enough for the motion.
    TooFew,
    /// A run failed with a shorter step than one that succeeded.
    StepsFailed,
    /// The event solver failed.
    EventsFailed,
}

/// Reference of the comparison; other model sizes have references of their own.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reference {
    /// Event solver with unilateral contact, or explicit solver with the finest of the halved
    /// steps.
    #[serde(flatten)]
    pub way: Way,
    /// Method.
    pub method: Method,
    /// Verdict; without a reference, that of the finest step.
    pub verdict: Verdict,
    /// Number of impacts.
    pub impact_count: u64,
    /// Whether the scene is sensitive. `None` with halved steps, which show it by themselves.
    pub sensitive: Option<bool>,
    /// Estimated error of the final state, in units of the clearance; `None` without a reference.
    pub error: Option<f64>,
    /// Change of the final state by half the tolerance, or by the last halving of the step, in
    /// units of the clearance; `None` if that failed.
    pub error_halved: Option<f64>,
    /// Observed order of convergence with halved steps.
    pub order: Option<f64>,
    /// Change of the final state by each halving of the step, from coarse to fine, in units of the
    /// clearance.
    pub changes: Vec<f64>,
    /// Wall time of the reference run \[s\].
    pub wall_s: f64,
}

/// The complete comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Precision {
    /// Scene; its solver settings are not used.
    pub scene: Scene,
    /// Reference of the comparison.
    pub reference: Reference,
    /// Rows, one for each way.
    pub rows: Vec<Row>,
}

/// A run to the end.
struct TimedRun {
    motion: Motion,
    /// State at the time of comparison.
    state: State,
    verdict: Verdict,
    failed: bool,
    wall_s: f64,
}

/// Reference solutions for each model size.
pub struct Measure {
    scene: Scene,
    reference: Reference,
    tracks: Vec<Track>,
}

impl Measure {
    /// Rejects a scene that the event solver does not support and that is too long for a reference
    /// with halved steps.
    ///
    /// # Errors
    /// States the end of the scene.
    pub fn check(scene: &Scene, effort: Effort) -> Result<(), SceneError> {
        reference(scene, scene.solver.model)
            .map(|_| ())
            .or_else(|by_steps| halving::check(by_steps, scene, effort))
    }

    /// Computes the references of a scene for every model size among its ways; `None` if `go_on`
    /// stopped it.
    ///
    /// # Errors
    /// As [`check`](Self::check).
    pub fn new(scene: &Scene, effort: Effort, go_on: GoOn<'_>) -> Result<Option<Self>, SceneError> {
        let own = scene.solver.model;
        Self::check(scene, effort)?;
        let mut models = vec![own];
        models.extend(ways(scene, effort).iter().map(|way| way.model));
        models.dedup();
        let mut tracks: Vec<Track> = Vec::new();
        for model in models {
            let way = reference(scene, model);
            if tracks.iter().any(|track| track.is_of(way)) {
                continue;
            }
            let track = match way {
                Ok(exact) => Track::by_events(exact, scene, go_on)?,
                Err(by_steps) => Track::by_steps(by_steps, scene, effort, go_on)?,
            };
            let Some(track) = track else { return Ok(None) };
            tracks.push(track);
        }
        let Some(first) = tracks.first() else { return Ok(None) };
        let Some(reference) = described(first, scene, go_on)? else { return Ok(None) };
        Ok(Some(Self { scene: scene.clone(), reference, tracks }))
    }

    /// Returns the reference of the scene's own model size.
    #[must_use]
    pub fn reference(&self) -> &Reference {
        &self.reference
    }

    /// Solves the scene in one way, repeatedly, and compares the result; `None` if `go_on` stopped
    /// it.
    ///
    /// # Errors
    /// The scene does not allow this way.
    pub fn row(
        &self,
        way: Way,
        effort: Effort,
        go_on: GoOn<'_>,
    ) -> Result<Option<Row>, SceneError> {
        let of_size = reference(&self.scene, way.model);
        let track = self.tracks.iter().find(|track| track.is_of(of_size));
        let look_s = track.map_or(self.scene.solver.end_s, |track| track.look_s(&self.scene));
        let run = || way.run(&self.scene, look_s, go_on);
        let Some(first) = run()? else { return Ok(None) };
        let mut walls = vec![first.wall_s];
        while walls.len() < effort.repeats as usize
            && walls.iter().sum::<f64>() < effort.seconds
            && let Some(again) = run()?
        {
            walls.push(again.wall_s);
        }
        let wall_s = median(&mut walls);
        let comparable = self.reference.sensitive != Some(true) && !first.failed;
        let clearance = first.motion.machine().clearance().abs();
        let error_final = track
            .filter(|_| comparable)
            .and_then(|track| track.at(first.state.t_s))
            .map(|exact| distance(exact, first.state.u) / clearance);
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
            verdict_right: track.and_then(Track::right).map(|right| first.verdict == right),
            other_law: way.contact != self.reference.way.contact,
        }))
    }

    /// Combines the rows to a report.
    #[must_use]
    pub fn report(self, rows: Vec<Row>) -> Precision {
        let Self { scene, reference, .. } = self;
        Precision { scene, reference, rows }
    }
}

/// Describes the reference for the scene's own model size; `None` if `go_on` stopped it.
fn described(
    track: &Track,
    scene: &Scene,
    go_on: GoOn<'_>,
) -> Result<Option<Reference>, SceneError> {
    let mut reference = Reference {
        way: track.way,
        method: Method::Events,
        verdict: track.verdict,
        impact_count: track.end.contacts().impact_count,
        sensitive: None,
        error: None,
        error_halved: None,
        order: None,
        changes: Vec::new(),
        wall_s: track.wall_s,
    };
    if let Some(settled) = track.settled() {
        reference.method = settled.method;
        reference.error = settled.end.map(|(_, error)| error);
        reference.error_halved = settled.changes.last().copied();
        reference.order = settled.order;
        reference.changes.clone_from(&settled.changes);
        return Ok(Some(reference));
    }
    let halved = by_events(track.way.model, 0.5 * tolerances::EVENT);
    let Some(halved) = halved.run(scene, scene.solver.end_s, go_on)? else { return Ok(None) };
    if track.end.failure().is_none() && !halved.failed {
        let moved = distance(track.end.state().u, halved.state.u);
        reference.error = Some(moved / track.end.machine().clearance());
        reference.error_halved = reference.error;
    } else {
        reference.method = Method::None(Lack::EventsFailed);
    }
    let reached = VerdictReached::of(&track.end, track.verdict);
    let certainty = certainty(&track.way.of(scene)?, reached, false, go_on);
    reference.sensitive = certainty.map(|certainty| certainty.sensitive);
    Ok(reference.sensitive.map(|_| reference))
}

/// Returns `|u_a - u_b|` \[m\].
fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Returns the largest difference in the times of the first impacts \[s\]; `None` if they involve
/// other blades.
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
    use crate::scene::{ContactLaw, ModelSize, SolverKind};

    fn rows(scene: &Scene, chosen: impl Fn(&Way) -> bool) -> (Reference, Vec<Row>) {
        let measure = Measure::new(scene, Effort::QUICK, &to_the_end).unwrap().unwrap();
        let rows = ways(scene, Effort::QUICK)
            .into_iter()
            .filter(chosen)
            .map(|way| measure.row(way, Effort::QUICK, &to_the_end).unwrap().unwrap())
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
        assert!(reference.error_halved.unwrap() < 1e-12 && reference.sensitive == Some(false));
        let errors: Vec<f64> = rows.iter().map(|row| row.error_final.unwrap()).collect();
        assert_eq!(errors.len(), 4);
        assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "{errors:?}");
        // First order in contact: two decades of step give two decades of error.
        assert!((errors[0] / errors[3]).log10() > 1.7, "{errors:?}");
        assert!(rows.iter().all(|row| row.verdict_right == Some(true)));
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
        assert!(ways(&scene, Effort::QUICK).iter().all(|way| way.step_s.is_none_or(|h| h < 1e-5)));
    }

    #[test]
    fn medians() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), 2.5);
    }
}
