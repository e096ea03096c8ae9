//! One whole run: advance a motion to its end, sample it, judge it,
//! and report it.

use std::f64::consts::TAU;

use serde::Serialize;

use super::script::{Script, Scripted};
use super::sensitivity::sign;
use super::wave::WaveTracker;
use super::{
    ActiveSet, Basis, Checks, Contact, ContactLog, EnergyAccount, Failure, FailureReason, GoOn,
    Hold, Motion, Outcome, Proof, State, Verdict, to_the_end,
};
use crate::model::Machine;
use crate::scene::{CheckedScene, ContactLaw, ModelSize, SolverKind};
use crate::tolerances::{
    LARGEST_BLADE_ANGLE, LAST_PART, LOOKS_A_PERIOD, PULL_ROUND_OFF, RUN_LOOKS,
};

/// What a recorder sees at one instant.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Coordinates and rates.
    pub state: State,
    /// Rotor angle \[rad\].
    pub rotor_angle_rad: f64,
    /// Rotor speed \[rad/s\].
    pub rotor_speed_rad_s: f64,
    /// Mean force on each touched side since the sample before \[N\]; negative
    /// is a push.
    pub mean_forces: Vec<(u32, f64)>,
    /// Gap of every blade \[m\]; empty unless asked for.
    pub gaps: Vec<f64>,
}

/// Which samples a recorder wants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sampling {
    /// Number of equal intervals from 0 to the end; none for 0.
    pub intervals: u32,
    /// Whether the gap of every blade is wanted.
    pub gaps: bool,
}

/// How the run was solved, and in how many steps.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SolverReport {
    /// Which solver.
    pub kind: SolverKind,
    /// Which contact law.
    pub contact: ContactLaw,
    /// Which model size.
    pub model: ModelSize,
    /// Whether the blades are too stiff for the casing to feel, and were solved as
    /// rigid ones whose angles follow the pushes at once; told where it is so.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub blades_follow: bool,
    /// Whether the angles of the blades are left out of the phases of the gaps; told
    /// where it is so.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub linearised: bool,
    /// Time steps taken: computed one by one.
    pub steps: Option<u64>,
    /// Time steps skipped: done many at once; the run has the sum of both.
    pub steps_skipped: Option<u64>,
    /// Changes of mode computed.
    pub events: Option<u64>,
}

/// One impact, with the blades of its group.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ImpactReport {
    /// When \[s\].
    pub t_s: f64,
    /// Blades of the group, numbered from 1.
    pub blades: Vec<u32>,
}

/// The state at the end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FinalState {
    /// Time \[s\].
    pub t_s: f64,
    /// `u_c` \[m\].
    pub u_c_m: f64,
    /// `u_s` \[m\].
    pub u_s_m: f64,
    /// `alpha_c` \[rad\].
    pub alpha_c_rad: f64,
    /// `alpha_s` \[rad\].
    pub alpha_s_rad: f64,
}

/// A whole run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunReport {
    /// The resolved scene.
    pub scene: CheckedScene,
    /// How it was solved.
    pub solver: SolverReport,
    /// How it ended.
    pub outcome: Outcome,
    /// The first 1000 impacts.
    pub impacts: Vec<ImpactReport>,
    /// All impacts; of a series that accumulates those that were counted.
    pub impact_count: u64,
    /// Where impacts accumulate, infinitely many in a finite time \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impacts_accumulate_at_s: Option<f64>,
    /// The state at the end.
    pub r#final: FinalState,
    /// Largest errors of the run.
    pub checks: Checks,
    /// Where energy came from and went to, beyond the paper.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyAccount>,
    /// Speed of the rotor at the end, after ramps and changes \[rad/s\].
    #[serde(skip)]
    pub end_speed_rad_s: f64,
    /// The machine at the end, after changes.
    #[serde(skip)]
    pub end_machine: Machine,
    /// The lock that broke on the way, and the speed of the rotor then \[rad/s\].
    #[serde(skip)]
    pub broken: Option<(Hold, f64)>,
    /// Rotor speed at which a run-up (true) or run-down came to its last contact \[rad/s\].
    #[serde(skip)]
    pub caught: Option<(f64, bool)>,
    /// Verdict of the event solver, whose contact only pushes, where it was asked.
    #[serde(skip)]
    pub pushes_only: Option<Verdict>,
    /// Why the run stopped early.
    #[serde(skip)]
    pub failure: Option<Failure>,
    /// What another run must agree with if this one is not sensitive.
    #[serde(skip)]
    pub reached: VerdictReached,
}

