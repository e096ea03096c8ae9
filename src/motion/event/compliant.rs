//! What comes after an event when the blades move: `contact` with the mass of
//! the blades in every impact, and with sides that turn by themselves.
//!
//! A push on a side at `y` opens it by `1 + ratio y^2` and the other side of
//! the corner by `cos 2 tau + ratio y_a y_b cos 2 delta`, `tau` half the angle
//! between the two. The closed forms of the rigid polygon are not used, but the
//! cases are the same.

use super::Event;
use super::blades::Blades;
use super::free::{Free, Leaving};
use super::held::Held;
use super::mode::{Mode, What};
use super::rocking;
use super::series::{From, Series};
use super::world::{NOISE, Plane};
use crate::motion::{FailureReason, Touching};

/// Rocking is summed once the rest of it takes less than this part of the time
/// of one radian: the blades do not notice.
const BRIEF: f64 = 1e-6;

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
                self.hold_or_leave(blades, side, rate, (!second, true));
            }
            (What::SeriesEnd, _, Some(a)) => self.enter_held(blades, a),
            (_, _, Some(a)) => self.rest_compliant(blades, a, rate),
            (_, Some((side, along)), _) => {
                let (_, rate) = self.on_side(side, along.y, along.rate);
                self.hold_or_leave_at(blades, side, (along.y, along.rate), rate);
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
        self.hold_or_leave_at(blades, side, (y, along), after);
    }

    /// A corner is reached along one of its sides: the first, or the second
    /// (`Some(true)`).
    fn cross_compliant(&mut self, blades: &Blades, a: u32, rate: Plane, kept: Option<bool>) {
        self.meet_compliant(blades, a, rate, kept);
        let Mode::Driven(series) = &self.mode else { return };
        let second = series.side != a;
        let speed = series.parting(second);
        if speed <= 0.0 {
            return;
        }
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
                (true, false) => self.hold_or_leave(blades, a, rate, (false, false)),
                (false, true) => self.hold_or_leave(blades, b, rate, (true, false)),
                (false, false) => {
                    let place = meeting.place(&self.world);
                    self.fly(place, rate);
                }
            }
        } else if first < 0.0 && second - share * first > 0.0 {
            let impulse = -first / meeting.own;
            self.strike_compliant(blades, &[(a, meeting.y[0], impulse, -first)]);
            self.hold_or_leave(blades, a, meeting.struck(rate, [impulse, 0.0]), (false, false));
        } else if second < 0.0 && first - share * second > 0.0 {
            let impulse = -second / meeting.own;
            self.strike_compliant(blades, &[(b, meeting.y[1], impulse, -second)]);
            self.hold_or_leave(blades, b, meeting.struck(rate, [0.0, impulse]), (true, false));
        } else {
            let impulses = meeting.cancelled(first, second);
            self.strike_compliant(
                blades,
                &[(a, meeting.y[0], impulses[0], -first), (b, meeting.y[1], impulses[1], -second)],
            );
            self.rest_compliant(blades, a, meeting.struck(rate, impulses));
        }
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
        let place = meeting.place(&self.world);
        let flight = Free::new(place, rate, self.tips);
        let noise = self.world.push_noise(&self.drive);
        let [first, second] = [meeting.a, meeting.b].map(|side| {
            let opening = flight.curvature(&self.world, &self.drive, side).0;
            if opening.abs() <= noise { 0.0 } else { opening }
        });
        let share = meeting.cross / meeting.own;
        if meeting.cancelled(first, second).iter().all(|&push| push >= 0.0) {
            self.enter_held(blades, a);
        } else if first <= 0.0 && second - share * first > 0.0 {
            self.slide_from_corner(meeting.a, rate, (false, true));
        } else if second <= 0.0 && first - share * second > 0.0 {
            self.slide_from_corner(meeting.b, rate, (true, true));
        } else {
            self.leave_compliant(&[meeting.a, meeting.b], (place, rate));
        }
    }

    fn enter_held(&mut self, blades: &Blades, a: u32) {
        let held = Held::new(&self.world, &self.drive, blades, a, &self.tips);
        self.enter(Mode::Held(held));
    }

    /// One side of a corner touches without rate: it holds if it pushes. The
    /// corner is at its upper (`true`) or lower end, and may be at rest.
    fn hold_or_leave(&mut self, blades: &Blades, side: u32, rate: Plane, end: (bool, bool)) {
        let (y, _) = self.at_corner(side, rate, end.0);
        if self.pushes_at(blades, side, y, rate) {
            self.slide_from_corner(side, rate, end);
        } else {
            let (place, _) = self.on_side(side, y, 0.0);
            self.leave_compliant(&[side], (place, rate));
        }
    }

    /// Place and rate along a side whose corner at the upper (`true`) or lower
    /// end is where the casing is.
    fn at_corner(&self, side: u32, rate: Plane, upper: bool) -> (f64, f64) {
        let lower = if upper { self.world.machine.rim.previous(side) } else { side };
        let half = self.world.clearance * self.world.half_angle(lower, &self.tips).tan();
        let (inward, spin) = self.world.facing(&self.drive, side, 0.0, &self.tips);
        // i (-g0 + i y) spin has the imaginary part -g0 spin.
        let along = (rate * inward.conj()).im + self.world.clearance * spin;
        (if upper { half } else { -half }, along)
    }

    fn slide_from_corner(&mut self, side: u32, rate: Plane, (upper, resting): (bool, bool)) {
        let (y, along) = self.at_corner(side, rate, upper);
        let from = From { y, rate: along, tips: self.tips, edge: Some(upper), resting };
        self.slide_compliant(side, &from);
    }

    /// One side touches without rate, away from its corners: it holds if it pushes.
    fn hold_or_leave_at(
        &mut self,
        blades: &Blades,
        side: u32,
        (y, along): (f64, f64),
        rate: Plane,
    ) {
        if self.pushes_at(blades, side, y, rate) {
            let from = From { y, rate: along, tips: self.tips, edge: None, resting: false };
            self.slide_compliant(side, &from);
        } else {
            let (place, _) = self.on_side(side, y, along);
            self.leave_compliant(&[side], (place, rate));
        }
    }

    /// Whether a side that touches without rate pushes.
    fn pushes_at(&self, blades: &Blades, side: u32, y: f64, rate: Plane) -> bool {
        let (place, _) = self.on_side(side, y, 0.0);
        let flight = Free::new(place, rate, self.tips);
        let opening = flight.curvature(&self.world, &self.drive, side).0;
        -opening / (1.0 + blades.ratio * y * y) >= 0.0
    }

    fn slide_compliant(&mut self, side: u32, from: &From) {
        let series = Series::new(&self.world, &self.drive, side, from);
        if series.may_meet_other(&self.world) {
            let size = from.tips.angle.norm();
            self.fail(0.0, FailureReason::TwoSides { angle_rad: size });
        }
        self.enter(Mode::Driven(series));
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
}
