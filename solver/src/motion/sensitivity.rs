//! Sensitivity of a verdict: the run is repeated with changes below any measurement accuracy, and
//! its verdict compared (docs/theory.md, section 9).
//!
//! There are four repetitions: three with a tiny change, and one with half the time step; the event
//! solver, which has no step, uses noise and a tighter tolerance instead. Each change has its own
//! run, because two changes could cancel. The differences of the final numbers show which of their
//! digits are reliable ([`Spread`]).

use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use serde::Serialize;

use super::report::{VerdictReached, report};
use super::run::{run_motion_to_verdict, run_to_verdict};
use super::script::{Change, Script};
use super::wave::WaveTracker;
use super::{Contact, GoOn, Motion, RunReport, Verdict};
use crate::scene::{CheckedScene, ContactLaw, SolverKind};

/// Relative change of the input that must not change a reliable verdict: below any measurement error,
/// six digits above round-off. Smaller: sensitive runs are not found.
const PERTURBATION: f64 = 1e-9;

/// Part of a casing period by which a lock may come earlier or later. Larger: a
/// lock time with no correct digit is trusted.
const LOCK_MOMENT: f64 = 0.1;

/// Factor on the tolerance of the event solver in its repetition.
const FINER: f64 = 0.1;

/// Factor on the time step in the repetition of a run by steps. Larger: fewer verdicts that depend on
/// the step are found. Smaller: it costs more.
const OTHER_STEP: f64 = 0.5;

/// Result of comparing perturbed runs with a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Certainty {
    /// Whether a tiny change alters the verdict, the blades that hold the wave, the number of
    /// impacts or the time of the lock.
    pub sensitive: bool,
    /// Whether a tiny change alters the verdict or the blades that hold the wave.
    pub ends_otherwise: bool,
    /// Whether another time step alters the verdict or the blades that hold the wave. `None`
    /// without time steps, and if the run was already found sensitive.
    pub depends_on_step: Option<bool>,
}

/// Difference between two runs that should agree, in increasing order of severity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Difference {
    Nothing,
    /// Number of impacts, or time of the lock.
    Impacts,
    /// Verdict, or blades that hold the wave.
    End,
}

impl VerdictReached {
    /// Compares two runs that should agree; lock times may differ by up to `moment` \[s\].
    fn difference(self, other: Self, moment: f64) -> Difference {
        let counted = !self.rested && !other.rested;
        let late = |(one, two): (f64, f64)| (one - two).abs() > moment;
        if self.verdict != other.verdict || self.held != other.held {
            Difference::End
        } else if (counted && self.impact_count != other.impact_count)
            || self.locked_s.zip(other.locked_s).is_some_and(late)
        {
            Difference::Impacts
        } else {
            Difference::Nothing
        }
    }
}

/// As [`run_to_verdict`], with the certainty of the verdict. Stops at the first perturbed run that
/// differs. `None` if `go_on` returned false.
#[must_use]
pub fn run_with_certainty(
    scene: &CheckedScene,
    go_on: GoOn<'_>,
) -> Option<(VerdictReached, Certainty)> {
    let reached = run_to_verdict(scene, go_on)?;
    let certainty = certainty(scene, reached, false, go_on)?;
    Some((reached, certainty))
}

