//! Strides: many steps at once between changes of contact.
//!
//! At constant speed, and as long as the same tips push, a step is an affine map of the casing and of
//! two blade modes in the frame of the blades,
//!
//! ```text
//! x[n+1] = T x[n] + b,    T = (1 - K W^-1 G) P,    p[n] = -W^-1 (G P x[n] + g)
//! ```
//!
//! with the prediction `P`, the gaps `G` of the held tips, the contact matrix `W` and what pushes
//! `p` move, `K` (as in `step`). Its powers of two take `2^j` steps at the cost of one product. Free
//! flight is the empty set of tips.
//!
//! A stride of `L` steps must not pass a change of contact. What decides on one is linear in the
//! state: the predicted gap of every other tip, the predicted gap and the push of every held one.
//! Let `f` be such a function. Its second difference is `f (T - 1) d[n]` with the change
//! `d[n] = x[n+1] - x[n] = T^n d[0]`, so it is at most `B = |f (T - 1)| |T|^L |d[0]|` over the stride.
//! A sequence whose second difference is at most `B` lies no more than `B L^2/8` off the straight
//! line between its ends. So `f` keeps its sign if `|f|` is larger than that at both ends, where it
//! has the same sign. `|T|` is the norm on the states that held tips allow (the range of `T^2`), in
//! units in which free flight without damping keeps the norm.
//!
//! In flight the blade modes swing by themselves, each with powers of its own. Blades that move turn
//! the tips that they hold, `dn = i n_d n dalpha`. In a corner, where the casing rests, the map is that
//! of small deviations from the state at which it was made: with `t = i n` and the pushes `p`,
//!
//! ```text
//! W dp = -dg - c n_d sum_j p_j [(t_i n_j) dalpha_i + (n_i t_j) dalpha_j],  c the compliance of the casing,
//! d(force) = n_j dp_j + p_j n_d t_j dalpha_j,    d(arm) = n_d (n_j x dz) - n_d^2 (n_j z) dalpha_j,
//! ```
//!
//! and leaves out the square of `n_d dalpha`. Elsewhere blades that move are held step by step.

use std::sync::Arc;

use nalgebra::{Matrix2, SMatrix, SVector, Vector2};

use super::Explicit;
use super::oscillator::{Coordinate, Oscillator};
use super::row::Row;
use crate::motion::{ActiveSet, Plane};
use crate::tolerances::{ANGLE_LOOK, BREAK_STEPS, LARGEST_BLADE_ANGLE};

/// Coordinates of a state: casing `z`, its increment, two modes, their increments.
const SIZE: usize = 8;
/// Most tips that are held: a corner.
const HELD: usize = 2;
/// A state, the constant 1, and the sums of the pushes.
const WHOLE: usize = SIZE + 1 + HELD;
/// Strides of up to `2^LONGEST` steps.
const LONGEST: usize = 20;
/// A stride of fewer than `2^3` steps costs more than the steps.
const SHORTEST: usize = 3;

pub(super) type State = SVector<f64, SIZE>;
type Square = SMatrix<f64, SIZE, SIZE>;
type Whole = SVector<f64, WHOLE>;

/// A tip that pushes, in the frame of the blades, at the prediction from the reference.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HeldTip {
    /// \[m\]
    pub gap: f64,
    /// Derivative of the gap by the casing, and the force on the casing per unit push.
    pub normal: Plane,
    pub force: Plane,
    /// Derivative of the gap by the blade angle \[m\], and the shapes of the two modes.
    pub arm: f64,
    pub shape: [f64; 2],
}

/// A function of the state that must keep its sign over a stride.
#[derive(Clone, Copy, Debug)]
struct Sign {
    /// Its value is the product with the whole state.
    by: Whole,
    /// Its second difference per unit norm of the change, at most.
    bend: f64,
}

