//! From one stretch to the next: what ends it, moving the start, and changes from
//! outside.

use std::f64::consts::TAU;

use super::Joined;
use super::parameters::Point;
use super::search::{Loose, What, seek};
use super::stretch::{Held, Stretch};
use crate::motion::{Failure, FailureReason, Plane};
use crate::tolerances::{
    AN_INSTANT, AT_A_CORNER, AT_REST, FREE_MARGIN, JUST_OPENED, MOST_EVENTS, MOST_EVENTS_AT_ONCE,
    MOST_LOOKS,
};

impl Joined {
    /// Seconds from the start of the stretch to `t`.
    pub(super) fn elapsed(&self, t: f64) -> f64 {
        self.clock.elapsed(t)
    }

    /// Ends the motion `s` seconds into the stretch.
    pub(super) fn fail(&mut self, s: f64, reason: FailureReason) {
        let t_s = self.clock.start() + s;
        self.clock.arrive(t_s);
        self.failure.get_or_insert(Failure { t_s, reason });
        self.next = (f64::INFINITY, What::StretchEnd);
    }

    /// Whether the pulse acts from the start of the stretch on, for more than an
    /// instant.
    fn pulses(&self) -> bool {
        self.pulse.at(self.clock.start()) != 0.0
            && self.elapsed(self.pulse.end) * self.parameters.rates() > AN_INSTANT
    }

    /// The force of the pulse per unit casing mass at the start of the stretch, in the
    /// frame of the blades \[m/s^2\].
    pub(super) fn force(&self) -> Plane {
        if self.pulses() {
            Plane::cis(-self.phase) * (self.pulse.force / self.parameters.machine.casing_mass)
        } else {
            Plane::default()
        }
    }

    /// Ends the motion at this point, at the start of the stretch to come.
    pub(super) fn fail_at(&mut self, point: &Point, reason: FailureReason) {
        self.held = Held::default();
        self.stretch = Stretch::to_the_end(*point);
        self.fail(0.0, reason);
    }

    /// The next stretch, from this point on with the rows held now.
    pub(super) fn enter(&mut self, point: Point) {
        if self.failure.is_some() {
            return;
        }
        let pulses = self.pulses();
        let parameters = &self.parameters;
        let point = self.held.closed(parameters, &point);
        let gaps = self.held.rows.is_empty() && !pulses;
        if gaps && parameters.swing(&point) < parameters.clearance() * (1.0 - FREE_MARGIN) {
            self.stretch = Stretch::to_the_end(point);
            self.loose.clear();
            self.next = (f64::INFINITY, What::StretchEnd);
            return;
        }
        let most = if pulses { self.elapsed(self.pulse.end) } else { f64::INFINITY };
        let stretch = Stretch::new(parameters, &self.held, point, self.force(), most);
        if stretch.lost {
            self.stretch = stretch;
            self.fail(0.0, FailureReason::Series);
            return;
        }
        let [travel, _] = stretch.travel(parameters);
        let moved = travel.max(stretch.swings(parameters));
        if !pulses && self.loose.is_empty() && moved <= AT_REST * parameters.clearance() {
            self.stretch = stretch;
            if self.held_for_good(0.0) {
                self.stretch = self.stretch.clone().at_rest();
                self.next = (f64::INFINITY, What::StretchEnd);
                return;
            }
        } else {
            self.stretch = stretch;
        }
        self.next = seek(&self.parameters, &self.stretch, &self.held, &self.loose);
    }

    /// Passes the event that ends the stretch.
    pub(super) fn pass(&mut self) {
        let (s, what) = self.next;
        self.looks += 1;
        self.idle = if s * self.parameters.rates() > AN_INSTANT { 0 } else { self.idle + 1 };
        if what != What::StretchEnd {
            self.events += 1;
        }
        let reason = if self.events > MOST_EVENTS {
            FailureReason::Events
        } else if self.looks > MOST_LOOKS {
            FailureReason::Looks
        } else if self.idle > MOST_EVENTS_AT_ONCE {
            FailureReason::EventsAtOnce
        } else {
            let pulsed = self.pulses();
            let Some(mut point) = self.rebase(s) else { return };
            if what == What::StretchEnd && pulsed && !self.pulses() {
                // The pushes jump with the force.
                let rows = self.held.rows.clone();
                self.settle(&mut point, &rows);
            } else {
                self.follow(&mut point, what);
            }
            return;
        };
        self.fail(s, reason);
    }

    /// What comes after an event.
    fn follow(&mut self, point: &mut Point, what: What) {
        match what {
            What::StretchEnd => self.enter(*point),
            What::Touch(row, rate) => {
                let mut met = self.touching(point, row);
                met.push((row, rate));
                self.meet(point, &met);
            }
            What::Release(row) => {
                let still: Vec<usize> =
                    self.held.rows.iter().copied().filter(|&held| held != row).collect();
                self.loose.push(Loose { row, gap: 0.0, rate: 0.0, released: true });
                self.settle(point, &still);
            }
        }
    }

