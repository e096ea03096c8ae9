//! What did not happen in a run, asked how nearly it did: a side that a flight just
//! misses, an end or a release on the way along a side, and a contact at the instant
//! at which the run ends.

use std::f64::consts::TAU;

use super::Event;
use super::bounds::size;
use super::decisions::{acceleration, least, push_rates, side_of};
use super::free::Bends;
use super::mode::Mode;
use super::parameters::{Drive, Parameters};
use super::rise::farthest;
use super::slide::Along;
use super::variation::{Column, Columns, Local, Variation, floor};
use crate::motion::{Plane, Solver, Verdict};
use crate::tolerances::{
    LOCK_MOMENT, NEAR_MISS_REACH, NEAR_MISS_STEPS, NEAR_SIDES, PERTURBATION, TIE, TIE_BLADES,
    TURNED_TIE, TURNS_SOUGHT,
};

impl Variation {
    /// On the way along a side: no end and no release but nearly.
    pub(super) fn passed(&mut self, event: &Event, s: f64, side: u32, columns: &Columns) {
        let Event { parameters, drive, mode, .. } = event;
        let at = |t: f64| {
            let (_, along) = mode.along(parameters, drive, t)?;
            let inward = drive.inward(parameters, side, t);
            let bend = acceleration(parameters, drive, inward, along.y, along.rate);
            let [fall, _] = push_rates(parameters, drive, inward, along.rate, bend);
            Some((along, fall))
        };
        let half = parameters.half_side;
        let rates = parameters.omega + drive.nu.abs();
        let places = columns.map(|column| size(column.place) + size(column.rate) * s);
        // A pulse may turn the motion more than once: each part has one turn at most.
        let parts = (2.0 * rates * s).ceil().clamp(1.0, TURNS_SOUGHT);
        let Some(mut start) = at(0.0) else { return };
        let mut from = 0.0;
        for part in 1..=parts as u32 {
            let to = s * (f64::from(part) / parts);
            let Some(end) = at(to) else { return };
            let turn = |rate: &dyn Fn(&(Along, f64)) -> f64| {
                let (mut low, mut high) = (from, to);
                for _ in 0..40 {
                    let middle = 0.5 * (low + high);
                    let here = at(middle)?;
                    if rate(&here) * rate(&start) > 0.0 {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                at(high)
            };
            let ((before, fall_before), (after, fall_after)) = (start, end);
            if before.rate * after.rate < 0.0
                && before.y.abs().max(after.y.abs()) > 0.5 * half
                && let Some((there, _)) = turn(&|(along, _)| along.rate)
            {
                self.ties.tell(half - there.y.abs(), places, floor(parameters) * half);
            }
            let small = 0.1 * (before.push.abs() + after.push.abs());
            if fall_before < 0.0
                && fall_after > 0.0
                && before.push + fall_before * (to - from) < small
                && let Some((there, _)) = turn(&|(_, fall)| *fall)
            {
                let pushes = places.map(|y| 4.0 * rates * rates * y);
                self.ties.tell(there.push, pushes, least(parameters));
            }
            (start, from) = (end, to);
        }
    }

    /// In the part of a flight from `s` to `later`: a side that it just misses, or the
    /// circle of the clearance, within which there is none.
    pub(super) fn near_miss(&mut self, event: &Event, s: f64, later: f64) {
        let Event { parameters, drive, mode, .. } = event;
        let Mode::Free(free) = mode else { return };
        let clearance = parameters.clearance;
        let (u, v) = free.at(parameters, drive, s);
        let radius = size(u);
        if radius < clearance
            && drive.pulse == 0.0
            && let Some(swing) = parameters.propagator.swing()
        {
            let farthest = farthest(parameters, swing, u, v);
            if farthest < clearance {
                self.ties.tell(clearance - farthest, [0.0; 2], self.reach);
            }
        }
        // A look from far within ends where the clearance is reached, and may have passed
        // a side that nearly lay in the way: it is sought back from there.
        let (from, way) = if radius < NEAR_SIDES * clearance { (later, -1.0) } else { (s, 1.0) };
        let there = free.at(parameters, drive, from);
        if size(there.0) < NEAR_SIDES * clearance {
            return;
        }
        let (omega, rates) = (parameters.omega, parameters.omega + drive.nu.abs());
        let jounce = rates.powi(4) * (radius + size(v) / omega + drive.pulse.abs() / omega.powi(2));
        let now = Approach::new(parameters, drive, from, there);
        for side in nearest(parameters, now.place) {
            let leaves = |side| free.leaving.iter().flatten().any(|leaving| leaving.side == side);
            if s == 0.0 && leaves(side) {
                continue;
            }
            let normal = parameters.direction(side);
            let within = |time: &f64| (s..later).contains(&(from + 0.5 * time));
            let Some(time) = now.turns(normal, way).filter(within) else {
                continue;
            };
            let unknown = jounce * time.powi(4) / 24.0;
            if clearance + now.ahead(normal, time) > NEAR_MISS_REACH * self.reach + unknown {
                continue;
            }
            let (mut at, mut time, mut least) = (from, time, f64::INFINITY);
            for _ in 0..NEAR_MISS_STEPS {
                at = (at + time).clamp(s, later);
                let there = Approach::new(parameters, drive, at, free.at(parameters, drive, at));
                time = there.to_rest(normal);
                least = clearance + there.ahead(normal, time);
            }
            let back = (normal * Plane::cis(drive.phase(at))).conj();
            let shifts = self.carried(event, at).map(|column| (column.place * back).re);
            self.ties.tell(least, shifts, floor(parameters) * clearance);
        }
    }

    /// Where the run ends.
    pub(super) fn conclude(&mut self, event: &Event) {
        let Event { parameters, drive, mode, .. } = event;
        let s = event.elapsed(event.now);
        let columns = self.carried(event, s);
        let delays = columns.map(|column| column.delay);
        let verdict = event.final_verdict();
        // Rigid sides stand elsewhere by what blades turn them.
        let part = floor(parameters).max(TURNED_TIE * self.turned);
        if self.turned > TIE_BLADES {
            self.ties.give_up();
        }
        match (mode, verdict) {
            (_, Some(Verdict::Locked)) => {
                let period = TAU / parameters.omega;
                let later = delays[0].abs().max(delays[1].abs()) * PERTURBATION * TIE;
                if later > LOCK_MOMENT * period {
                    self.ties.give_up();
                }
            }
            (Mode::Free(free), verdict) => {
                let (u, v) = free.at(parameters, drive, s);
                let square = parameters.omega * parameters.omega;
                let top = square * parameters.clearance * parameters.clearance;
                let energy = v.norm_sqr() + square * u.norm_sqr();
                let drag = -4.0 * parameters.damping * v.norm_sqr();
                let shifts = columns.map(|Column { place, rate, delay }| {
                    2.0 * ((v.conj() * rate).re + square * (u.conj() * place).re) - drag * delay
                });
                self.ties.tell(top - energy, shifts, part * top);
                if verdict.is_none() {
                    let all = seen(parameters, drive, s, (u, v), Plane::new(1.0, 0.0));
                    let fast = delays[0].abs().max(delays[1].abs()) * size(all.rate);
                    let near = self.reach + TIE * PERTURBATION * fast;
                    for side in nearest(parameters, all.place) {
                        let back = parameters.direction(side).conj();
                        let gap = parameters.clearance + (all.place * back).re;
                        self.ties.tell(gap, [0.0; 2], near);
                    }
                }
            }
            (Mode::Slide(_) | Mode::Driven(_), _) => {
                let side = side_of(mode).unwrap_or_default();
                self.passed(event, s, side, &columns);
                let inward = drive.inward(parameters, side, s);
                if let Some((_, along)) = mode.along(parameters, drive, s) {
                    let fixed = columns.map(|column| column.place.im - along.rate * column.delay);
                    let least = part * parameters.half_side;
                    self.ties.tell(parameters.half_side - along.y, fixed.map(|y| -y), least);
                    self.ties.tell(parameters.half_side + along.y, fixed, least);
                    self.push(parameters, drive, inward, (along.y, along.rate), &columns);
                }
            }
            (Mode::Rocking { time, .. }, _) => {
                self.ties.tell(time - s, delays, part / parameters.omega);
            }
            _ => self.ties.give_up(),
        }
    }
}

/// A flight as the rotor sees it, with three derivatives.
struct Approach {
    place: Plane,
    rate: Plane,
    bend: Plane,
    twist: Plane,
}

impl Approach {
    fn new(parameters: &Parameters, drive: &Drive, s: f64, now: (Plane, Plane)) -> Self {
        let Local { place, rate, bend } = seen(parameters, drive, s, now, Plane::new(1.0, 0.0));
        let [_, third] = Bends::new(parameters, drive, now.0, now.1).turned(drive.nu, 0.0, 0.0);
        Self { place, rate, bend, twist: third * Plane::cis(-drive.phase(s)) }
    }

    /// The derivatives of the gap of the side of this normal.
    fn derivatives(&self, normal: Plane) -> [f64; 3] {
        [self.rate, self.bend, self.twist].map(|p| (p * normal.conj()).re)
    }

    /// Time until a gap that falls begins to rise, by its three derivatives, or with
    /// `way` -1 from where one that rises did \[s\].
    fn turns(&self, normal: Plane, way: f64) -> Option<f64> {
        let [rate, bend, twist] = self.derivatives(normal);
        let (rate, twist) = (way * rate, way * twist);
        let root = bend * bend - 2.0 * twist * rate;
        let slope = bend + root.max(0.0).sqrt();
        (rate < 0.0 && root >= 0.0 && slope > 0.0).then(|| -2.0 * way * rate / slope)
    }

    /// Time to or from the instant at which a gap turns, close to it \[s\].
    fn to_rest(&self, normal: Plane) -> f64 {
        let [rate, bend, _] = self.derivatives(normal);
        if bend > 0.0 { -rate / bend } else { 0.0 }
    }

    /// The gap some time on, less the clearance \[m\].
    fn ahead(&self, normal: Plane, time: f64) -> f64 {
        let [rate, bend, twist] = self.derivatives(normal);
        (self.place * normal.conj()).re + time * (rate + time * (0.5 * bend + time * twist / 6.0))
    }
}

/// The nearest side and its neighbours.
fn nearest(parameters: &Parameters, place: Plane) -> [u32; 3] {
    let polygon = &parameters.machine.polygon;
    let side = polygon.nearest_side(place.re, place.im);
    [side, polygon.previous(side), polygon.next(side)]
}

/// A flight as the direction `normal` of the rotor sees it.
pub(super) fn seen(
    parameters: &Parameters,
    drive: &Drive,
    s: f64,
    (u, v): (Plane, Plane),
    normal: Plane,
) -> Local {
    let back = Plane::cis(-drive.phase(s)) * normal.conj();
    let [second, _] = Bends::new(parameters, drive, u, v).turned(drive.nu, 0.0, 0.0);
    Local { place: u * back, rate: (v - Plane::i() * u * drive.nu) * back, bend: second * back }
}
