//! How far the tiny changes that find sensitive runs move the final numbers of a run:
//! which of their digits hold.

use serde::Serialize;

use super::{Contact, RunReport};

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
