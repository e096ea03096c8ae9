//! Can a verdict be trusted? It is asked four times more, three times with changes that no
//! measurement could see (docs/theory.md, section 9) and once by another step; by events,
//! which have no step, with noise and a finer tolerance. Each change has a separate run,
//! because two in one run may cancel. And how far these changes move the final numbers of
//! a run: which of their digits hold (`Spread`).

use std::f64::consts::TAU;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use serde::Serialize;

use super::run::{VerdictReached, report, run_motion_to_verdict, run_to_verdict};
use super::script::{Change, Script};
use super::wave::WaveTracker;
use super::{Contact, GoOn, Motion, RunReport, Verdict};
use crate::scene::{CheckedScene, ContactLaw, SolverKind};
use crate::tolerances::{FINER, LOCK_MOMENT, OTHER_STEP, PERTURBATION};

/// What changed runs say of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Certainty {
    /// Whether a tiny change makes another verdict, other blades that hold, another number
    /// of impacts or another time of the lock.
    pub sensitive: bool,
    /// Whether a tiny change makes another verdict, or other blades that hold.
    pub ends_otherwise: bool,
    /// Whether another step makes another verdict, or other blades that hold; none where
    /// there are no steps, or where it was not asked of a sensitive run.
    pub depends_on_step: Option<bool>,
}

/// How two runs that should be the same differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Difference {
    Nothing,
    /// Other impacts, or another time of the lock.
    Impacts,
    /// Another verdict, or other blades that hold.
    End,
}

impl VerdictReached {
    /// How two runs that should be the same differ, where `moment` \[s\] is how much later a
    /// wave may lock.
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

/// As `run_to_verdict`, and what changed runs say of it, up to the first that differs.
#[must_use]
pub fn run_with_certainty(
    scene: &CheckedScene,
    go_on: GoOn<'_>,
) -> Option<(VerdictReached, Certainty)> {
    let reached = run_to_verdict(scene, go_on)?;
    let certainty = certainty(scene, reached, false, go_on)?;
    Some((reached, certainty))
}

/// What changed runs say of a checked scene that settled so and went this way; none where
/// `go_on` said no on the way. Idle threads of the pool that asks take some of the runs.
/// The first that makes a tiny change differ
/// ends all others; with `thoroughly`, the first with another end does.
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
    let told: Vec<_> = match rayon::current_thread_index() {
        Some(_) => all.par_iter().with_max_len(1).map(difference).collect(),
        None => all.iter().map(difference).collect(),
    };
    // A run that was told to stop has said nothing.
    if found.load(Ordering::Relaxed) {
        let ends_otherwise = told.iter().any(|(_, told)| *told == Some(Difference::End));
        return Some(Certainty { sensitive: true, ends_otherwise, depends_on_step: None });
    }
    let told = told.into_iter().map(|(change, told)| Some((change, told?)));
    Some(Certainty::of(told.collect::<Option<Vec<_>>>()?.into_iter()))
}

