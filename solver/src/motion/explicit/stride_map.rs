//! The affine map of the steps between two changes of contact, its powers of two, and how many steps
//! they may take at once.
//!
//! At constant speed, and as long as the same tips push, a step is an affine map of the casing and of
//! two blade modes in the frame of the blades,
//!
//! ```text
//! x[n+1] = T x[n] + b,    T = (1 - K W^-1 G) P,    p[n] = -W^-1 (G P x[n] + g)
//! ```
//!
//! with the prediction `P`, the gaps `G` of the held tips, the contact matrix `W` and what pushes
//! `p` move, `K` (as in `step`). `T^(2^j)` takes `2^j` steps at the cost of one product. Free flight
//! is the empty set of tips.
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
//! Blades that move turn the tips that they hold, `dn = i n_d n dalpha`. In a corner, where the casing
//! rests, the map is that of small deviations from the state at which it was made: with `t = i n`
//! and the pushes `p`,
//!
//! ```text
//! W dp = -dg - c n_d sum_j p_j [(t_i n_j) dalpha_i + (n_i t_j) dalpha_j],  c the compliance of the casing,
//! d(force) = n_j dp_j + p_j n_d t_j dalpha_j,    d(arm) = n_d (n_j x dz) - n_d^2 (n_j z) dalpha_j,
//! ```
//!
//! and leaves out the square of `n_d dalpha`, which a stride keeps below [`SMALL_TURN`].

use std::sync::OnceLock;

use nalgebra::{Matrix2, SMatrix, SVector, Vector2};

use super::oscillator::{Coordinate, Oscillator};
use super::row::Row;
use super::step::NEIGHBOUR_DEPTHS;
use crate::motion::{Plane, dot};

/// Coordinates of a state: casing `z`, its increment, two modes, their increments.
const SIZE: usize = 8;
/// Most tips that are held: a corner.
pub(super) const HELD: usize = 2;
/// A state, the constant 1, and the sums of the pushes.
const WHOLE: usize = SIZE + 1 + HELD;
/// A stride has at most `2^LONGEST` steps, and at least `2^SHORTEST`: fewer cost more than the
/// steps.
const LONGEST: usize = 20;
pub(super) const SHORTEST: usize = 3;
/// Largest rotation `n_d alpha` of held tips since their map was computed; the map neglects its square
/// \[rad\].
const SMALL_TURN: f64 = 3e-6;

pub(super) type State = SVector<f64, SIZE>;
/// A state after some steps, and the sums of the pushes \[N\] until then.
pub(super) type Taken = (State, [f64; HELD]);
type Square = SMatrix<f64, SIZE, SIZE>;
pub(super) type Whole = SVector<f64, WHOLE>;
type Change = SMatrix<f64, WHOLE, WHOLE>;
/// A function of each held tip, linear in the state.
type OfTips = SMatrix<f64, HELD, SIZE>;

/// Returns whether two tips at rest are equal within round-off.
fn are_near(a: &Row, b: &Row) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() < 1e-13;
    (a.gap - b.gap).abs() <= 1e-14 * a.gap.abs()
        && near(a.normal.re, b.normal.re)
        && near(a.normal.im, b.normal.im)
        && a.shape == b.shape
}

/// A function of the state that must keep its sign over a stride.
#[derive(Clone, Copy, Debug)]
struct Sign {
    /// Coefficients: its value is their product with the whole state.
    by: Whole,
    /// Bound on its second difference per unit norm of the change.
    bend: f64,
}

/// The affine map of a step for one set of held tips, and its powers.
#[derive(Debug)]
pub(super) struct StrideMap {
    /// The held tips, the casing and the blades at rest.
    tips: Vec<Row>,
    /// State from which deviations are counted.
    reference: State,
    /// `A^(2^j) - 1`, with `A` the map of the whole state, once asked for.
    changes: [OnceLock<Box<Change>>; LONGEST + 1],
    /// `|E x|` is the norm of a state.
    units: Square,
    /// `L^2 |T|^L / 8` of each power: bound on the deviation of a function from its straight line.
    limits: [f64; LONGEST + 1],
    /// Nodal diameters of the wave, where blades turn the tips that they hold; else 0.
    diameters: f64,
    /// Bound on the second difference of a blade angle, as in `Sign`.
    angle_bend: f64,
    /// Predicted casing position; `bend` as in `Sign`.
    place: SMatrix<f64, 2, SIZE>,
    place_bend: f64,
    pushes: Vec<Sign>,
    /// Predicted penetrations of the held tips.
    depths: Vec<Sign>,
}