/// Compares perturbed runs with the result `reached` of a scene; `None` if `go_on` returned false.
///
/// Called from a thread of a rayon pool, the runs are distributed over its idle threads. The first
/// perturbed run that differs ends all others; with `thoroughly`, the first one with another
/// verdict or other blades does.
#[must_use]
pub fn certainty(
    scene: &CheckedScene,
    reached: VerdictReached,
    thoroughly: bool,
    go_on: GoOn<'_>,
) -> Option<Certainty> {
    let script = Script::default();
    let moment = moment(scene);
    let enough = if thoroughly { Difference::End } else { Difference::Impacts };
    let found = AtomicBool::new(false);
    let undecided = || !found.load(Ordering::Relaxed) && go_on();
    let difference = |change: &TinyChange| {
        if !undecided() {
            return (*change, None);
        }
        let Some((motion, verdict)) = change.run(scene, &script, None, &undecided) else {
            return (*change, None);
        };
        let differs = VerdictReached::of(&motion, verdict).difference(reached, moment);
        found.fetch_or(*change != TinyChange::Step && differs >= enough, Ordering::Relaxed);
        (*change, Some(differs))
    };
    let all = TinyChange::all(scene);
    let differences: Vec<_> = match rayon::current_thread_index() {
        Some(_) => all.par_iter().with_max_len(1).map(difference).collect(),
        None => all.iter().map(difference).collect(),
    };
    // A run that was stopped has no result.
    if found.load(Ordering::Relaxed) {
        let ends_otherwise =
            differences.iter().any(|(_, difference)| *difference == Some(Difference::End));
        return Some(Certainty { sensitive: true, ends_otherwise, depends_on_step: None });
    }
    let differences =
        differences.into_iter().map(|(change, difference)| Some((change, difference?)));
    Some(Certainty::from_differences(differences.collect::<Option<Vec<_>>>()?.into_iter()))
}

impl Certainty {
    /// Combines the differences of all perturbed runs.
    fn from_differences(differences: impl Iterator<Item = (TinyChange, Difference)>) -> Self {
        let mut certainty = Self::default();
        for (change, difference) in differences {
            if change == TinyChange::Step {
                certainty.depends_on_step = Some(difference == Difference::End);
            } else {
                certainty.sensitive |= difference != Difference::Nothing;
                certainty.ends_otherwise |= difference == Difference::End;
            }
        }
        certainty
    }
}

impl RunReport {
    /// Repeats this run and its script with all perturbations, in parallel and to the end, and
    /// stores whether the run is sensitive or depends on its step, and how far its final numbers
    /// move. Stores nothing if `go_on` returned false.
    pub fn ask_changed_runs(&mut self, script: &Script, go_on: GoOn<'_>) {
        let run =
            |change: &TinyChange| Some((*change, change.run_to_end(&self.scene, script, go_on)?));
        let all = TinyChange::all(&self.scene);
        let changed: Option<Vec<_>> = all.par_iter().with_max_len(1).map(run).collect();
        let Some(changed) = changed else { return };
        let moment = moment(&self.scene);
        let differences = changed
            .iter()
            .map(|(change, other)| (*change, other.reached.difference(self.reached, moment)));
        let certainty = Certainty::from_differences(differences);
        let changed: Vec<_> = changed.into_iter().map(|(_, other)| other).collect();
        self.outcome.spread = Some(Spread::of(self, &changed));
        self.outcome.sensitive = Some(certainty.sensitive);
        self.outcome.ends_otherwise = Some(certainty.ends_otherwise);
        self.outcome.depends_on_step = certainty.depends_on_step;
    }

    /// Determines the verdict of the event solver, whose contact only pushes, for a run with time
    /// steps under the unilateral law, or one in which contact pulled, without changes during the
    /// run. The outcome keeps it only if the law is unilateral and the verdicts differ.
    pub fn ask_events(&mut self, script: &Script, go_on: GoOn<'_>) {
        let by_steps = self.solver.kind == SolverKind::Explicit;
        let pushes = by_steps && self.solver.contact == ContactLaw::Unilateral;
        if !(pushes || self.checks.tensile_steps > 0) || !script.changes().is_empty() {
            return;
        }
        let Ok(scene) = self.scene.as_reference().checked() else { return };
        self.pushes_only = run_to_verdict(&scene, go_on).map(|reached| reached.verdict);
        let other = self.pushes_only.filter(|other| *other != self.outcome.verdict);
        self.outcome.by_events = other.filter(|_| pushes);
    }
}