/// The affine map of a step for one set of held tips, and its powers.
#[derive(Clone, Debug)]
pub(super) struct StrideMap {
    /// State from which deviations are counted.
    reference: State,
    /// `A^(2^j) - 1`, with `A` the map of the whole state.
    changes: Vec<SMatrix<f64, WHOLE, WHOLE>>,
    /// `|E x|` is the norm of a state.
    units: Square,
    /// `L^2 |T|^L / 8` of each power: what a stride may bend a function off its line.
    limits: Vec<f64>,
    /// Predicted place of the casing; `bend` as in `Sign`.
    place: SMatrix<f64, 2, SIZE>,
    place_bend: f64,
    /// Pushes and predicted gaps of the held tips.
    signs: Vec<Sign>,
    held: usize,
}

/// A stride that was taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stride {
    pub steps: u64,
    pub state: State,
    /// Pushes of the step that follows, and the sums of all pushes of the stride \[N\].
    pub pushes: [f64; HELD],
    pub sums: [f64; HELD],
}

impl StrideMap {
    /// The map of a step from states near `reference` with these tips held, at most two, in a frame
    /// that turns by `turn` in a step \[rad\], for waves of `diameters` nodal diameters. None where
    /// the tips depend on each other.
    pub fn new(
        casing: &Oscillator,
        modes: &[Oscillator],
        (turn, diameters): (f64, f64),
        tips: &[HeldTip],
        reference: State,
    ) -> Option<Self> {
        // Prediction, Eq. (10), seen from the frame as it is after the step, as its change: against
        // the 1 of P = 1 + S a short step would lose its digits.
        let (sin, cos) = turn.sin_cos();
        let back = Matrix2::new(cos, sin, -sin, cos);
        let versine = 2.0 * (0.5 * turn).sin().powi(2);
        let turned = Matrix2::new(-versine, sin, -sin, -versine);
        let mut predict = Square::zeros();
        let mut put = |row, column, part: Matrix2<f64>| {
            predict.fixed_view_mut::<2, 2>(row, column).copy_from(&part);
        };
        put(0, 0, turned - back * casing.pull);
        put(0, 2, back * casing.ratio);
        put(2, 0, back * -casing.pull);
        put(2, 2, turned * casing.ratio - Matrix2::identity() * casing.loss);
        for (m, mode) in modes.iter().enumerate() {
            let [x_x, x_increment, increment_x, increment] = mode.change();
            (predict[(4 + m, 4 + m)], predict[(4 + m, 6 + m)]) = (x_x, x_increment);
            (predict[(6 + m, 4 + m)], predict[(6 + m, 6 + m)]) = (increment_x, increment);
        }
        for m in modes.len()..2 {
            (predict[(4 + m, 4 + m)], predict[(6 + m, 6 + m)]) = (-1.0, -1.0);
        }

        // Gaps of the held tips, Eq. (9), and what their pushes move, Eq. (13).
        let mut gaps = SMatrix::<f64, HELD, SIZE>::zeros();
        let mut moves = SMatrix::<f64, SIZE, HELD>::zeros();
        let mut depths = Vector2::zeros();
        for (i, tip) in tips.iter().enumerate() {
            depths[i] = -tip.gap;
            (gaps[(i, 0)], gaps[(i, 1)]) = (tip.normal.re, tip.normal.im);
            for (k, force) in [tip.force.re, tip.force.im].into_iter().enumerate() {
                moves[(k, i)] = casing.compliance * force;
                moves[(2 + k, i)] = casing.compliance * force;
            }
            for (m, mode) in modes.iter().enumerate() {
                gaps[(i, 4 + m)] = tip.arm * tip.shape[m];
                moves[(4 + m, i)] = mode.compliance * tip.shape[m] * tip.arm;
                moves[(6 + m, i)] = moves[(4 + m, i)];
            }
        }
        let mut contact = gaps * moves;
        (tips.len()..HELD).for_each(|i| contact[(i, i)] = 1.0);
        let inverse = contact.try_inverse()?;
        let at_reference = inverse * depths;

        // How pushes and what they move change as blades turn the tips that they hold.
        let ahead = reference + predict * reference;
        let z = Plane::new(ahead[0], ahead[1]);
        let dot = |a: Plane, b: Plane| a.re * b.re + a.im * b.im;
        let mut apart = gaps;
        let mut turning = Square::zeros();
        for (j, tip) in tips.iter().enumerate() {
            let (push, across) = (at_reference[j], tip.normal * Plane::i());
            let moved = diameters * casing.compliance * push;
            for (m, mode) in modes.iter().enumerate() {
                for (i, other) in tips.iter().enumerate() {
                    let by_own = dot(other.normal * Plane::i(), tip.normal) * other.shape[m];
                    let by_other = dot(other.normal, across) * tip.shape[m];
                    apart[(i, 4 + m)] += moved * (by_own + by_other);
                }
                for k in [0, 2] {
                    turning[(k, 4 + m)] += moved * tip.shape[m] * across.re;
                    turning[(k + 1, 4 + m)] += moved * tip.shape[m] * across.im;
                }
                let felt = mode.compliance * tip.shape[m] * push * diameters;
                for row in [4 + m, 6 + m] {
                    turning[(row, 0)] -= felt * tip.normal.im;
                    turning[(row, 1)] += felt * tip.normal.re;
                    for other in 0..modes.len() {
                        let turned = diameters * dot(tip.normal, z) * tip.shape[other];
                        turning[(row, 4 + other)] -= felt * turned;
                    }
                }
            }
        }

        // Multipliers, Eq. (12), and the whole step, as deviations from the reference.
        let pushes = -(inverse * (apart + apart * predict));
        let map_change = predict + turning + turning * predict + moves * pushes;
        let map = map_change + Square::identity();
        let shift = predict * reference + moves * at_reference;
        let mut change = SMatrix::<f64, WHOLE, WHOLE>::zeros();
        change.fixed_view_mut::<SIZE, SIZE>(0, 0).copy_from(&map_change);
        change.fixed_view_mut::<SIZE, 1>(0, SIZE).copy_from(&shift);
        change.fixed_view_mut::<HELD, SIZE>(SIZE + 1, 0).copy_from(&pushes);
        change.fixed_view_mut::<HELD, 1>(SIZE + 1, SIZE).copy_from(&at_reference);
        // (1 + S)^2 = 1 + (2 S + S^2) keeps the digits of a small change S.
        let mut changes = vec![change];
        for _ in 0..LONGEST {
            change = change * 2.0 + change * change;
            changes.push(change);
        }

        // In these units the energy of a free coordinate between two steps is the square of the
        // norm: m (dx/h)^2 (1 - k h^2/4m) + k (x - dx/2)^2.
        let mut units = Square::identity();
        let mut measure = |x: usize, increment: usize, pull: f64, unit: f64| {
            units[(x, x)] = unit;
            units[(x, increment)] = -0.5 * unit;
            units[(increment, increment)] = ((1.0 - 0.25 * pull) / pull).sqrt() * unit;
        };
        (0..2).for_each(|k| measure(k, 2 + k, casing.pull, 1.0));
        for (m, mode) in modes.iter().enumerate() {
            measure(4 + m, 6 + m, mode.pull, diameters.max(1.0));
        }
        let back = units.try_inverse()?;
        let scaled = units * map * back;
        let allowed = range(&(scaled * scaled), 4 + 2 * modes.len() - 2 * tips.len())?;
        let within = scaled * allowed;
        let growth = (allowed.transpose() * within).singular_values().max().max(1.0);
        let bend = back * (within - allowed);
        let limit = |exponent: usize| {
            let steps = (1_u64 << exponent) as f64;
            0.125 * steps * steps * growth.powf(steps)
        };

        let place = (predict + Square::identity()).fixed_rows::<2>(0).into_owned();
        let row = |by: &SMatrix<f64, HELD, SIZE>, constant: &Vector2<f64>, row: usize| {
            let mut whole = Whole::zeros();
            whole.fixed_rows_mut::<SIZE>(0).copy_from(&by.row(row).transpose());
            whole[SIZE] = constant[row];
            Sign { by: whole, bend: (by.row(row) * bend).norm() }
        };
        let by_gaps = gaps + gaps * predict;
        let of_pushes = (0..tips.len()).map(|i| row(&pushes, &at_reference, i));
        let of_gaps = (0..tips.len()).map(|i| row(&by_gaps, &-depths, i));
        Some(Self {
            signs: of_pushes.chain(of_gaps).collect(),
            place_bend: (place * bend).norm(),
            held: tips.len(),
            reference,
            limits: (0..=LONGEST).map(limit).collect(),
            changes,
            units,
            place,
        })
    }

