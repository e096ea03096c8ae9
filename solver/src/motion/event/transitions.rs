//! From one stretch to the next: where it starts, the event that ends it, and changes from outside.

use std::f64::consts::TAU;

use super::Events;
use super::seek::{Ending, OpenedGap, seek};
use super::stretch::Held;
use crate::motion::point::Point;
use crate::motion::{FailureReason, Plane, size};
use crate::numeric::rounding::ROUNDINGS;

/// Part of the clearance up to which a gap that has just opened is stored separately from the state.
/// Smaller: a short excursion is lost in round-off.
const JUST_OPENED: f64 = 1e-6;

/// Phase of the fastest rate that counts as no time \[rad\], far below what the clock resolves. Zero: a
/// row that opens and closes by round-off does so endlessly.
pub(super) const AN_INSTANT: f64 = 1e-26;

impl Events {
    /// Returns the time from the start of the stretch to `t` \[s\].
    pub(super) fn elapsed(&self, t: f64) -> f64 {
        self.run.clock.elapsed(t)
    }

    /// Ends the motion `s` seconds into the stretch.
    pub(super) fn fail(&mut self, s: f64, reason: FailureReason) {
        self.run.fail(s, reason);
        self.next = (f64::INFINITY, Ending::StretchEnd);
    }

    /// Ends the motion at this point, at the start of the next stretch.
    pub(super) fn fail_at(&mut self, point: &Point, reason: FailureReason) {
        self.held = Held::default();
        self.stretch.fly(*point, f64::INFINITY);
        self.fail(0.0, reason);
    }

    /// Returns whether the pulse acts from the start of the stretch on for more than an instant.
    fn pulses(&self) -> bool {
        self.run.pulse.at(self.run.clock.start()) != 0.0
            && self.elapsed(self.run.pulse.end) * self.flow.rates() > AN_INSTANT
    }

    /// Returns the pulse force per unit casing mass at the start of the stretch, in the blade frame
    /// \[m/s^2\].
    pub(super) fn force(&self) -> Plane {
        if self.pulses() {
            Plane::cis(-self.phase) * (self.run.pulse.force / self.flow.machine.casing_mass)
        } else {
            Plane::default()
        }
    }

    /// Starts the next stretch from this point with the present rows in contact.
    pub(super) fn enter(&mut self, mut point: Point) {
        if self.run.failure.is_some() {
            return;
        }
        let pulses = self.pulses();
        if self.held.close(&self.flow, &mut point).is_none() {
            self.fail_at(&point, FailureReason::Singular { rows: self.held.rows.len() });
            return;
        }
        if self.held.rows.is_empty() && !pulses {
            let safe = self.flow.safe_flight(&point);
            if safe * self.flow.rates() > super::series::STRETCH {
                self.stretch.fly(point, safe);
                self.opened.clear();
                self.next = (safe, Ending::StretchEnd);
                return;
            }
        }
        let most = if pulses { self.elapsed(self.run.pulse.end) } else { f64::INFINITY };
        let force = self.force();
        self.stretch.begin(&self.flow, &self.held, point, force, most);
        if self.stretch.lost {
            self.fail(0.0, FailureReason::Series);
            return;
        }
        let still = ROUNDINGS * self.flow.clearance();
        // Without slope or friction the blades move far less than the casing.
        let angle = match self.flow.diameters() {
            0.0 => self.flow.clearance() / self.flow.machine.blade_length,
            _ => size(point.a),
        };
        let swings = self.stretch.swing > ROUNDINGS * angle;
        let rests = !pulses && self.opened.is_empty();
        if rests && !swings && self.stretch.travel[0] <= still && self.held_for_good(0.0) {
            let rest = self.rest.get().and_then(Option::as_ref);
            self.stretch.come_to_rest(rest.map_or(point, |rest| rest.point));
            self.next = (f64::INFINITY, Ending::StretchEnd);
            return;
        }
        self.next = seek(&self.flow, &self.stretch, &self.held, &self.opened);
    }

    /// Processes the event that ends the stretch.
    pub(super) fn pass(&mut self) {
        let (s, what) = self.next;
        self.run.looks += 1;
        let phase = s * self.flow.rates();
        if let Some(reason) = self.run.count(phase, what != Ending::StretchEnd) {
            return self.fail(s, reason);
        }
        let pulsed = self.pulses();
        let Some(mut point) = self.rebase(s) else { return };
        if what == Ending::StretchEnd && pulsed && !self.pulses() {
            // The contact forces jump together with the pulse.
            let met = self.closed(&point, &self.held.rows);
            self.settle(&mut point, met);
        } else {
            self.follow(&mut point, what);
        }
    }

    /// Starts the motion after an event.
    fn follow(&mut self, point: &mut Point, what: Ending) {
        match what {
            Ending::StretchEnd => self.enter(*point),
            Ending::Touch(..) if self.held.rows.len() == 1 && self.flow.rows.len() == 2 => {
                self.fail(0.0, FailureReason::TwoSides { angle_rad: size(point.a) });
            }
            Ending::Touch(row, rate) => {
                let met = self.touching(point, row, rate);
                self.meet(point, met);
            }
            Ending::Release(row) => {
                let mut met = self.closed(point, &self.held.rows);
                met.retain(|touch| touch.row != row);
                let (gap, rate) = (0.0, 0.0);
                self.opened.push(OpenedGap { row, gap, rate, released: true, struck: false });
                self.settle(point, met);
            }
            Ending::Lock => {
                let t = self.run.clock.start();
                self.run.log.accumulate(t);
                let met = self.closed(point, &self.held.rows);
                self.settle(point, met);
            }
        }
    }