impl StrideMap {
    /// The map of a step from states near `reference` with these tips held, at most two, in a frame
    /// that turns by `turn` in a step \[rad\], for waves of `diameters` nodal diameters; `ahead`
    /// gives a tip at a state. None where the tips depend on each other.
    pub fn new(
        casing: &Oscillator,
        modes: &[Oscillator],
        (turn, diameters): (f64, f64),
        at_rest: Vec<Row>,
        reference: State,
        ahead: impl Fn(usize, &State) -> Row,
    ) -> Option<Self> {
        let predict = change_of_prediction(casing, modes, turn);
        let predicted = reference + predict * reference;
        let tips: Vec<Row> = (0..at_rest.len()).map(|tip| ahead(tip, &predicted)).collect();

        // Gaps of the held tips, Eq. (9), and what their pushes move, Eq. (13).
        let mut gaps = OfTips::zeros();
        let mut moves = SMatrix::<f64, SIZE, HELD>::zeros();
        let mut depths = Vector2::zeros();
        for (i, tip) in tips.iter().enumerate() {
            depths[i] = -tip.gap;
            (gaps[(i, 0)], gaps[(i, 1)]) = (tip.normal.re, tip.normal.im);
            for (k, force) in [tip.normal.re, tip.normal.im].into_iter().enumerate() {
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
        let z = Plane::new(predicted[0], predicted[1]);
        let (apart, turning) =
            turn_of_tips(casing, modes, diameters, &tips, [at_reference[0], at_reference[1]], z);

        // Multipliers, Eq. (13a), and the whole step, as deviations from the reference.
        let gaps_apart = gaps + apart;
        let pushes = -(inverse * (gaps_apart + gaps_apart * predict));
        let map_change = predict + turning + turning * predict + moves * pushes;
        let shift = predict * reference + moves * at_reference;
        let mut change = Box::new(Change::zeros());
        change.fixed_view_mut::<SIZE, SIZE>(0, 0).copy_from(&map_change);
        change.fixed_view_mut::<SIZE, 1>(0, SIZE).copy_from(&shift);
        change.fixed_view_mut::<HELD, SIZE>(SIZE + 1, 0).copy_from(&pushes);
        change.fixed_view_mut::<HELD, 1>(SIZE + 1, SIZE).copy_from(&at_reference);
        let changes: [OnceLock<Box<Change>>; LONGEST + 1] = Default::default();
        changes[0].get_or_init(|| change);

        let units = energy_units(casing, modes, diameters);
        let back = units.try_inverse()?;
        let scaled = units * (map_change + Square::identity()) * back;
        // Each held tip fixes its gap and the rate of it.
        let allowed = range(&(scaled * scaled), 4 + 2 * modes.len() - 2 * tips.len())?;
        let within = scaled * allowed;
        let growth = (allowed.transpose() * within).singular_values().max().max(1.0);
        let bend = back * (within - allowed);
        let limit = |exponent: usize| {
            let steps = (1_u64 << exponent) as f64;
            0.125 * steps * steps * growth.powf(steps)
        };

        let place = (predict + Square::identity()).fixed_rows::<2>(0).into_owned();
        let sign = |by: &OfTips, constant: &Vector2<f64>, row: usize| {
            let mut whole = Whole::zeros();
            whole.fixed_rows_mut::<SIZE>(0).copy_from(&by.row(row).transpose());
            whole[SIZE] = constant[row];
            Sign { by: whole, bend: (by.row(row) * bend).norm() }
        };
        let by_depths = -(gaps + gaps * predict);
        Some(Self {
            pushes: (0..tips.len()).map(|i| sign(&pushes, &at_reference, i)).collect(),
            depths: (0..tips.len()).map(|i| sign(&by_depths, &depths, i)).collect(),
            place_bend: (place * bend).norm(),
            angle_bend: if modes.is_empty() { 0.0 } else { bend.fixed_rows::<2>(4).norm() },
            diameters: if modes.is_empty() { 0.0 } else { diameters },
            tips: at_rest,
            reference,
            changes,
            units,
            limits: std::array::from_fn(limit),
            place,
        })
    }

    /// Returns whether it is the map of these tips for states near this one.
    pub fn serves(&self, tips: &[Row], state: &State) -> bool {
        self.tips.len() == tips.len()
            && self.tips.iter().zip(tips).all(|(own, tip)| are_near(own, tip))
            && 2.0 * self.turned(&(state - self.reference)) < SMALL_TURN
    }

    /// Returns a bound on the rotation of held tips by their blades that this deviation means
    /// \[rad\].
    fn turned(&self, deviation: &State) -> f64 {
        self.diameters * (deviation[4].abs() + deviation[5].abs())
    }

    /// Returns the longest safe stride of at most so many steps, with a bound on how far a blade angle
    /// between both ends lies from the straight line between its values there \[rad\]; none where it
    /// is not worth it.
    /// `open` is the least gap of all tips that are not held and not turned, for a place of the
    /// casing \[m\]; `turned` bounds the phase `n_d alpha` that blades turn them \[rad\].
    /// Held tips must penetrate at each prediction, and push, or pull where they may.
    pub fn longest(
        &self,
        state: &State,
        may_pull: bool,
        turned: f64,
        most: u64,
        open: impl Fn(Plane) -> f64,
    ) -> Option<(u64, f64)> {
        let from = self.whole(state);
        let change = (self.change(0) * from).fixed_rows::<SIZE>(0).into_owned();
        let speed = (self.units * change).norm();
        // A push may close another gap by a multiple of its own depth, and the rotation of a tip by
        // its blade reduces the gap.
        let depth_bend = self.depths.iter().fold(0.0, |most, depth| f64::max(most, depth.bend));
        let open_bend = self.place_bend * (1.0 + 2.0 * turned) + NEIGHBOUR_DEPTHS * depth_bend;
        let pushes = self.pushes.iter().map(|push| {
            let pulls = may_pull && push.by.dot(&from) < 0.0;
            (push, if pulls { -1.0 } else { 1.0 })
        });
        let signs = pushes.chain(self.depths.iter().map(|depth| (depth, 1.0)));
        // How far functions may lie off their straight lines, per unit of `bend`, if this is an end.
        let room = |whole: &Whole| {
            let deviation = whole.fixed_rows::<SIZE>(0).into_owned();
            let place = self.place * (deviation + self.reference);
            let nearer = turned * (place.x.abs() + place.y.abs());
            let closed = NEIGHBOUR_DEPTHS * self.deepest(whole);
            let gap = open(Plane::new(place.x, place.y)) - nearer - closed;
            let part = |value: f64, bend: f64| if value > 0.0 { value / bend } else { 0.0 };
            let turn = SMALL_TURN - self.turned(&deviation);
            let rooms =
                signs.clone().map(|(sign, side)| part(side * sign.by.dot(whole), sign.bend));
            rooms
                .chain([part(gap, open_bend), part(turn, 2.0 * self.diameters * self.angle_bend)])
                .fold(f64::INFINITY, f64::min)
        };
        let at_start = room(&from);
        let stride = |exponent: usize| {
            let (steps, off) = (1_u64 << exponent, speed * self.limits[exponent]);
            let may = steps <= most && off < at_start;
            let is_safe = may && off < room(&moved(self.change(exponent), &from));
            is_safe.then_some((steps, self.angle_bend * off))
        };
        (SHORTEST..=LONGEST).rev().find_map(stride)
    }

    /// Takes many steps at once. Returns the state after them, and the sums of the pushes \[N\].
    pub fn take(&self, state: &State, steps: u64) -> Taken {
        self.taken(&self.after(state, steps))
    }

    /// As [`Self::take`], with the pushes of the held tips in the last step \[N\].
    pub fn see(&self, state: &State, steps: u64) -> (Taken, [f64; HELD]) {
        // The pushes follow from a state that is not rounded to the digits of the reference.
        let before = self.after(state, steps - 1);
        let mut pushes = [0.0; HELD];
        pushes.iter_mut().zip(&self.pushes).for_each(|(of, push)| *of = push.by.dot(&before));
        (self.taken(&moved(self.change(0), &before)), pushes)
    }

    fn taken(&self, whole: &Whole) -> Taken {
        (whole.fixed_rows::<SIZE>(0) + self.reference, [whole[SIZE + 1], whole[SIZE + 2]])
    }

    /// Returns the deepest predicted penetration of the held tips in the step from a state \[m\].
    pub fn deepest(&self, whole: &Whole) -> f64 {
        self.depths.iter().fold(0.0, |most, depth| f64::max(most, depth.by.dot(whole)))
    }

    fn after(&self, state: &State, steps: u64) -> Whole {
        let mut whole = self.whole(state);
        for exponent in (0..=LONGEST).filter(|exponent| steps >> exponent & 1 == 1) {
            whole = moved(self.change(exponent), &whole);
        }
        whole
    }

    /// Returns `A^(2^exponent) - 1`.
    fn change(&self, exponent: usize) -> &Change {
        self.changes[exponent].get_or_init(|| {
            // (1 + S)^2 = 1 + (2 S + S^2) keeps the digits of a small change S.
            let half = self.change(exponent - 1);
            Box::new(half * 2.0 + half * half)
        })
    }

    /// The deviation of a state from the reference, and the constant 1.
    pub fn whole(&self, state: &State) -> Whole {
        let mut whole = Whole::zeros();
        whole.fixed_rows_mut::<SIZE>(0).copy_from(&(state - self.reference));
        whole[SIZE] = 1.0;
        whole
    }
}

/// Returns `(1 + change) whole`.
fn moved(change: &Change, whole: &Whole) -> Whole {
    let mut sum = Whole::zeros();
    for (column, x) in change.data.0.iter().zip(whole.iter()) {
        sum.iter_mut().zip(column).for_each(|(sum, part)| *sum += part * x);
    }
    whole + sum
}

/// Returns `P - 1`, Eq. (10), seen from the frame as it is after the step: against the 1 of `P` a
/// short step would lose its digits.
fn change_of_prediction(casing: &Oscillator, modes: &[Oscillator], turn: f64) -> Square {
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
    predict
}

/// How contact changes as blades turn the tips that they hold with these pushes, the casing at
/// `z`: the sum over `p_j` in the formula of `W dp` above, and what the turned pushes change of the
/// state, both by the predicted state.
fn turn_of_tips(
    casing: &Oscillator,
    modes: &[Oscillator],
    diameters: f64,
    tips: &[Row],
    pushes: [f64; HELD],
    z: Plane,
) -> (OfTips, Square) {
    let (mut apart, mut turning) = (OfTips::zeros(), Square::zeros());
    for (tip, push) in tips.iter().zip(pushes) {
        let across = tip.normal * Plane::i();
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
    (apart, turning)
}

/// Units in which the energy of a free coordinate between two steps is the square of the norm:
/// `m (dx/h)^2 (1 - k h^2/4m) + k (x - dx/2)^2`.
fn energy_units(casing: &Oscillator, modes: &[Oscillator], diameters: f64) -> Square {
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
    units
}

/// The two modes of a state.
pub(super) fn modes_of(state: &State) -> [Coordinate; 2] {
    [4, 5].map(|m| Coordinate { x: state[m], increment: state[m + 2] })
}

/// An orthonormal basis of the range of a matrix of this rank, as the first columns of a square.
fn range(matrix: &Square, rank: usize) -> Option<Square> {
    let parts = matrix.svd(true, false);
    let mut basis = parts.u?;
    (rank..SIZE).for_each(|column| basis.column_mut(column).fill(0.0));
    Some(basis)
}
