//! One whole run: drive a motion to its end, sample it on the way, judge it,
//! and report it in the shape of `rubscope.run/1`.

use std::f64::consts::{PI, TAU};
use std::time::Instant;

use serde::Serialize;

use super::verdict::{LAST_PART, judge};
use super::{Checks, Contact, Motion, Outcome, State, Verdict};
use crate::model::Machine;
use crate::scene::{ContactLaw, ModelSize, Scene, SolverKind};

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

/// How the run was solved, and at what cost.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SolverReport {
    /// Which solver.
    pub kind: SolverKind,
    /// Which contact law.
    pub contact: ContactLaw,
    /// Which model size.
    pub model: ModelSize,
    /// Time steps taken.
    pub steps: Option<u64>,
    /// Changes of mode computed.
    pub events: Option<u64>,
    /// Wall time, sampling included \[s\].
    pub wall_s: f64,
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

/// A whole run, as `run --json` prints it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunReport {
    /// `rubscope.run/1`.
    pub schema: &'static str,
    /// The resolved scene.
    pub scene: Scene,
    /// How it was solved.
    pub solver: SolverReport,
    /// How it ended.
    pub outcome: Outcome,
    /// The first 1000 impacts.
    pub impacts: Vec<ImpactReport>,
    /// All impacts.
    pub impact_count: u64,
    /// The state at the end.
    pub r#final: FinalState,
    /// What was kept watch on.
    pub checks: Checks,
}

/// How a run lasts, without its history.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Settled {
    /// How the motion lasts.
    pub verdict: Verdict,
    /// Impacts until the verdict was settled.
    pub impact_count: u64,
}

impl Settled {
    /// Whether two runs that should be the same are not.
    fn differs_from(self, other: Self) -> bool {
        let locked = matches!(self.verdict, Verdict::Locked | Verdict::Adhesive);
        self.verdict != other.verdict || (!locked && self.impact_count != other.impact_count)
    }
}

/// Runs a checked scene until its verdict is settled, at most to its end.
#[must_use]
pub fn settle(scene: &Scene) -> Settled {
    settle_motion(Motion::new(scene), scene.solver.end_s)
}

fn settle_motion(mut motion: Motion, end: f64) -> Settled {
    // Looking costs little against one casing period of motion.
    let interval = (TAU / motion.machine().omega_c).max(end / 1e6);
    let mut verdict = None;
    let mut looks = 0.0;
    while verdict.is_none() {
        looks += 1.0;
        let until = (looks * interval).min(end);
        verdict = match motion.advance(until) {
            Err(_) => Some(Verdict::Failed),
            Ok(()) if until >= end => Some(verdict_of(&motion, LAST_PART * end)),
            Ok(()) => motion.settled(),
        };
    }
    Settled {
        verdict: verdict.unwrap_or(Verdict::Failed),
        impact_count: motion.contacts().impact_count,
    }
}

/// Relative change of the pulse that no trustworthy verdict may notice.
const NUDGE: f64 = 1e-9;

/// The verdict on a motion now, over the last `window` seconds.
#[must_use]
pub fn verdict_of(motion: &Motion, window: f64) -> Verdict {
    let now = || motion.state().t_s;
    if motion.failure().is_some() {
        return Verdict::Failed;
    }
    motion
        .settled()
        .unwrap_or_else(|| judge(motion.contacts(), motion.machine(), now(), window, motion.over()))
}

/// Part of its tolerance at which the event solver is tried again.
const FINER: f64 = 0.1;

/// Whether a relative change of 1e-9 of the pulse, up or down, changes the
/// verdict or the impact count. The event solver goes up with a tolerance ten
/// times finer as well, so that two runs more answer for both. A locked wave
/// has rocked into its corner by infinitely many impacts, so there the count is
/// no fact and only the verdict counts.
#[must_use]
pub fn is_sensitive(scene: &Scene, settled: Settled) -> bool {
    [(1.0 + NUDGE, FINER), (1.0 - NUDGE, 1.0)].into_iter().any(|(factor, finer)| {
        let mut nudged = scene.clone();
        nudged.operation.pulse_n *= factor;
        let motion = match Motion::new(&nudged) {
            Motion::Event(event) => {
                let tolerance = finer * event.tolerance();
                Motion::Event(Box::new(event.with_tolerance(tolerance)))
            }
            explicit => explicit,
        };
        settle_motion(motion, scene.solver.end_s).differs_from(settled)
    })
}

