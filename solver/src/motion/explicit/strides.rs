//! Strides: many steps at once between changes of contact, by the maps of `stride_map`.
//!
//! In free flight the casing and the blade modes are uncoupled, each with its own powers; the map
//! bounds how many steps are safe. With rigid blades on a side or in a corner the map is that of the
//! casing; with moving blades in a corner it is that of small deviations. All other motion, such as
//! moving blades on one side, is computed step by step.
//!
//! Observing the motion inside a stride does not change it: the motion continues from the start of
//! the stride.

use std::sync::Arc;

use super::Explicit;
use super::angles::ANGLE_LOOK;
use super::oscillator::{Coordinate, Oscillator};
use super::row::Row;
use super::stride_map::{HELD, SHORTEST, State, StrideMap, Taken, modes_of};
use crate::model::LARGEST_BLADE_ANGLE;
use crate::motion::{ActiveSet, Plane, across};

/// Steps with the same tips in contact before a stride is tried: longer than a pause within one
/// contact.
const SAME_STEPS: u64 = 4;
/// Largest rotation of tips at which the map of a corner with moving blades is computed \[rad\].
const LARGEST_TURN: f64 = 1e-3;
/// Steps that cost about as much as a map: so many lie between two maps of moving blades.
const STEPS_OF_MAP: u64 = 512;
/// Number of cached maps.
const MOST_MAPS: usize = 64;
/// Part of the largest blade angle by which an angle inside a stride may exceed it unseen. Smaller:
/// the search costs more where an angle stays at its largest.
const ANGLE_UNSEEN: f64 = 1e-7;

/// Maps of strides, and when to try the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct Strides {
    /// Shared by copies of the motion.
    maps: Arc<Vec<Arc<StrideMap>>>,
    /// Sides in contact at the last step, and the number of steps that they have been.
    sides: ActiveSet,
    same: u64,
    /// Step before which no stride is tried, and step before which no map of moving blades is
    /// computed.
    next: u64,
    next_map: u64,
}

impl Strides {
    /// Discards maps of another machine or speed.
    pub fn forget(&mut self) {
        *self = Self { sides: self.sides, next: self.next, ..Self::default() };
    }
}

/// A stride that may be taken, wholly or in part.
#[derive(Clone, Debug)]
pub(super) struct Stride {
    pub steps: u64,
    map: Arc<StrideMap>,
    /// Direction that is the real axis of the state.
    first: Plane,
    state: State,
    /// Whether the tips of the latest contact are held; else all gaps are open.
    holds: bool,
    /// Bound on how far an angle of a pair of modes inside the stride lies from the straight line
    /// between its values at the ends \[rad\].
    sag: f64,
}

impl Explicit {
    /// Finds a stride from the latest step.
    pub(super) fn find_stride(&mut self) -> Option<Stride> {
        let touches = self.record.last_touch == self.n;
        let sides = if touches { self.record.log.active_set } else { ActiveSet::Nothing };
        if sides == self.strides.sides {
            self.strides.same += 1;
        } else {
            (self.strides.sides, self.strides.same) = (sides, 0);
        }
        let ready = self.strides.same >= SAME_STEPS && self.n >= self.strides.next;
        if !ready || !self.drive.is_steady(self.n) {
            return None;
        }
        let stride = match sides {
            ActiveSet::Nothing => self.find_flight(),
            ActiveSet::Side(_) | ActiveSet::Corner(..) => self.find_hold(sides),
            ActiveSet::Many => None,
        };
        if stride.is_none() {
            self.strides.next = self.n + (1 << SHORTEST);
        }
        stride
    }

    /// Takes so many steps of a stride, at least one. Who `sees` has the pushes of the last of them:
    /// what the map leaves of the gaps would be a false push in a step from here.
    pub(super) fn take_stride(&mut self, stride: &Stride, steps: u64, sees: bool) {
        let seen = (stride.holds && sees).then(|| stride.map.see(&stride.state, steps));
        let taken = || stride.holds.then(|| stride.map.take(&stride.state, steps));
        let held = seen.map(|(held, _)| held).or_else(taken);
        if stride.sag > 0.0 {
            let end = held.map_or_else(|| self.disk.flown_pair(steps), |(at, _)| modes_of(&at));
            let [low, high] =
                [self.pair_after(stride, 0), end].map(|pair| self.disk.see_pair(pair));
            self.see_between(stride, (0, low), (steps, high));
        }
        match held {
            Some(held) => self.hold(stride, steps, held),
            None => self.fly(steps),
        }
        if let Some((_, pushes)) = seen {
            // A multiplier is the negative push.
            self.rows.iter_mut().zip(pushes).for_each(|(row, push)| row.lambda = -push);
        }
        self.skipped += steps;
        self.disk.watch();
    }

