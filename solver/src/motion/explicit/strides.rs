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
use super::oscillator::Coordinate;
use super::row::Row;
use super::stride_map::{HELD, HeldTip, SHORTEST, State, StrideMap};
use crate::model::LARGEST_BLADE_ANGLE;
use crate::motion::{ActiveSet, Plane};

/// Steps with the same tips in contact before a stride is tried: longer than a pause within one
/// contact.
const SAME_STEPS: u64 = 4;
/// Steps in the same corner before the map of a corner with moving blades is computed.
const SAME_STEPS_OF_CORNER: u64 = 64;
/// Largest rotation `n_d alpha` of held tips since their map was computed; the map neglects its square
/// \[rad\].
const SMALL_TURN: f64 = 3e-6;
/// Largest rotation of tips at which such a map is computed \[rad\].
const LARGEST_TURN: f64 = 1e-3;
/// Steps that cost about as much as a map.
const STEPS_OF_MAP: u64 = 512;
/// Number of cached maps.
const MOST_MAPS: usize = 64;

/// Change of a free coordinate over some steps, `[x, increment]` by `[x, increment]`.
type Change = [f64; 4];

/// Maps of strides, and when to try the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct Strides {
    maps: Vec<(Vec<HeldTip>, Arc<StrideMap>)>,
    /// Map of the corner held by moving blades, and the row whose direction is its real axis.
    corner: Option<(usize, Arc<StrideMap>)>,
    /// Sides in contact at the last step, and the number of steps that they have been.
    sides: ActiveSet,
    same: u64,
    /// Step before which no stride is tried.
    next: u64,
    /// Changes of the casing, and of the blade modes, over `2^j` free steps.
    free: Vec<(Change, Vec<Change>)>,
}

impl Strides {
    /// Discards maps of another machine or speed.
    pub fn forget(&mut self) {
        *self = Self { sides: self.sides, next: self.next, ..Self::default() };
    }
}

/// A stride that may be taken, wholly or in part.
pub(super) struct Stride {
    pub steps: u64,
    map: Arc<StrideMap>,
    /// Direction that is the real axis of the state.
    first: Plane,
    state: State,
    /// Rows that push.
    held: Vec<Row>,
}