    /// Takes the longest stride found of at most `most` steps; none where it is not worth it.
    /// `open` is the least gap of all tips that are not held, for a place of the casing \[m\].
    pub fn take(&self, state: &State, most: u64, open: impl Fn(Plane) -> f64) -> Option<Stride> {
        let mut from = Whole::zeros();
        from.fixed_rows_mut::<SIZE>(0).copy_from(&(state - self.reference));
        from[SIZE] = 1.0;
        let gap = |whole: &Whole| {
            let place = self.place * (whole.fixed_rows::<SIZE>(0) + self.reference);
            open(Plane::new(place.x, place.y))
        };
        let change = (self.changes.first()? * from).fixed_rows::<SIZE>(0).into_owned();
        let speed = (self.units * change).norm();
        let first = gap(&from);
        let firsts = self.signs.iter().map(|sign| sign.by.dot(&from));
        let firsts: [f64; 2 * HELD] = fill(firsts);
        let most = (most.checked_ilog2()? as usize).min(LONGEST);
        for exponent in (SHORTEST..=most).rev() {
            let off = speed * self.limits.get(exponent)?;
            let clear = |bend: f64, value: f64| value > bend * off;
            let signs = || self.signs.iter().zip(firsts);
            if !clear(self.place_bend, first) || !signs().all(|(s, f)| clear(s.bend, f.abs())) {
                continue;
            }
            let to = from + self.changes.get(exponent)? * from;
            let kept =
                |(sign, first): (&Sign, f64)| clear(sign.bend, sign.by.dot(&to) * first.signum());
            if !signs().all(kept) || !clear(self.place_bend, gap(&to)) {
                continue;
            }
            return Some(Stride {
                steps: 1 << exponent,
                state: to.fixed_rows::<SIZE>(0) + self.reference,
                pushes: fill(self.signs.iter().take(self.held).map(|sign| sign.by.dot(&to))),
                sums: [to[SIZE + 1], to[SIZE + 2]],
            });
        }
        None
    }
}

