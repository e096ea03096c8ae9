//! Wall time against error on one scene, for every solver, law and model size, each with several
//! steps or tolerances. The reference is the event solver or, for a scene that it does not support (a
//! lining, an excitation, ramps and single blades beyond the paper), the explicit solver at its
//! finest step.
//!
//! An explicit run ends at its last step, up to a step before the end of the scene, so the reference
//! is evaluated at the time that each run reached. The error of the reference is estimated with half
//! its tolerance or twice its step. In a *sensitive* scene a tiny change of the pulse changes the
//! outcome; end states then mean nothing, and only verdicts are compared.

mod track;
mod ways;

use serde::Serialize;
use strum::IntoStaticStr;

pub use ways::{Effort, Way, ways};

use crate::motion::{GoOn, Motion, Verdict, VerdictReached, certainty};
use crate::scene::{Scene, SceneError, SolverKind, keys};
use track::Track;
use ways::reference;

/// Number of impacts whose times are compared.
const FIRST_IMPACTS: usize = 4;

/// Result and cost of one way to solve the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Solver, law, model size, and step or tolerance.
    pub way: Way,
    /// Error `|u - u_ref|/g0` at the last instant that this run reached; `None` for a sensitive
    /// scene, if this run or the reference failed, or if another contact law gives another
    /// verdict. Velocities are not compared, because in contact the explicit scheme computes their
    /// averages over a step.
    pub error_final: Option<f64>,
    /// Largest error of the times of the first impacts \[s\]; `None` without a reference, and if this
    /// run has fewer impacts or impacts on other blades.
    pub error_impact_time_s: Option<f64>,
    /// Deepest penetration of a corrected state \[m\].
    pub max_penetration_m: f64,
    /// Median wall time \[s\].
    pub wall_s: f64,
    /// Wall time divided by the number of computed steps; `None` if there are none \[ns\].
    pub ns_per_step: Option<f64>,
    /// Number of time steps computed one by one; `None` for the event solver.
    pub steps: Option<u64>,
    /// Number of time steps skipped; the run consists of both. `None` for the event solver.
    pub steps_skipped: Option<u64>,
    /// Number of events; `None` for the explicit solver.
    pub events: Option<u64>,
    /// Verdict of the run.
    pub verdict: Verdict,
    /// Whether the verdict equals that of the reference of its model size; `None` without one.
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
    /// Explicit solver at the finest step.
    FinestStep,
    /// No reference, because its run failed.
    None,
}

/// Reference of the comparison; other model sizes have references of their own.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reference {
    /// The event solver under unilateral contact, or the explicit solver at the finest step.
    #[serde(flatten)]
    pub way: Way,
    /// Method.
    pub method: Method,
    /// Its verdict.
    pub verdict: Verdict,
    /// Number of impacts.
    pub impact_count: u64,
    /// Whether the scene is sensitive.
    pub sensitive: bool,
    /// Distance of its final casing position from that of a run with half the tolerance or twice the
    /// step, in clearances; `None` if either run failed.
    pub error: Option<f64>,
    /// Wall time of its run \[s\].
    pub wall_s: f64,
}

/// The complete comparison.
#[derive(Clone, Debug, PartialEq)]
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
    /// Rejects a scene that the event solver does not support and for which the explicit solver would
    /// need more than `effort.most_steps` steps.
    ///
    /// # Errors
    /// The scene has no reference; the error names its end time.
    pub fn check(scene: &Scene, effort: Effort) -> Result<(), SceneError> {
        if reference(scene, scene.solver.model, effort).is_some() {
            return Ok(());
        }
        let allowed = format!(
            "an end of at most {:e} time steps, because its reference is explicit",
            effort.most_steps
        );
        Err(SceneError::refused(keys::END, scene.solver.end_s, allowed))
    }

    /// Computes a reference for every model size in which the scene is solved; `None` if `go_on`
    /// stopped it.
    ///
    /// # Errors
    /// As [`check`](Self::check).
    pub fn new(scene: &Scene, effort: Effort, go_on: GoOn<'_>) -> Result<Option<Self>, SceneError> {
        Self::check(scene, effort)?;
        let mut models = vec![scene.solver.model];
        models.extend(ways(scene, effort).iter().map(|way| way.model));
        models.dedup();
        let mut tracks: Vec<Track> = Vec::new();
        for way in models.into_iter().filter_map(|model| reference(scene, model, effort)) {
            if tracks.iter().any(|track| track.way == way) {
                continue;
            }
            let Some(track) = Track::run(way, scene, go_on)? else { return Ok(None) };
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

    /// Solves the scene repeatedly with one set of solver settings, and compares the result with the
    /// reference; `None` if `go_on` stopped it.
    ///
    /// # Errors
    /// The scene does not allow this way.
    pub fn row(
        &self,
        way: Way,
        effort: Effort,
        go_on: GoOn<'_>,
    ) -> Result<Option<Row>, SceneError> {
        let of_size = reference(&self.scene, way.model, effort);
        let track = self.tracks.iter().find(|track| Some(track.way) == of_size);
        let run = || way.run(&self.scene, go_on);
        let Some(first) = run()? else { return Ok(None) };
        let mut walls = vec![first.wall_s];
        while walls.len() < effort.repeats as usize
            && walls.iter().sum::<f64>() < effort.seconds
            && let Some(again) = run()?
        {
            walls.push(again.wall_s);
        }
        let wall_s = median(&mut walls);
        let other_law = way.contact != self.reference.way.contact;
        let verdict_right = track.map(|track| first.verdict == track.verdict);
        let other_problem = other_law && verdict_right == Some(false);
        let comparable = !self.reference.sensitive && !first.failed && !other_problem;
        let clearance = first.motion.machine().clearance().abs();
        let state = first.motion.state();
        let error_final = track
            .filter(|_| comparable)
            .and_then(|track| track.at(state.t_s))
            .map(|exact| distance(exact, state.u) / clearance);
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
            verdict_right,
            other_law,
        }))
    }

    /// Combines the rows into a report.
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
    let changed = Way {
        step_s: track.way.step_s.map(|step| 2.0 * step),
        tolerance: track.way.tolerance.map(|tolerance| 0.5 * tolerance),
        ..track.way
    };
    let Some(other) = changed.run(scene, go_on)? else { return Ok(None) };
    let state = other.motion.state();
    let clearance = track.end.machine().clearance().abs();
    let end = track.at(state.t_s).filter(|_| !other.failed);
    let method = match track.way.solver {
        _ if track.end.failure().is_some() => Method::None,
        SolverKind::Event => Method::Events,
        SolverKind::Explicit => Method::FinestStep,
    };
    let reached = VerdictReached::of(&track.end, track.verdict);
    let certainty = certainty(&track.way.of(scene)?, reached, false, go_on);
    Ok(certainty.map(|certainty| Reference {
        way: track.way,
        method,
        verdict: track.verdict,
        impact_count: track.end.contacts().impact_count,
        sensitive: certainty.sensitive,
        error: end.map(|end| distance(end, state.u) / clearance),
        wall_s: track.wall_s,
    }))
}

/// Returns `|u_a - u_b|` \[m\].
fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Returns the largest difference in the times of the first impacts \[s\]; `None` if the reference
/// has no impact, or if the motion has fewer of them or on other blades.
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