    /// Finds the largest angle of a pair of modes between two steps of a stride, where it is known: an
    /// interval in which it may exceed the largest one so far is halved.
    fn see_between(&mut self, stride: &Stride, low: (u64, f64), high: (u64, f64)) {
        let length = high.0 - low.0;
        let part = length as f64 / stride.steps as f64;
        let most = low.1.max(high.1) + stride.sag * part * part;
        if length < 2 || most <= self.disk.largest * (1.0 + ANGLE_UNSEEN) {
            return;
        }
        let step = low.0 + length / 2;
        let middle = (step, self.disk.see_pair(self.pair_after(stride, step)));
        self.see_between(stride, low, middle);
        self.see_between(stride, middle, high);
    }

    /// Returns the modes of a pair so many steps after the start of a stride that is not taken yet.
    fn pair_after(&self, stride: &Stride, steps: u64) -> [Coordinate; 2] {
        if stride.holds {
            modes_of(&stride.map.take(&stride.state, steps).0)
        } else {
            self.disk.flown_pair(steps)
        }
    }

    fn find_flight(&mut self) -> Option<Stride> {
        let (reach, farthest) = (self.disk.reach(), self.casing.reach(&self.u));
        // No cause of a failure may lie within the stride.
        let fails = reach > LARGEST_BLADE_ANGLE || farthest > self.scene.casing.radius_m;
        // Only the angles of a pair of modes are looked for inside of it.
        let may_pass = reach > self.disk.largest;
        let is_unseen = may_pass && !self.disk.is_pair();
        if fails || is_unseen || self.dips != [0.0; 2] || !self.disk.is_tuned() {
            return None;
        }
        let first = Plane::new(1.0, 0.0);
        let mut state = self.casing_and_pair(first);
        // The modes have changes of their own.
        state.fixed_rows_mut::<4>(4).fill(0.0);
        let map = self.map_of(false, state, first)?;
        let (tips, law) = (&self.tips_of_rows, &self.tips);
        let margin = law.rise.abs() * reach + tips.out_of_round;
        // No extreme of a tip swing may lie inside the stride.
        let steps = (ANGLE_LOOK / self.disk.fastest_turn()).max(1.0);
        let most = if law.rise == 0.0 { u64::MAX } else { 1 << (steps.min(2e9) as u64).ilog2() };
        let (steps, _) = map.longest(&state, false, law.diameters * reach, most, |place| {
            tips.least_gap(place, law, ActiveSet::Nothing) - margin
        })?;
        let length = steps as f64;
        let mode = self.disk.modes_of_pair().first().filter(|_| may_pass);
        let sag = 0.125 * length * length * mode.map_or(0.0, |mode| mode.bend(reach));
        Some(Stride { steps, map, first, state, holds: false, sag })
    }

    /// Finds a stride with the tips held that push now.
    fn find_hold(&mut self, sides: ActiveSet) -> Option<Stride> {
        let moves = self.disk.coordinates() > 0;
        let turned = self.tips.diameters * self.disk.reach();
        let linear = !self.scene.goes_beyond()
            && self.machine.polygon.has_corners()
            && self.rows.len() <= HELD
            && self.rows.iter().all(|row| row.lambda != 0.0);
        let is_corner = self.rows.len() == HELD && self.disk.is_pair() && turned < LARGEST_TURN;
        if !linear || (moves && !is_corner) {
            return None;
        }
        let first = self.tips_of_rows.rows[self.rows.first()?.index].normal;
        let state = self.casing_and_pair(first);
        let map = self.map_of(true, state, first)?;
        let (steps, sag) = map.longest(&state, self.law.pulls(), turned, u64::MAX, |place| {
            self.tips_of_rows.least_gap(place * first, &self.tips, sides)
        })?;
        Some(Stride { steps, map, first, state, holds: true, sag })
    }

