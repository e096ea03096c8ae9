//! What a motion has shown at the end of its run: its verdict, the basis of the verdict, and the
//! report of the run.

use std::f64::consts::TAU;

use serde::Serialize;

use super::wave::WaveTracker;
use super::{
    ActiveSet, Basis, Checks, Contact, EnergyAccount, Failure, FailureReason, Hold, Impact, Motion,
    Outcome, Proof, Verdict,
};
use crate::model::{LARGEST_BLADE_ANGLE, Machine};
use crate::scene::{CheckedScene, ContactLaw, ModelSize, SolverKind};

/// Final part of the run over which the verdict is judged. Shorter: a pause in a bounce counts as
/// decay or lock.
pub const LAST_PART: f64 = 0.1;

/// Largest pull of push-only contact at the end of a run, as a part of the elastic force of the casing.
/// Smaller: round-off of forces in equilibrium fails a run. Larger: a wrong result goes unnoticed.
const PULL_ROUND_OFF: f64 = 1e-9;

/// Solver settings of a run, and its numbers of steps.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SolverReport {
    /// Solver.
    pub kind: SolverKind,
    /// Contact law.
    pub contact: ContactLaw,
    /// Model size.
    pub model: ModelSize,
    /// Whether the blades are so stiff that they were solved as rigid ones. Reported only if true.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub blades_follow: bool,
    /// Whether the blade angles are neglected in the phases of the gaps. Reported only if true.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub linearised: bool,
    /// Number of time steps computed one by one; `None` for the event solver.
    pub steps: Option<u64>,
    /// Number of time steps skipped; the run consists of both. `None` for the event solver.
    pub steps_skipped: Option<u64>,
    /// Number of events computed; `None` for the explicit solver.
    pub events: Option<u64>,
}

/// An impact, with the blades of its group.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ImpactReport {
    /// Time \[s\].
    pub t_s: f64,
    /// Blades of the group, numbered from 1.
    pub blades: Vec<u32>,
}

/// State at the end of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FinalState {
    /// Time \[s\].
    pub t_s: f64,
    /// Displacement `u_c` \[m\].
    pub u_c_m: f64,
    /// Displacement `u_s` \[m\].
    pub u_s_m: f64,
    /// Blade coordinate `alpha_c` \[rad\].
    pub alpha_c_rad: f64,
    /// Blade coordinate `alpha_s` \[rad\].
    pub alpha_s_rad: f64,
}

/// Report of a whole run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunReport {
    /// Scene of the run.
    pub scene: CheckedScene,
    /// Solver settings and numbers of steps.
    pub solver: SolverReport,
    /// Verdict and final values.
    pub outcome: Outcome,
    /// The first 1000 impacts.
    pub impacts: Vec<ImpactReport>,
    /// Number of impacts; in an infinite series only those that were computed are counted.
    pub impact_count: u64,
    /// First time at which infinitely many impacts accumulate; `None` if they never do \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impacts_accumulate_at_s: Option<f64>,
    /// First time at which two groups of blades hit the casing in one step, so that it is not known
    /// which one came first; `None` if none did, with a lining, and under the law that pulls \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impacts_in_one_step_at_s: Option<f64>,
    /// State at the end.
    pub r#final: FinalState,
    /// Largest errors of the run.
    pub checks: Checks,
    /// Energy account of a model beyond the paper; `None` within the paper's model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyAccount>,
    /// Rotor speed at the end \[rad/s\].
    #[serde(skip)]
    pub end_speed_rad_s: f64,
    /// Machine at the end, after all changes.
    #[serde(skip)]
    pub end_machine: Machine,
    /// Longest hold of a corner that ended during the run, and the rotor speed when it ended
    /// \[rad/s\]; `None` if no hold lasted for at least a casing period, or if the speed was changed
    /// after that.
    #[serde(skip)]
    pub broken: Option<(Hold, f64)>,
    /// Rotor speed at which the present contact began during a speed ramp \[rad/s\], and whether
    /// the rotor accelerates; `None` without a ramp, for a contact since the start of the run, and if
    /// speed or ramp were changed after the contact began.
    #[serde(skip)]
    pub caught: Option<(f64, bool)>,
    /// What was seen where the verdict is judged; `None` if the verdict is proved, if it decays and
    /// no contact can come, and if the run failed or diverged.
    #[serde(skip)]
    pub seen: Option<Seen>,
    /// Verdict of the event solver with unilateral contact; `None` if it was not determined.
    #[serde(skip)]
    pub pushes_only: Option<Verdict>,
    /// Reason why the run failed or stopped early; `None` if it did neither.
    #[serde(skip)]
    pub failure: Option<Failure>,
    /// Values that a perturbed run must reproduce if this one is not sensitive.
    #[serde(skip)]
    pub reached: VerdictReached,
}

