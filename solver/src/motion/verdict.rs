//! How a motion lasts, judged in one place for every solver, as
//! docs/theory.md, section 9, says: a proven verdict (`Solver::final_verdict`) counts
//! at once, otherwise the last part of the run is judged.
//! A `Trend` says where an amplitude is heading at the end of a run: from its values in
//! the middle of the run, at three quarters and now.

use serde::Serialize;
use strum::{AsRefStr, Display, EnumString};

use super::{ActiveSet, ContactLog, Spread};
use crate::model::Machine;

/// How a motion lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Display, EnumString, AsRefStr)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Verdict {
    /// The motion dies away without further contact; where all blades press on a lining
    /// at rest, the wave does.
    Decay,
    /// Contacts that come and go.
    Bounce,
    /// Contact without a break while its sides change, or along one side. On a lining
    /// that all blades press, also under a wave that does not die away and swings the
    /// blades little.
    Slip,
    /// Contact without a break that passes from blade to blade and swings the blades:
    /// `|kappa| l_b |a|` is above a quarter of the clearance (of the interference). In
    /// the model of single blades `a` is the largest angle about the mean of all blades.
    Whirl,
    /// One blade or one group of tips of their own lengths presses without a break, and no
    /// corner is held: the wave is dragged along.
    Forced,
    /// Permanent contact of the same sides, not all there are, all pushing.
    Locked,
    /// Permanent contact of the same sides, some of them pulling.
    Adhesive,
    /// Nothing bounds the growth of the motion: the run left the range of the model.
    Divergent,
    /// The run stopped early, with a reason.
    Failed,
}

impl Verdict {
    /// Every verdict, in the order of the documentation.
    pub const ALL: [Self; 9] = [
        Self::Decay,
        Self::Bounce,
        Self::Slip,
        Self::Whirl,
        Self::Forced,
        Self::Locked,
        Self::Adhesive,
        Self::Divergent,
        Self::Failed,
    ];

    /// Whether the same blades hold the wave, by pushes or by a pull.
    #[must_use]
    pub fn is_held(self) -> bool {
        matches!(self, Self::Locked | Self::Adhesive)
    }

    /// Whether the contact at the end has no break: it has a time since when.
    #[must_use]
    pub fn keeps_contact(self) -> bool {
        self.is_held() || matches!(self, Self::Slip | Self::Whirl | Self::Forced)
    }

    /// This verdict of a motion since `start`, or forced where one side of a machine has
    /// touched alone since then, whose tip or whose lobe leaves a casing at rest no clearance.
    #[must_use]
    pub(super) fn unless_forced(self, machine: &Machine, log: &ContactLog, start: f64) -> Self {
        let ActiveSet::Side(side) = log.active_set else { return self };
        let beyond = machine.is_uneven() && machine.apothem(side) < machine.out_of_round();
        let lasts = log.since <= start && self.keeps_contact();
        if beyond && lasts { Self::Forced } else { self }
    }
}

/// One phase group in contact, with its multiplier.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contact {
    /// The blades of the group, numbered from 1.
    pub blades: Vec<u32>,
    /// Sum of the group's multipliers; negative is a push \[N\].
    pub multiplier_n: f64,
}

/// What a verdict rests on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Basis {
    /// Nothing to come can change it.
    Proved {
        /// The reason.
        by: Proof,
        /// Since when the contact is as the reason says \[s\].
        since_s: f64,
    },
    /// The motion over the last part of the run.
    Judged {
        /// Begin of that part \[s\].
        from_s: f64,
        /// End of that part \[s\].
        to_s: f64,
    },
}

/// Why nothing to come can change a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Proof {
    /// The casing cannot reach a blade any more.
    NoContact,
    /// The forces of the blades that hold the wave cannot change their signs.
    HeldCorner,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// How the motion lasts.
    pub verdict: Verdict,
    /// What the verdict rests on; none of a run that stopped early.
    pub basis: Option<Basis>,
    /// Rate at which the wave dies about a linear rest, free or pressed into a lining by
    /// all blades through the whole beat; negative where it grows; none elsewhere \[1/s\].
    pub decay_rate_per_s: Option<f64>,
    /// Whether a tiny change of what drives the run, or of its rate on the way,
    /// changes the verdict, the blades that hold, the impact count or the time of the
    /// lock; none where it was not asked.
    pub sensitive: Option<bool>,
    /// Whether it changes the verdict, or the blades that hold.
    pub ends_otherwise: Option<bool>,
    /// Whether another step changes them; none where there are no steps, too.
    pub depends_on_step: Option<bool>,
    /// Verdict of the event solver, where that of a run by steps is another.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by_events: Option<Verdict>,
    /// How far such changes move the final numbers; none where it was not asked.
    pub spread: Option<Spread>,
    /// Why the run failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Since when the final sides have been locked \[s\].
    pub lock_time_s: Option<f64>,
    /// The groups in contact at the end, in phase order (`psi_a`, `psi_b`).
    pub contacts: Vec<Contact>,
    /// `|u|` at the end \[m\].
    pub amplitude_m: f64,
    /// Mean angular speed of the casing wave over the last part, divided by
    /// `n_d`; equals the rotor speed when locked \[rad/s\].
    pub wave_speed_rad_s: Option<f64>,
}

