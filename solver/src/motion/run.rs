//! Whole runs: a motion to its end or to its verdict, with samples on the way.
//!
//! [`simulate`] is the complete run with its certainty, [`run_to_end`] the run alone with samples,
//! [`run_to_verdict`] the shortest way to a verdict.

use std::f64::consts::TAU;

use super::report::{LAST_PART, RunReport, VerdictReached, report, verdict_of};
use super::script::{Script, Scripted};
use super::sensitivity::sign;
use super::wave::WaveTracker;
use super::{Failure, GoOn, Motion, State, Verdict, to_the_end};
use crate::scene::CheckedScene;

/// Number of checks for a proved verdict per casing period. Speed only.
const LOOKS_A_PERIOD: u64 = 4;

/// Largest number of casing periods that are checked one by one. More: in a long run the checks cost
/// more than the solution.
const RUN_LOOKS: f64 = 1e6;

/// State of a run as passed to a recorder.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Coordinates and rates.
    pub state: State,
    /// Rotor angle \[rad\].
    pub rotor_angle_rad: f64,
    /// Rotor speed \[rad/s\].
    pub rotor_speed_rad_s: f64,
    /// Mean force on each side in contact since the previous sample; negative is a push \[N\].
    pub mean_forces: Vec<(u32, f64)>,
    /// Gap of every blade \[m\]; empty unless requested.
    pub gaps: Vec<f64>,
}

/// Selection of samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sampling {
    /// Number of equal intervals from 0 to the end; no samples for 0.
    pub intervals: u32,
    /// Whether samples contain the gap of every blade.
    pub gaps: bool,
}

/// Runs a scene until its verdict is known, at most to its end; `None` if `go_on` returned false.
#[must_use]
pub fn run_to_verdict(scene: &CheckedScene, go_on: GoOn<'_>) -> Option<VerdictReached> {
    let end = scene.solver.end_s;
    run_motion_to_verdict(Motion::new(scene), &Script::default(), end, None, None, go_on)
        .map(|(motion, verdict)| VerdictReached::of(&motion, verdict))
}

/// Runs a motion with a script until its verdict is known, at most to `end`; `None` if `go_on`
/// returned false. With `noise`, the casing rate is changed by this fraction, up or down, once in a
/// casing period. `wave` is updated during the run.
pub(super) fn run_motion_to_verdict(
    motion: Motion,
    script: &Script,
    end: f64,
    noise: Option<f64>,
    mut wave: Option<&mut WaveTracker>,
    go_on: GoOn<'_>,
) -> Option<(Motion, Verdict)> {
    // Checking costs little compared with a fraction of a casing period of motion.
    let period = (TAU / motion.machine().omega_c).max(end / RUN_LOOKS);
    let interval = period / LOOKS_A_PERIOD as f64;
    let mut scripted = Scripted::new(motion, script);
    scripted.motion.forgo_checks();
    let mut verdict = None;
    let mut looks = 0;
    while verdict.is_none() {
        looks += 1;
        let until = (looks as f64 * interval).min(end);
        let reached = match wave.as_deref_mut() {
            None if until < end => scripted.approach(until, go_on),
            wave => advance_following(&mut scripted, wave, until, go_on),
        };
        verdict = match reached {
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

/// Advances to `until` and updates the wave tracker.
fn advance_following(
    scripted: &mut Scripted,
    wave: Option<&mut WaveTracker>,
    until: f64,
    go_on: GoOn<'_>,
) -> Result<bool, Failure> {
    if let Some(wave) = wave {
        while wave.next_observation() <= until {
            if !scripted.advance_while(wave.next_observation(), go_on)? {
                return Ok(false);
            }
            wave.observe(&scripted.motion);
        }
    }
    scripted.advance_while(until, go_on)
}

/// Runs a scene to its end, and determines whether the outcome is sensitive and which digits are
/// reliable.
#[must_use]
pub fn simulate(scene: &CheckedScene) -> RunReport {
    let script = Script::default();
    let mut report = run_to_end(scene, &script, Sampling::default(), &mut |_| {});
    report.ask_changed_runs(&script, &to_the_end);
    report
}

/// Runs a scene to its end with changes on the way and hands samples to `sink`.
pub fn run_to_end(
    scene: &CheckedScene,
    script: &Script,
    sampling: Sampling,
    sink: &mut dyn FnMut(&Sample),
) -> RunReport {
    let mut scripted = Scripted::new(Motion::new(scene), script);
    let end = scene.solver.end_s;
    let mut wave = WaveTracker::over(scene);
    let mut sample = 0_u32;
    loop {
        let samples_left = sampling.intervals > 0 && sample <= sampling.intervals;
        let part = f64::from(sample) / f64::from(sampling.intervals);
        let sample_time = if samples_left { end * part } else { f64::INFINITY };
        let until = sample_time.min(wave.next_observation()).min(end);
        if scripted.advance_while(until, &to_the_end).is_err() {
            break;
        }
        if until >= wave.next_observation() {
            // A motion that is certain to decay has no wave speed, and a locked wave turns with the
            // rotor.
            let decided = !wave.has_observed()
                && scripted.is_through()
                && scripted.motion.final_verdict().is_some();
            if decided { wave.stop() } else { wave.observe(&scripted.motion) }
        }
        if until >= sample_time {
            sink(&take_sample(&mut scripted.motion, sampling.gaps));
            sample += 1;
        }
        if until >= end && wave.next_observation() > end && !samples_left {
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