/// What the judged end of a run has shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Length of the part that was judged \[s\].
    pub span_s: f64,
    /// Time since the last contact, or since the start if there was none \[s\].
    pub without_contact_s: f64,
    /// Displacement of the casing at the end as a part of the clearance; `None` without one.
    pub reach: Option<f64>,
}

impl Seen {
    /// Returns what the end of a motion with this verdict has shown; `None` if the verdict is
    /// proved, if it decays and no contact can come, and if the run failed or diverged.
    fn at_end(motion: &Motion, verdict: Verdict, window: f64) -> Option<Self> {
        let rests = motion.over() || motion.rest_rate().is_some_and(|rate| rate > 0.0);
        if matches!(verdict, Verdict::Failed | Verdict::Divergent)
            || motion.final_verdict() == Some(verdict)
            || (verdict == Verdict::Decay && rests)
        {
            return None;
        }
        let (now, clearance) = (motion.t_s(), motion.machine().clearance());
        let reach = motion.state().amplitude() / clearance;
        Some(Self {
            span_s: window.min(now),
            without_contact_s: now - motion.contacts().last_contact.unwrap_or(0.0),
            reach: (clearance > 0.0).then_some(reach),
        })
    }
}

/// Verdict of a run with the values that decide whether two runs agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VerdictReached {
    /// Long-term behaviour of the motion.
    pub verdict: Verdict,
    /// Number of impacts until the verdict was known.
    pub impact_count: u64,
    /// Whether a corner was held for at least a casing period. It is then reached by infinitely
    /// many impacts, and their number is not meaningful.
    pub rested: bool,
    /// Time since which the same blades hold the wave; `None` if they do not \[s\].
    pub locked_s: Option<f64>,
    /// Sides that hold the wave; none if the wave is not held.
    pub held: ActiveSet,
}

impl VerdictReached {
    /// Collects the values of a motion with this verdict.
    #[must_use]
    pub fn of(motion: &Motion, verdict: Verdict) -> Self {
        let (log, period) = (motion.contacts(), TAU / motion.machine().omega_c);
        let locked = verdict.is_held();
        Self {
            verdict,
            impact_count: log.impact_count,
            rested: locked || log.corner_time() >= period,
            locked_s: locked.then_some(log.since),
            held: if locked { log.active_set } else { ActiveSet::Nothing },
        }
    }
}

/// Returns the present verdict on a motion: the proved one, or that over the last `window` seconds.
/// [`Verdict::Failed`] if the contact forces contradict it.
#[must_use]
pub fn verdict_of(motion: &Motion, window: f64) -> Verdict {
    let verdict = proven_or_lasting(motion, window);
    if wrong_pull(motion, verdict).is_some() { Verdict::Failed } else { verdict }
}

/// Returns the proved verdict on a motion, or that over the last `window` seconds.
fn proven_or_lasting(motion: &Motion, window: f64) -> Verdict {
    motion.final_verdict().unwrap_or_else(|| motion.lasting(window))
}

/// Returns the pull that contradicts a verdict: any pull under a law that only pushes; in a lock
/// also under the bilateral law. `None` without such a pull, and if the run has already failed.
fn wrong_pull(motion: &Motion, verdict: Verdict) -> Option<FailureReason> {
    if motion.failure().is_some() || (motion.pulls() && verdict != Verdict::Locked) {
        return None;
    }
    let machine = motion.machine();
    let reach = motion.state().amplitude().max(machine.clearance().abs());
    let forces = motion.multipliers().into_iter().map(|(_, force)| force);
    pull_beyond(PULL_ROUND_OFF * machine.casing_stiffness * reach, forces)
}

/// Returns the reason of failure if the largest of these multipliers, positive for a pull, exceeds
/// `most` \[N\].
fn pull_beyond(most: f64, forces: impl Iterator<Item = f64>) -> Option<FailureReason> {
    let force_n = forces.fold(f64::NEG_INFINITY, f64::max);
    (force_n > most).then_some(FailureReason::Pull { force_n })
}

