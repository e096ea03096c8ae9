//! Strides: many steps at once between changes of contact.
//!
//! At constant speed, and as long as the same tips of rigid blades push, a step is an affine map of
//! the casing in the frame of the blades,
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
//! the sides that they hold, so that no map is linear: while they push, steps are taken one by one.

use std::sync::Arc;

use nalgebra::{Matrix2, SMatrix, SVector, Vector2};

use super::Explicit;
use super::oscillator::{Coordinate, Oscillator};
use super::row::Row;
use crate::motion::{ActiveSet, Plane};
use crate::tolerances::{ANGLE_LOOK, BREAK_STEPS};

/// Coordinates of a state: casing `z`, its increment.
const SIZE: usize = 4;
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

/// A tip that pushes, in the frame of the blades.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HeldTip {
    /// Gap where the casing is at rest \[m\].
    pub clearance: f64,
    /// Derivative of the gap by the casing, and the force on the casing per unit push.
    pub normal: Plane,
    pub force: Plane,
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
    /// The map of a step with these tips held, at most two, in a frame that turns by `turn` in a
    /// step \[rad\]. None where the tips depend on each other.
    pub fn new(casing: &Oscillator, turn: f64, tips: &[HeldTip]) -> Option<Self> {
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

        // Gaps of the held tips, Eq. (9), and what their pushes move, Eq. (13).
        let mut gaps = SMatrix::<f64, HELD, SIZE>::zeros();
        let mut moves = SMatrix::<f64, SIZE, HELD>::zeros();
        let mut clearances = Vector2::zeros();
        for (i, tip) in tips.iter().enumerate() {
            clearances[i] = tip.clearance;
            let by_casing = [tip.normal.re, tip.normal.im];
            for (k, force) in [tip.force.re, tip.force.im].into_iter().enumerate() {
                gaps[(i, k)] = by_casing[k];
                moves[(k, i)] = casing.compliance * force;
                moves[(2 + k, i)] = casing.compliance * force;
            }
        }
        let mut contact = gaps * moves;
        (tips.len()..HELD).for_each(|i| contact[(i, i)] = 1.0);
        let inverse = contact.try_inverse()?;

        // Multipliers, Eq. (12), and the whole step.
        let ahead = gaps + gaps * predict;
        let pushes = -(inverse * ahead);
        let constant = -(inverse * clearances);
        let map_change = predict + moves * pushes;
        let map = map_change + Square::identity();
        let mut change = SMatrix::<f64, WHOLE, WHOLE>::zeros();
        change.fixed_view_mut::<SIZE, SIZE>(0, 0).copy_from(&map_change);
        change.fixed_view_mut::<SIZE, 1>(0, SIZE).copy_from(&(moves * constant));
        change.fixed_view_mut::<HELD, SIZE>(SIZE + 1, 0).copy_from(&pushes);
        change.fixed_view_mut::<HELD, 1>(SIZE + 1, SIZE).copy_from(&constant);
        // (1 + S)^2 = 1 + (2 S + S^2) keeps the digits of a small change S.
        let mut changes = vec![change];
        for _ in 0..LONGEST {
            change = change * 2.0 + change * change;
            changes.push(change);
        }

        // In these units the energy of a free coordinate between two steps is the square of the
        // norm: m (dx/h)^2 (1 - k h^2/4m) + k (x - dx/2)^2.
        let mut units = Square::identity();
        for k in 0..2 {
            units[(k, 2 + k)] = -0.5;
            units[(2 + k, 2 + k)] = ((1.0 - 0.25 * casing.pull) / casing.pull).sqrt();
        }
        let back = units.try_inverse()?;
        let scaled = units * map * back;
        let allowed = range(&(scaled * scaled), SIZE - 2 * tips.len())?;
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
        let of_pushes = (0..tips.len()).map(|i| row(&pushes, &constant, i));
        let of_gaps = (0..tips.len()).map(|i| row(&ahead, &clearances, i));
        Some(Self {
            signs: of_pushes.chain(of_gaps).collect(),
            place_bend: (place * bend).norm(),
            held: tips.len(),
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
        from.fixed_rows_mut::<SIZE>(0).copy_from(state);
        from[SIZE] = 1.0;
        let gap = |whole: &Whole| {
            let place = self.place * whole.fixed_rows::<SIZE>(0);
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
                state: to.fixed_rows::<SIZE>(0).into_owned(),
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

/// Steps with the same tips in contact before a stride is tried.
const SAME_STEPS: u64 = 4;
/// Maps that are kept.
const MOST_MAPS: usize = 64;

/// Maps of strides, and when to try the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct Strides {
    maps: Vec<(Vec<HeldTip>, Arc<StrideMap>)>,
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
        self.strides.same = if sides == self.strides.sides { self.strides.same + 1 } else { 0 };
        self.strides.sides = sides;
        let ready = self.strides.same >= SAME_STEPS && self.n >= self.strides.next;
        if !ready || !self.drive.is_steady(self.n) {
            return None;
        }
        let steps = match sides {
            ActiveSet::Nothing => self.fly(target - self.n),
            ActiveSet::Side(_) | ActiveSet::Corner(..) => self.hold(target - self.n),
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
        if !paused || pressed || self.dips != [0.0; 2] || !self.disk.flies() {
            return None;
        }
        // No blade angle, and no swing of a tip, may pass its extreme unseen.
        let turn = self.disk.fastest_turn();
        let unseen = if turn > 0.0 { (ANGLE_LOOK / turn) as u64 } else { u64::MAX };
        let reach = self.disk.reach();
        let margin = self.tips.rise.abs() * reach + self.tips_of_rows.out_of_round;
        let state = self.casing_state(Plane::new(1.0, 0.0));
        let map = self.map_of(&[])?;
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

    /// Takes a stride of rigid blades with the tips held that push now.
    fn hold(&mut self, most: u64) -> Option<u64> {
        let held: Vec<Row> = self.rows.iter().copied().filter(|row| row.lambda != 0.0).collect();
        let linear = self.disk.coordinates() == 0
            && self.restitution == 0.0
            && !self.drive.has_lobes()
            && !self.ledger.counts
            && self.lining.is_none()
            && held.len() <= HELD
            && self.rows.len() == held.len();
        if !linear {
            return None;
        }
        let first = self.direction(held.first()?.index);
        let state = self.casing_state(first);
        let tips: Vec<HeldTip> = held.iter().map(|row| self.held_tip(row, first)).collect();
        let map = self.map_of(&tips)?;
        let (of, law, sides) = (&self.tips_of_rows, &self.tips, self.strides.sides);
        let stride = map.take(&state, most, |place| of.least_gap(place * first, law, sides))?;
        self.place_casing(&stride, first);
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
        self.look_at_swing();
        Some(stride.steps)
    }

    /// The direction of a row, at blades that are not bent.
    fn direction(&self, row: usize) -> Plane {
        Plane::new(self.tips_of_rows.cosine[row], self.tips_of_rows.sine[row])
    }

    /// The casing in the frame of the blades, turned so that `first` is the real axis.
    fn casing_state(&mut self, first: Plane) -> State {
        let [c, s] = self.u;
        let back = (self.drive.turn(self.n) * first).conj();
        let (z, w) = (Plane::new(c.x, s.x) * back, Plane::new(c.increment, s.increment) * back);
        let mut state = State::zeros();
        state.copy_from_slice(&[z.re, z.im, w.re, w.im]);
        state
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

    /// The linear functions of a tip that is held, with `first` as the real axis.
    fn held_tip(&self, row: &Row, first: Plane) -> HeldTip {
        let normal = self.direction(row.index);
        HeldTip {
            clearance: self.tips.clearance - self.tips_of_rows.longer[row.index],
            normal: normal * first.conj(),
            force: self.tips.push_on_casing(normal) * first.conj(),
        }
    }

    /// The map with these tips held, which is known or made.
    fn map_of(&mut self, tips: &[HeldTip]) -> Option<Arc<StrideMap>> {
        let alike = |known: &[HeldTip]| {
            known.len() == tips.len() && known.iter().zip(tips).all(|(a, b)| a.is_near(b))
        };
        if let Some((_, map)) = self.strides.maps.iter().find(|(known, _)| alike(known)) {
            return Some(map.clone());
        }
        if self.strides.maps.len() >= MOST_MAPS {
            self.strides.maps.clear();
        }
        let turn = self.machine.nu(self.drive.speed(self.n)) * self.drive.step;
        let map = Arc::new(StrideMap::new(&self.casing, turn, tips)?);
        self.strides.maps.push((tips.to_vec(), map.clone()));
        Some(map)
    }
}

impl HeldTip {
    /// Whether two tips are one but for round-off.
    fn is_near(&self, other: &Self) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-13;
        let near_plane = |a: Plane, b: Plane| near(a.re, b.re) && near(a.im, b.im);
        (self.clearance - other.clearance).abs() <= 1e-14 * self.clearance.abs()
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
            at.copy_from_slice(&[z.re, z.im, w.re, w.im]);
            pushes
        }

        fn map(&self, held: &[usize]) -> StrideMap {
            let tips: Vec<HeldTip> = held
                .iter()
                .map(|&side| HeldTip {
                    clearance: CLEARANCE,
                    normal: self.normals[side],
                    force: self.normals[side],
                })
                .collect();
            StrideMap::new(&self.casing, self.turn.arg(), &tips).unwrap()
        }
    }

    #[test]
    fn strides_pass_no_change_of_contact_and_give_the_state_of_the_steps() {
        for (damping, rate) in [(0.01, 0.65), (0.0, 0.65), (0.05, 0.3), (0.01, 1.29)] {
            let plain = Plain::new(damping);
            let start = [0.0, 0.0, 1e-7 * rate, 0.3e-7 * rate];
            let (mut at, mut by_steps) = (State::from(start), State::from(start));
            let (mut n, mut taken, mut held, mut same) = (0_u64, 0, Vec::new(), 0);
            let mut sums = [0.0; SIDES];
            let mut expected = [0.0; SIDES];
            while n < 1_000_000 {
                if same > 1
                    && let Some(stride) = plain.map(&held).take(&at, 1_000_000 - n, |z| {
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
