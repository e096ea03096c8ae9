//! What comes after an event when the blades move: `contact` with the mass of
//! the blades in every impact, and with sides that turn by themselves.
//!
//! A push on a side at `y` opens it by `1 + ratio y^2` and the other side of
//! the corner by `cos 2 tau + ratio y_a y_b cos 2 delta`, `tau` half the angle
//! between the two. The closed forms of the rigid polygon are not used, but the
//! cases are the same.

use super::Event;
use super::blades::{Blades, Tips};
use super::free::{Free, Leaving};
use super::held::Held;
use super::mode::{Mode, What};
use super::rocking;
use super::series::{From, Series};
use super::world::Plane;
use crate::motion::Touching;

/// Rocking is summed once the rest of it takes less than this part of the time
/// of one radian: the blades do not notice.
const BRIEF: f64 = 1e-6;

/// Part of the rates that a difference of two may be off by.
const NOISE: f64 = 1e-14;

/// The corner of side `a` and the next as it stands now.
struct Meeting {
    a: u32,
    b: u32,
    /// Directions that open the gaps.
    inward: [Plane; 2],
    /// Places along the sides \[m\].
    y: [f64; 2],
    /// Opening of both gaps by a push on the first, and of one by the other's.
    own: f64,
    cross: f64,
}

impl Event {
    /// Passes the event `what`, `s` seconds into the segment.
    pub(super) fn pass_compliant(&mut self, blades: &Blades, s: f64, what: What) {
        let (place, rate) = self.mode.standing(&self.world, &self.drive, s);
        let along = self.mode.along(&self.world, &self.drive, s);
        let tips = self.mode.tips(&self.world, s);
        let held = if let Mode::Held(held) = &self.mode { Some(held.a) } else { None };
        self.rebase(s, Some(what));
        self.tips = tips;
        let rim = &self.world.machine.rim;
        match (what, along, held) {
            (What::Touch(side), ..) => self.touch_compliant(blades, side, place, rate),
            (What::Edge(true), Some((side, _)), _) => {
                let lower = rim.previous(side);
                self.cross_compliant(blades, lower, rate, Some(true));
            }
            (What::Edge(false), Some((side, _)), _) => {
                self.cross_compliant(blades, side, rate, Some(false));
            }
            (What::Release, Some((side, along)), _) => {
                self.leave_compliant(&[side], self.on_side(side, along.y, along.rate));
            }
            (What::Yield(second), _, Some(a)) => {
                let side = if second { a } else { rim.next(a) };
                self.hold_or_leave(blades, side, rate, Some(!second));
            }
            (What::SeriesEnd, _, Some(a)) => self.enter_held(blades, a),
            (_, _, Some(a)) => self.rest_compliant(blades, a, rate),
            (_, Some((side, along)), _) => {
                let (_, rate) = self.on_side(side, along.y, along.rate);
                self.hold_or_leave_at(blades, side, (along.y, along.rate), rate, None);
            }
            _ => self.fly(place, rate),
        }
    }

    /// Place and rate in the standing frame of a point that slides on a side.
    fn on_side(&self, side: u32, y: f64, rate: f64) -> (Plane, Plane) {
        let (inward, spin) = self.world.facing(&self.drive, side, 0.0, &self.tips);
        let place = Plane::new(-self.world.clearance, y);
        (place * inward, (Plane::new(0.0, rate) + Plane::i() * place * spin) * inward)
    }