/// Returns the verdict at the end of a run, based on its last `window` seconds, and the reason for
/// a failure. A run also fails if a wrong pull, or a blade angle in `checks` outside the
/// small-angle range, contradicts the verdict.
#[must_use]
pub fn judge_end(motion: &Motion, checks: &Checks, window: f64) -> (Verdict, Option<Failure>) {
    let verdict = proven_or_lasting(motion, window);
    if let Some(failure) = motion.failure() {
        return (verdict, Some(failure.clone()));
    }
    let angle_rad = checks.max_blade_angle_rad;
    let turned =
        || (angle_rad > LARGEST_BLADE_ANGLE).then_some(FailureReason::BladeAngle { angle_rad });
    match wrong_pull(motion, verdict).or_else(turned) {
        Some(reason) => (Verdict::Failed, Some(Failure { t_s: motion.t_s(), reason })),
        None => (verdict, None),
    }
}

/// Returns the basis of the verdict; `None` for a failed or divergent run.
fn basis(motion: &Motion, verdict: Verdict, window: f64) -> Option<Basis> {
    let (log, to_s) = (motion.contacts(), motion.t_s());
    let (by, since_s) = match verdict {
        Verdict::Failed | Verdict::Divergent => return None,
        _ if motion.final_verdict() != Some(verdict) => {
            return Some(Basis::Judged { from_s: (to_s - window).max(0.0), to_s });
        }
        Verdict::Locked | Verdict::Adhesive => (Proof::HeldCorner, log.since),
        _ => (Proof::NoContact, log.last_contact.unwrap_or(0.0)),
    };
    Some(Basis::Proved { by, since_s })
}

/// Returns the decay rate of free motion or of the wave about a linear rest; `None` while contact
/// can still occur without such a rest, and for a failed or divergent run \[1/s\].
fn decay_rate(motion: &Motion, verdict: Verdict) -> Option<f64> {
    if matches!(verdict, Verdict::Failed | Verdict::Divergent) {
        return None;
    }
    let machine = motion.machine();
    let free = || motion.over().then_some(machine.casing_damping_ratio * machine.omega_c);
    motion.rest_rate().or_else(free)
}

impl RunReport {
    /// Collects the report of a motion that has come to `end` \[s\], under the parameters of
    /// `scene`; the speed of a slipping wave is not in it.
    #[must_use]
    pub fn at_end(scene: &CheckedScene, motion: &Motion, end: f64) -> Self {
        let scene = scene.perturbed(|scene| scene.solver.end_s = end);
        report(&scene, motion, &WaveTracker::over(&scene))
    }
}

/// Collects the report of a motion at the end of its run.
pub(super) fn report(scene: &CheckedScene, motion: &Motion, wave: &WaveTracker) -> RunReport {
    let machine = motion.machine();
    let (log, state) = (motion.contacts(), motion.state());
    let window = LAST_PART * scene.solver.end_s;
    let checks = motion.checks();
    let (verdict, failure) = judge_end(motion, &checks, window);
    let locked = verdict.is_held();
    let wave_speed_rad_s = match verdict {
        Verdict::Failed | Verdict::Divergent | Verdict::Decay => None,
        // The wave turns with the blades.
        Verdict::Locked | Verdict::Adhesive | Verdict::Forced => {
            Some(motion.rotor().mean_speed(state.t_s, window))
        }
        Verdict::Slip | Verdict::Whirl | Verdict::Bounce => wave.speed(machine),
    };
    let outcome = Outcome {
        verdict,
        basis: basis(motion, verdict, window),
        decay_rate_per_s: decay_rate(motion, verdict),
        sensitive: None,
        ends_otherwise: None,
        depends_on_step: None,
        by_events: None,
        spread: None,
        message: motion.stopped().or_else(|| failure.as_ref().map(ToString::to_string)),
        lock_time_s: locked.then_some(log.since),
        contacts: motion
            .multipliers()
            .into_iter()
            .map(|(side, multiplier_n)| Contact {
                blades: machine.first_of_side(side),
                multiplier_n,
            })
            .collect(),
        amplitude_m: state.amplitude(),
        wave_speed_rad_s,
    };
    let accumulated = accumulation(scene, motion);
    RunReport {
        scene: scene.clone(),
        solver: SolverReport {
            kind: scene.solver.kind,
            contact: scene.solver.contact,
            model: scene.solver.model,
            blades_follow: motion.blades_follow(),
            linearised: motion.linearised(),
            steps: motion.steps_taken(),
            steps_skipped: motion.steps_skipped(),
            events: motion.events(),
        },
        outcome,
        impacts: log
            .impacts
            .iter()
            .map(|hit| ImpactReport { t_s: hit.t_s, blades: machine.first_of_side(hit.side) })
            .collect(),
        impact_count: log.impact_count,
        impacts_accumulate_at_s: accumulated,
        impacts_in_one_step_at_s: in_one_step(scene, motion, accumulated),
        r#final: FinalState {
            t_s: state.t_s,
            u_c_m: state.u[0],
            u_s_m: state.u[1],
            alpha_c_rad: state.alpha[0],
            alpha_s_rad: state.alpha[1],
        },
        checks,
        energy: motion.energy_account(),
        end_speed_rad_s: motion.rotor().speed(state.t_s),
        end_machine: machine.clone(),
        broken: lock_that_broke(motion),
        caught: caught_at(motion),
        seen: Seen::at_end(motion, verdict, window),
        pushes_only: None,
        failure,
        reached: VerdictReached::of(motion, verdict),
    }
}