/// Runs a checked scene to its end, handing samples to `sink` on the way.
pub fn simulate(scene: &Scene, sampling: Sampling, sink: &mut dyn FnMut(&Sample)) -> RunReport {
    let started = Instant::now();
    let mut motion = Motion::new(scene);
    let end = scene.solver.end_s;
    let last_part = (1.0 - LAST_PART) * end;
    let mut wave = WaveAngle::default();
    let wave_interval = wave_interval(scene);
    let mut next_wave = last_part;
    let mut sample = 0_u32;
    loop {
        let sample_time = match sampling.intervals {
            0 => f64::INFINITY,
            n if sample > n => f64::INFINITY,
            n => end * (f64::from(sample) / f64::from(n)),
        };
        let until = sample_time.min(next_wave).min(end);
        if motion.advance(until).is_err() {
            break;
        }
        if until >= next_wave {
            wave.look(motion.state());
            next_wave =
                if until < end { (next_wave + wave_interval).min(end) } else { f64::INFINITY };
        }
        if until >= sample_time {
            sink(&take_sample(&mut motion, sampling.gaps));
            sample += 1;
        }
        if until >= end
            && next_wave > end
            && (sampling.intervals == 0 || sample > sampling.intervals)
        {
            break;
        }
    }
    let mut report = report(scene, &motion, &wave, started);
    let settled = Settled { verdict: report.outcome.verdict, impact_count: report.impact_count };
    report.outcome.sensitive = is_sensitive(scene, settled);
    report
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

/// Interval at which the wave's angle cannot turn by half a turn unseen \[s\].
fn wave_interval(scene: &Scene) -> f64 {
    let machine = scene.machine();
    let end = scene.solver.end_s;
    let last = scene.operation.speed_rad_s + scene.operation.speed_ramp_rad_s2 * end;
    let fastest = machine.nu(scene.operation.speed_rad_s.abs().max(last.abs())) + machine.omega_c;
    // Bounded from below, so that a very long last part stays affordable.
    (TAU / 16.0 / fastest).max(LAST_PART * end / 100_000.0)
}

/// Total angle the casing wave turns through, by small differences.
#[derive(Clone, Copy, Debug, Default)]
struct WaveAngle {
    first: Option<(f64, f64)>,
    last: (f64, f64),
    turned: f64,
}

impl WaveAngle {
    fn look(&mut self, state: State) {
        if state.amplitude() == 0.0 {
            return;
        }
        let angle = state.u[1].atan2(state.u[0]);
        if self.first.is_none() {
            self.first = Some((state.t_s, angle));
        } else {
            self.turned += (angle - self.last.1 + PI).rem_euclid(TAU) - PI;
        }
        self.last = (state.t_s, angle);
    }

    /// Mean angular speed of the wave divided by `n_d` \[rad/s\].
    fn speed(&self, machine: &Machine) -> Option<f64> {
        let elapsed = self.last.0 - self.first?.0;
        let speed = self.turned / elapsed / machine.nodal_diameters;
        (elapsed > 0.0 && speed.is_finite()).then_some(speed)
    }
}

fn report(scene: &Scene, motion: &Motion, wave: &WaveAngle, started: Instant) -> RunReport {
    let machine = motion.machine();
    let rim = &machine.rim;
    let (log, state) = (motion.contacts(), motion.state());
    let window = LAST_PART * scene.solver.end_s;
    let verdict = verdict_of(motion, window);
    let lasting = !matches!(verdict, Verdict::Failed | Verdict::Decay);
    let outcome = Outcome {
        verdict,
        sensitive: false,
        message: motion.failure().map(ToString::to_string),
        lock_time_s: matches!(verdict, Verdict::Locked | Verdict::Adhesive).then_some(log.since),
        contacts: motion
            .multipliers()
            .into_iter()
            .map(|(side, multiplier_n)| Contact { blades: rim.blades_of_side(side), multiplier_n })
            .collect(),
        amplitude_m: state.amplitude(),
        wave_speed_rad_s: if lasting { wave.speed(machine) } else { None },
    };
    RunReport {
        schema: "rubscope.run/1",
        scene: scene.clone(),
        solver: SolverReport {
            kind: scene.solver.kind,
            contact: scene.solver.contact,
            model: scene.solver.model,
            steps: motion.steps(),
            events: motion.events(),
            wall_s: started.elapsed().as_secs_f64(),
        },
        outcome,
        impacts: log
            .impacts
            .iter()
            .map(|hit| ImpactReport { t_s: hit.t_s, blades: rim.blades_of_side(hit.side) })
            .collect(),
        impact_count: log.impact_count,
        r#final: FinalState {
            t_s: state.t_s,
            u_c_m: state.u[0],
            u_s_m: state.u[1],
            alpha_c_rad: state.alpha[0],
            alpha_s_rad: state.alpha[1],
        },
        checks: motion.checks(),
    }
}
