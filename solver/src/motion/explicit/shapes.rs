//! Shapes of the modes at the blades, `cos d Phi_i` and `sin d Phi_i`, four modes side by side.
//!
//! All are fractions of one turn. A table holds those of a small disk; of a larger one a row is
//! worked out when it is asked for. All blades of a large ring at once are a discrete Fourier
//! transform, `N log N` products instead of `N^2`.

use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

use crate::model::fraction_of_turn;
use crate::motion::Plane;

/// Largest table of mode shapes, in groups of four: 2 MiB, those of 512 single blades. For a larger
/// disk each row is computed on demand. Speed only.
const SHAPES_KEPT: usize = 1 << 16;

/// Number of single blades from which a Fourier transform costs less than products. Speed only.
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
    turn: Vec<(f64, f64)>,
    /// Blades of a place: `place`, `place + count`, ...
    each: u32,
    count: usize,
    width: usize,
    /// Row after row; empty where there are too many.
    table: Vec<Four>,
    ring: Option<Transforms>,
}

/// From the modes of a ring to its blades and back.
struct Transforms {
    to_blades: Arc<dyn ComplexToReal<f64>>,
    to_modes: Arc<dyn RealToComplex<f64>>,
}

impl fmt::Debug for Transforms {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Transforms({})", self.to_blades.len())
    }
}

impl Shapes {
    /// Creates the shapes at `count` places of `each` blades. `is_ring`: the places are single blades,
    /// and these are all their modes, in order of their diameters.
    pub fn new(labels: &[Label], blades: u32, each: u32, count: u32, is_ring: bool) -> Self {
        let (count, width) = (count as usize, labels.len().div_ceil(4));
        let ring = (is_ring && count >= SHAPES_TRANSFORMED).then(|| {
            let mut planner = RealFftPlanner::new();
            let to_blades = planner.plan_fft_inverse(count);
            Transforms { to_blades, to_modes: planner.plan_fft_forward(count) }
        });
        let labels = labels.to_vec();
        let turn = (0..blades).map(|blade| fraction_of_turn(blade, blades)).collect();
        let mut shapes = Self { labels, turn, each, count, width, table: Vec::new(), ring };
        if count * width <= SHAPES_KEPT {
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
                let (cos, sin) = self.turn[turned as usize];
                if label.is_sine { sin } else { cos }
            };
            row[m / 4][m % 4] = (0..self.each).map(at).sum::<f64>() / f64::from(self.each);
        }
        row
    }

    /// Returns the angles at all places of these mode coordinates.
    pub fn all(&self, x: impl Fn(usize) -> f64) -> Vec<f64> {
        let Some(ring) = &self.ring else {
            let mut modes = vec![[0.0; 4]; self.width];
            (0..self.labels.len()).for_each(|m| modes[m / 4][m % 4] = x(m));
            let angle = |place| {
                let [a, b, c, d] = dot(&self.row(place), modes.iter().copied());
                (a + b) + (c + d)
            };
            return (0..self.count).map(angle).collect();
        };
        let mut spectrum = vec![Plane::default(); self.count / 2 + 1];
        for (m, label) in self.labels.iter().enumerate() {
            let half = if label.is_alone { 1.0 } else { 0.5 };
            let place = &mut spectrum[label.diameters as usize];
            if label.is_sine { place.im -= half * x(m) } else { place.re += half * x(m) }
        }
        let mut angles = vec![0.0; self.count];
        // Lengths agree, so it has no error.
        let _ = ring.to_blades.process(&mut spectrum, &mut angles);
        angles
    }

    /// Calls `add` with the modal force of each mode due to torques at all places.
    pub fn feel(&self, torques: &[f64], mut add: impl FnMut(usize, f64)) {
        let Some(ring) = &self.ring else {
            let mut felt = vec![[0.0; 4]; self.width];
            for (place, torque) in torques.iter().enumerate().filter(|(_, torque)| **torque != 0.0)
            {
                for (felt, shape) in felt.iter_mut().zip(self.row(place).iter()) {
                    (0..4).for_each(|k| felt[k] += shape[k] * torque);
                }
            }
            return (0..self.labels.len()).for_each(|m| add(m, felt[m / 4][m % 4]));
        };
        let (mut room, mut spectrum) =
            (torques.to_vec(), vec![Plane::default(); self.count / 2 + 1]);
        let _ = ring.to_modes.process(&mut room, &mut spectrum);
        for (m, label) in self.labels.iter().enumerate() {
            let of = spectrum[label.diameters as usize];
            add(m, if label.is_sine { -of.im } else { of.re });
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