impl Explicit {
    /// Finds a stride from the latest step.
    pub(super) fn find_stride(&mut self) -> Option<Stride> {
        let touches = self.record.last_touch == self.n;
        let sides = if touches { self.record.log.active_set } else { ActiveSet::Nothing };
        if sides == self.strides.sides {
            self.strides.same += 1;
        } else {
            (self.strides.sides, self.strides.same, self.strides.corner) = (sides, 0, None);
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
        let stride = stride.and_then(|stride| self.shortened(stride));
        if stride.is_none() {
            // Steps leave the map of small deviations: the next try makes another.
            let is_left = self.strides.corner.take().is_some();
            self.strides.next = self.n + if is_left { STEPS_OF_MAP } else { 1 << SHORTEST };
        }
        stride
    }

    /// Takes so many steps of a stride, at least one.
    pub(super) fn take_stride(&mut self, stride: &Stride, steps: u64) {
        if stride.held.is_empty() {
            self.fly(steps);
        } else {
            self.hold(stride, steps);
        }
        self.skipped += steps;
        self.disk.watch();
    }

    /// Takes so many steps of a stride, at least one, and has the pushes of the last of them. What the
    /// map leaves of the gaps would be a false push in a step from here.
    pub(super) fn see_stride(&mut self, stride: &Stride, steps: u64) {
        self.take_stride(stride, steps);
        let pushing = self.rows.iter_mut().filter(|row| row.lambda != 0.0);
        for (row, push) in pushing.zip(stride.map.last_pushes(&stride.state, steps)) {
            // A multiplier is the negative push.
            row.lambda = -push;
        }
    }

    /// Shortens a stride so that no maximum of a blade angle lies inside it, and so that held tips
    /// rotate little.
    fn shortened(&mut self, mut stride: Stride) -> Option<Stride> {
        if !self.disk.is_pair() {
            return (self.disk.reach() <= self.disk.largest()).then_some(stride);
        }
        while stride.steps >= 1 << SHORTEST {
            let after = self.pair_after(&stride)?;
            let holds = !stride.held.is_empty();
            let turns = holds && self.turned_since(&stride.map, after) > SMALL_TURN;
            if !turns && !self.disk.may_pass_largest(after) {
                return Some(stride);
            }
            stride.steps /= 2;
        }
        None
    }

    /// Returns the modes of a pair after a stride.
    fn pair_after(&mut self, stride: &Stride) -> Option<[Coordinate; 2]> {
        if !stride.held.is_empty() {
            return Some(modes_of(&stride.map.take(&stride.state, stride.steps).0));
        }
        let mut modes = self.disk.coordinates_of_pair();
        let (_, changes) = self.free(stride.steps.trailing_zeros() as usize)?;
        modes.iter_mut().zip(changes).for_each(|(at, change)| *at = at.changed(change));
        Some(modes)
    }

    fn find_flight(&mut self) -> Option<Stride> {
        let (reach, farthest) = (self.disk.reach(), self.casing.reach(&self.u));
        // No cause of a failure may lie within the stride.
        let fails = reach > LARGEST_BLADE_ANGLE || farthest > self.scene.casing.radius_m;
        if fails || self.dips != [0.0; 2] || !self.disk.is_tuned() {
            return None;
        }
        let first = Plane::new(1.0, 0.0);
        let mut state = self.casing_and_pair(first);
        // The modes have changes of their own.
        state.fixed_rows_mut::<4>(4).fill(0.0);
        let map = self.map_of(&[], state, first)?;
        let (tips, law) = (&self.tips_of_rows, &self.tips);
        let margin = law.rise.abs() * reach + tips.out_of_round;
        let exponent = map.longest(&state, false, law.diameters * reach, |place| {
            tips.least_gap(place, law, ActiveSet::Nothing) - margin
        })?;
        // No extreme of a blade angle or of a tip swing may lie inside the stride.
        let steps = (1 << exponent).min(self.steps_of_small_turn());
        Some(Stride { steps, map, first, state, held: Vec::new() })
    }

    /// Finds a stride with the tips held that push now.
    fn find_hold(&mut self, sides: ActiveSet) -> Option<Stride> {
        let held: Vec<Row> = self.rows.iter().copied().filter(|row| row.lambda != 0.0).collect();
        let (moves, turned) =
            (self.disk.coordinates() > 0, self.tips.diameters * self.disk.reach());
        let linear = !self.scene.goes_beyond()
            && self.machine.polygon.has_corners()
            && held.len() <= HELD
            && self.rows.len() == held.len();
        let rests = !moves
            || (held.len() == HELD
                && self.strides.same >= SAME_STEPS_OF_CORNER
                && self.disk.is_pair()
                && turned < LARGEST_TURN);
        if !linear || !rests {
            return None;
        }
        let axis = held.first()?.index;
        let first = self.tips_of_rows.rows[axis].normal;
        let state = self.casing_and_pair(first);
        let near = |(row, map): &(usize, Arc<StrideMap>)| {
            *row == axis && 2.0 * self.turned_since(map, modes_of(&state)) < SMALL_TURN
        };
        let map = match (moves, self.strides.corner.clone().filter(near)) {
            (true, Some((_, map))) => map,
            (true, None) => {
                let map = self.map_of_corner(&held, state, first)?;
                self.strides.corner = Some((axis, map.clone()));
                map
            }
            (false, _) => self.map_of(&held, state, first)?,
        };
        let exponent = map.longest(&state, self.law.pulls(), turned, |place| {
            self.tips_of_rows.least_gap(place * first, &self.tips, sides)
        })?;
        let steps = (1 << exponent).min(self.steps_of_small_turn());
        Some(Stride { steps, map, first, state, held })
    }

    /// Returns a bound on the rotation of the tips by their blades since a map was computed \[rad\].
    fn turned_since(&self, map: &StrideMap, modes: [Coordinate; 2]) -> f64 {
        let [c, s] = modes_of(&map.reference);
        self.tips.diameters * ((modes[0].x - c.x).abs() + (modes[1].x - s.x).abs())
    }

    /// Returns the steps, as a power of two, in which the fastest mode turns by little.
    fn steps_of_small_turn(&self) -> u64 {
        let steps = ANGLE_LOOK / self.disk.fastest_turn();
        if steps < 2e9 { 1 << (steps.max(1.0) as u64).ilog2() } else { u64::MAX }
    }

    fn fly(&mut self, steps: u64) {
        let counts = self.ledger.counts;
        let stored = counts.then(|| (self.casing_energy(), self.disk.energy()));
        self.n += steps;
        for exponent in (0..u64::BITS as usize).filter(|exponent| steps >> exponent & 1 == 1) {
            let Some((casing, modes)) = self.free(exponent).cloned() else { return };
            self.u = self.u.map(|at| at.changed(&casing));
            self.disk.fly(&modes);
        }
        if let Some((casing, blades)) = stored {
            self.ledger.sums.casing_loss_j += casing - self.casing_energy();
            self.ledger.sums.blade_loss_j += blades - self.disk.energy();
        }
        self.leave();
    }

    fn hold(&mut self, stride: &Stride, steps: u64) {
        let (at, sums) = stride.map.take(&stride.state, steps);
        self.n += steps;
        let turn = self.drive.turn(self.n) * stride.first;
        let (z, w) = (Plane::new(at[0], at[1]) * turn, Plane::new(at[2], at[3]) * turn);
        self.u = [(z.re, w.re), (z.im, w.im)].map(|(x, increment)| Coordinate { x, increment });
        self.disk.set_pair(modes_of(&at));
        if let [a, b] = stride.held[..]
            && self.disk.coordinates() > 0
        {
            self.close(a.index, b.index);
        }
        let mut pulls = false;
        for (row, sum) in stride.held.iter().zip(sums) {
            self.record.impulse(row.side, -sum);
            self.record.keep_touching(self.n, row.side);
            pulls |= sum < 0.0;
        }
        if pulls {
            self.record.log.tensile_steps += steps - 1;
        }
        self.record.touch(self.n, self.record.log.active_set, pulls);
        let deepest = stride.map.deepest(&stride.state).max(stride.map.deepest(&at));
        self.record.deepest_predicted = self.record.deepest_predicted.max(deepest);
        self.look_at_swing();
    }

    /// Puts the casing where the gaps of two rows are zero: what a map leaves out, the square of a
    /// small turn, would be a kick for the next step.
    fn close(&mut self, a: usize, b: usize) {
        let turn = self.drive.turn(self.n);
        let [a, b] = [a, b].map(|row| self.row(row, self.place(turn)));
        let (p, q) = (a.normal, b.normal);
        let area = p.re * q.im - p.im * q.re;
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
        let [a, b] = self.disk.coordinates_of_pair();
        State::from([z.re, z.im, w.re, w.im, a.x, b.x, a.increment, b.increment])
    }

    /// Returns the changes of casing and modes over `2^exponent` free steps.
    fn free(&mut self, exponent: usize) -> Option<&(Change, Vec<Change>)> {
        while self.strides.free.len() <= exponent {
            let next = match self.strides.free.last() {
                None => (self.casing.change(), self.disk.changes_of_modes()),
                Some((casing, modes)) => (twice(casing), modes.iter().map(twice).collect()),
            };
            self.strides.free.push(next);
        }
        self.strides.free.get(exponent)
    }

    /// The map with these tips of rigid blades held, or with none, which is known or made. It does
    /// not depend on the state at which it was made.
    fn map_of(&mut self, held: &[Row], state: State, first: Plane) -> Option<Arc<StrideMap>> {
        let tip = |row: &Row| {
            let tip = self.tips_of_rows.rows[row.index];
            HeldTip {
                gap: self.tips.clearance - tip.longer,
                normal: tip.normal * first.conj(),
                ..HeldTip::default()
            }
        };
        let key: Vec<HeldTip> = held.iter().map(tip).collect();
        let alike = |known: &[HeldTip]| {
            known.len() == key.len() && known.iter().zip(&key).all(|(a, b)| a.is_near(b))
        };
        if let Some((_, map)) = self.strides.maps.iter().find(|(known, _)| alike(known)) {
            return Some(map.clone());
        }
        if self.strides.maps.len() >= MOST_MAPS {
            self.strides.maps.clear();
        }
        let z = self.predicted(state);
        let mut tips = key.clone();
        for tip in &mut tips {
            tip.gap += z.re * tip.normal.re + z.im * tip.normal.im;
        }
        let map =
            Arc::new(StrideMap::new(&self.casing, &[], (self.frame_turn(), 0.0), &tips, state)?);
        self.strides.maps.push((key, map.clone()));
        Some(map)
    }

    /// The map of a corner of blades that move, for small deviations from a state.
    fn map_of_corner(&self, held: &[Row], state: State, first: Plane) -> Option<Arc<StrideMap>> {
        let modes = self.disk.modes_of_pair();
        let z = self.predicted(state) * first;
        let ahead: Vec<f64> =
            modes.iter().zip(modes_of(&state)).map(|(mode, at)| mode.step(at, 0.0).x).collect();
        let tip = |row: &Row| {
            let shape = self.disk.shape_of(row.index);
            let angle = shape.iter().zip(&ahead).map(|(shape, x)| shape * x).sum();
            let at = self.tips_of_rows.row(row.index, z, angle, self.lobe_turn, &self.tips);
            let normal = at.normal * first.conj();
            HeldTip { gap: at.gap, normal, arm: at.arm, shape }
        };
        let tips: Vec<HeldTip> = held.iter().map(tip).collect();
        let frame = (self.frame_turn(), self.tips.diameters);
        StrideMap::new(&self.casing, modes, frame, &tips, state).map(Arc::new)
    }

    /// Rotation of the blade frame in a step \[rad\].
    fn frame_turn(&self) -> f64 {
        self.machine.nu(self.drive.speed(self.n)) * self.drive.step
    }

    /// Place of the casing after a free step, in the frame of the blades after it.
    fn predicted(&self, state: State) -> Plane {
        let (z, w) = (Plane::new(state[0], state[1]), Plane::new(state[2], state[3]));
        (z + w * self.casing.ratio - z * self.casing.pull) * Plane::cis(-self.frame_turn())
    }
}

impl HeldTip {
    /// Returns whether two tips are equal within round-off.
    fn is_near(&self, other: &Self) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-13;
        let near_plane = |a: Plane, b: Plane| near(a.re, b.re) && near(a.im, b.im);
        (self.gap - other.gap).abs() <= 1e-14 * self.gap.abs()
            && near_plane(self.normal, other.normal)
    }
}

/// The two modes of a state.
fn modes_of(state: &State) -> [Coordinate; 2] {
    [4, 5].map(|m| Coordinate { x: state[m], increment: state[m + 2] })
}

/// The change over twice as many steps, `(1 + S)^2 - 1`.
fn twice(change: &Change) -> Change {
    let [a, b, c, d] = *change;
    [
        2.0 * a + a * a + b * c,
        2.0 * b + a * b + b * d,
        2.0 * c + c * a + d * c,
        2.0 * d + c * b + d * d,
    ]
}
