//! What comes after an event: plastic impact and the choice of the next mode.
//!
//! Both are small complementarity problems solved by cases. *Impact*: no gap may
//! close faster than zero, impulses only push, and a side that gets one keeps
//! no rate. *Mode*: the same for accelerations, among the sides that touch
//! without rate. Where an event says that a push has vanished, that side is out;
//! it is not asked again.

use super::Event;
use super::blades::Tips;
use super::corner::{cancelled, opening};
use super::free::{Free, Leaving};
use super::mode::{Mode, What};
use super::rocking;
use super::series::{From, Series};
use super::slide::Slide;
use super::world::Plane;
use crate::motion::Touching;

/// A closing speed below this part of `omega_c g0` is a touch without impact.
const SOFT: f64 = 1e-12;

impl Event {
    /// The first mode, from the initial state.
    pub(super) fn begin(&mut self, place: Plane, rate: Plane) {
        let rim = &self.world.machine.rim;
        let side = rim.nearest_side(place.re, place.im);
        // The scene allows a start on a side up to this round-off.
        if rim.gap(side, place.re, place.im) <= 1e-12 * self.world.clearance {
            // So is a rate against the blades that is round-off of its two parts.
            let carried = Plane::i() * place * self.drive.nu;
            let local = (rate - carried) * self.world.direction(side).conj();
            let noise = 1e-12 * (rate.norm() + carried.norm());
            let clean = |x: f64| if x.abs() <= noise { 0.0 } else { x };
            let local = Plane::new(clean(local.re), clean(local.im));
            if let Some(blades) = self.world.blades {
                let rate = carried + local * self.world.direction(side);
                self.touch_compliant(&blades, side, place, rate);
            } else {
                self.touch(side, place, local);
            }
        } else {
            self.fly(place, rate);
        }
    }

    /// Passes the event `what`, `s` seconds into the segment.
    pub(super) fn pass(&mut self, s: f64, what: What) {
        if let Some(blades) = self.world.blades {
            self.pass_compliant(&blades, s, what);
            return;
        }
        let (place, rate) = self.mode.standing(&self.world, &self.drive, s);
        let along = self.mode.along(&self.world, &self.drive, s);
        let corner = match self.mode {
            Mode::Corner(a) | Mode::Rocking { a, .. } => Some(a),
            _ => None,
        };
        self.rebase(s, Some(what));
        let half = self.world.half_side;
        let next = |side: u32| self.world.machine.rim.next(side);
        match (what, along, corner) {
            (What::Touch(side), ..) => {
                let out = self.drive.inward(&self.world, side, 0.0).conj();
                let local = (rate - Plane::i() * place * self.drive.nu) * out;
                self.touch(side, place, local);
            }
            (What::Edge(true), Some((side, along)), _) => {
                let lower = self.world.machine.rim.previous(side);
                let rate = Plane::new(0.0, along.rate) * self.world.turn;
                self.cross(lower, rate);
            }
            (What::Edge(false), Some((side, along)), _) => {
                self.cross(side, Plane::new(0.0, along.rate));
            }
            (What::Release, Some((side, along)), _) => {
                self.leave(&[(side, along.y)], Plane::new(0.0, along.rate), side);
            }
            (What::Yield(second), _, Some(a)) => {
                let (side, y) = if second { (a, -half) } else { (next(a), half) };
                self.stay_or_leave(side, y, 0.0);
            }
            (What::Lock, _, Some(a)) => self.enter(Mode::Corner(a)),
            (What::PulseEnd, Some(_), Some(a)) if matches!(self.mode, Mode::Corner(_)) => {
                self.rest(a);
            }
            (_, Some((side, along)), _) => self.stay_or_leave(side, along.y, along.rate),
            _ => self.fly(place, rate),
        }
    }

    /// Free flight from a state that touches nothing.
    pub(super) fn fly(&mut self, place: Plane, rate: Plane) {
        self.enter(Mode::Free(Free::new(place, rate, self.tips)));
    }