    /// What touches beside a row that has just closed, with rates. A gap of no more
    /// than round-off that closes too is one of them: two rows that each open the other
    /// would otherwise strike in turn without end.
    fn touching(&self, point: &Point, hit: usize) -> Vec<(usize, f64)> {
        let parameters = &self.parameters;
        let size =
            parameters.clearance() + point.z.norm() + parameters.arm().abs() * point.a.norm();
        let limit = AT_A_CORNER * parameters.tolerance * size;
        let rate_if_near = |row: usize| {
            if row == hit {
                return None;
            }
            if self.held.rows.contains(&row) {
                return Some((row, 0.0));
            }
            if let Some(gap) = self.loose.iter().find(|gap| gap.row == row) {
                return (gap.gap <= limit && gap.rate <= 0.0).then_some((row, gap.rate));
            }
            let near = parameters.gap(row, point) <= limit;
            near.then(|| (row, parameters.along(row, point.dz, point.da)))
        };
        (0..parameters.rows.len()).filter_map(rate_if_near).collect()
    }

    /// Books the stretch and moves its start by `s`; returns where the motion is. None
    /// where it has grown beyond the model: it stays in the stretch that it grew in, so
    /// that all that is said of it is of one instant.
    fn rebase(&mut self, s: f64) -> Option<Point> {
        let point = self.stretch.point(&self.parameters, s);
        self.check_growth(s, &point);
        if self.failure.is_some() {
            return None;
        }
        let parameters = &self.parameters;
        if self.checked {
            self.ledger.book(parameters, &self.held, &self.stretch, s);
        }
        self.widest = self.widest_until(s);
        let [travel, reach] = self.stretch.travel(parameters);
        if reach + travel >= parameters.clearance() {
            let known = |row: usize| self.loose.iter().any(|gap| gap.row == row);
            let gaps = (0..parameters.rows.len()).filter(|&row| !known(row));
            let least = gaps.map(|row| parameters.gap(row, &point)).fold(0.0, f64::min);
            self.deepest = self.deepest.max(-least);
        }
        let limit = JUST_OPENED * parameters.clearance();
        let later = self.loose.iter().map(|gap| gap.later(parameters, &self.stretch, s));
        self.loose = later.filter(|gap| gap.gap < limit).collect();
        self.phase = (self.phase + parameters.nu * s) % TAU;
        if self.pulses() && s >= self.elapsed(self.pulse.end) {
            self.clock.begin_at(self.pulse.end);
        } else {
            self.clock.pass(s);
        }
        self.swings.see(self.clock.start(), point.a.norm());
        Some(point)
    }

    /// The largest angle of any blade until `s` seconds into the stretch \[rad\].
    pub(super) fn widest_until(&self, s: f64) -> f64 {
        if self.parameters.blades.is_none() {
            return 0.0;
        }
        // Free blades swing on for long: their largest swing comes within a period.
        let s = s.min(TAU / self.parameters.machine.omega_bd);
        let parts = if self.stretch.free { 64 } else { 4 };
        (0..=parts).fold(self.widest, |widest, part| {
            let point =
                self.stretch.point(&self.parameters, s * f64::from(part) / f64::from(parts));
            if point.a.norm() <= widest {
                widest
            } else {
                widest.max(self.parameters.largest_angle(point.a))
            }
        })
    }

    /// Whether, from `s` seconds into the stretch on, the same rows are held for ever.
    pub(super) fn held_for_good(&self, s: f64) -> bool {
        if self.pulses() || self.held.rows.len() < 2 || !self.loose.is_empty() {
            return false;
        }
        let rest = self.rest.get_or_init(|| super::Rest::of(&self.parameters, &self.held));
        let point = self.stretch.point(&self.parameters, s);
        rest.as_ref().is_some_and(|rest| rest.for_good(&self.parameters, &point))
    }

    /// Changes rotor, pulse or rate at the present instant; the casing keeps its place,
    /// and its rate in the standing frame but for `change`.
    pub(super) fn intervene(&mut self, change: impl FnOnce(&mut Self, &mut Point)) {
        if self.failure.is_some() {
            return;
        }
        let s = self.elapsed(self.clock.now);
        let Some(mut point) = self.rebase(s) else { return };
        self.clock.begin_at(self.clock.now);
        let (before, energy) = (self.parameters.nu, self.parameters.energy(&point));
        let rate = point.dz;
        change(self, &mut point);
        let jump = before - self.parameters.nu;
        point.dz += Plane::i() * point.z * jump;
        self.ledger.start += self.parameters.energy(&point) - energy;
        self.loosen(point.dz - rate, Plane::default());
        if jump == 0.0 {
            let rows = std::mem::take(&mut self.held).rows;
            self.settle(&mut point, &rows);
            return;
        }
        // A sudden change of speed acts on what touches as an impact does.
        self.rest = std::sync::OnceLock::new();
        let parameters = &self.parameters;
        let met: Vec<(usize, f64)> = std::mem::take(&mut self.held)
            .rows
            .into_iter()
            .map(|row| (row, parameters.along(row, point.dz, point.da)))
            .collect();
        self.meet(&mut point, &met);
    }
}
