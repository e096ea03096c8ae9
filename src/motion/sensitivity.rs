//! Can a verdict be trusted? It is asked three times more, with changes that no
//! measurement could see (docs/theory.md, section 9). Each change has a separate run,
//! because two in one run may cancel.

use std::f64::consts::TAU;

use super::run::{Noise, VerdictReached, run_motion_to_verdict};
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

/// Whether a tiny change makes another verdict, or another number of impacts, of
/// a checked scene with changes that settled so; none where `go_on` said no on
/// the way.
#[must_use]
pub fn is_sensitive(
    scene: &CheckedScene,
    script: &Script,
    reached: VerdictReached,
    go_on: GoOn<'_>,
) -> Option<bool> {
    differs(scene, script, reached, Suspect::ALL, go_on)
}

/// The verdict of a checked scene, and whether it is sensitive: as by
/// `run_to_verdict` and `is_sensitive`, but a run that tells that no tiny change can
/// matter is the only one.
#[must_use]
pub fn run_with_sensitivity(
    scene: &CheckedScene,
    go_on: GoOn<'_>,
) -> Option<(VerdictReached, bool)> {
    let (reached, certainty) = run_with_certainty(scene, go_on)?;
    let suspects = match certainty {
        Certainty::Certain => return Some((reached, false)),
        Certainty::Doubtful(suspects) => suspects,
        Certainty::Unknown => Suspect::ALL,
    };
    let sensitive = differs(scene, &Script::default(), reached, suspects, go_on)?;
    Some((reached, sensitive))
}

/// As `run_to_verdict`, and whether a tiny change could make another verdict, as the
/// run itself tells.
#[must_use]
pub fn run_with_certainty(
    scene: &CheckedScene,
    go_on: GoOn<'_>,
) -> Option<(VerdictReached, Certainty)> {
    let (mut motion, end) = (Motion::new(scene), scene.solver.end_s);
    motion.carry_variation(end);
    run_motion_to_verdict(motion, &Script::default(), end, Noise::Carried, go_on)
}

/// Whether one of these changes, tried in this order, makes another run.
fn differs(
    scene: &CheckedScene,
    script: &Script,
    reached: VerdictReached,
    suspects: [Suspect; 3],
    go_on: GoOn<'_>,
) -> Option<bool> {
    let end = scene.solver.end_s;
    let moment = LOCK_MOMENT * TAU / scene.machine().omega_c;
    for suspect in suspects {
        let (noise, script) = match suspect {
            Suspect::Noise => (Noise::Rate(PERTURBATION), script.clone()),
            _ => (Noise::None, script.mapped(|change| suspect.change(change))),
        };
        let (other, _) =
            run_motion_to_verdict(Motion::changed(scene, suspect), &script, end, noise, go_on)?;
        if other.differs_from(reached, moment) {
            return Some(true);
        }
    }
    Some(false)
}

impl Motion {
    /// The motion of a scene at t = 0 with a tiny change.
    fn changed(scene: &CheckedScene, suspect: Suspect) -> Self {
        if suspect == Suspect::Noise {
            let mut motion = Self::new(scene);
            motion.scale_tolerance(FINER);
            motion
        } else {
            Self::new(&perturbed(scene, suspect.factor()))
        }
    }
}

impl Suspect {
    /// Every change that a certain run does not notice.
    pub const ALL: [Self; 3] = [Self::Stronger, Self::Weaker, Self::Noise];

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

/// A tiny change of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Suspect {
    /// A stronger pulse.
    Stronger,
    /// A weaker pulse.
    Weaker,
    /// The noise.
    Noise,
}

/// Whether a tiny change of a run could make another verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Certainty {
    /// It was not asked, or the run is not of a kind that can tell.
    Unknown,
    /// It cannot.
    Certain,
    /// One of these may, the first before the others.
    Doubtful([Suspect; 3]),
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