    /// A side is met at `place` in the standing frame; `local` is the rate of
    /// `z exp(-i psi)`.
    fn touch(&mut self, side: u32, place: Plane, local: Plane) {
        let met = place * self.drive.inward(&self.world, side, 0.0).conj();
        self.deepest = self.deepest.max(-(self.world.clearance + met.re));
        let half = self.world.half_side;
        let y = met.im.clamp(-half, half);
        let size = self.world.clearance + local.norm() / self.world.omega;
        let rim = &self.world.machine.rim;
        if self.world.corners && half - y.abs() <= 16.0 * self.world.tolerance * size {
            // Within round-off of a corner: both sides are met at once.
            if y > 0.0 {
                let lower = rim.previous(side);
                let turn = self.world.turn;
                self.meet_corner(lower, local * turn);
            } else {
                self.meet_corner(side, local);
            }
        } else {
            self.meet_side(side, y, local);
        }
    }

    /// One side is closed at `y`; `rate` is that of `z exp(-i psi)`.
    pub(super) fn meet_side(&mut self, side: u32, y: f64, rate: Plane) {
        if rate.re > 0.0 {
            let (place, rate) = self.standing(side, y, rate);
            self.fly(place, rate);
            return;
        }
        self.strike(&[(side, y, -rate.re, -rate.re)]);
        self.stay_or_leave(side, y, rate.im);
    }

    /// A corner is reached along one of its sides; `rate` in the frame of `a`.
    fn cross(&mut self, a: u32, rate: Plane) {
        self.meet_corner(a, rate);
        // What goes on along one side may be the beginning of the end.
        let along = self.mode.along(&self.world, &self.drive, 0.0);
        let (side, along) = match (&self.mode, along) {
            (Mode::Slide(_) | Mode::Driven(_), Some(found)) => found,
            _ => return,
        };
        let second = side != a;
        let speed = along.rate.abs();
        if speed > 0.0
            && let Some(limit) = rocking::limit(&self.world, &self.drive, a, second, speed)
        {
            let rocking::Limit { time, lost } = limit;
            self.mode = Mode::Rocking { a, second, speed, time, lost };
        }
    }

    /// Both sides of the corner of `a` and the next are closed; `rate` is that of
    /// `z` in the frame of `a`. Plastic impact by cases.
    pub(super) fn meet_corner(&mut self, a: u32, rate: Plane) {
        let world = &self.world;
        let (turn, cos) = (world.turn, world.turn.re);
        let (b, half) = (world.machine.rim.next(a), world.half_side);
        let other = rate * turn.conj();
        let (opens_a, opens_b) = (rate.re, other.re);
        if opens_a >= 0.0 && opens_b >= 0.0 {
            if opens_a == 0.0 && opens_b == 0.0 {
                self.rest(a);
            } else if opens_a == 0.0 {
                self.stay_or_leave(a, -half, rate.im);
            } else if opens_b == 0.0 {
                self.stay_or_leave(b, half, other.im);
            } else {
                let (place, rate) = self.standing(a, -half, rate);
                self.fly(place, rate);
            }
        } else if opens_a < 0.0 && opens_b - cos * opens_a > 0.0 {
            self.strike(&[(a, -half, -opens_a, -opens_a)]);
            self.stay_or_leave(a, -half, rate.im);
        } else if opens_b < 0.0 && opens_a - cos * opens_b > 0.0 {
            self.strike(&[(b, half, -opens_b, -opens_b)]);
            self.stay_or_leave(b, half, other.im);
        } else {
            let [first, second] = cancelled(world, opens_a, opens_b);
            self.strike(&[(a, -half, first, -opens_a), (b, half, second, -opens_b)]);
            self.rest(a);
        }
    }

    /// Books an impulse (per unit mass) on a side at `y`, which ended a closing
    /// speed: it takes the work `-impulse nu y` from the rotor.
    pub(super) fn book_impact(&mut self, side: u32, y: f64, impulse: f64, closing: f64) {
        self.ledger.rotor -= impulse * self.drive.nu * y;
        self.ledger.lost += 0.5 * impulse * closing;
        if let Some(blades) = &self.world.stiff {
            self.widest = self.widest.max(blades.kicked(y, impulse));
        }
        if closing > SOFT * self.world.omega * self.world.clearance {
            self.log.impact(self.start.0, side);
        }
    }

