//! The watch on blade angles: small ones, and sides that keep their order.

use std::f64::consts::FRAC_PI_2;

use super::Event;
use crate::motion::{Failure, FailureReason};
use crate::tolerances::{CORNER_ROOM, LARGEST_BLADE_ANGLE};

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
        for _ in 0..100 {
            let middle = 0.5 * (within + after);
            if middle <= within || middle >= after {
                break;
            }
            if beyond(self, middle) { after = middle } else { within = middle }
        }
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