    /// A side is met at a state in the standing frame.
    pub(super) fn touch_compliant(
        &mut self,
        blades: &Blades,
        side: u32,
        place: Plane,
        rate: Plane,
    ) {
        let (inward, spin) = self.world.facing(&self.drive, side, 0.0, &self.tips);
        let met = place * inward.conj();
        self.deepest = self.deepest.max(-(self.world.clearance + met.re));
        let rim = &self.world.machine.rim;
        let lower = if met.im > 0.0 { rim.previous(side) } else { side };
        let half = self.world.clearance * self.world.half_angle(lower, &self.tips).tan();
        let size = self.world.clearance + rate.norm() / self.world.omega;
        if self.world.corners && half - met.im.abs() <= 16.0 * self.world.tolerance * size {
            self.meet_compliant(blades, lower, rate, None);
            return;
        }
        let y = met.im;
        let local = rate * inward.conj() - Plane::i() * Plane::new(-self.world.clearance, y) * spin;
        if local.re > NOISE * (rate.norm() + size * self.drive.nu.abs()) {
            self.fly(place, rate);
            return;
        }
        let closing = (-local.re).max(0.0);
        let impulse = closing / (1.0 + blades.ratio * y * y);
        self.strike_compliant(blades, &[(side, y, impulse, closing)]);
        let along = local.im + blades.ratio * y * impulse * self.world.clearance;
        let after = rate + inward * impulse;
        self.hold_or_leave_at(blades, side, (y, along), after, None);
    }