/// Number of perturbed runs that determine whether a run is sensitive.
const CHANGED_RUNS: usize = 4;

/// Returns the tolerated difference of lock times \[s\].
fn moment(scene: &CheckedScene) -> f64 {
    LOCK_MOMENT * TAU / scene.machine().omega_c
}

/// Perturbation of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TinyChange {
    /// Weaker pulse, with a push to one side.
    Weaker,
    /// Faster rotor.
    Faster,
    /// Stronger pulse, with a push to the other side.
    Stronger,
    /// Noise and a tighter tolerance (event solver).
    Noise,
    /// Half the time step (explicit solver).
    Step,
}

impl TinyChange {
    /// Returns the perturbations for the solver of a scene, the most effective ones first.
    fn all(scene: &CheckedScene) -> [Self; CHANGED_RUNS] {
        let last = match scene.solver.kind {
            SolverKind::Explicit => Self::Step,
            SolverKind::Event => Self::Noise,
        };
        [Self::Weaker, Self::Faster, Self::Stronger, last]
    }

    /// Runs a scene with this perturbation until its verdict is known; `None` if `go_on` returned
    /// false.
    fn run(
        self,
        scene: &CheckedScene,
        script: &Script,
        wave: Option<&mut WaveTracker>,
        go_on: GoOn<'_>,
    ) -> Option<(Motion, Verdict)> {
        let mut motion = Motion::new(&self.changed(scene));
        let noise = (self == Self::Noise).then_some(PERTURBATION);
        if noise.is_some() {
            motion.scale_tolerance(FINER);
        }
        let script = script.mapped(|change| self.change(change));
        run_motion_to_verdict(motion, &script, scene.solver.end_s, noise, wave, go_on)
    }

    /// Runs a scene with this perturbation to its end; `None` if `go_on` returned false.
    fn run_to_end(
        self,
        scene: &CheckedScene,
        script: &Script,
        go_on: GoOn<'_>,
    ) -> Option<RunReport> {
        let mut wave = WaveTracker::over(scene);
        let (mut motion, _) = self.run(scene, script, Some(&mut wave), go_on)?;
        // A run whose verdict is known early continues to the end; a failed one stays where it is.
        let finished = motion.advance_while(scene.solver.end_s, go_on).unwrap_or(true);
        finished.then(|| report(scene, &motion, &wave))
    }

    /// Applies the perturbation to a scene.
    fn changed(self, scene: &CheckedScene) -> CheckedScene {
        match self {
            Self::Noise => scene.clone(),
            Self::Weaker => perturbed(scene, -PERTURBATION),
            Self::Stronger => perturbed(scene, PERTURBATION),
            Self::Faster => scene.perturbed(|scene| {
                let slow = scene.machine().omega_c * PERTURBATION;
                let speed = &mut scene.operation.speed_rad_s;
                *speed = if *speed == 0.0 { slow } else { *speed * MORE };
            }),
            Self::Step => scene.perturbed(|scene| scene.solver.step_s *= OTHER_STEP),
        }
    }

    /// Applies the perturbation to a change during the run.
    fn change(self, change: Change) -> Change {
        match change {
            Change::Parameters(scene) => Change::Parameters(Arc::new(self.changed(&scene))),
            Change::Rotor { speed, ramp } if self == Self::Faster => {
                Change::Rotor { speed: speed.map(|speed| speed * MORE), ramp }
            }
            other => other,
        }
    }
}

const MORE: f64 = 1.0 + PERTURBATION;

