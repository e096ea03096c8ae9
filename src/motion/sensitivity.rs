//! Can a verdict be trusted? It is asked three times more, with changes that no
//! measurement could see (docs/theory.md, section 9). Each change has a separate run,
//! because two in one run may cancel.

use std::f64::consts::TAU;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::run::{VerdictReached, run_motion_to_verdict, run_to_verdict};
use super::script::{Change, Script};
use super::{GoOn, Motion};
use crate::scene::CheckedScene;
use crate::tolerances::{FINER, LOCK_MOMENT, PERTURBATION};

impl VerdictReached {
    /// Whether two runs that should be the same are not, where `moment` \[s\] is
    /// how much later a wave may lock.
    fn differs_from(self, other: Self, moment: f64) -> bool {
        let counted = !self.rested && !other.rested;
        let late = |(one, two): (f64, f64)| (one - two).abs() > moment;
        self.verdict != other.verdict
            || (counted && self.impact_count != other.impact_count)
            || self.locked_s.zip(other.locked_s).is_some_and(late)
    }
}

/// As `run_to_verdict`, and whether the run is sensitive.
#[must_use]
pub fn run_with_sensitivity(
    scene: &CheckedScene,
    go_on: GoOn<'_>,
) -> Option<(VerdictReached, bool)> {
    let reached = run_to_verdict(scene, go_on)?;
    let sensitive = is_sensitive(scene, &Script::default(), reached, go_on)?;
    Some((reached, sensitive))
}

/// Whether a tiny change makes another verdict, or another number of impacts, of
/// a checked scene with changes that settled so; none where `go_on` said no on
/// the way. Idle threads of the pool that asks take some of the runs, and the first
/// that disagrees ends the others.
#[must_use]
pub fn is_sensitive(
    scene: &CheckedScene,
    script: &Script,
    reached: VerdictReached,
    go_on: GoOn<'_>,
) -> Option<bool> {
    let moment = LOCK_MOMENT * TAU / scene.machine().omega_c;
    let found = AtomicBool::new(false);
    let undecided = || !found.load(Ordering::Relaxed) && go_on();
    let agrees = |suspect: &Suspect| {
        let other = suspect.run(scene, script, &undecided);
        let differs = other.is_some_and(|other| other.differs_from(reached, moment));
        found.fetch_or(differs, Ordering::Relaxed);
        other.is_some() && !differs
    };
    let all_agree = match rayon::current_thread_index() {
        Some(_) => Suspect::ALL.par_iter().with_max_len(1).all(agrees),
        None => Suspect::ALL.iter().all(agrees),
    };
    // A run that was told to stop has said nothing.
    if found.load(Ordering::Relaxed) { Some(true) } else { all_agree.then_some(false) }
}

/// A tiny change of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Suspect {
    /// The noise.
    Noise,
    /// A stronger pulse.
    Stronger,
    /// A weaker pulse.
    Weaker,
}

impl Suspect {
    /// All of them, first the one that finds most.
    const ALL: [Self; 3] = [Self::Noise, Self::Stronger, Self::Weaker];

    /// How a run with this change lasts.
    fn run(self, scene: &CheckedScene, script: &Script, go_on: GoOn<'_>) -> Option<VerdictReached> {
        let end = scene.solver.end_s;
        if self == Self::Noise {
            let mut motion = Motion::new(scene);
            motion.scale_tolerance(FINER);
            return run_motion_to_verdict(motion, script, end, Some(PERTURBATION), go_on);
        }
        let motion = Motion::new(&perturbed(scene, self.factor()));
        let script = script.mapped(|change| self.change(change));
        run_motion_to_verdict(motion, &script, end, None, go_on)
    }

    /// What drives the run is multiplied by this.
    fn factor(self) -> f64 {
        match self {
            Self::Stronger => 1.0 + PERTURBATION,
            Self::Weaker => 1.0 - PERTURBATION,
            Self::Noise => 1.0,
        }
    }

    /// The same change of a change during the run.
    fn change(self, change: Change) -> Change {
        match change {
            Change::Parameters(scene) => {
                Change::Parameters(Box::new(perturbed(&scene, self.factor())))
            }
            other => other,
        }
    }
}

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
