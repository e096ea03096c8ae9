//! From one segment to the next: finding the event that ends it, moving the start, what pulse
//! and rotor do from there, and the choice of the next mode (docs/theory.md, section 7).
//!
//! Among the sides that touch without rate, accelerations decide which of them
//! hold, as a small complementarity problem solved by cases. Where an event says
//! that a push has vanished, that side opens and is not tested again.
//!
//! Places and rates are those the rotor sees, `z = u exp(-i n_d theta)` and `z'`,
//! so that a slow motion along a side keeps its digits. Rigid blades are moving
//! ones with zero coupling: where they do not move, the closed forms of `locked`
//! and `slide` take the place of the derivatives and series.

use std::f64::consts::TAU;

use super::free::{Free, OpenedSide};
use super::impact::CornerContact;
use super::locked::CornerSeries;
use super::mode::{Ending, Mode, Next, casing_energy};
use super::parameters::Drive;
use super::slide::{From, SideSeries, Slide};
use super::{ExactEvents, locked, rocking};
use crate::motion::{ActiveSet, Failure, FailureReason, GoOn, Plane};
use crate::tolerances::{BRIEF_ROCKING, LOOKS_UNASKED, MOST_LOOKS, ON_A_SIDE};

/// What became of the next event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Passage {
    /// It is passed.
    Passed,
    /// It comes later.
    Later,
    /// The search for it was told not to go on.
    Paused,
}

impl ExactEvents {
    /// Seconds from the start of the segment to `t`.
    pub(super) fn elapsed(&self, t: f64) -> f64 {
        self.run.clock.elapsed(t)
    }

    /// Goes through the next event, if it comes no later than `until`.
    pub(super) fn change(&mut self, until: f64, go_on: GoOn<'_>) -> Result<Passage, Failure> {
        if let Some(failure) = &self.run.failure {
            return Err(failure.clone());
        }
        let (s, what) = match self.seek(self.elapsed(until), go_on) {
            Ok(found) => found,
            Err(passage) => return self.run.failure.clone().map_or(Ok(passage), Err),
        };
        self.check_angles(s)?;
        let rates = self.parameters.omega + self.parameters.drive.nu.abs();
        let exceeded = self.run.count(s * rates, what != Ending::SeriesEnd);
        let reason = if matches!(what, Ending::Gone | Ending::Edge(_)) && !self.parameters.corners {
            Some(FailureReason::NoCorner { radius_m: self.parameters.reach })
        } else if what == Ending::Lost {
            Some(FailureReason::Series)
        } else {
            exceeded
        };
        match reason {
            Some(reason) => _ = self.fail(s, reason),
            None => self.pass(s, what),
        }
        self.run.failure.clone().map_or(Ok(Passage::Passed), Err)
    }

    /// Ends `advance` at `until`.
    ///
    /// # Errors
    /// Blades went beyond small angles before.
    pub(super) fn arrive(&mut self, until: f64) -> Result<(), Failure> {
        self.check_angles(self.elapsed(until))?;
        self.run.clock.arrive(until);
        let active_set = self.mode.active_set(&self.parameters);
        if active_set != ActiveSet::Nothing {
            self.run.log.touch(self.run.clock.now, active_set);
        }
        Ok(())
    }

    /// Ends the motion `s` seconds into the segment.
    pub(super) fn fail(&mut self, s: f64, reason: FailureReason) -> Failure {
        self.run.fail(s, reason)
    }

    /// Returns the event that ends the segment and when, if no later than `limit` seconds after
    /// its start, or why not. The looks ahead depend neither on `limit` nor on pauses.
    fn seek(&mut self, limit: f64, go_on: GoOn<'_>) -> Result<(f64, Ending), Passage> {
        let pulse_end = self.pulse_left();
        let series_end = self.mode.length();
        let end = pulse_end.min(series_end);
        loop {
            if let Some((s, what)) = self.found {
                return if s <= limit { Ok((s, what)) } else { Err(Passage::Later) };
            }
            if self.safe > limit {
                return Err(Passage::Later);
            }
            if self.safe >= end {
                if !end.is_finite() {
                    return Err(Passage::Later);
                }
                let what =
                    if pulse_end <= series_end { Ending::PulseEnd } else { Ending::SeriesEnd };
                self.found = Some((end, what));
                continue;
            }
            if self.looks.is_multiple_of(LOOKS_UNASKED) && !go_on() {
                return Err(Passage::Paused);
            }
            self.looks += 1;
            self.run.looks += 1;
            if self.run.looks > MOST_LOOKS {
                self.fail(self.safe, FailureReason::Looks);
                return Err(Passage::Later);
            }
            match self.mode.look(&self.parameters, self.safe, end) {
                Next::Until(later) => self.safe = later.min(end),
                Next::Now(what) => self.found = Some((self.safe, what)),
            }
        }
    }