/// Largest errors of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Checks {
    /// Deepest penetration of an accepted state \[m\].
    pub max_penetration_m: f64,
    /// Deepest penetration predicted before correction (explicit only) \[m\].
    pub max_predicted_penetration_m: Option<f64>,
    /// Steps with a tensile multiplier.
    pub tensile_steps: u64,
    /// Largest blade angle \[rad\].
    pub max_blade_angle_rad: f64,
    /// Work of pulse and rotor less energy stored, dissipated and lost \[J\].
    pub energy_residual_j: Option<f64>,
}

/// Verdict at time `now` over the last `window` seconds.
#[must_use]
pub fn judge(log: &ContactLog, now: f64, window: f64) -> Verdict {
    let start = now - window;
    let corner = matches!(log.active_set, ActiveSet::Corner(..) | ActiveSet::Many);
    if corner && log.since <= start {
        if log.last_tensile.is_some_and(|t| t >= start) {
            Verdict::Adhesive
        } else {
            Verdict::Locked
        }
    } else if log.unbroken_since.is_some_and(|t| t <= start) {
        Verdict::Slip
    } else if log.last_contact.is_some_and(|t| t >= start) {
        Verdict::Bounce
    } else {
        Verdict::Decay
    }
}

/// Values of an amplitude over a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trend {
    /// End of the run \[s\].
    end: f64,
    marks: [Option<f64>; 2],
}

impl Trend {
    /// Of a run to this end \[s\].
    pub fn over(end: f64) -> Self {
        Self { end, marks: [None; 2] }
    }

    /// The largest value of a while until `t` \[s\].
    pub fn see(&mut self, t: f64, value: f64) {
        let [middle, later] = &mut self.marks;
        if t >= 0.5 * self.end {
            middle.get_or_insert(value);
        }
        if t >= 0.75 * self.end {
            later.get_or_insert(value);
        }
    }

    /// Forgets what was before a change on the way.
    pub fn forget(&mut self) {
        self.marks = [None; 2];
    }

    /// Whether enough of the run was seen.
    pub fn is_known(&self) -> bool {
        self.marks[1].is_some()
    }

    /// What the amplitude comes down to if it goes on like this from its value now
    /// (Aitken's rule); none where it does not fall, or where too little of the run was
    /// seen.
    pub fn falls_to(&self, now: f64) -> Option<f64> {
        let [Some(middle), Some(later)] = self.marks else { return None };
        if now >= FALLEN * middle {
            return None;
        }
        let (before, after) = (middle - later, later - now);
        let left = if before > after && after > 0.0 {
            now - after * after / (before - after)
        } else if after <= 0.0 {
            now
        } else {
            0.0
        };
        Some(left.max(0.0))
    }
}

/// Part of its value in the middle of a run below which an amplitude has fallen.
const FALLEN: f64 = 0.98;

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(build: impl Fn(&mut ContactLog)) -> Verdict {
        let mut log = ContactLog::default();
        build(&mut log);
        judge(&log, 0.1, 0.01)
    }

    #[test]
    fn the_five_ways_to_last() {
        assert_eq!(judged(|_| {}), Verdict::Decay);
        assert_eq!(judged(|log| log.touch(0.01, ActiveSet::Corner(15, 16))), Verdict::Locked);
        assert_eq!(
            judged(|log| {
                log.touch(0.01, ActiveSet::Corner(15, 16));
                log.tensile(0.0999);
            }),
            Verdict::Adhesive
        );
        assert_eq!(
            judged(|log| {
                log.touch(0.01, ActiveSet::Corner(15, 16));
                log.tensile(0.0899);
            }),
            Verdict::Locked
        );
        for last in [ActiveSet::Side(2), ActiveSet::Corner(2, 3)] {
            // A corner held for half of the last part is not held all through it.
            assert_eq!(
                judged(|log| {
                    log.touch(0.01, ActiveSet::Side(3));
                    log.touch(0.095, last);
                }),
                Verdict::Slip
            );
        }
        assert_eq!(
            judged(|log| {
                log.touch(0.091, ActiveSet::Side(3));
                log.touch(0.095, ActiveSet::Nothing);
            }),
            Verdict::Bounce
        );
        assert_eq!(
            judged(|log| {
                log.touch(0.02, ActiveSet::Side(3));
                log.touch(0.03, ActiveSet::Nothing);
            }),
            Verdict::Decay
        );
    }
}

#[cfg(test)]
mod trend_tests {
    use super::*;

    /// A run to 1 s of an amplitude, looked at every hundredth.
    fn seen(amplitude: impl Fn(f64) -> f64) -> Option<f64> {
        let mut trend = Trend::over(1.0);
        (0..=100).for_each(|n| trend.see(f64::from(n) / 100.0, amplitude(f64::from(n) / 100.0)));
        trend.falls_to(amplitude(1.0))
    }

    #[test]
    fn what_dies_falls_to_nothing_and_what_settles_to_its_size() {
        assert!(seen(|t| (-3.0 * t).exp()).unwrap() < 1e-3);
        assert!((seen(|t| 0.7 + 2.0 * (-4.0 * t).exp()).unwrap() - 0.7).abs() < 1e-3);
        assert_eq!(seen(|t| 1.0 + t), None);
        assert_eq!(seen(|_| 1.0), None);
        // Faster and faster.
        assert_eq!(seen(|t| 1.0 - t * t), Some(0.0));
        let mut short = Trend::over(1.0);
        short.see(0.3, 1.0);
        assert_eq!(short.falls_to(0.1), None);
    }
}
