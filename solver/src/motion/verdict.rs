//! Verdicts: the long-term behaviour of a motion, determined in one place for all solvers
//! (docs/theory.md, section 9). A proved verdict (`Solver::final_verdict`) applies at once;
//! otherwise the last part of the run is judged (`lasting`).
//!
//! A `Trend` extrapolates an amplitude from its values in the middle of the time since the last
//! change, at three quarters of it, and now.

use serde::Serialize;
use strum::{AsRefStr, Display, EnumString};

use super::{ActiveSet, ContactLog, Spread};
use crate::model::Machine;

/// Long-term behaviour of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Display, EnumString, AsRefStr)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Verdict {
    /// The motion dies away without further contact. If all blades are in contact with a lining at
    /// rest, the wave dies away.
    Decay,
    /// Contacts begin and end repeatedly.
    Bounce,
    /// Unbroken contact that changes sides, or stays on one side. With all blades in contact with a
    /// lining, a wave that does not die away and swings the blades only slightly.
    Slip,
    /// Unbroken contact that passes from blade to blade and swings the blades: `|kappa| l_b |a|`
    /// exceeds a quarter of the clearance (or interference). In the full model `a` is the largest
    /// deviation of a blade angle from the mean.
    Whirl,
    /// One blade or group with longer tips, or a lobe, is in unbroken contact without holding a
    /// corner: the rotor drags the wave along.
    Forced,
    /// Permanent contact of the same sides, but not of all, and all push.
    Locked,
    /// Permanent contact of the same sides, some of which pull.
    Adhesive,
    /// The motion grows without bound: the run left the range of the model.
    Divergent,
    /// The run stopped early for a stated reason.
    Failed,
}

impl Verdict {
    /// All verdicts, in the order of the documentation.
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

    /// Returns whether the same blades hold the wave, by pushes or with a pull.
    #[must_use]
    pub fn is_held(self) -> bool {
        matches!(self, Self::Locked | Self::Adhesive)
    }

    /// Returns whether the contact at the end is unbroken.
    #[must_use]
    pub fn keeps_contact(self) -> bool {
        self.is_held() || matches!(self, Self::Slip | Self::Whirl | Self::Forced)
    }

    /// Replaces a verdict of unbroken contact by [`Verdict::Forced`] if a single side has been in
    /// contact since `start` whose tip or lobe leaves no clearance to the undeformed casing.
    #[must_use]
    pub(super) fn unless_forced(self, machine: &Machine, log: &ContactLog, start: f64) -> Self {
        let ActiveSet::Side(side) = log.active_set else { return self };
        let beyond = machine.is_uneven() && machine.apothem(side) < machine.out_of_round();
        let lasts = log.since <= start && self.keeps_contact();
        if beyond && lasts { Self::Forced } else { self }
    }
}

/// A phase group in contact.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contact {
    /// Blades of the group that can touch, those with its longest tip, numbered from 1.
    pub blades: Vec<u32>,
    /// Sum of the group's multipliers; negative is a push \[N\].
    pub multiplier_n: f64,
}

/// Basis of a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Basis {
    /// The verdict is proved: the rest of the motion cannot change it.
    Proved {
        /// Kind of proof.
        by: Proof,
        /// Time since which the contact meets its condition \[s\].
        since_s: f64,
    },
    /// The verdict describes the last part of the run.
    Judged {
        /// Start of that part \[s\].
        from_s: f64,
        /// End of that part \[s\].
        to_s: f64,
    },
}

/// Proof that the rest of the motion cannot change a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Proof {
    /// The casing cannot reach a blade any more.
    NoContact,
    /// The contact forces of the blades that hold the wave cannot change their signs.
    HeldCorner,
}

/// Outcome of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Verdict.
    pub verdict: Verdict,
    /// Basis of the verdict; `None` for a failed or divergent run.
    pub basis: Option<Basis>,
    /// Decay rate of the wave in free motion, or about a linear rest on a lining; negative if it
    /// grows. `None` in any other motion, and for a failed or divergent run \[1/s\].
    pub decay_rate_per_s: Option<f64>,
    /// Whether a tiny change of the excitation, or of the rate during the run, alters the verdict,
    /// the blades that hold the wave, the number of impacts or the time of the lock; `None` if not
    /// determined.
    pub sensitive: Option<bool>,
    /// Whether such a change alters the verdict or the blades that hold the wave; `None` if not
    /// determined.
    pub ends_otherwise: Option<bool>,
    /// Whether another time step alters the verdict or those blades; `None` if not determined, and
    /// for the event solver, which has no steps.
    pub depends_on_step: Option<bool>,
    /// Verdict of the event solver, if it differs from that of a run with time steps under the
    /// unilateral law; `None` if it agrees or was not determined.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by_events: Option<Verdict>,
    /// Deviation of the final numbers under such changes; `None` if not determined.
    pub spread: Option<Spread>,
    /// Why the run failed or stopped early; `None` if it did neither.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Time since which the final sides hold the wave; `None` unless the verdict is locked or
    /// adhesive \[s\].
    pub lock_time_s: Option<f64>,
    /// Groups in contact at the end, in phase order (`psi_a`, `psi_b`).
    pub contacts: Vec<Contact>,
    /// Amplitude `|u|` of the casing wave at the end \[m\].
    pub amplitude_m: f64,
    /// Mean frequency of the casing wave over the last part of the run, divided by `n_d`; equal to
    /// the rotor speed if locked, adhesive or forced. `None` for a decaying, failed or divergent
    /// motion, and if the wave was not observed \[rad/s\].
    pub wave_speed_rad_s: Option<f64>,
}