    /// Seconds from the start of the segment to the end of the pulse.
    fn pulse_left(&self) -> f64 {
        if self.parameters.drive.pulse == 0.0 {
            f64::INFINITY
        } else {
            self.elapsed(self.run.pulse.end)
        }
    }

    /// Books the segment and moves its start by `s`; the mode is left to be
    /// replaced.
    pub(super) fn rebase(&mut self, s: f64, what: Option<Ending>) {
        if self.run.checked {
            self.mode.book(&self.parameters, s, &mut self.energy_balance);
            self.run.widest = self.mode.largest_angle(&self.parameters, s, self.run.widest);
        }
        self.tips = self.mode.tips(&self.parameters, s);
        let phase = self.parameters.drive.phase(s) % TAU;
        if what == Some(Ending::PulseEnd) {
            self.run.clock.begin_at(self.run.pulse.end);
        } else {
            self.run.clock.pass(s);
        }
        self.parameters.drive = self.drive_now(phase);
        self.safe = 0.0;
        self.found = None;
        self.looks = 0;
        self.check_order();
    }

    /// Rotor and pulse from the start of the segment on.
    pub(super) fn drive_now(&self, phase: f64) -> Drive {
        let t = self.run.clock.start();
        let diameters = self.parameters.machine.nodal_diameters;
        let acting = (self.run.pulse.start..self.run.pulse.end).contains(&t);
        Drive {
            phase,
            nu: diameters * self.run.rotor.speed(t),
            nu_rate: diameters * self.run.rotor.ramp(),
            pulse: if acting { self.run.pulse.force / self.parameters.mass } else { 0.0 },
        }
    }

    /// Changes rotor or pulse at the present instant; the casing keeps its
    /// place and its rate in the standing frame.
    pub(super) fn intervene(&mut self, change: impl FnOnce(&mut Self)) {
        self.intervene_scaled(1.0, change);
    }

    /// As `intervene`, with the rate of free flight or along a side multiplied
    /// by `factor`.
    pub(super) fn intervene_scaled(&mut self, factor: f64, change: impl FnOnce(&mut Self)) {
        if self.run.failure.is_some() {
            return;
        }
        let s = self.elapsed(self.run.clock.now);
        let side = self.mode.along(&self.parameters, s);
        let (place, mut rate) = self.mode.seen_by_rotor(&self.parameters, s, side);
        if let (Mode::Slide(_) | Mode::Driven(_), Some((side, along))) = (&self.mode, side) {
            let tips = self.mode.tips(&self.parameters, s);
            let (normal, _) = self.parameters.normal(side, &tips);
            rate += Plane::i() * normal * ((factor - 1.0) * along.rate);
        }
        let standing = self.mode.standing(&self.parameters, s);
        let mut flight = self.mode.flight(&self.parameters, s);
        let corner = self.mode.corner().filter(|_| !matches!(self.mode, Mode::Rocking { .. }));
        self.rebase(s, None);
        self.run.clock.begin_at(self.run.clock.now);
        let (nu, clearance) = (self.parameters.drive.nu, self.parameters.clearance);
        change(self);
        self.parameters.drive = self.drive_now(self.parameters.drive.phase);
        if self.parameters.clearance > clearance {
            flight = Some(standing);
        } else if self.parameters.clearance < clearance {
            self.shrink_into_clearance(standing, side.map(|(side, _)| side), corner);
            return;
        }
        // The rate against the blades jumps with the speed of the rotor.
        let rate = rate + Plane::i() * place * (nu - self.parameters.drive.nu);
        match (flight, corner, side) {
            (Some((u, v)), ..) => self.enter(Mode::Free(Free::new(u, v * factor, self.tips))),
            (_, Some(a), _) => self.meet_corner_at(a, rate),
            (_, _, Some((side, _))) => self.touch(side, place, rate),
            _ => {}
        }
    }
}