    fn fly(&mut self, steps: u64) {
        let counts = self.ledger.counts;
        let stored = counts.then(|| (self.casing_energy(), self.disk.energy()));
        self.n += steps;
        self.u = self.u.map(|at| self.casing.fly(at, steps));
        self.disk.fly(steps);
        if let Some((casing, blades)) = stored {
            self.ledger.sums.casing_loss_j += casing - self.casing_energy();
            self.ledger.sums.blade_loss_j += blades - self.disk.energy();
        }
        self.leave();
    }

    /// Goes so many steps with tips held, to a state with the sums of their pushes.
    fn hold(&mut self, stride: &Stride, steps: u64, (at, sums): Taken) {
        self.n += steps;
        let turn = self.drive.turn(self.n) * stride.first;
        let (z, w) = (Plane::new(at[0], at[1]) * turn, Plane::new(at[2], at[3]) * turn);
        self.u = [(z.re, w.re), (z.im, w.im)].map(|(x, increment)| Coordinate { x, increment });
        self.disk.set_pair(modes_of(&at));
        if let [a, b] = self.rows[..]
            && self.disk.coordinates() > 0
        {
            self.close(a.index, b.index);
        }
        let mut pulls = false;
        for (row, sum) in self.rows.iter().zip(sums) {
            self.record.impulse(row.side, -sum);
            self.record.keep_touching(self.n, row.side);
            pulls |= sum < 0.0;
        }
        if pulls {
            self.record.log.tensile_steps += steps - 1;
        }
        self.record.touch(self.n, self.record.log.active_set, pulls);
        for state in [&stride.state, &at] {
            let deepest = stride.map.deepest(&stride.map.whole(state));
            self.record.deepest_predicted = self.record.deepest_predicted.max(deepest);
        }
        self.look_at_swing();
    }

    /// Puts the casing where the gaps of two rows are zero: what a map leaves out, the square of a
    /// small turn, would be a kick for the next step.
    fn close(&mut self, a: usize, b: usize) {
        let turn = self.drive.turn(self.n);
        let [a, b] = [a, b].map(|row| self.row(row, self.place(turn)));
        let (p, q) = (a.normal, b.normal);
        let area = across(p, q);
        let shift = Plane::new(b.gap * p.im - a.gap * q.im, a.gap * q.re - b.gap * p.re) / area;
        let moved = shift * turn;
        self.u[0].x += moved.re;
        self.u[1].x += moved.im;
    }

    /// The casing in the frame of the blades, turned so that `first` is the real axis, and the modes
    /// of a pair.
    fn casing_and_pair(&mut self, first: Plane) -> State {
        let [c, s] = self.u;
        let back = (self.drive.turn(self.n) * first).conj();
        let (z, w) = (Plane::new(c.x, s.x) * back, Plane::new(c.increment, s.increment) * back);
        let [a, b] = self.disk.flown_pair(0);
        State::from([z.re, z.im, w.re, w.im, a.x, b.x, a.increment, b.increment])
    }

    /// Returns the map with the tips of the latest contact held, or with none, for states near this one:
    /// a known one, or a new one.
    fn map_of(&mut self, holds: bool, state: State, first: Plane) -> Option<Arc<StrideMap>> {
        let held = if holds { &self.rows[..] } else { &[] };
        let tip = |place: usize, at: &State| {
            let Row { index, shape, .. } = held[place];
            let [a, b] = modes_of(at);
            let (z, angle) = (Plane::new(at[0], at[1]) * first, shape[0] * a.x + shape[1] * b.x);
            let row = self.tips_of_rows.row(index, z, angle, self.lobe_turn, &self.tips);
            Row { normal: row.normal * first.conj(), ..row }
        };
        let tips: Vec<Row> = (0..held.len()).map(|place| tip(place, &State::zeros())).collect();
        if let Some(map) = self.strides.maps.iter().find(|map| map.serves(&tips, &state)) {
            return Some(map.clone());
        }
        let modes: &[Oscillator] = if held.is_empty() { &[] } else { self.disk.modes_of_pair() };
        if !modes.is_empty() {
            if self.n < self.strides.next_map {
                return None;
            }
            self.strides.next_map = self.n + STEPS_OF_MAP;
        }
        let turn = self.machine.nu(self.drive.speed(self.n)) * self.drive.step;
        let frame = (turn, self.tips.diameters);
        let map = StrideMap::new(&self.casing, modes, frame, tips, state, tip)?;
        let map = Arc::new(map);
        let known = Arc::make_mut(&mut self.strides.maps);
        if known.len() >= MOST_MAPS {
            known.clear();
        }
        known.push(map.clone());
        Some(map)
    }
}