impl Certainty {
    /// Of how the changed runs differ.
    fn of(told: impl Iterator<Item = (TinyChange, Difference)>) -> Self {
        let mut certainty = Self::default();
        for (change, difference) in told {
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
    /// Finds out by changed runs, all of them to the end and side by side, whether this
    /// run through a script is sensitive or depends on its step, and how far its final
    /// numbers move; nothing is known where `go_on` said no on the way.
    pub fn ask_changed_runs(&mut self, script: &Script, go_on: GoOn<'_>) {
        let run =
            |change: &TinyChange| Some((*change, change.run_to_end(&self.scene, script, go_on)?));
        let all = TinyChange::all(&self.scene);
        let changed: Option<Vec<_>> = all.par_iter().with_max_len(1).map(run).collect();
        let Some(changed) = changed else { return };
        let moment = moment(&self.scene);
        let told = changed
            .iter()
            .map(|(change, other)| (*change, other.reached.difference(self.reached, moment)));
        let certainty = Certainty::of(told);
        let changed: Vec<_> = changed.into_iter().map(|(_, other)| other).collect();
        self.outcome.spread = Some(Spread::of(self, &changed));
        self.outcome.sensitive = Some(certainty.sensitive);
        self.outcome.ends_otherwise = Some(certainty.ends_otherwise);
        self.outcome.depends_on_step = certainty.depends_on_step;
    }

    /// Finds the verdict of the event solver, whose contact only pushes, where this run is by
    /// steps of contact that only pushes, too, or that pulled, and nothing is changed on the way.
    /// Of a run that only pushes it is kept in the outcome where it is another.
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

/// How many changed runs find out whether a run is sensitive.
pub const CHANGED_RUNS: usize = 4;

/// How much later a wave may lock \[s\].
fn moment(scene: &CheckedScene) -> f64 {
    LOCK_MOMENT * TAU / scene.machine().omega_c
}

/// A tiny change of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TinyChange {
    /// A weaker pulse.
    Weaker,
    /// A faster rotor.
    Faster,
    /// A stronger pulse.
    Stronger,
    /// Noise and a finer tolerance, by events.
    Noise,
    /// Another step.
    Step,
}

impl TinyChange {
    /// All of them for the solver of a scene, first the one that finds most, then what finds
    /// most of the rest.
    fn all(scene: &CheckedScene) -> [Self; CHANGED_RUNS] {
        let last = match scene.solver.kind {
            SolverKind::Explicit => Self::Step,
            SolverKind::Event => Self::Noise,
        };
        [Self::Weaker, Self::Faster, Self::Stronger, last]
    }

    /// Runs a scene with this change until its verdict is settled.
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

    /// Runs a scene with this change to its end.
    fn run_to_end(
        self,
        scene: &CheckedScene,
        script: &Script,
        go_on: GoOn<'_>,
    ) -> Option<RunReport> {
        let mut wave = WaveTracker::over(scene, script);
        let (mut motion, _) = self.run(scene, script, Some(&mut wave), go_on)?;
        // What is settled before the end goes on to it; a failure stays where it is.
        let arrived = motion.advance_while(scene.solver.end_s, go_on).unwrap_or(true);
        arrived.then(|| report(scene, &motion, &wave))
    }

    /// The scene with this change.
    fn changed(self, scene: &CheckedScene) -> CheckedScene {
        match self {
            Self::Noise => scene.clone(),
            Self::Weaker => perturbed(scene, 1.0 - PERTURBATION),
            Self::Stronger => perturbed(scene, MORE),
            Self::Faster => scene.perturbed(|scene| scene.operation.speed_rad_s *= MORE),
            Self::Step => scene.perturbed(|scene| scene.solver.step_s *= OTHER_STEP),
        }
    }

    /// The same change of a change during the run.
    fn change(self, change: Change) -> Change {
        match change {
            Change::Parameters(scene) => Change::Parameters(Box::new(self.changed(&scene))),
            Change::Rotor { speed, ramp } if self == Self::Faster => {
                Change::Rotor { speed: speed.map(|speed| speed * MORE), ramp }
            }
            other => other,
        }
    }
}

const MORE: f64 = 1.0 + PERTURBATION;

/// The scene with what drives it multiplied by `factor`: the pulse, or without
/// one the start and the excitation. The start only moves inward, for it may
/// touch.
fn perturbed(scene: &CheckedScene, factor: f64) -> CheckedScene {
    scene.perturbed(|scene| {
        if scene.operation.pulse_n != 0.0 {
            scene.operation.pulse_n *= factor;
            return;
        }
        scene.excitation.amplitude_nm *= factor;
        let initial = &mut scene.initial;
        initial.v_c_m_s *= factor;
        initial.v_s_m_s *= factor;
        initial.u_c_m *= factor.min(1.0);
        initial.u_s_m *= factor.min(1.0);
    })
}

/// `-1` or `1`, without a pattern (the finisher of SplitMix64).
pub(super) fn sign(n: u64) -> f64 {
    let mut x = n.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    if (x ^ (x >> 31)) & 1 == 0 { 1.0 } else { -1.0 }
}

/// The largest difference that one of the changed runs makes to each final number; none
/// where one of the runs has no such number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Of the time since when it is locked \[s\].
    pub lock_time_s: Option<f64>,
    /// Of the multiplier of each group in contact \[N\].
    pub multipliers_n: Vec<Option<f64>>,
    /// Of the amplitude at the end \[m\].
    pub amplitude_m: Option<f64>,
    /// Of the speed of the wave \[rad/s\].
    pub wave_speed_rad_s: Option<f64>,
    /// Of the time of the end state \[s\].
    pub t_s: Option<f64>,
    /// Of `u_c` \[m\].
    pub u_c_m: Option<f64>,
    /// Of `u_s` \[m\].
    pub u_s_m: Option<f64>,
    /// Of `alpha_c` \[rad\].
    pub alpha_c_rad: Option<f64>,
    /// Of `alpha_s` \[rad\].
    pub alpha_s_rad: Option<f64>,
}

impl Spread {
    /// Of a run, from the same run with changes.
    pub(super) fn of(run: &RunReport, changed: &[RunReport]) -> Self {
        let most = |number: &dyn Fn(&RunReport) -> Option<f64>| {
            let value = number(run)?;
            changed.iter().try_fold(0.0, |most: f64, other| {
                let moved = (number(other)? - value).abs();
                // A difference that is no number is none that is known.
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
    use crate::motion::run_to_verdict;
    use crate::scene::Scene;

    #[test]
    fn a_faster_rotor_is_faster_after_a_change_of_its_speed_too() {
        let change = |speed| Change::Rotor { speed, ramp: -3.0 };
        for (tiny, speed) in [(TinyChange::Faster, 400.0 * MORE), (TinyChange::Stronger, 400.0)] {
            assert_eq!(tiny.change(change(Some(400.0))), change(Some(speed)));
            assert_eq!(tiny.change(change(None)), change(None));
        }
    }

    #[test]
    fn what_is_told_to_stop_does_not_know_whether_a_run_is_sensitive() {
        let scene = Scene::base().as_reference().checked().unwrap();
        let reached = run_to_verdict(&scene, &|| true).unwrap();
        assert_eq!(certainty(&scene, reached, false, &|| false), None);
        assert_eq!(run_with_certainty(&scene, &|| false), None);
    }
}