/// The values in an array, zeros behind them.
fn fill<const N: usize>(values: impl Iterator<Item = f64>) -> [f64; N] {
    let mut filled = [0.0; N];
    filled.iter_mut().zip(values).for_each(|(place, value)| *place = value);
    filled
}

/// An orthonormal basis of the range of a matrix of this rank, as the first columns of a square.
fn range(matrix: &Square, rank: usize) -> Option<Square> {
    let parts = matrix.svd(true, false);
    let mut basis = parts.u?;
    (rank..SIZE).for_each(|column| basis.column_mut(column).fill(0.0));
    Some(basis)
}

/// Steps with the same tips in contact before a stride is tried, and before the map of a corner of
/// blades that move is made.
const SAME_STEPS: u64 = 4;
const SAME_STEPS_OF_CORNER: u64 = 64;
/// Turn of held tips, `n_d alpha`, whose square is left out \[rad\].
const SMALL_TURN: f64 = 1e-5;
/// Maps that are kept.
const MOST_MAPS: usize = 64;

/// Maps of strides, and when to try the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct Strides {
    maps: Vec<(Vec<HeldTip>, Arc<StrideMap>)>,
    /// Map of the corner that blades that move hold now.
    corner: Option<Arc<StrideMap>>,
    /// Sides in contact at the last step, and the number of steps that they have been.
    sides: ActiveSet,
    same: u64,
    /// Step before which no stride is tried.
    next: u64,
    /// Change of each mode, `[x, increment]` by `[x, increment]`, over `2^j` free steps.
    modes: Vec<Vec<[f64; 4]>>,
}