impl ExactEvents {
    /// A clearance that is smaller all at once: where it leaves the casing beyond a side, all
    /// of its displacement shrinks by one part, and its rate stays.
    fn shrink_into_clearance(
        &mut self,
        (u, v): (Plane, Plane),
        held: Option<u32>,
        corner: Option<u32>,
    ) {
        let back = Plane::cis(-self.parameters.drive.phase);
        let (place, polygon) = (u * back, &self.parameters.machine.polygon);
        let near = polygon.nearest_side(place.re, place.im);
        let side = held.unwrap_or(near);
        let open = polygon.gap(near, place.re, place.im).min(polygon.gap(side, place.re, place.im));
        if open > 0.0 || polygon.clearance <= 0.0 {
            self.enter(Mode::Free(Free::new(u, v, self.tips)));
            return;
        }
        let part = polygon.clearance / (polygon.clearance - open);
        let work = casing_energy(&self.parameters, u * part, v);
        self.energy_balance.growth += work - casing_energy(&self.parameters, u, v);
        let place = place * part;
        let rate = v * back - Plane::i() * place * self.parameters.drive.nu;
        match corner {
            Some(a) => self.meet_corner_at(a, rate),
            None => self.touch(if held.is_some() { side } else { near }, place, rate),
        }
    }

    /// The first mode, from the initial state.
    pub(super) fn begin(&mut self, place: Plane, rate: Plane) {
        let polygon = &self.parameters.machine.polygon;
        let side = polygon.nearest_side(place.re, place.im);
        if polygon.gap(side, place.re, place.im) <= ON_A_SIDE * self.parameters.clearance {
            // A rate against the blades that is round-off of its two parts is none.
            let direction = self.parameters.direction(side);
            let carried = Plane::i() * place * self.parameters.drive.nu;
            let local = (rate - carried) * direction.conj();
            let noise = ON_A_SIDE * (rate.norm() + carried.norm());
            let clean = |x: f64| if x.abs() <= noise { 0.0 } else { x };
            self.touch(side, place, Plane::new(clean(local.re), clean(local.im)) * direction);
        } else {
            self.enter(Mode::Free(Free::new(place, rate, self.tips)));
        }
    }

    /// Passes the event `what`, `s` seconds into the segment.
    pub(super) fn pass(&mut self, s: f64, what: Ending) {
        let along = self.mode.along(&self.parameters, s);
        let (place, rate) = self.mode.seen_by_rotor(&self.parameters, s, along);
        let corner = self.mode.corner();
        // Flight ends at a touch, and goes on from its own frame otherwise.
        let flight = match what {
            Ending::Touch(_) => None,
            _ => self.mode.flight(&self.parameters, s),
        };
        self.rebase(s, Some(what));
        let polygon = &self.parameters.machine.polygon;
        match (what, along, corner) {
            (Ending::Touch(side), ..) => self.touch(side, place, rate),
            (Ending::Edge(upper), Some((side, along)), _) => {
                let a = if upper { polygon.previous(side) } else { side };
                self.cross(a, upper, along.rate, rate);
            }
            (Ending::Release, Some((side, along)), _) => self.leave(&[side], along.y, rate),
            (Ending::Yield(second), _, Some(a)) => {
                let side = if second { a } else { polygon.next(a) };
                self.hold_at_corner(side, rate, !second, 0.0);
            }
            (Ending::Lock | Ending::SeriesEnd, _, Some(a)) => self.enter_corner(a),
            (_, _, Some(a)) if !matches!(self.mode, Mode::Rocking { .. }) => self.rest(a, rate),
            (_, Some((side, along)), _) => self.hold(side, along.y, along.rate, rate),
            _ => {
                if let Some((u, v)) = flight {
                    self.enter(Mode::Free(Free::new(u, v, self.tips)));
                }
            }
        }
    }

