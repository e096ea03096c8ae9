//! Mode shapes of a ring of equal blades, `cos(k Phi_i)` and `sin(k Phi_i)`, made
//! orthonormal: from mode coordinates to blade angles.
//!
//! Cosines of all pairs are multiples of one angle, so one turn of them is a
//! table of all. One blade costs a sum over the modes; the blades near contact, which are
//! asked for step after step, keep their rows. Every blade at once, and what many blades
//! feel, are discrete Fourier transforms, `N log N` instead of `N^2`.

use std::fmt;
use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

use crate::model::fraction_of_turn;
use crate::motion::Plane;
use crate::tolerances::{FEW_BLADES, SHAPES_KEPT};

/// Numbers that are added side by side.
pub(super) const LANES: usize = 4;

/// Mode shapes of `N` blades. Coordinates are lists of twice `width` numbers:
/// the cosine modes of `0 ..= N/2` diameters, then the sine modes, each filled
/// up with zeros to a multiple of `LANES`.
#[derive(Clone, Debug)]
pub(super) struct Shapes {
    /// `(cos, sin)` of `2 pi i/N`.
    turn: Vec<(f64, f64)>,
    /// Length of one half of a list of coordinates.
    width: usize,
    /// Factor that makes the modes of each number of diameters orthonormal.
    scales: Vec<f64>,
    /// `rows[blade]`, ready to be multiplied with coordinates, of a ring of few
    /// blades; none of a larger one, where they would be `N^2` numbers.
    rows: Vec<Vec<f64>>,
    transforms: Transforms,
}

/// From coordinates to blades and back.
#[derive(Clone)]
struct Transforms {
    to_blades: Arc<dyn ComplexToReal<f64>>,
    to_modes: Arc<dyn RealToComplex<f64>>,
}

impl fmt::Debug for Transforms {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Transforms({})", self.to_blades.len())
    }
}

/// Room for the transforms of a ring, which step after step takes.
#[derive(Clone, Debug)]
pub(super) struct Room {
    spectrum: Vec<Plane>,
    scratch: Vec<Plane>,
    /// One value of each blade.
    pub blades: Vec<f64>,
}

impl Shapes {
    /// Creates the shapes of a ring of `count >= 1` blades.
    pub fn new(count: u32) -> Self {
        let blades = f64::from(count);
        let turn: Vec<_> = (0..count).map(|blade| fraction_of_turn(blade, count)).collect();
        let scale = |k: u32| {
            let alone = k == 0 || 2 * k == count;
            if alone { 1.0 / blades } else { 2.0 / blades }.sqrt()
        };
        let scales: Vec<f64> = (0..=count / 2).map(scale).collect();
        let width = scales.len().next_multiple_of(LANES);
        let mut planner = RealFftPlanner::new();
        let transforms = Transforms {
            to_blades: planner.plan_fft_inverse(count as usize),
            to_modes: planner.plan_fft_forward(count as usize),
        };
        let mut shapes = Self { turn, width, scales, rows: Vec::new(), transforms };
        if count <= SHAPES_KEPT {
            shapes.rows = (0..count as usize).map(|blade| shapes.row(blade)).collect();
        }
        shapes
    }

    /// Returns both shapes of every mode at a blade (from 0), in the order of
    /// coordinates.
    pub fn row(&self, blade: usize) -> Vec<f64> {
        let mut row = vec![0.0; 2 * self.width];
        let (cosines, sines) = row.split_at_mut(self.width);
        for ((c, s), (cos, sin)) in cosines.iter_mut().zip(sines).zip(self.along(blade)) {
            (*c, *s) = (cos, sin);
        }
        row
    }

    /// Returns how many blades there are.
    pub fn count(&self) -> usize {
        self.turn.len()
    }

    /// Returns the length of one half of a list of coordinates.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the factor of the shapes of `k` diameters.
    pub fn scale(&self, k: usize) -> f64 {
        self.scales[k]
    }

    /// Factors of `0 ..= N/2` diameters.
    pub fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// Returns both shapes at a blade (from 0), of each number of diameters.
    fn along(&self, blade: usize) -> impl Iterator<Item = (f64, f64)> {
        let mut at = 0;
        self.scales.iter().map(move |scale| {
            let (c, s) = self.turn[at];
            at += blade;
            if at >= self.turn.len() {
                at -= self.turn.len();
            }
            (scale * c, scale * s)
        })
    }

    /// Calls `with` with the row of shapes at a blade (from 0).
    pub fn with_row<T>(&self, blade: usize, with: impl FnOnce(&[f64]) -> T) -> T {
        match self.rows.get(blade) {
            Some(row) => with(row),
            None => with(&self.row(blade)),
        }
    }

    /// Returns the value at a blade (from 0) of what has these coordinates.
    pub fn at(&self, blade: usize, coordinates: &[f64]) -> f64 {
        self.with_row(blade, |row| product(row, coordinates))
    }

    /// Returns how many blades cost less one by one than all of them at once.
    pub fn few(&self) -> usize {
        FEW_BLADES * (usize::BITS - self.count().leading_zeros()) as usize
    }