impl Strides {
    /// Forgets maps of another machine or speed.
    pub fn forget(&mut self) {
        *self = Self { sides: self.sides, same: 0, next: self.next, ..Self::default() };
    }
}

impl Explicit {
    /// Takes many steps at once, up to step `target`, where a stride is known to be safe. Returns
    /// their number.
    pub(super) fn stride(&mut self, target: u64) -> Option<u64> {
        let pushing = self.rows.iter().filter(|row| row.lambda != 0.0);
        let sides = if self.record.last_touch == self.n {
            pushing.fold(ActiveSet::Nothing, |sides, row| sides.with(row.side))
        } else {
            ActiveSet::Nothing
        };
        if sides == self.strides.sides {
            self.strides.same += 1;
        } else {
            (self.strides.sides, self.strides.same, self.strides.corner) = (sides, 0, None);
        }
        let ready = self.strides.same >= SAME_STEPS && self.n >= self.strides.next;
        if !ready || !self.drive.is_steady(self.n) {
            return None;
        }
        let steps = match sides {
            // The last step is taken, so that the pushes are those of a step.
            ActiveSet::Nothing => self.fly(target - self.n - 1),
            ActiveSet::Side(_) | ActiveSet::Corner(..) => self.hold(target - self.n - 1),
            ActiveSet::Many => None,
        };
        if steps.is_none() {
            self.strides.next = self.n + (1 << SHORTEST);
        }
        steps
    }

    /// Takes a stride of free flight.
    fn fly(&mut self, most: u64) -> Option<u64> {
        let paused = self.n > self.record.last_touch + BREAK_STEPS || self.record.last_touch == 0;
        let pressed = self.lining.as_ref().is_some_and(|lining| lining.presses());
        let (reach, farthest) = (self.disk.reach(), self.casing.reach(&self.u));
        // Nothing that makes a run fail may come on the way.
        let fails = reach > LARGEST_BLADE_ANGLE || farthest > self.scene.casing.radius_m;
        if !paused || pressed || fails || self.dips != [0.0; 2] || !self.disk.flies() {
            return None;
        }
        // No blade angle, and no swing of a tip, may pass its extreme unseen.
        let turn = self.disk.fastest_turn();
        let unseen = if turn > 0.0 { (ANGLE_LOOK / turn) as u64 } else { u64::MAX };
        let margin = self.tips.rise.abs() * reach + self.tips_of_rows.out_of_round;
        let state = self.casing_and_pair(Plane::new(1.0, 0.0));
        let map = self.map_of(&[], state, Plane::new(1.0, 0.0))?;
        let (tips, law) = (&self.tips_of_rows, &self.tips);
        let open = |place: Plane| {
            let turned = law.diameters * reach * (place.re.abs() + place.im.abs());
            tips.least_gap(place, law, ActiveSet::Nothing) - margin - turned
        };
        let stride = map.take(&state, most.min(unseen), open)?;
        let stored = if self.ledger.counts {
            Some((self.casing_energy(), self.disk.energy()))
        } else {
            None
        };
        self.place_casing(&stride, Plane::new(1.0, 0.0));
        let exponent = stride.steps.trailing_zeros() as usize;
        while self.strides.modes.len() <= exponent {
            let next = match self.strides.modes.last() {
                None => self.disk.changes_of_modes(),
                Some(last) => last.iter().map(twice).collect(),
            };
            self.strides.modes.push(next);
        }
        self.disk.fly(self.strides.modes.get(exponent)?);
        if let Some((casing, blades)) = stored {
            self.ledger.sums.casing_loss_j += casing - self.casing_energy();
            self.ledger.sums.blade_loss_j += blades - self.disk.energy();
        }
        self.disk.watch();
        self.leave();
        Some(stride.steps)
    }

