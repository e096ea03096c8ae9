//! The watch on blade angles: small ones, and sides that keep their order.

use std::f64::consts::FRAC_PI_2;

use super::Event;
use crate::motion::{Failure, FailureReason};
use crate::numeric::{bisection::bisected, maximum::highest};
use crate::tolerances::{CORNER_ROOM, LARGEST_BLADE_ANGLE, PEAK_LOOKS};

impl Event {
    /// Fails a motion whose blades go beyond small angles in the first `s` seconds
    /// of the segment, at the instant they do.
    ///
    /// # Errors
    /// They do.
    pub(super) fn check_angles(&mut self, s: f64) -> Result<(), Failure> {
        let beyond = |event: &Self, s: f64| {
            let Self { mode, parameters, drive, .. } = event;
            mode.largest_angle(parameters, drive, s, LARGEST_BLADE_ANGLE) > LARGEST_BLADE_ANGLE
        };
        if self.parameters.blades.is_none() || !beyond(self, s) {
            return Ok(());
        }
        // A bracket that does not depend on `s`: where one looks changes no bit.
        let (mut within, mut after) = (0.0, self.mode.length());
        if !after.is_finite() {
            after = 1.0 / self.parameters.omega;
            while after < s && !beyond(self, after) {
                (within, after) = (after, 2.0 * after);
            }
        }
        let [_, after] = bisected([within, after], |s| beyond(self, s));
        let angle_rad = self.mode.largest_angle(&self.parameters, &self.drive, after, 0.0);
        Err(self.fail(after, FailureReason::BladeAngle { angle_rad }))
    }

    /// Fails a motion whose blades have turned a corner so far that it nearly
    /// closes or opens to a half turn. Half its angle differs from `delta` by up to
    /// `n_d sin(delta) |a|`.
    pub(super) fn check_order(&mut self) {
        let Some(blades) = self.parameters.blades.filter(|_| self.parameters.corners) else {
            return;
        };
        let delta = self.parameters.machine.polygon.delta;
        let room = CORNER_ROOM * delta.min(FRAC_PI_2 - delta);
        let (size, most) = (self.tips.angle.norm(), room / (blades.diameters * delta.sin()));
        if size > most {
            self.fail(0.0, FailureReason::CornerAngle { angle_rad: size, most_rad: most });
        }
    }
}

/// The largest value over `[0, s]` of a function that changes at `rate`.
pub(super) fn peak(s: f64, rate: f64, value: impl Fn(f64) -> f64) -> f64 {
    let parts = (8.0 * rate * s).ceil().clamp(2.0, PEAK_LOOKS);
    let at = |k: f64| s * (k / parts).clamp(0.0, 1.0);
    let (mut best, mut most, mut k) = (0.0, value(0.0), 1.0);
    while k <= parts {
        let here = value(at(k));
        if here > most {
            (best, most) = (k, here);
        }
        k += 1.0;
    }
    // The maximum lies next to the largest sample, and there is one.
    most.max(highest([at(best - 1.0), at(best + 1.0)], value).1)
}