    /// A corner is reached along one of its sides, the second where `second`,
    /// with the rate `along` that side.
    fn cross(&mut self, a: u32, second: bool, along: f64, rate: Plane) {
        let contact = self.corner_contact(a);
        let mut openings = self.clean_openings(&contact, rate);
        openings[usize::from(second)] = 0.0;
        if self.parameters.blades.is_none() {
            // The closed form keeps all digits of a slow motion.
            openings[usize::from(!second)] = -along.abs() * self.parameters.turn.im;
        }
        self.meet_corner(&contact, rate, openings);
        // What goes on along one side may be the beginning of the end.
        let Some((side, along)) = self.mode.along(&self.parameters, 0.0) else {
            return;
        };
        let second = side != a;
        let speed = match &self.mode {
            Mode::Driven(series) => series.parting(second),
            Mode::Slide(_) => along.rate.abs(),
            _ => return,
        };
        if speed <= 0.0 {
            return;
        }
        let Self { parameters, tables, .. } = self;
        let Some(limit) = rocking::limit(parameters, tables, a, second, speed) else {
            return;
        };
        match self.parameters.blades {
            None => {
                let rocking::Limit { time, lost } = limit;
                self.mode = Mode::Rocking { a, second, speed, time, lost };
            }
            Some(blades) => {
                let rates = self.parameters.omega + self.parameters.drive.nu.abs() + blades.omega;
                if limit.time * rates <= BRIEF_ROCKING {
                    self.stop_rocking(a);
                }
            }
        }
    }

    /// Ends a rocking so brief that the blades do not notice: the impulses that
    /// stop it now are what the crossings to come add to the pushes of the corner
    /// at rest.
    fn stop_rocking(&mut self, a: u32) {
        let along = self.mode.along(&self.parameters, 0.0);
        let (_, rate) = self.mode.seen_by_rotor(&self.parameters, 0.0, along);
        let contact = self.corner_contact(a);
        let [first, second] = self.openings(&contact, rate);
        let impulses = contact.cancelled(first, second);
        for (side, y, impulse) in contact.on_sides(impulses) {
            self.kick(side, y, impulse);
        }
        self.energy_balance.lost -= 0.5 * (first * impulses[0] + second * impulses[1]);
        let rotor = impulses[0] * contact.y[0] + impulses[1] * contact.y[1];
        self.energy_balance.rotor -= rotor * self.parameters.drive.nu;
        self.rest(a, contact.struck(rate, impulses));
    }

    /// At rest in a corner: which sides hold? Accelerations by cases.
    pub(super) fn rest(&mut self, a: u32, rate: Plane) {
        let contact = self.corner_contact(a);
        let [first, second] = self.opening_accelerations(&contact, rate);
        let share = contact.share();
        if contact.cancelled(first, second).iter().all(|&push| push >= 0.0) {
            self.enter_corner(a);
        } else if first <= 0.0 && second - share * first > 0.0 {
            self.slide_from_corner(contact.a, rate, false, 0.0);
        } else if second <= 0.0 && first - share * second > 0.0 {
            self.slide_from_corner(contact.b, rate, true, 0.0);
        } else {
            self.leave(&[contact.a, contact.b], contact.y[0], rate);
        }
    }

    /// Returns the second derivatives of both gaps of a corner at rest, without its pushes.
    fn opening_accelerations(&self, contact: &CornerContact, rate: Plane) -> [f64; 2] {
        let parameters = &self.parameters;
        if parameters.blades.is_none() {
            return locked::opening(parameters, contact.a, 0.0).map(|opening| opening.0);
        }
        let flight = self.flight(contact.place(parameters), rate);
        let noise = parameters.push_noise();
        [contact.a, contact.b].map(|side| {
            let opening = flight.curvature(parameters, side).0;
            if opening.abs() <= noise { 0.0 } else { opening }
        })
    }

    fn enter_corner(&mut self, a: u32) {
        let mode = match &self.parameters.blades {
            None => Mode::Corner(a),
            Some(blades) => Mode::Held(CornerSeries::new(&self.parameters, blades, a, &self.tips)),
        };
        self.enter(mode);
    }

