//! A corner of two sides that may move with their blades: where it is, how its
//! gaps open, and what impulses on both sides do.
//!
//! A push on one side opens it by `1 + ratio y^2` and the other by
//! `cos 2 tau + ratio y_a y_b cos 2 delta`, `tau` half the angle between the two.

use super::Event;
use super::parameters::Parameters;
use crate::motion::Plane;
use crate::tolerances::ROUND_OFF;

/// The corner of side `a` and the next, `b`, at one instant.
pub(super) struct CornerContact {
    pub a: u32,
    pub b: u32,
    /// Directions that open the gaps, as the rotor sees them.
    normals: [Plane; 2],
    /// Rates at which blades turn the sides \[rad/s\].
    spins: [f64; 2],
    /// Places along the sides \[m\].
    pub y: [f64; 2],
    /// Opening of both gaps by a push on their own side, and on the other.
    pub own: f64,
    cross: f64,
    /// `own^2 - cross^2`, without cancellation.
    determinant: f64,
}

impl Event {
    /// The corner of `a` and the next side now.
    pub(super) fn corner_contact(&self, a: u32) -> CornerContact {
        let parameters = &self.parameters;
        let b = parameters.machine.polygon.next(a);
        let [first, second] = [a, b].map(|side| parameters.normal(side, &self.tips));
        let y = parameters.half_length(a, &self.tips);
        let square = parameters.coupling() * y * y;
        let turn = parameters.turn_between(a, &self.tips);
        // 1 - cos^2 = sin^2: corners of many sides keep their digits.
        let less = turn.im * turn.im / (1.0 + turn.re) + square * (1.0 + parameters.turn.re);
        let more = 1.0 + turn.re + square * (1.0 - parameters.turn.re);
        CornerContact {
            a,
            b,
            normals: [first.0, second.0],
            spins: [first.1, second.1],
            y: [-y, y],
            own: 1.0 + square,
            cross: turn.re - square * parameters.turn.re,
            determinant: less * more,
        }
    }

    /// Rates of both gaps of a corner at a casing rate.
    pub(super) fn openings(&self, contact: &CornerContact, rate: Plane) -> [f64; 2] {
        // i (-g0 + i y) spin has the real part -y spin.
        std::array::from_fn(|k| {
            (rate * contact.normals[k].conj()).re + contact.y[k] * contact.spins[k]
        })
    }

    /// As `openings`, where the round-off of a rate's two parts is none.
    pub(super) fn clean_openings(&self, contact: &CornerContact, rate: Plane) -> [f64; 2] {
        let noise = ROUND_OFF * (rate.norm() + self.parameters.clearance * self.drive.nu.abs());
        self.openings(contact, rate).map(|rate| if rate.abs() <= noise { 0.0 } else { rate })
    }
}

impl CornerContact {
    /// Where the casing is \[m\].
    pub(super) fn place(&self, parameters: &Parameters) -> Plane {
        self.normals[0] * Plane::new(-parameters.clearance, self.y[0])
    }

    /// Opening of the other gap by a push, over the opening of its own gap.
    pub(super) fn share(&self) -> f64 {
        self.cross / self.own
    }

    /// Impulses or pushes that cancel two opening rates at once.
    pub(super) fn cancelled(&self, first: f64, second: f64) -> [f64; 2] {
        [
            -(self.own * first - self.cross * second) / self.determinant,
            -(self.own * second - self.cross * first) / self.determinant,
        ]
    }

    /// These impulses with their sides and places.
    pub(super) fn on_sides(&self, impulses: [f64; 2]) -> [(u32, f64, f64); 2] {
        [(self.a, self.y[0], impulses[0]), (self.b, self.y[1], impulses[1])]
    }

    /// The casing rate after impulses on both sides.
    pub(super) fn struck(&self, rate: Plane, impulses: [f64; 2]) -> Plane {
        rate + self.normals[0] * impulses[0] + self.normals[1] * impulses[1]
    }
}