    /// Takes a stride with the tips held that push now.
    fn hold(&mut self, most: u64) -> Option<u64> {
        let held: Vec<Row> = self.rows.iter().copied().filter(|row| row.lambda != 0.0).collect();
        let moves = self.disk.coordinates() > 0;
        let linear = self.restitution == 0.0
            && !self.drive.has_lobes()
            && !self.scene.goes_beyond()
            && self.machine.polygon.has_corners()
            && self.lining.is_none()
            && held.len() <= HELD
            && self.rows.len() == held.len();
        let still = !moves
            || (held.len() == HELD
                && self.strides.same >= SAME_STEPS_OF_CORNER
                && self.disk.is_pair()
                && self.tips.pushed == 0.0
                && self.tips.diameters * self.disk.reach() < SMALL_TURN);
        if !linear || !still {
            return None;
        }
        let first = self.direction(held.first()?.index);
        let state = self.casing_and_pair(first);
        let map = match (moves, self.strides.corner.clone()) {
            (true, Some(map)) => map,
            (true, None) => self.map_of_corner(&held, state, first)?,
            (false, _) => self.map_of(&held, state, first)?,
        };
        let (of, law, sides) = (&self.tips_of_rows, &self.tips, self.strides.sides);
        let turned = if moves { SMALL_TURN } else { 0.0 };
        let stride = map.take(&state, most, |place| {
            let turned = turned * (place.re.abs() + place.im.abs());
            of.least_gap(place * first, law, sides) - turned
        })?;
        self.place_casing(&stride, first);
        let at = &stride.state;
        self.disk.set_pair([4, 5].map(|m| Coordinate { x: at[m], increment: at[m + 2] }));
        let mut pulls = false;
        for (place, row) in held.iter().enumerate() {
            // A multiplier is the negative push.
            self.record.impulse(row.side, -stride.sums[place]);
            self.record.keep_touching(self.n, row.side);
            if let Some(row) = self.rows.get_mut(place) {
                row.lambda = -stride.pushes[place];
            }
            pulls |= stride.pushes[place] < 0.0;
        }
        if pulls {
            self.record.log.tensile_steps += stride.steps - 1;
        }
        self.record.touch(self.n, self.record.log.active_set, pulls);
        self.disk.watch();
        self.look_at_swing();
        Some(stride.steps)
    }

