//! A corner of two sides that move with their blades: where it is, how its gaps
//! open, and what impulses on both sides do. Also the watch on blade angles.

use super::Event;
use super::blades::{Blades, Tips};
use super::world::{Plane, World};
use crate::motion::Failure;

/// Largest blade angle the model stands for \[rad\].
const MOST_ANGLE: f64 = 0.1;

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

    /// Fails a motion whose blades leave what the model can describe: beyond
    /// small angles, or so far that two sides of the polygon change places, which
    /// are `2 delta - 2 n_d sin(delta) |a|` apart at least.
    pub(super) fn watch_blades(&mut self, tips: &Tips) {
        let Some(blades) = &self.world.blades else { return };
        let rim = &self.world.machine.rim;
        let order = if self.world.corners {
            rim.delta / (blades.diameters * rim.delta.sin())
        } else {
            f64::INFINITY
        };
        let (angle, size) = (self.widest, tips.angle.norm());
        let reason = if angle > MOST_ANGLE {
            format!(
                "a blade angle of {angle:.3e} rad is beyond the {MOST_ANGLE} rad that small angles allow"
            )
        } else if size > order {
            format!(
                "blade angles of {size:.3e} rad let sides change places, which they do from {order:.3e} rad on"
            )
        } else {
            return;
        };
        if self.failed.is_none() {
            self.failed = Some(Failure { t_s: self.start.0, reason });
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