/// How a run lasts, without its history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VerdictReached {
    /// How the motion lasts.
    pub verdict: Verdict,
    /// Impacts until the verdict was settled.
    pub impact_count: u64,
    /// Whether a corner was held for a casing period: then it was reached by
    /// infinitely many impacts, and their count is no fact.
    pub rested: bool,
    /// Since when the wave is locked \[s\].
    pub locked_s: Option<f64>,
    /// The sides that hold it.
    pub held: ActiveSet,
}

impl VerdictReached {
    /// Of a motion that has come to this verdict.
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

/// Runs a checked scene until its verdict is settled, at most to its end; none
/// where `go_on` said no on the way.
#[must_use]
pub fn run_to_verdict(scene: &CheckedScene, go_on: GoOn<'_>) -> Option<VerdictReached> {
    let end = scene.solver.end_s;
    run_motion_to_verdict(Motion::new(scene), &Script::default(), end, None, None, go_on)
        .map(|(motion, verdict)| VerdictReached::of(&motion, verdict))
}

/// Runs a motion through a script until its verdict is settled, at most to
/// `end`; where there is `noise`, its rate changes by this part, up or down, once a casing
/// period. `wave` is followed on the way. None where `go_on` said no.
pub(super) fn run_motion_to_verdict(
    motion: Motion,
    script: &Script,
    end: f64,
    noise: Option<f64>,
    mut wave: Option<&mut WaveTracker>,
    go_on: GoOn<'_>,
) -> Option<(Motion, Verdict)> {
    // Looking costs little against a part of a casing period of motion.
    let period = (TAU / motion.machine().omega_c).max(end / RUN_LOOKS);
    let interval = period / LOOKS_A_PERIOD as f64;
    let mut scripted = Scripted::new(motion, script);
    scripted.motion.forgo_checks();
    let mut verdict = None;
    let mut looks = 0;
    while verdict.is_none() {
        looks += 1;
        let until = (looks as f64 * interval).min(end);
        verdict = match advance_following(&mut scripted, wave.as_deref_mut(), until, go_on) {
            Err(_) => scripted.motion.final_verdict().or(Some(Verdict::Failed)),
            Ok(false) => return None,
            Ok(true) if until >= end => Some(verdict_of(&scripted.motion, LAST_PART * end)),
            Ok(true) if scripted.is_through() => scripted.motion.final_verdict(),
            Ok(true) => None,
        };
        if let (None, Some(part)) = (verdict, noise)
            && looks % LOOKS_A_PERIOD == 0
        {
            scripted.motion.scale_rate(1.0 + part * sign(looks / LOOKS_A_PERIOD));
        }
    }
    Some((scripted.motion, verdict?))
}

/// Advances to `until`, and follows the wave on the way.
fn advance_following(
    scripted: &mut Scripted<'_>,
    wave: Option<&mut WaveTracker>,
    until: f64,
    go_on: GoOn<'_>,
) -> Result<bool, Failure> {
    if let Some(wave) = wave {
        while wave.next_look() <= until {
            if !scripted.advance_while(wave.next_look(), go_on)? {
                return Ok(false);
            }
            wave.look(scripted.motion.state());
        }
    }
    scripted.advance_while(until, go_on)
}

/// Returns the verdict on a motion now: the proven one, or that over the last
/// `window` seconds; [`Verdict::Failed`] where the contact forces contradict it.
#[must_use]
pub fn verdict_of(motion: &Motion, window: f64) -> Verdict {
    let verdict = proven_or_lasting(motion, window);
    if wrong_pull(motion, verdict).is_some() { Verdict::Failed } else { verdict }
}

/// Returns the proven verdict on a motion, or that over the last `window` seconds.
fn proven_or_lasting(motion: &Motion, window: f64) -> Verdict {
    motion.final_verdict().unwrap_or_else(|| motion.lasting(window))
}

/// Returns the pull that contradicts the verdict on a motion: under a law that only
/// pushes any, in a lock also under the law that pulls.
fn wrong_pull(motion: &Motion, verdict: Verdict) -> Option<FailureReason> {
    if motion.failure().is_some() || (motion.pulls() && verdict != Verdict::Locked) {
        return None;
    }
    let machine = motion.machine();
    let reach = motion.state().amplitude().max(machine.clearance().abs());
    let forces = motion.multipliers().into_iter().map(|(_, force)| force);
    pull_beyond(PULL_ROUND_OFF * machine.casing_stiffness * reach, forces)
}

/// Returns the largest of these contact forces, if it pulls by more than `most` \[N\].
fn pull_beyond(most: f64, forces: impl Iterator<Item = f64>) -> Option<FailureReason> {
    let force_n = forces.fold(f64::NEG_INFINITY, f64::max);
    (force_n > most).then_some(FailureReason::Pull { force_n })
}

/// Returns the verdict at the end of a run, over its last `window` seconds, and why it
/// failed: also where a wrong pull, or a blade angle of `checks` that the model does not
/// describe, contradicts the verdict.
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

/// Returns what the verdict on a motion rests on; none where it stopped early.
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

/// Returns the rate at which the wave of a motion dies about its linear rest \[1/s\].
fn decay_rate(motion: &Motion, verdict: Verdict) -> Option<f64> {
    if matches!(verdict, Verdict::Failed | Verdict::Divergent) {
        return None;
    }
    let machine = motion.machine();
    let free = || motion.over().then_some(machine.casing_damping_ratio * machine.omega_c);
    motion.rest_rate().or_else(free)
}

/// Runs a scene to its end, and finds out whether its outcome is sensitive, and which digits hold.
#[must_use]
pub fn simulate(scene: &CheckedScene) -> RunReport {
    let script = Script::default();
    let mut report = run_to_end(scene, &script, Sampling::default(), &mut |_| {}, &mut ());
    report.ask_changed_runs(&script, &to_the_end);
    report
}

/// Looks at a run on the way, when it wants to. The run is the same.
pub trait Watch: Sync {
    /// Whether the run may go on: no look is due.
    fn goes_on(&self) -> bool;

