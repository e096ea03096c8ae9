//! A corner of two sides that move with their blades: where it is, how its gaps
//! open, and what impulses on both sides do. Also the watch on blade angles.

use std::f64::consts::FRAC_PI_2;

use super::Event;
use super::blades::{Blades, Tips};
use super::world::{Plane, World};
use crate::motion::{Failure, FailureReason};
use crate::tolerances::LARGEST_BLADE_ANGLE;

/// Part of the way to a closed or a straight corner that blades may turn it.
const CORNER_ROOM: f64 = 0.9;

/// The corner of side `a` and the next as it stands now.
pub(super) struct Meeting {
    pub a: u32,
    pub b: u32,
    /// Directions that open the gaps.
    inward: [Plane; 2],
    /// Places along the sides \[m\].
    pub y: [f64; 2],
    /// Opening of both gaps by a push on the first, and of one by the other's.
    pub own: f64,
    pub cross: f64,
}

impl Event {
    /// The corner of `a` and the next side as it stands now.
    pub(super) fn meeting(&self, blades: &Blades, a: u32) -> Meeting {
        let world = &self.world;
        let b = world.machine.rim.next(a);
        let tau = world.half_angle(a, &self.tips);
        let y = world.clearance * tau.tan();
        let [first, second] = [a, b].map(|side| world.facing(&self.drive, side, 0.0, &self.tips).0);
        Meeting {
            a,
            b,
            inward: [first, second],
            y: [-y, y],
            own: 1.0 + blades.ratio * y * y,
            cross: (2.0 * tau).cos() - blades.ratio * y * y * world.turn.re,
        }
    }

    /// Rates of both gaps of a corner at a casing rate in the standing frame.
    pub(super) fn openings(&self, meeting: &Meeting, rate: Plane) -> [f64; 2] {
        let sides = [meeting.a, meeting.b];
        std::array::from_fn(|k| {
            let (inward, spin) = self.world.facing(&self.drive, sides[k], 0.0, &self.tips);
            // i (-g0 + i y) spin has the real part -y spin.
            (rate * inward.conj()).re + meeting.y[k] * spin
        })
    }

    /// Fails a motion whose blades go beyond small angles in the first `s` seconds
    /// of the segment, at the instant they do.
    ///
    /// # Errors
    /// They do.
    pub(super) fn check_angles(&mut self, s: f64) -> Result<(), Failure> {
        let beyond = |event: &Self, s: f64| {
            let Self { mode, world, drive, .. } = event;
            mode.largest_angle(world, drive, s, LARGEST_BLADE_ANGLE) > LARGEST_BLADE_ANGLE
        };
        if self.world.blades.is_none() || !beyond(self, s) {
            return Ok(());
        }
        let (mut within, mut after) = (0.0, s);
        for _ in 0..100 {
            let middle = 0.5 * (within + after);
            if middle <= within || middle >= after {
                break;
            }
            if beyond(self, middle) { after = middle } else { within = middle }
        }
        let angle_rad = self.mode.largest_angle(&self.world, &self.drive, after, 0.0);
        Err(self.fail(after, FailureReason::BladeAngle { angle_rad }))
    }

    /// Fails a motion whose blades have turned a corner so far that it nearly
    /// closes or opens to a half turn. Half its angle is `delta`, give or take
    /// `n_d sin(delta) |a|`.
    pub(super) fn check_order(&mut self, tips: &Tips) {
        let Some(blades) = self.world.blades.filter(|_| self.world.corners) else { return };
        let delta = self.world.machine.rim.delta;
        let room = CORNER_ROOM * delta.min(FRAC_PI_2 - delta);
        let (size, most) = (tips.angle.norm(), room / (blades.diameters * delta.sin()));
        if size > most {
            self.fail(0.0, FailureReason::CornerAngle { angle_rad: size, most_rad: most });
        }
    }
}

impl Meeting {
    /// Where the casing is, in the standing frame \[m\].
    pub(super) fn place(&self, world: &World) -> Plane {
        self.inward[0] * Plane::new(-world.clearance, self.y[0])
    }

    /// Impulses or pushes that cancel two opening rates at once.
    pub(super) fn cancelled(&self, first: f64, second: f64) -> [f64; 2] {
        let scale = 1.0 / (self.own * self.own - self.cross * self.cross);
        [
            -(self.own * first - self.cross * second) * scale,
            -(self.own * second - self.cross * first) * scale,
        ]
    }

    /// These impulses on their sides and places, as `kick` takes them.
    pub(super) fn on_sides(&self, impulses: [f64; 2]) -> [(u32, f64, f64); 2] {
        [(self.a, self.y[0], impulses[0]), (self.b, self.y[1], impulses[1])]
    }

    /// The casing rate after impulses on both sides.
    pub(super) fn struck(&self, rate: Plane, impulses: [f64; 2]) -> Plane {
        rate + self.inward[0] * impulses[0] + self.inward[1] * impulses[1]
    }
}