/// Changes what drives the motion by this part: the pulse, or without one the excitation and the
/// initial velocity. So that motion on a symmetry, at rest or in contact changes, too, the casing
/// gets as small a part of its usual velocity across the pulse, and without a pulse along it.
fn perturbed(scene: &CheckedScene, part: f64) -> CheckedScene {
    scene.perturbed(|scene| {
        let (machine, place) = (scene.machine(), scene.start());
        let pulse = scene.operation.pulse_n * scene.operation.pulse_s;
        let swing = machine.omega_c * machine.clearance().abs().max(place.0.hypot(place.1));
        let usual = if pulse == 0.0 { swing } else { (pulse / machine.casing_mass).abs() };
        scene.operation.pulse_n *= 1.0 + part;
        // A state that is given replaces the start that unequal tips find for themselves.
        (scene.initial.u_c_m, scene.initial.u_s_m) = place;
        scene.initial.v_s_m_s += part * usual;
        if pulse == 0.0 {
            scene.excitation.amplitude_nm *= 1.0 + part;
            scene.initial.v_c_m_s = scene.initial.v_c_m_s * (1.0 + part) + part * usual;
        }
    })
}

/// Returns `-1` or `1` in a pseudo-random sequence (finaliser of SplitMix64).
pub(super) fn sign(n: u64) -> f64 {
    let mut x = n.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    if (x ^ (x >> 31)) & 1 == 0 { 1.0 } else { -1.0 }
}

/// Largest deviation of each final number over the perturbed runs; `None` if one of the runs does
/// not have the number, or if the deviation is not finite.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Deviation of the lock time \[s\].
    pub lock_time_s: Option<f64>,
    /// Deviation of the multiplier of each group in contact \[N\].
    pub multipliers_n: Vec<Option<f64>>,
    /// Deviation of the final amplitude \[m\].
    pub amplitude_m: Option<f64>,
    /// Deviation of the wave speed \[rad/s\].
    pub wave_speed_rad_s: Option<f64>,
    /// Deviation of the end time \[s\].
    pub t_s: Option<f64>,
    /// Deviation of `u_c` \[m\].
    pub u_c_m: Option<f64>,
    /// Deviation of `u_s` \[m\].
    pub u_s_m: Option<f64>,
    /// Deviation of `alpha_c` \[rad\].
    pub alpha_c_rad: Option<f64>,
    /// Deviation of `alpha_s` \[rad\].
    pub alpha_s_rad: Option<f64>,
}

impl Spread {
    /// Compares a run with its perturbed repetitions.
    pub(super) fn of(run: &RunReport, changed: &[RunReport]) -> Self {
        let most = |number: &dyn Fn(&RunReport) -> Option<f64>| {
            let value = number(run)?;
            changed.iter().try_fold(0.0, |most: f64, other| {
                let moved = (number(other)? - value).abs();
                // A deviation that is not finite counts as unknown.
                (moved <= f64::MAX).then(|| most.max(moved))
            })
        };
        let multiplier = |group: &Contact| {
            most(&|run| {
                let mut groups = run.outcome.contacts.iter();
                Some(groups.find(|other| other.blades == group.blades)?.multiplier_n)
            })
        };
        Self {
            lock_time_s: most(&|run| run.outcome.lock_time_s),
            multipliers_n: run.outcome.contacts.iter().map(multiplier).collect(),
            amplitude_m: most(&|run| Some(run.outcome.amplitude_m)),
            wave_speed_rad_s: most(&|run| run.outcome.wave_speed_rad_s),
            t_s: most(&|run| Some(run.r#final.t_s)),
            u_c_m: most(&|run| Some(run.r#final.u_c_m)),
            u_s_m: most(&|run| Some(run.r#final.u_s_m)),
            alpha_c_rad: most(&|run| Some(run.r#final.alpha_c_rad)),
            alpha_s_rad: most(&|run| Some(run.r#final.alpha_s_rad)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_faster_rotor_is_faster_after_a_change_of_its_speed_too() {
        let change = |speed| Change::Rotor { speed, ramp: -3.0 };
        for (tiny, speed) in [(TinyChange::Faster, 400.0 * MORE), (TinyChange::Stronger, 400.0)] {
            assert_eq!(tiny.change(change(Some(400.0))), change(Some(speed)));
            assert_eq!(tiny.change(change(None)), change(None));
        }
    }
}