    /// Records the stretch up to `s`, moves the start of the next one there, and returns the point.
    /// `None` if the motion has left the range of the model; it then stays in the present stretch,
    /// so that everything reported refers to the same instant.
    fn rebase(&mut self, s: f64) -> Option<Point> {
        let point = self.stretch.point(&self.flow, s);
        self.check_growth(s, &point);
        if self.run.failure.is_some() {
            return None;
        }
        let flow = &self.flow;
        if self.ledger.counts {
            self.ledger.sums.book(flow, &self.held, &self.stretch, s);
            self.run.widest = self.widest_until(s);
            let [travel, reach] = self.stretch.travel;
            if reach + travel >= flow.least_clearance() {
                let known = |row: usize| self.opened.iter().any(|gap| gap.row == row);
                let gaps = flow
                    .near(&point, 0.0, self.held.rows.first().copied())
                    .filter(|&row| !known(row));
                let least = gaps.map(|row| flow.gap(row, &point)).fold(0.0, f64::min);
                self.run.deepest = self.run.deepest.max(-least);
            }
        }
        let limit = JUST_OPENED * flow.clearance();
        self.opened.retain_mut(|gap| {
            *gap = gap.later(flow, &self.stretch, s);
            gap.gap < limit
        });
        self.phase = (self.phase + flow.turned(s)) % TAU;
        if self.pulses() && s >= self.elapsed(self.run.pulse.end) {
            self.run.clock.begin_at(self.run.pulse.end);
        } else {
            self.run.clock.pass(s);
        }
        let t = self.run.clock.start();
        if self.flow.nu_rate != 0.0 {
            self.flow.turn_at(self.run.rotor.speed(t), self.run.rotor.ramp());
        }
        let (still, swing) = (Plane::default(), self.flow.arm().abs() * size(point.a));
        self.lasting.look(t, still, still, swing);
        Some(point)
    }

    /// Returns whether the same rows stay in contact for ever from `s` seconds into the stretch on.
    pub(super) fn held_for_good(&self, s: f64) -> bool {
        let changes = self.pulses() || self.flow.nu_rate != 0.0 || self.next.1 == Ending::Lock;
        if changes || self.held.rows.len() < 2 || !self.opened.is_empty() {
            return false;
        }
        let rest = self.rest.get_or_init(|| super::Rest::of(&self.flow, &self.held));
        let point = self.stretch.point(&self.flow, s);
        rest.as_ref().is_some_and(|rest| rest.for_good(&self.flow, &point))
    }

    /// Changes rotor, pulse or rate at the present instant. The casing keeps its position, and its
    /// velocity in the stationary frame except for `change`.
    pub(super) fn intervene(&mut self, change: impl FnOnce(&mut Self, &mut Point)) {
        if self.run.failure.is_some() {
            return;
        }
        let s = self.elapsed(self.run.clock.now);
        let Some(mut point) = self.rebase(s) else { return };
        self.run.clock.begin_at(self.run.clock.now);
        let (before, energy) = (self.flow.nu, self.flow.energy(&point, 0.0));
        let (clearance, ramp) = (self.flow.clearance(), self.flow.nu_rate);
        let rate = point.dz;
        change(self, &mut point);
        let jump = before - self.flow.nu;
        point.dz += Plane::i() * point.z * jump;
        self.ledger.start += self.flow.energy(&point, 0.0) - energy;
        for gap in &mut self.opened {
            gap.rate += self.flow.face(gap.row, &point).along(point.dz - rate, Plane::default());
        }
        if self.flow.clearance() != clearance {
            // A different clearance can open or close any gap.
            self.held = Held::default();
            self.opened.clear();
            self.rest = std::sync::OnceLock::new();
            self.begin(point);
            return;
        }
        if jump == 0.0 {
            if self.flow.nu_rate != ramp {
                self.rest = std::sync::OnceLock::new();
            }
            let rows = std::mem::take(&mut self.held).rows;
            let met = self.closed(&point, &rows);
            self.settle(&mut point, met);
            return;
        }
        // A sudden change of speed acts on closed gaps like an impact.
        self.rest = std::sync::OnceLock::new();
        let rows = std::mem::take(&mut self.held).rows;
        let mut met = self.closed(&point, &rows);
        met.iter_mut().for_each(|touch| touch.opening = touch.face.along(point.dz, point.da));
        self.meet(&mut point, met);
    }

    /// Changes the machine to another speed and acceleration. The change of blade stiffness at the
    /// present angles is work of the rotor. If a smaller clearance would leave tips inside the
    /// casing, all displacements are reduced by a common factor, which is work of the growing blades.
    pub(super) fn change_speed(&mut self, speed: f64, ramp: f64, point: &mut Point) {
        let flow = &mut self.flow;
        // The energies refer to the present frame; the casing rate is converted to the new frame
        // afterwards.
        let before = flow.energy(point, 0.0);
        let turned = flow.nu;
        flow.machine.turn_at(speed);
        flow.stiffen();
        let stiffened = flow.energy(point, 0.0);
        let part = (0..flow.rows.len())
            .map(|row| (flow.gap(row, point), flow.apothem(row)))
            .filter(|(open, apothem)| *open < 0.0 && *apothem > 0.0)
            .fold(1.0, |part: f64, (open, apothem)| part.min(apothem / (apothem - open)));
        if part < 1.0 {
            point.dz += Plane::i() * point.z * ((1.0 - part) * turned);
            (point.z, point.a) = (point.z * part, point.a * part);
        }
        let after = flow.energy(point, 0.0);
        self.ledger.sums.rotor_work_j += stiffened - before;
        self.ledger.sums.growth_work_j += after - stiffened;
        self.ledger.start -= after - before;
        flow.turn_at(speed, ramp);
    }
}
