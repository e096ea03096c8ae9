//! Reasons why a motion stopped before its end, and their wording.

use super::event::{MOST_EVENTS, MOST_EVENTS_AT_ONCE, MOST_LOOKS};
use super::{Pulse, Verdict};
use crate::model::LARGEST_BLADE_ANGLE;
use crate::numeric::rounding::rounded;
use thiserror::Error;

/// Largest number of rows that one step closes together: a few in an ordinary step, a hundred on a rim
/// of thousands of blades. The cost grows with their cube; more rows mean that the step is too long.
pub(crate) const MOST_ROWS: usize = 512;

/// A run that stopped before its end.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("failed at t = {:e} s: {reason}", shown_time(*t_s))]
pub struct Failure {
    /// Time at which it stopped \[s\].
    pub t_s: f64,
    /// Reason.
    pub reason: FailureReason,
}

/// Rounds a time to the digits that messages show.
fn shown_time(t_s: f64) -> f64 {
    rounded(t_s, 6)
}

impl Failure {
    /// Words the failure for a motion that grew beyond the range of the model, as opposed to a
    /// breakdown of the computation.
    #[must_use]
    pub fn as_growth(&self) -> String {
        format!("left the range of the model at t = {:e} s: {}", shown_time(self.t_s), self.reason)
    }

    /// Returns the verdict for a model beyond the paper: unbounded growth is a possible behaviour
    /// of such a machine and gives [`Verdict::Divergent`]. Growth during the pulse is caused by the
    /// pulse and counts as a failure.
    #[must_use]
    pub fn verdict_beyond(&self, pulse: &Pulse) -> Verdict {
        if self.reason.is_growth() && self.t_s > pulse.end {
            Verdict::Divergent
        } else {
            Verdict::Failed
        }
    }
}

impl FailureReason {
    /// Returns whether the motion grew beyond the range of the model.
    #[must_use]
    pub fn is_growth(&self) -> bool {
        matches!(
            self,
            Self::BladeAngle { .. }
                | Self::NoCorner { .. }
                | Self::Displacement { .. }
                | Self::CasingSpeed { .. }
                | Self::LongStep { .. }
        )
    }
}

/// Behaviour that the model does not describe or the solver cannot follow.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FailureReason {
    /// A blade angle is too large for the small-angle approximation.
    #[error(
        "a blade angle of {angle_rad:.3e} rad is beyond the {LARGEST_BLADE_ANGLE} rad that small \
         angles allow"
    )]
    BladeAngle {
        /// Largest blade angle \[rad\].
        angle_rad: f64,
    },
    /// The two sides of a polygon without corners are about to meet.
    #[error("blade angles of {angle_rad:.3e} rad turn the only two sides onto each other")]
    TwoSides {
        /// Amplitude of the blade angles \[rad\].
        angle_rad: f64,
    },
    /// The wave has grown beyond the casing radius along a polygon without corners.
    #[error(
        "no corner holds the casing wave, and it grew beyond the casing radius, {radius_m:e} m"
    )]
    NoCorner {
        /// Casing radius \[m\].
        radius_m: f64,
    },
    /// The solver supports constant speed only.
    #[error("beyond the paper's model the event solver needs a constant speed")]
    Ramp,
    /// Growth of blades and disk has closed the clearance.
    #[error(
        "at {speed_rad_s:.6} rad/s the blades have grown into the casing, and rigid contact needs \
         a clearance"
    )]
    Closed {
        /// Rotor speed \[rad/s\].
        speed_rad_s: f64,
    },
    /// The power series of a motion in contact does not converge.
    #[error(
        "blades and casing in contact accelerate each other, faster than the power series can \
         follow"
    )]
    Series,
    /// The run has too many changes of contact.
    #[error("more than {MOST_EVENTS} changes of contact")]
    Events,
    /// Too many changes of contact occur at one instant.
    #[error("{MOST_EVENTS_AT_ONCE} changes of contact at one instant")]
    EventsAtOnce,
    /// The search for changes of contact takes too many evaluations.
    #[error("more than {MOST_LOOKS} stretches in the search for changes of contact")]
    Looks,
    /// Too many rows penetrate in one step.
    #[error(
        "{rows} rows penetrate in one step, and at most {MOST_ROWS} are closed together; a smaller \
         step is needed"
    )]
    Rows {
        /// Number of rows.
        rows: usize,
    },
    /// The casing displacement exceeds the casing radius.
    #[error("the casing displacement {distance_m:.3e} m is beyond the casing radius {radius_m} m")]
    Displacement {
        /// Casing displacement \[m\].
        distance_m: f64,
        /// Casing radius \[m\].
        radius_m: f64,
    },
    /// The casing moves faster than the blade tips, which would reverse the friction.
    #[error(
        "the casing moves along its rim at {speed_m_s:.3e} m/s, faster than the blade tips, \
         {tip_m_s:.3e} m/s, but the model has friction in one direction only"
    )]
    CasingSpeed {
        /// Tangential speed of the casing \[m/s\].
        speed_m_s: f64,
        /// Speed of the blade tips \[m/s\].
        tip_m_s: f64,
    },
    /// The wave moves along the polygon too fast for the time step, for many steps.
    #[error(
        "the casing moves {moved_m:.3e} m along the blades in one step, a large part of the \
         {side_m:.3e} m from blade to blade; the step is too long to follow it"
    )]
    LongStep {
        /// Displacement of the casing in a step \[m\].
        moved_m: f64,
        /// Length of a side of the polygon \[m\].
        side_m: f64,
    },
    /// A step penetrates deeper than the clearance.
    #[error(
        "a predicted penetration of {depth_m:.3e} m is deeper than the clearance {clearance_m:.3e} \
         m; a smaller step or a weaker pulse may help"
    )]
    Penetration {
        /// Predicted penetration \[m\].
        depth_m: f64,
        /// Clearance \[m\].
        clearance_m: f64,
    },
    /// A contact that can only push pulls at the end of the run.
    #[error(
        "a contact that only pushes ended with a pull of {force_n:.6} N, so the result is wrong; \
         run --plain takes every step"
    )]
    Pull {
        /// Largest contact force at the end, positive for a pull \[N\].
        force_n: f64,
    },
    /// The equations of a step are singular.
    #[error("the multipliers of {rows} penetrating rows are not unique (singular equations)")]
    Singular {
        /// Number of rows.
        rows: usize,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_told_in_six_digits_at_most() {
        for (t_s, told) in [(9.949_999_999_999_999e-3, "9.95e-3"), (1.985_620_839e-2, "1.98562e-2")]
        {
            let failure = Failure { t_s, reason: FailureReason::Series };
            assert!(failure.to_string().starts_with(&format!("failed at t = {told} s: ")));
            assert!(failure.as_growth().contains(&format!(" at t = {told} s: ")));
        }
    }
}