    /// Books impulses on sides at their places with the closing speeds.
    fn strike(&mut self, impulses: &[(u32, f64, f64, f64)]) {
        let t = self.start.0;
        for &(side, y, impulse, closing) in impulses {
            self.book_impact(side, y, impulse, closing);
        }
        match *impulses {
            [(side, ..)] => self.log.touch(t, Touching::Side(side)),
            [(a, ..), (b, ..)] => self.log.touch(t, Touching::of(&[a, b])),
            _ => {}
        }
    }

    /// At rest in a corner: which sides hold? Accelerations by cases.
    fn rest(&mut self, a: u32) {
        let world = &self.world;
        let (cos, b, half) = (world.turn.re, world.machine.rim.next(a), world.half_side);
        let [(opens_a, _), (opens_b, _)] = opening(world, &self.drive, a, 0.0);
        let pushes = cancelled(world, opens_a, opens_b);
        if pushes.iter().all(|&push| push >= 0.0) {
            self.enter(Mode::Corner(a));
        } else if opens_a <= 0.0 && opens_b - cos * opens_a > 0.0 {
            self.slide(a, -half, 0.0);
        } else if opens_b <= 0.0 && opens_a - cos * opens_b > 0.0 {
            self.slide(b, half, 0.0);
        } else {
            self.leave(&[(a, -half), (b, half)], Plane::default(), a);
        }
    }

    /// One side touches without rate: it holds if it pushes.
    fn stay_or_leave(&mut self, side: u32, y: f64, rate: f64) {
        let (world, drive) = (&self.world, &self.drive);
        let pulse = drive.pulse * drive.inward(world, side, 0.0).re;
        if world.push(drive.nu, drive.nu_rate, y, rate, pulse) >= 0.0 {
            self.slide(side, y, rate);
        } else {
            self.leave(&[(side, y)], Plane::new(0.0, rate), side);
        }
    }

    fn slide(&mut self, side: u32, y: f64, rate: f64) {
        let (world, drive) = (&self.world, &self.drive);
        let mode = if drive.steady() {
            Mode::Slide(Slide::new(world, drive, side, y, rate))
        } else {
            let edge = (y.abs() == world.half_side).then_some(y > 0.0);
            let from = From { y, rate, tips: Tips::default(), edge, resting: rate == 0.0 };
            Mode::Driven(Series::new(world, drive, side, &from))
        };
        self.enter(mode);
    }

    /// Free flight off the sides at the given places along them; `rate` in the
    /// frame of `frame`, the first of them.
    fn leave(&mut self, sides: &[(u32, f64)], rate: Plane, frame: u32) {
        let Some(&(_, y)) = sides.first() else { return };
        let (place, rate) = self.standing(frame, y, rate);
        let flight = Free::new(place, rate, Tips::default());
        let mut free = flight;
        for (slot, &(side, _)) in free.leaving.iter_mut().zip(sides) {
            let (bend, twist) = flight.curvature(&self.world, &self.drive, side);
            *slot = Some(Leaving { side, bend: bend.max(0.0), twist });
        }
        self.enter(Mode::Free(free));
    }

    /// Place and rate in the standing frame of a point on a side.
    fn standing(&self, side: u32, y: f64, rate: Plane) -> (Plane, Plane) {
        let inward = self.drive.inward(&self.world, side, 0.0);
        let place = Plane::new(-self.world.clearance, y);
        (place * inward, (rate + Plane::i() * place * self.drive.nu) * inward)
    }

    pub(super) fn enter(&mut self, mode: Mode) {
        let t = self.start.0;
        let touching = mode.touching(&self.world);
        let before = self.log.touching;
        if before != Touching::Nothing && before != touching {
            // The old contact lasted until now.
            self.log.touch(t, before);
        }
        self.log.touch(t, touching);
        self.mode = mode;
    }
}