    /// The corner of `a` and the next side as it stands now.
    fn meeting(&self, blades: &Blades, a: u32) -> Meeting {
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
    fn openings(&self, meeting: &Meeting, rate: Plane) -> [f64; 2] {
        let sides = [meeting.a, meeting.b];
        std::array::from_fn(|k| {
            let (inward, spin) = self.world.facing(&self.drive, sides[k], 0.0, &self.tips);
            // i (-g0 + i y) spin has the real part -y spin.
            (rate * inward.conj()).re + meeting.y[k] * spin
        })
    }

    /// A corner is reached along one of its sides: the first, or the second
    /// (`Some(true)`).
    fn cross_compliant(&mut self, blades: &Blades, a: u32, rate: Plane, kept: Option<bool>) {
        self.meet_compliant(blades, a, rate, kept);
        let Mode::Driven(series) = &self.mode else { return };
        let second = series.side != a;
        let speed = series.at(0.0).rate.abs();
        let Some(limit) = rocking::limit(&self.world, &self.drive, a, second, speed) else {
            return;
        };
        let rates = self.world.omega + self.drive.nu.abs() + blades.omega;
        if limit.time * rates > BRIEF {
            return;
        }
        // The impulses that stop it now are what the crossings to come add to
        // the pushes of the corner at rest.
        let (_, rate) = self.mode.standing(&self.world, &self.drive, 0.0);
        let meeting = self.meeting(blades, a);
        let [first, second] = self.openings(&meeting, rate);
        let impulses = meeting.cancelled(first, second);
        self.kick(blades, &meeting.on_sides(impulses));
        self.ledger.lost -= 0.5 * (first * impulses[0] + second * impulses[1]);
        let rotor = impulses[0] * meeting.y[0] + impulses[1] * meeting.y[1];
        self.ledger.rotor -= rotor * self.drive.nu;
        let rate = meeting.struck(rate, impulses);
        self.rest_compliant(blades, a, rate);
    }

    /// Both sides of a corner are closed. Plastic impact by cases; `kept` names
    /// the side that has no rate by construction.
    fn meet_compliant(&mut self, blades: &Blades, a: u32, rate: Plane, kept: Option<bool>) {
        let meeting = self.meeting(blades, a);
        let mut openings = self.openings(&meeting, rate);
        // A rate against the blades may be the round-off of its two parts.
        let noise = NOISE * (rate.norm() + self.world.clearance * self.drive.nu.abs());
        for opening in &mut openings {
            if opening.abs() <= noise {
                *opening = 0.0;
            }
        }
        match kept {
            Some(false) => openings[0] = 0.0,
            Some(true) => openings[1] = 0.0,
            None => {}
        }
        let [first, second] = openings;
        let share = meeting.cross / meeting.own;
        let (a, b) = (meeting.a, meeting.b);
        if first >= 0.0 && second >= 0.0 {
            match (first == 0.0, second == 0.0) {
                (true, true) => self.rest_compliant(blades, a, rate),
                (true, false) => self.hold_or_leave(blades, a, rate, Some(false)),
                (false, true) => self.hold_or_leave(blades, b, rate, Some(true)),
                (false, false) => {
                    let place = self.corner_place(&meeting);
                    self.fly(place, rate);
                }
            }
        } else if first < 0.0 && second - share * first > 0.0 {
            let impulse = -first / meeting.own;
            self.strike_compliant(blades, &[(a, meeting.y[0], impulse, -first)]);
            self.hold_or_leave(blades, a, meeting.struck(rate, [impulse, 0.0]), Some(false));
        } else if second < 0.0 && first - share * second > 0.0 {
            let impulse = -second / meeting.own;
            self.strike_compliant(blades, &[(b, meeting.y[1], impulse, -second)]);
            self.hold_or_leave(blades, b, meeting.struck(rate, [0.0, impulse]), Some(true));
        } else {
            let impulses = meeting.cancelled(first, second);
            self.strike_compliant(
                blades,
                &[(a, meeting.y[0], impulses[0], -first), (b, meeting.y[1], impulses[1], -second)],
            );
            self.rest_compliant(blades, a, meeting.struck(rate, impulses));
        }
    }

    fn corner_place(&self, meeting: &Meeting) -> Plane {
        meeting.inward[0] * Plane::new(-self.world.clearance, meeting.y[0])
    }

    /// Turns the blades by impulses on sides at their places.
    fn kick(&mut self, blades: &Blades, impulses: &[(u32, f64, f64)]) {
        for &(side, y, impulse) in impulses {
            let direction = self.world.direction(side);
            self.tips.rate += direction * (blades.ratio / blades.diameters * y * impulse);
        }
    }

    /// Books impulses on sides at their places, with the closing speeds they end.
    fn strike_compliant(&mut self, blades: &Blades, impulses: &[(u32, f64, f64, f64)]) {
        for &(side, y, impulse, closing) in impulses {
            self.kick(blades, &[(side, y, impulse)]);
            self.book_impact(side, y, impulse, closing);
        }
        match *impulses {
            [(side, ..)] => self.log.touch(self.start.0, Touching::Side(side)),
            [(a, ..), (b, ..)] => self.log.touch(self.start.0, Touching::of(&[a, b])),
            _ => {}
        }
    }

    /// At rest in a corner: which sides hold? Accelerations by cases.
    fn rest_compliant(&mut self, blades: &Blades, a: u32, rate: Plane) {
        let meeting = self.meeting(blades, a);
        let place = self.corner_place(&meeting);
        let flight = Free::new(place, rate, self.tips);
        let [first, second] =
            [meeting.a, meeting.b].map(|side| flight.curvature(&self.world, &self.drive, side).0);
        let share = meeting.cross / meeting.own;
        if meeting.cancelled(first, second).iter().all(|&push| push >= 0.0) {
            self.enter_held(blades, a);
        } else if first <= 0.0 && second - share * first > 0.0 {
            self.slide_compliant(meeting.a, (meeting.y[0], 0.0), Some(false));
        } else if second <= 0.0 && first - share * second > 0.0 {
            self.slide_compliant(meeting.b, (meeting.y[1], 0.0), Some(true));
        } else {
            self.leave_compliant(&[meeting.a, meeting.b], (place, rate));
        }
    }

    fn enter_held(&mut self, blades: &Blades, a: u32) {
        let held = Held::new(&self.world, &self.drive, blades, a, &self.tips);
        self.enter(Mode::Held(held));
    }

    /// One side of a corner, at its upper (`true`) or lower end, touches without
    /// rate.
    fn hold_or_leave(&mut self, blades: &Blades, side: u32, rate: Plane, edge: Option<bool>) {
        let lower = if edge == Some(true) { self.world.machine.rim.previous(side) } else { side };
        let half = self.world.clearance * self.world.half_angle(lower, &self.tips).tan();
        let y = if edge == Some(true) { half } else { -half };
        let (inward, spin) = self.world.facing(&self.drive, side, 0.0, &self.tips);
        // i (-g0 + i y) spin has the imaginary part -g0 spin.
        let along = (rate * inward.conj()).im + self.world.clearance * spin;
        self.hold_or_leave_at(blades, side, (y, along), rate, edge);
    }

    /// One side touches without rate: it holds if it pushes.
    fn hold_or_leave_at(
        &mut self,
        blades: &Blades,
        side: u32,
        (y, along): (f64, f64),
        rate: Plane,
        edge: Option<bool>,
    ) {
        let (place, _) = self.on_side(side, y, along);
        let flight = Free::new(place, rate, self.tips);
        let opening = flight.curvature(&self.world, &self.drive, side).0;
        if -opening / (1.0 + blades.ratio * y * y) >= 0.0 {
            self.slide_compliant(side, (y, along), edge);
        } else {
            self.leave_compliant(&[side], (place, rate));
        }
    }

    fn slide_compliant(&mut self, side: u32, (y, rate): (f64, f64), edge: Option<bool>) {
        let from = From { y, rate, tips: self.tips, edge };
        self.enter(Mode::Driven(Series::new(&self.world, &self.drive, side, &from)));
    }

    fn leave_compliant(&mut self, sides: &[u32], (place, rate): (Plane, Plane)) {
        let flight = Free::new(place, rate, self.tips);
        let mut free = flight;
        for (slot, &side) in free.leaving.iter_mut().zip(sides) {
            let (bend, twist) = flight.curvature(&self.world, &self.drive, side);
            *slot = Some(Leaving { side, bend: bend.max(0.0), twist });
        }
        self.enter(Mode::Free(free));
    }

    /// Contact goes on after the speed of the rotor has jumped.
    pub(super) fn resume_compliant(
        &mut self,
        blades: &Blades,
        (place, rate): (Plane, Plane),
        side: Option<u32>,
        held: Option<u32>,
    ) {
        if let Some(a) = held {
            self.meet_compliant(blades, a, rate, None);
        } else if let Some(side) = side {
            self.touch_compliant(blades, side, place, rate);
        } else {
            self.fly(place, rate);
        }
    }

    /// Fails a motion whose blades leave what the model can describe.
    pub(super) fn watch_blades(&mut self, tips: &Tips) {
        let Some(blades) = &self.world.blades else { return };
        let angle = tips.angle.norm();
        self.widest = self.widest.max(angle);
        let limit = MOST_ANGLE.min(0.5 * self.world.machine.rim.delta / blades.diameters);
        if angle > limit && self.failed.is_none() {
            self.failed = Some(crate::motion::Failure {
                t_s: self.start.0,
                reason: format!(
                    "a blade angle of {angle:e} rad; beyond {limit:e} rad the sides lose their order"
                ),
            });
        }
    }
}

/// Largest blade angle the model stands for \[rad\].
const MOST_ANGLE: f64 = 0.1;

impl Meeting {
    /// Impulses or pushes that cancel two opening rates at once.
    fn cancelled(&self, first: f64, second: f64) -> [f64; 2] {
        let scale = 1.0 / (self.own * self.own - self.cross * self.cross);
        [
            -(self.own * first - self.cross * second) * scale,
            -(self.own * second - self.cross * first) * scale,
        ]
    }

    fn on_sides(&self, impulses: [f64; 2]) -> [(u32, f64, f64); 2] {
        [(self.a, self.y[0], impulses[0]), (self.b, self.y[1], impulses[1])]
    }

    /// The casing rate after impulses on both sides.
    fn struck(&self, rate: Plane, impulses: [f64; 2]) -> Plane {
        rate + self.inward[0] * impulses[0] + self.inward[1] * impulses[1]
    }
}
