//! Plastic impact on one or two sides, solved by cases: no gap may close faster
//! than zero, impulses only push, and a side that gets one keeps no rate
//! (docs/theory.md, section 7).
//!
//! A push on a side at `y` opens it by `1 + ratio y^2`, with the mass of the blades in the
//! ratio; of a corner it opens the other side by `cos 2 tau + ratio y_a y_b cos 2 delta`,
//! `tau` half the angle between the two.

use super::ExactEvents;
use super::mode::Mode;
use super::parameters::Parameters;
use crate::motion::{ActiveSet, Plane};
use crate::tolerances::{AT_A_CORNER, ROUND_OFF, SOFT_TOUCH};

impl ExactEvents {
    /// A side is met at a place and rate that the rotor sees.
    pub(super) fn touch(&mut self, side: u32, place: Plane, rate: Plane) {
        let parameters = &self.parameters;
        let (normal, spin) = parameters.normal(side, &self.tips);
        let met = place * normal.conj();
        self.run.deepest = self.run.deepest.max(-(parameters.clearance + met.re));
        let (y, size) = (met.im, parameters.clearance + rate.norm() / parameters.omega);
        if parameters.corners {
            let polygon = &parameters.machine.polygon;
            let lower = if y > 0.0 { polygon.previous(side) } else { side };
            let half = parameters.half_length(lower, &self.tips);
            if half - y.abs() <= AT_A_CORNER * parameters.tolerance * size {
                // Within round-off of a corner: both sides are met at once.
                self.meet_corner_at(lower, rate);
                return;
            }
        }
        let local = rate * normal.conj() + Plane::new(y, parameters.clearance) * spin;
        if local.re > ROUND_OFF * (rate.norm() + size * self.parameters.drive.nu.abs()) {
            self.enter(Mode::Free(self.flight(place, rate)));
            return;
        }
        let (ratio, clearance) = (parameters.coupling(), parameters.clearance);
        let closing = (-local.re).max(0.0);
        let impulse = closing / (1.0 + ratio * y * y);
        self.strike(&[(side, y, impulse, closing)]);
        // The blades that it kicks turn the side away under the casing.
        let along = local.im + ratio * y * impulse * clearance;
        self.hold(side, y, along, rate + normal * impulse);
    }

    /// Both sides of the corner of `a` and the next are closed.
    pub(super) fn meet_corner_at(&mut self, a: u32, rate: Plane) {
        let contact = self.corner_contact(a);
        let openings = self.clean_openings(&contact, rate);
        self.meet_corner(&contact, rate, openings);
    }

    /// Both sides of a corner are closed, and open with these rates.
    pub(super) fn meet_corner(
        &mut self,
        contact: &CornerContact,
        rate: Plane,
        [first, second]: [f64; 2],
    ) {
        let share = contact.share();
        let (a, b, [ya, yb]) = (contact.a, contact.b, contact.y);
        if first >= 0.0 && second >= 0.0 {
            match (first == 0.0, second == 0.0) {
                (true, true) => self.rest(a, rate),
                (true, false) => self.hold_at_corner(a, rate, false, second),
                (false, true) => self.hold_at_corner(b, rate, true, first),
                (false, false) => {
                    let flight = self.flight(contact.place(&self.parameters), rate);
                    self.enter(Mode::Free(flight));
                }
            }
        } else if first < 0.0 && second - share * first > 0.0 {
            let impulse = -first / contact.own;
            self.strike(&[(a, ya, impulse, -first)]);
            let rate = contact.struck(rate, [impulse, 0.0]);
            self.hold_at_corner(a, rate, false, second - share * first);
        } else if second < 0.0 && first - share * second > 0.0 {
            let impulse = -second / contact.own;
            self.strike(&[(b, yb, impulse, -second)]);
            let rate = contact.struck(rate, [0.0, impulse]);
            self.hold_at_corner(b, rate, true, first - share * second);
        } else {
            let impulses = contact.cancelled(first, second);
            self.strike(&[(a, ya, impulses[0], -first), (b, yb, impulses[1], -second)]);
            self.rest(a, contact.struck(rate, impulses));
        }
    }

    /// Turns the blades of a side by an impulse at `y`.
    pub(super) fn kick(&mut self, side: u32, y: f64, impulse: f64) {
        if let Some(blades) = &self.parameters.blades {
            let direction = self.parameters.direction(side);
            self.tips.rate += direction * (blades.ratio / blades.diameters * y * impulse);
        }
    }

    /// Books impulses (per unit mass) on sides at their places, with the closing
    /// speeds they end: each takes the work `-impulse nu y` from the rotor.
    fn strike(&mut self, impulses: &[(u32, f64, f64, f64)]) {
        let t = self.run.clock.start();
        for &(side, y, impulse, closing) in impulses {
            self.kick(side, y, impulse);
            self.energy_balance.rotor -= impulse * self.parameters.drive.nu * y;
            self.energy_balance.lost += 0.5 * impulse * closing;
            if let Some(blades) = &self.parameters.following {
                self.run.widest = self.run.widest.max(blades.kicked(y, impulse));
            }
            if closing > SOFT_TOUCH * self.parameters.omega * self.parameters.clearance {
                self.run.log.impact(t, side);
            }
        }
        match *impulses {
            [(side, ..)] => self.run.log.touch(t, ActiveSet::Side(side)),
            [(a, ..), (b, ..)] => self.run.log.touch(t, ActiveSet::of(&[a, b])),
            _ => {}
        }
    }
}

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

impl ExactEvents {
    /// Returns the corner of `a` and the next side now.
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

    /// Returns the rates of both gaps of a corner at a casing rate.
    pub(super) fn openings(&self, contact: &CornerContact, rate: Plane) -> [f64; 2] {
        // i (-g0 + i y) spin has the real part -y spin.
        std::array::from_fn(|k| {
            (rate * contact.normals[k].conj()).re + contact.y[k] * contact.spins[k]
        })
    }

    /// Same as for `openings`, where the round-off of a rate's two parts is none.
    pub(super) fn clean_openings(&self, contact: &CornerContact, rate: Plane) -> [f64; 2] {
        let noise =
            ROUND_OFF * (rate.norm() + self.parameters.clearance * self.parameters.drive.nu.abs());
        self.openings(contact, rate).map(|rate| if rate.abs() <= noise { 0.0 } else { rate })
    }
}

impl CornerContact {
    /// Returns the displacement of the casing \[m\].
    pub(super) fn place(&self, parameters: &Parameters) -> Plane {
        self.normals[0] * Plane::new(-parameters.clearance, self.y[0])
    }

    /// Returns the opening of the other gap by a push, over the opening of its own gap.
    pub(super) fn share(&self) -> f64 {
        self.cross / self.own
    }

    /// Returns the impulses or pushes that cancel two opening rates at once.
    pub(super) fn cancelled(&self, first: f64, second: f64) -> [f64; 2] {
        [
            -(self.own * first - self.cross * second) / self.determinant,
            -(self.own * second - self.cross * first) / self.determinant,
        ]
    }

    /// Returns these impulses with their sides and places.
    pub(super) fn on_sides(&self, impulses: [f64; 2]) -> [(u32, f64, f64); 2] {
        [(self.a, self.y[0], impulses[0]), (self.b, self.y[1], impulses[1])]
    }

    /// Returns the casing rate after impulses on both sides.
    pub(super) fn struck(&self, rate: Plane, impulses: [f64; 2]) -> Plane {
        rate + self.normals[0] * impulses[0] + self.normals[1] * impulses[1]
    }
}