    /// Looks at it, and lets it go on.
    fn look(&mut self, motion: &Motion);
}

impl Watch for () {
    fn goes_on(&self) -> bool {
        true
    }

    fn look(&mut self, _: &Motion) {}
}

/// Runs a scene to its end with changes on the way, hands samples to `sink`, and lets `watch` look
/// at the run (`&mut ()` does not).
pub fn run_to_end(
    scene: &CheckedScene,
    script: &Script,
    sampling: Sampling,
    sink: &mut dyn FnMut(&Sample),
    watch: &mut dyn Watch,
) -> RunReport {
    let mut scripted = Scripted::new(Motion::new(scene), script);
    let end = scene.solver.end_s;
    let mut wave = WaveTracker::over(scene, script);
    let mut sample = 0_u32;
    loop {
        let sample_time = match sampling.intervals {
            0 => f64::INFINITY,
            n if sample > n => f64::INFINITY,
            n => end * (f64::from(sample) / f64::from(n)),
        };
        let until = sample_time.min(wave.next_look()).min(end);
        let advanced = loop {
            match scripted.advance_while(until, &|| watch.goes_on()) {
                Ok(false) => watch.look(&scripted.motion),
                other => break other,
            }
        };
        if advanced.is_err() {
            break;
        }
        if until >= wave.next_look() {
            // What is certain to decay has no wave, and what is locked turns with the rotor.
            let decided = !wave.has_looked()
                && scripted.is_through()
                && scripted.motion.final_verdict().is_some();
            if decided { wave.stop() } else { wave.look(scripted.motion.state()) }
        }
        if until >= sample_time {
            sink(&take_sample(&mut scripted.motion, sampling.gaps));
            sample += 1;
        }
        let sampled = sampling.intervals == 0 || sample > sampling.intervals;
        if until >= end && wave.next_look() > end && sampled {
            break;
        }
    }
    report(scene, &scripted.motion, &wave)
}

fn take_sample(motion: &mut Motion, gaps: bool) -> Sample {
    let state = motion.state();
    Sample {
        rotor_angle_rad: motion.rotor().angle(state.t_s),
        rotor_speed_rad_s: motion.rotor().speed(state.t_s),
        mean_forces: motion.take_mean_forces(),
        gaps: if gaps { motion.blade_gaps() } else { Vec::new() },
        state,
    }
}

/// What there is to say of a motion at the end of its run.
pub(super) fn report(scene: &CheckedScene, motion: &Motion, wave: &WaveTracker) -> RunReport {
    let machine = motion.machine();
    let (log, state) = (motion.contacts(), motion.state());
    let window = LAST_PART * scene.solver.end_s;
    let checks = motion.checks();
    let (verdict, failure) = judge_end(motion, &checks, window);
    let locked = verdict.is_held();
    let wave_speed_rad_s = match verdict {
        Verdict::Failed | Verdict::Divergent | Verdict::Decay => None,
        // It turns with the blades.
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
        impacts_accumulate_at_s: accumulation(scene, log, machine),
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
        pushes_only: None,
        failure,
        reached: VerdictReached::of(motion, verdict),
    }
}

/// Returns where impacts accumulate \[s\]: rigid pushes come to rest in a corner by infinitely
/// many, and with restitution on a side, too. Such a rest is one of a casing period at least.
fn accumulation(scene: &CheckedScene, log: &ContactLog, machine: &Machine) -> Option<f64> {
    let lasts = |(from, until): &(f64, f64)| until - from >= TAU / machine.omega_c;
    let now = |from: f64| Some((from, log.last_contact?));
    let held = matches!(log.active_set, ActiveSet::Corner(..));
    let corner = now(log.since).filter(|_| held);
    let rebounds = scene.contact.restitution > 0.0;
    let side = log.unbroken_since.filter(|_| rebounds).and_then(now);
    let before = log.longest_hold.map(|hold| (hold.from, hold.until));
    let rigid = scene.solver.contact == ContactLaw::Unilateral && log.impact_count > 0;
    let rests = [before, side, corner].into_iter().flatten().filter(lasts);
    rests.map(|(from, _)| from).reduce(f64::min).filter(|_| rigid)
}

/// The longest hold of a corner that ended on the way, if it was as long as a casing period,
/// and the speed of the rotor when it ended \[rad/s\]; none where that was changed since.
pub fn lock_that_broke(motion: &Motion) -> Option<(Hold, f64)> {
    let period = TAU / motion.machine().omega_c;
    let hold = motion.contacts().longest_hold.filter(|hold| hold.length() >= period)?;
    Some((hold, motion.rotor().known_speed(hold.ended)?))
}

/// The rotor speed at which a motion came to the blades that it touches now, where the speed
/// changes \[rad/s\], and whether it becomes faster; none where the ramp was changed since.
pub fn caught_at(motion: &Motion) -> Option<(f64, bool)> {
    let (since, ramp) = (motion.contacts().since, motion.rotor().ramp());
    let speed = motion.rotor().known_speed(since)?;
    (ramp != 0.0 && since > 0.0).then_some((speed, ramp * speed > 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn a_pull_beyond_round_off_contradicts_a_lock() {
        let reason = |forces: &[f64]| pull_beyond(1e-7, forces.iter().copied());
        assert_eq!(reason(&[-244.6, -57.1]), None);
        assert_eq!(reason(&[-244.6, 5e-8]), None);
        assert_eq!(reason(&[]), None);
        assert_eq!(reason(&[-244.6, 57.1]), Some(FailureReason::Pull { force_n: 57.1 }));
    }

    #[test]
    fn an_end_outside_the_model_is_a_failure() {
        let mut motion = Motion::new(&Scene::base().checked().unwrap());
        motion.advance(1e-3).unwrap();
        let judged = |angle_rad| {
            let checks = Checks { max_blade_angle_rad: angle_rad, ..motion.checks() };
            judge_end(&motion, &checks, 1e-4)
        };
        assert_eq!(judged(0.1), (verdict_of(&motion, 1e-4), None));
        let (verdict, failure) = judged(0.797);
        assert_eq!(verdict, Verdict::Failed);
        assert_eq!(failure.unwrap().reason, FailureReason::BladeAngle { angle_rad: 0.797 });
    }

    /// Pulls are what the bilateral law is for, as long as no lock is said to push.
    #[test]
    fn an_adhesive_contact_of_the_law_that_pulls_is_no_failure() {
        let changes = [("solver.contact", "bilateral"), ("operation.speed_rad_s", "400")];
        let scene = Scene::builtin("paper-nd3").unwrap().with(&changes).unwrap();
        let report =
            run_to_end(&scene, &Script::default(), Sampling::default(), &mut |_| {}, &mut ());
        assert_eq!(report.outcome.verdict, Verdict::Adhesive);
        assert!(report.outcome.contacts.iter().any(|contact| contact.multiplier_n > 1.0));
        assert_eq!(report.failure, None);
    }
}
