//! Shapes of the modes at the blades, `cos d Phi_i` and `sin d Phi_i`, four modes side by side.
//!
//! All are fractions of one turn. A table holds those of a small disk; of a larger one a row is
//! worked out when it is asked for. All blades of a large ring at once are a discrete Fourier
//! transform, `N log N` products instead of `N^2`.

use std::borrow::Cow;

use crate::model::fraction_of_turn;
use crate::motion::Plane;

/// Largest table of mode shapes, in groups of four: 2 MiB, those of 512 single blades. For a larger
/// disk each row is computed on demand. Speed only.
const SHAPES_KEPT: usize = 1 << 16;

/// Number of single blades from which a Fourier transform costs less than products of a table, if
/// it is a multiple of eight. Speed only.
const SHAPES_TRANSFORMED: usize = 64;

/// One number of each of four modes.
pub(super) type Four = [f64; 4];

/// A mode of the tuned disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Label {
    pub diameters: u32,
    pub is_sine: bool,
    /// Whether the sine of these diameters vanishes at every blade.
    pub is_alone: bool,
}

/// Shapes of modes at places, each the mean of some blades.
#[derive(Debug)]
pub(super) struct Shapes {
    labels: Vec<Label>,
    /// Fractions of a turn, one a blade of the disk.
    turn: Vec<Plane>,
    /// Blades of a place: `place`, `place + count`, ...
    each: u32,
    count: usize,
    width: usize,
    /// Row after row; empty where there are too many.
    table: Vec<Four>,
    /// Whether angles and forces of all places are worked out by transforms.
    is_transformed: bool,
}

impl Shapes {
    /// Creates the shapes at `count` places of `each` blades. `is_ring`: the places are single blades,
    /// and these are all their modes, in order of their diameters.
    pub fn new(labels: &[Label], blades: u32, each: u32, count: u32, is_ring: bool) -> Self {
        let (count, width) = (count as usize, labels.len().div_ceil(4));
        let has_table = count * width <= SHAPES_KEPT;
        let is_quick = count >= SHAPES_TRANSFORMED && count.is_multiple_of(8);
        let is_transformed = is_ring && (is_quick || !has_table);
        let labels = labels.to_vec();
        let of_blade = |blade| fraction_of_turn(blade, blades);
        let turn = (0..blades).map(of_blade).map(|(cos, sin)| Plane::new(cos, sin)).collect();
        let mut shapes =
            Self { labels, turn, each, count, width, table: Vec::new(), is_transformed };
        if has_table {
            shapes.table = (0..count).flat_map(|place| shapes.compute(place)).collect();
        }
        shapes
    }

    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the number of fours of modes.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the shapes of the first four modes at every place, for few modes.
    pub fn table(&self) -> &[Four] {
        &self.table
    }

    /// Returns the shapes of all modes at a place.
    #[inline]
    pub fn row(&self, place: usize) -> Cow<'_, [Four]> {
        match self.table.get(place * self.width..(place + 1) * self.width) {
            Some(row) => Cow::Borrowed(row),
            None => Cow::Owned(self.compute(place)),
        }
    }

    fn compute(&self, place: usize) -> Vec<Four> {
        let mut row = vec![[0.0; 4]; self.width];
        for (m, label) in self.labels.iter().enumerate() {
            let at = |k: u32| {
                let blade = place as u64 + u64::from(k) * self.count as u64;
                let turned = u64::from(label.diameters) * blade % self.turn.len() as u64;
                let turn = self.turn[turned as usize];
                if label.is_sine { turn.im } else { turn.re }
            };
            row[m / 4][m % 4] = (0..self.each).map(at).sum::<f64>() / f64::from(self.each);
        }
        row
    }

    /// Returns the angles at all places of these mode coordinates.
    pub fn all(&self, x: impl Fn(usize) -> f64) -> Vec<f64> {
        if !self.is_transformed {
            let mut modes = vec![[0.0; 4]; self.width];
            (0..self.labels.len()).for_each(|m| modes[m / 4][m % 4] = x(m));
            let angle = |place| total(dot(&self.row(place), modes.iter().copied()));
            return (0..self.count).map(angle).collect();
        }
        let mut spectrum = vec![Plane::default(); self.count];
        for (m, label) in self.labels.iter().enumerate() {
            let place = &mut spectrum[label.diameters as usize];
            if label.is_sine { place.im -= x(m) } else { place.re += x(m) }
        }
        self.transform(&spectrum).iter().map(|angle| angle.re).collect()
    }

    /// Calls `add` with the modal force of each mode due to torques at all places.
    pub fn feel(&self, torques: &[f64], mut add: impl FnMut(usize, f64)) {
        if !self.is_transformed {
            let mut felt = vec![[0.0; 4]; self.width];
            for (place, torque) in torques.iter().enumerate().filter(|(_, torque)| **torque != 0.0)
            {
                for (felt, shape) in felt.iter_mut().zip(self.row(place).iter()) {
                    (0..4).for_each(|k| felt[k] += shape[k] * torque);
                }
            }
            return (0..self.labels.len()).for_each(|m| add(m, felt[m / 4][m % 4]));
        }
        let torques: Vec<Plane> = torques.iter().map(|&torque| Plane::from(torque)).collect();
        let spectrum = self.transform(&torques);
        for (m, label) in self.labels.iter().enumerate() {
            let of = spectrum[label.diameters as usize];
            add(m, if label.is_sine { of.im } else { of.re });
        }
    }

    /// Returns `sum_j x_j exp(2 pi i j k / N)` for every `k`.
    fn transform(&self, x: &[Plane]) -> Vec<Plane> {
        let mut room = vec![Plane::default(); 2 * x.len()];
        let (sums, room) = room.split_at_mut(x.len());
        transform(x, 1, &self.turn, sums, room);
        sums.to_vec()
    }
}

/// Writes the sums of every `stride`-th of `x`: those of as many parts as the smallest prime factor
/// of their number says, then sums over the parts (Cooley and Tukey, 1965). `room` is as long.
fn transform(x: &[Plane], stride: usize, turn: &[Plane], sums: &mut [Plane], room: &mut [Plane]) {
    let count = sums.len();
    let Some(parts) = (2..=count).find(|parts| count.is_multiple_of(*parts)) else {
        sums[0] = x[0];
        return;
    };
    let length = count / parts;
    for part in 0..parts {
        let (x, own) = (&x[part * stride..], part * length..(part + 1) * length);
        transform(x, stride * parts, turn, &mut room[own.clone()], &mut sums[own]);
    }
    for k in 0..length {
        (1..parts).for_each(|part| room[part * length + k] *= turn[part * k * stride]);
        if parts == 2 {
            (sums[k], sums[length + k]) = (room[k] + room[length + k], room[k] - room[length + k]);
            continue;
        }
        for q in 0..parts {
            let root = |part: usize| turn[part * q % parts * length * stride];
            sums[q * length + k] =
                (0..parts).map(|part| room[part * length + k] * root(part)).sum();
        }
    }
}

/// Returns four sums of products.
#[inline]
pub(super) fn dot(shapes: &[Four], x: impl Iterator<Item = Four>) -> Four {
    let mut sums = [0.0; 4];
    for (shape, x) in shapes.iter().zip(x) {
        (0..4).for_each(|k| sums[k] += shape[k] * x[k]);
    }
    sums
}

/// Returns the sum of four numbers.
pub(super) fn total([a, b, c, d]: Four) -> f64 {
    (a + b) + (c + d)
}