    /// Creates the room for `all_into` and `feel`.
    pub fn room(&self) -> Room {
        let Transforms { to_blades, to_modes } = &self.transforms;
        let scratch = to_blades.get_scratch_len().max(to_modes.get_scratch_len());
        Room {
            spectrum: to_modes.make_output_vec(),
            scratch: vec![Plane::default(); scratch],
            blades: vec![0.0; self.count()],
        }
    }

    /// Returns the values at every blade.
    pub fn all(&self, coordinates: &[f64]) -> Vec<f64> {
        let mut room = self.room();
        self.all_into(coordinates, &mut room);
        room.blades
    }

    /// Puts the values at every blade into the room.
    pub fn all_into(&self, coordinates: &[f64], room: &mut Room) {
        if self.count() <= self.few() {
            for (blade, value) in room.blades.iter_mut().enumerate() {
                *value = self.at(blade, coordinates);
            }
            return;
        }
        let (cosines, sines) = coordinates.split_at(self.width);
        let modes = self.scales.iter().zip(cosines.iter().zip(sines));
        for (k, (value, (scale, (c, s)))) in room.spectrum.iter_mut().zip(modes).enumerate() {
            // The others come twice in the sum, as they and as their conjugates.
            let alone = k == 0 || 2 * k == self.count();
            let (re, im) = if alone { (*c, 0.0) } else { (0.5 * c, -0.5 * s) };
            *value = Plane::new(scale * re, scale * im);
        }
        let Room { spectrum, scratch, blades } = room;
        let done = self.transforms.to_blades.process_with_scratch(spectrum, blades, scratch);
        debug_assert!(done.is_ok(), "{done:?}");
    }

    /// What the modes feel of the values at the blades: gives the diameters of each pair,
    /// and both values.
    pub fn feel(&self, room: &mut Room, mut felt: impl FnMut(usize, [f64; 2])) {
        let Room { spectrum, scratch, blades } = room;
        let done = self.transforms.to_modes.process_with_scratch(blades, spectrum, scratch);
        debug_assert!(done.is_ok(), "{done:?}");
        for (k, (value, scale)) in room.spectrum.iter().zip(&self.scales).enumerate() {
            felt(k, [scale * value.re, -scale * value.im]);
        }
    }
}

/// Returns the value of what has these coordinates where the shapes are those of `row`.
fn product(row: &[f64], coordinates: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (shapes, values) = (row.as_chunks::<LANES>().0, coordinates.as_chunks::<LANES>().0);
    for (shape, value) in shapes.iter().zip(values) {
        for lane in 0..LANES {
            sums[lane] += shape[lane] * value[lane];
        }
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Some numbers of no structure, zero where no mode is.
    fn coordinates(shapes: &Shapes, seed: f64) -> Vec<f64> {
        let count = shapes.count();
        let value = |place: usize| {
            let (k, sine) = (place % shapes.width(), place >= shapes.width());
            let alone = k == 0 || 2 * k == count;
            let exists = 2 * k <= count && !(sine && alone);
            if exists { (seed * (place as f64 + 1.0)).sin() } else { 0.0 }
        };
        (0..2 * shapes.width()).map(value).collect()
    }

    /// The sum over the modes, as it is written.
    fn plain(shapes: &Shapes, blade: usize, coordinates: &[f64]) -> f64 {
        let count = shapes.count();
        let mode = |k: usize| {
            let angle = TAU * ((k * blade) % count) as f64 / count as f64;
            let alone = k == 0 || 2 * k == count;
            let scale = (if alone { 1.0 } else { 2.0 } / count as f64).sqrt();
            let (c, s) = (coordinates[k], coordinates[shapes.width() + k]);
            scale * (c * angle.cos() + s * angle.sin())
        };
        (0..=count / 2).map(mode).sum()
    }

    #[test]
    fn angles_of_blades_are_sums_over_modes() {
        // One blade and two, primes, powers, mixed, and rings too large to keep.
        for count in [1, 2, 3, 4, 5, 7, 8, 9, 22, 66, 97, 128, 129, 131, 180, 220, 243, 1001] {
            let shapes = Shapes::new(count);
            let (x, v) = (coordinates(&shapes, 0.7), coordinates(&shapes, 1.3));
            let [all, rates] = [&x, &v].map(|values| shapes.all(values));
            assert_eq!((all.len(), rates.len()), (count as usize, count as usize));
            // Round-off of a sum of N terms of one, and of phases of a turn.
            let allowed = 1e-15 * f64::from(count + 4);
            for blade in 0..count as usize {
                let expected = plain(&shapes, blade, &x);
                for found in [shapes.at(blade, &x), all[blade]] {
                    assert!((found - expected).abs() < allowed, "{count} {blade}: {found}");
                }
                let rate = rates[blade] - plain(&shapes, blade, &v);
                assert!(rate.abs() < allowed, "{count} {blade}: {rate}");
            }
        }
    }

    #[test]
    fn shapes_are_orthonormal() {
        for count in [1, 2, 5, 22, 131, 140] {
            let shapes = Shapes::new(count);
            let rows: Vec<Vec<f64>> = (0..count as usize).map(|blade| shapes.row(blade)).collect();
            for (i, a) in rows.iter().enumerate() {
                for (j, b) in rows.iter().enumerate() {
                    let product: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                    let expected = f64::from(u8::from(i == j));
                    assert!((product - expected).abs() < 1e-13, "{count} {i} {j}: {product}");
                }
            }
        }
    }
}