    /// The direction of a row, at blades that are not bent.
    fn direction(&self, row: usize) -> Plane {
        self.tips_of_rows.rows[row].normal
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

    /// Puts the casing where a stride has taken it.
    fn place_casing(&mut self, stride: &Stride, first: Plane) {
        self.n += stride.steps;
        let turn = self.drive.turn(self.n) * first;
        let at = &stride.state;
        let (z, w) = (Plane::new(at[0], at[1]) * turn, Plane::new(at[2], at[3]) * turn);
        self.u = [(z.re, w.re), (z.im, w.im)].map(|(x, increment)| Coordinate { x, increment });
        self.before = self.u.map(|at| self.casing.increment_before(at));
    }

    fn casing_energy(&self) -> f64 {
        0.5 * self.u.iter().map(|&at| self.casing.twice_energy(at)).sum::<f64>()
    }

    /// The map with these tips of rigid blades held, or with none, which is known or made. It does
    /// not depend on the state at which it was made.
    fn map_of(&mut self, held: &[Row], state: State, first: Plane) -> Option<Arc<StrideMap>> {
        let tip = |row: &Row| {
            let tip = self.tips_of_rows.rows[row.index];
            HeldTip {
                gap: self.tips.clearance - tip.longer,
                normal: tip.normal * first.conj(),
                force: self.tips.push_on_casing(tip.normal) * first.conj(),
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
    fn map_of_corner(
        &mut self,
        held: &[Row],
        state: State,
        first: Plane,
    ) -> Option<Arc<StrideMap>> {
        let modes = self.disk.modes_of_pair();
        let z = self.predicted(state) * first;
        let ahead = |m: usize| {
            let at = Coordinate { x: state[4 + m], increment: state[6 + m] };
            modes.get(m).map_or(0.0, |mode| mode.step(at, 0.0).x)
        };
        let tip = |row: &Row| {
            let shape = self.disk.shape_of(row.index);
            let angle = shape[0] * ahead(0) + shape[1] * ahead(1);
            let at = self.tips_of_rows.row(row.index, z, angle, self.lobe_turn, &self.tips);
            let normal = at.normal * first.conj();
            HeldTip { gap: at.gap, normal, force: normal, arm: at.arm, shape }
        };
        let tips: Vec<HeldTip> = held.iter().map(tip).collect();
        let frame = (self.frame_turn(), self.tips.diameters);
        let map = StrideMap::new(&self.casing, &modes, frame, &tips, state)?;
        self.strides.corner = Some(Arc::new(map));
        self.strides.corner.clone()
    }

    /// Turn of the frame of the blades in a step \[rad\].
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
    /// Whether two tips are one but for round-off.
    fn is_near(&self, other: &Self) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-13;
        let near_plane = |a: Plane, b: Plane| near(a.re, b.re) && near(a.im, b.im);
        (self.gap - other.gap).abs() <= 1e-14 * self.gap.abs()
            && near_plane(self.normal, other.normal)
            && near_plane(self.force, other.force)
    }
}

/// The change of a mode over twice as many steps, `(1 + S)^2 - 1`.
fn twice(change: &[f64; 4]) -> [f64; 4] {
    let [a, b, c, d] = *change;
    [
        2.0 * a + a * a + b * c,
        2.0 * b + a * b + b * d,
        2.0 * c + c * a + d * c,
        2.0 * d + c * b + d * d,
    ]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const SIDES: usize = 22;
    const CLEARANCE: f64 = 1e-4;

    /// Rigid blades, as `/kernel` of the paper: one casing, contact that only pushes on 22 sides.
    struct Plain {
        casing: Oscillator,
        turn: Plane,
        normals: Vec<Plane>,
    }

    impl Plain {
        fn new(damping: f64) -> Self {
            let stiffness = 1.544e6_f64;
            let casing =
                Oscillator::new(2.0, 2.0 * damping * (2.0 * stiffness).sqrt(), stiffness, 1e-7);
            let side = |i| Plane::from_polar(1.0, TAU * i as f64 / SIDES as f64);
            Self {
                casing,
                turn: Plane::from_polar(1.0, 3.0 * 500.0 * 1e-7),
                normals: (0..SIDES).map(side).collect(),
            }
        }

        fn gap(&self, side: usize, z: Plane) -> f64 {
            CLEARANCE + (z * self.normals[side].conj()).re
        }

        /// One step; returns the sides that push, and how much.
        fn step(&self, at: &mut State) -> Vec<(usize, f64)> {
            let (z, w) = (Plane::new(at[0], at[1]), Plane::new(at[2], at[3]));
            let moved = (w * self.casing.ratio - z * self.casing.pull) * self.turn.conj();
            let mut shift = Plane::default();
            let ahead = z * self.turn.conj() + moved;
            let deep: Vec<usize> = (0..SIDES).filter(|&i| self.gap(i, ahead) < 0.0).collect();
            let mut pushes: Vec<(usize, f64)> = Vec::new();
            let depth = |i: usize| -self.gap(i, ahead) / self.casing.compliance;
            if let [a, b] = deep[..] {
                let c = (self.normals[a] * self.normals[b].conj()).re;
                let (p, q) = (depth(a) - c * depth(b), depth(b) - c * depth(a));
                if p > 0.0 && q > 0.0 {
                    pushes = vec![(a, p / (1.0 - c * c)), (b, q / (1.0 - c * c))];
                } else {
                    let one = if p > 0.0 { a } else { b };
                    pushes = vec![(one, depth(one))];
                }
            } else if let [a] = deep[..] {
                pushes = vec![(a, depth(a))];
            }
            for (side, push) in &pushes {
                shift += self.normals[*side] * (push * self.casing.compliance);
            }
            let (z, w) = (ahead + shift, moved + shift);
            at.fixed_rows_mut::<4>(0).copy_from_slice(&[z.re, z.im, w.re, w.im]);
            pushes
        }

        fn map(&self, held: &[usize], at: State) -> StrideMap {
            let (z, w) = (Plane::new(at[0], at[1]), Plane::new(at[2], at[3]));
            let ahead = (z + w * self.casing.ratio - z * self.casing.pull) * self.turn.conj();
            let tips: Vec<HeldTip> = held
                .iter()
                .map(|&side| HeldTip {
                    gap: CLEARANCE + (ahead * self.normals[side].conj()).re,
                    normal: self.normals[side],
                    force: self.normals[side],
                    ..HeldTip::default()
                })
                .collect();
            StrideMap::new(&self.casing, &[], (self.turn.arg(), 0.0), &tips, at).unwrap()
        }
    }

    #[test]
    fn strides_pass_no_change_of_contact_and_give_the_state_of_the_steps() {
        for (damping, rate) in [(0.01, 0.65), (0.0, 0.65), (0.05, 0.3), (0.01, 1.29)] {
            let plain = Plain::new(damping);
            let start = [0.0, 0.0, 1e-7 * rate, 0.3e-7 * rate, 0.0, 0.0, 0.0, 0.0];
            let (mut at, mut by_steps) = (State::from(start), State::from(start));
            let (mut n, mut taken, mut held, mut same) = (0_u64, 0, Vec::new(), 0);
            let mut sums = [0.0; SIDES];
            let mut expected = [0.0; SIDES];
            while n < 1_000_000 {
                if same > 1
                    && let Some(stride) = plain.map(&held, at).take(&at, 1_000_000 - n, |z| {
                        let others = (0..SIDES).filter(|side| !held.contains(side));
                        others.map(|side| plain.gap(side, z)).fold(f64::MAX, f64::min)
                    })
                {
                    at = stride.state;
                    for (side, sum) in held.iter().zip(stride.sums) {
                        sums[*side] += sum;
                    }
                    for _ in 0..stride.steps {
                        let pushes = plain.step(&mut by_steps);
                        let sides: Vec<usize> = pushes.iter().map(|(side, _)| *side).collect();
                        assert_eq!(sides, held, "{damping} {rate} {n}: {}", stride.steps);
                        pushes.iter().for_each(|(side, push)| expected[*side] += push);
                    }
                    n += stride.steps;
                } else {
                    let pushes = plain.step(&mut at);
                    plain.step(&mut by_steps);
                    for (side, push) in &pushes {
                        sums[*side] += push;
                        expected[*side] += push;
                    }
                    let sides: Vec<usize> = pushes.into_iter().map(|(side, _)| side).collect();
                    same = if sides == held { same + 1 } else { 0 };
                    held = sides;
                    n += 1;
                }
                taken += 1;
            }
            let apart = (at - by_steps).fixed_rows::<2>(0).norm();
            println!("{damping} {rate}: {taken} strides and steps, apart {apart:e}");
            assert!(apart < 1e-9 * CLEARANCE, "{damping} {rate}: {apart:e}");
            for (sum, expected) in sums.iter().zip(expected) {
                assert!(
                    (sum - expected).abs() <= 1e-9 * expected.abs().max(1.0),
                    "{sum} {expected}"
                );
            }
            assert!(taken < 50_000, "{damping} {rate}: {taken} strides and steps");
        }
    }
}