/// Returns the first time at which impacts accumulate \[s\]. Rigid contact comes to rest in a
/// corner, and with restitution also on a side, through infinitely many impacts. The event solver
/// sees their limit. Steps do not resolve it: the rest that follows must last for at least a casing
/// period to count, and no impact leads to one from the start. `None` without either, and for any law
/// other than the unilateral one.
fn accumulation(scene: &CheckedScene, motion: &Motion) -> Option<f64> {
    let (log, period) = (motion.contacts(), TAU / motion.machine().omega_c);
    let lasts = |(from, until): &(f64, f64)| *from > 0.0 && until - from >= period;
    let now = |from: f64| Some((from, log.last_contact?));
    let held = matches!(log.active_set, ActiveSet::Corner(..));
    let corner = now(log.since).filter(|_| held);
    let rebounds = scene.contact.restitution > 0.0;
    let side = log.unbroken_since.filter(|_| rebounds).and_then(now);
    let before = log.longest_hold.map(|hold| (hold.from, hold.until));
    let rigid = scene.solver.contact == ContactLaw::Unilateral && log.impact_count > 0;
    let rests = [before, side, corner].into_iter().flatten().filter(lasts);
    rests.map(|(from, _)| from).chain(log.accumulated).reduce(f64::min).filter(|_| rigid)
}

/// Returns the first time at which two sides were hit in one step of rigid contact that only pushes
/// \[s\]. One after the other, they would leave the casing with another velocity. Impacts of the
/// last casing period before they come to `rest` do not count: no step tells them apart.
fn in_one_step(scene: &CheckedScene, motion: &Motion, rest: Option<f64>) -> Option<f64> {
    let (log, period) = (motion.contacts(), TAU / motion.machine().omega_c);
    let solver = &scene.solver;
    let pushes = solver.contact == ContactLaw::Unilateral && solver.kind == SolverKind::Explicit;
    let apart = |hit: &Impact| rest.is_none_or(|rest| hit.t_s + period < rest);
    let together = |pair: &&[Impact]| pair[0].t_s == pair[1].t_s && apart(&pair[0]);
    let first = log.impacts.windows(2).filter(|_| pushes).find(together)?;
    first.first().map(|hit| hit.t_s)
}

/// Returns the longest hold of a corner that ended during the run, and the rotor speed when it
/// ended \[rad/s\]; `None` if no hold lasted for at least a casing period, or if the speed was
/// changed after that.
fn lock_that_broke(motion: &Motion) -> Option<(Hold, f64)> {
    let period = TAU / motion.machine().omega_c;
    let hold = motion.contacts().longest_hold.filter(|hold| hold.length() >= period)?;
    Some((hold, motion.rotor().known_speed(hold.ended)?))
}

/// Returns the rotor speed at which the present contact began \[rad/s\], and whether the rotor
/// accelerates; `None` without a speed ramp, for a contact since the start of the run, and if speed
/// or ramp were changed after the contact began.
fn caught_at(motion: &Motion) -> Option<(f64, bool)> {
    let (since, ramp) = (motion.contacts().since, motion.rotor().ramp());
    let speed = motion.rotor().known_speed(since)?;
    (ramp != 0.0 && since > 0.0).then_some((speed, ramp * speed > 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pull_beyond_round_off_contradicts_a_lock() {
        let reason = |forces: &[f64]| pull_beyond(1e-7, forces.iter().copied());
        assert_eq!(reason(&[-244.6, -57.1]), None);
        assert_eq!(reason(&[-244.6, 5e-8]), None);
        assert_eq!(reason(&[]), None);
        assert_eq!(reason(&[-244.6, 57.1]), Some(FailureReason::Pull { force_n: 57.1 }));
    }
}