/// Largest errors of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Checks {
    /// Deepest penetration of a corrected state \[m\].
    pub max_penetration_m: f64,
    /// Deepest predicted penetration, before correction; `None` for the event solver and on a
    /// lining \[m\].
    pub max_predicted_penetration_m: Option<f64>,
    /// Number of steps with a tensile multiplier.
    pub tensile_steps: u64,
    /// Largest blade angle \[rad\].
    pub max_blade_angle_rad: f64,
    /// Work of pulse and rotor minus energy stored, dissipated and lost; `None` if the solver keeps
    /// no energy account \[J\].
    pub energy_residual_j: Option<f64>,
}

/// Values of an amplitude at two instants of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trend {
    /// Start of the run, or its last change \[s\].
    from: f64,
    /// End of the run \[s\].
    end: f64,
    /// Amplitude in the middle between the two and at three quarters; `None` before that time.
    marks: [Option<f64>; 2],
}

impl Trend {
    /// Creates the trend for a run that ends at `end` \[s\].
    pub fn over(end: f64) -> Self {
        Self { from: 0.0, end, marks: [None; 2] }
    }

    /// Begins again at the time `t` \[s\], where the run changes.
    pub fn change(&mut self, t: f64) {
        *self = Self { from: t, ..Self::over(self.end) };
    }

    /// Moves the end of the run, at the time `t` \[s\]: the values so far are of other instants.
    pub fn set_end(&mut self, t: f64, end: f64) {
        if end != self.end {
            *self = Self { from: t, ..Self::over(end) };
        }
    }

    /// Records `value` as the amplitude at the time `t` \[s\]: its largest value over a preceding
    /// interval.
    pub fn see(&mut self, t: f64, value: f64) {
        let part = (t - self.from) / (self.end - self.from);
        match &mut self.marks {
            [middle @ None, _] if part >= 0.5 => *middle = Some(value),
            // Not the value that is in the middle already.
            [Some(_), later @ None] if part >= 0.75 => *later = Some(value),
            _ => {}
        }
    }

    /// Returns whether the amplitudes of both earlier instants are known.
    pub fn is_known(&self) -> bool {
        self.marks[1].is_some()
    }

    /// Extrapolates the limit of the amplitude from its present value (Aitken's rule); `None` if it
    /// does not fall, or if too little of the run is known.
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

/// Fraction of its value in the middle of the run below which an amplitude counts as falling.
const FALLEN: f64 = 0.98;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::lasting::Lasting;

    #[test]
    fn the_five_ways_to_last() {
        use ActiveSet::{Corner, Nothing, Side};
        let machine = crate::scene::Scene::base().machine();
        // Touches of a run of 0.1 s with a window of 0.01 s, and the last pull.
        type Case<'a> = (&'a [(f64, ActiveSet)], Option<f64>, Verdict);
        let cases: [Case<'_>; 8] = [
            (&[], None, Verdict::Decay),
            (&[(0.01, Corner(15, 16))], None, Verdict::Locked),
            (&[(0.01, Corner(15, 16))], Some(0.0999), Verdict::Adhesive),
            (&[(0.01, Corner(15, 16))], Some(0.0899), Verdict::Locked),
            (&[(0.01, Side(3)), (0.095, Side(2))], None, Verdict::Slip),
            // A corner that is held during half of the window is not a lock.
            (&[(0.01, Side(3)), (0.095, Corner(2, 3))], None, Verdict::Slip),
            (&[(0.091, Side(3)), (0.095, Nothing)], None, Verdict::Bounce),
            (&[(0.02, Side(3)), (0.03, Nothing)], None, Verdict::Decay),
        ];
        for (touches, pull, verdict) in cases {
            let mut log = ContactLog::default();
            touches.iter().for_each(|(t, sides)| log.touch(*t, *sides));
            pull.into_iter().for_each(|t| log.tensile(t));
            let judged = Lasting::new(0.1).verdict(&machine, &log, [0.1, 0.01], || None);
            assert_eq!(judged, verdict, "{touches:?} {pull:?}");
        }
    }
}

#[cfg(test)]
mod trend_tests {
    use super::*;

    /// Records an amplitude every hundredth of a run of 1 s, and extrapolates it.
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
        // Falls at an increasing rate.
        assert_eq!(seen(|t| 1.0 - t * t), Some(0.0));
        let mut short = Trend::over(1.0);
        short.see(0.3, 1.0);
        assert_eq!(short.falls_to(0.1), None);
        // Too little is seen after a late change, and one look is not two.
        short.change(0.5);
        [(0.6, 9.0), (0.76, 1.0), (0.88, 0.5)].iter().for_each(|look| short.see(look.0, look.1));
        assert!((short.falls_to(0.4).unwrap() - 0.375).abs() < 1e-12);
        short.change(0.99);
        short.see(1.0, 1.0);
        assert!(!short.is_known() && short.falls_to(0.9).is_none());
        short.set_end(1.0, 2.0);
        short.see(1.6, 1.0);
        assert_eq!((short.falls_to(0.5), short.is_known()), (None, false));
    }
}