    /// One side of a corner touches without rate: it holds if it pushes. The
    /// corner is at its upper (`true`) or lower end, and its other side opens with
    /// the rate `opens`, zero or more.
    pub(super) fn hold_at_corner(&mut self, side: u32, rate: Plane, upper: bool, opens: f64) {
        let (y, along) = self.at_corner(side, rate, upper, opens);
        if self.pushes(side, y, along, rate) {
            self.slide_from_corner(side, rate, upper, opens);
        } else {
            self.leave(&[side], y, rate);
        }
    }

    /// Returns the place and rate along a side, as above.
    fn at_corner(&self, side: u32, rate: Plane, upper: bool, opens: f64) -> (f64, f64) {
        let parameters = &self.parameters;
        let lower = if upper { parameters.machine.polygon.previous(side) } else { side };
        let half = parameters.half_length(lower, &self.tips);
        let (y, away) = if upper { (half, -1.0) } else { (-half, 1.0) };
        if parameters.blades.is_none() {
            // The rate away from the corner keeps the digits of the opening.
            return (y, away * opens / parameters.turn.im);
        }
        let (normal, spin) = parameters.normal(side, &self.tips);
        // i (-g0 + i y) spin has the imaginary part -g0 spin.
        (y, (rate * normal.conj()).im + parameters.clearance * spin)
    }

    fn slide_from_corner(&mut self, side: u32, rate: Plane, upper: bool, opens: f64) {
        let (y, along) = self.at_corner(side, rate, upper, opens);
        let resting = opens == 0.0;
        let from = From { y, rate: along, tips: self.tips, edge: Some(upper), resting };
        self.slide(side, &from);
    }

    /// One side touches without rate, away from its corners: it holds if it pushes.
    pub(super) fn hold(&mut self, side: u32, y: f64, along: f64, rate: Plane) {
        if self.pushes(side, y, along, rate) {
            let from = From { y, rate: along, tips: self.tips, edge: None, resting: false };
            self.slide(side, &from);
        } else {
            self.leave(&[side], y, rate);
        }
    }

    /// Returns whether a side that touches without rate pushes.
    fn pushes(&self, side: u32, y: f64, along: f64, rate: Plane) -> bool {
        let parameters = &self.parameters;
        let push = match &parameters.blades {
            None => {
                let pulse = parameters.pulse_on(side, 0.0).re;
                parameters.push(parameters.drive.nu, parameters.drive.nu_rate, y, along, pulse)
            }
            Some(blades) => {
                let flight = self.flight(self.on_side(side, y), rate);
                -flight.curvature(parameters, side).0 / (1.0 + blades.ratio * y * y)
            }
        };
        push >= 0.0
    }

    fn slide(&mut self, side: u32, from: &From) {
        let parameters = &self.parameters;
        if parameters.blades.is_none() && parameters.drive.steady() {
            self.enter(Mode::Slide(Slide::new(parameters, side, from.y, from.rate)));
            return;
        }
        let series = SideSeries::new(parameters, side, from);
        if series.may_meet_other(parameters) {
            self.fail(0.0, FailureReason::TwoSides { angle_rad: from.tips.angle.norm() });
        }
        self.enter(Mode::Driven(series));
    }

    /// Free flight off these sides, from `y` along the first of them.
    fn leave(&mut self, sides: &[u32], y: f64, rate: Plane) {
        let Some(&first) = sides.first() else { return };
        let flight = self.flight(self.on_side(first, y), rate);
        let mut free = flight;
        for (slot, &side) in free.opened.iter_mut().zip(sides) {
            let (bend, twist) = flight.curvature(&self.parameters, side);
            *slot = Some(OpenedSide { side, bend: bend.max(0.0), twist });
        }
        self.enter(Mode::Free(free));
    }

    /// Returns the place of a point on a side.
    fn on_side(&self, side: u32, y: f64) -> Plane {
        Plane::new(-self.parameters.clearance, y) * self.parameters.normal(side, &self.tips).0
    }

    /// Free flight from a place and rate that the rotor sees.
    pub(super) fn flight(&self, place: Plane, rate: Plane) -> Free {
        let turn = Plane::cis(self.parameters.drive.phase);
        let rate = (rate + Plane::i() * place * self.parameters.drive.nu) * turn;
        Free::new(place * turn, rate, self.tips)
    }

    pub(super) fn enter(&mut self, mode: Mode) {
        self.run.hold(mode.active_set(&self.parameters));
        self.mode = mode;
    }
}
