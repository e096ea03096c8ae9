//! Place and rates of casing and blade modes in the frame of the blades, as states of a linear
//! motion.

use nalgebra::DVector;

use super::Plane;

/// Place and rates in the frame of the blades.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Point {
    /// `z` \[m\], and its rate or increment.
    pub z: Plane,
    pub dz: Plane,
    /// `a` \[rad\], and its rate or increment.
    pub a: Plane,
    pub da: Plane,
}

/// The units of the four parts of a point, so that all states are of one size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units(pub [f64; 4]);

impl Units {
    /// The units of a length \[m\], of blades of a length \[m\], and of these rates.
    pub fn of(length: f64, blade: f64, rate: f64) -> Self {
        Self([length, length * rate, length / blade, length / blade * rate])
    }

    /// The first `size` states of a point.
    pub fn states(&self, point: &Point, size: usize) -> DVector<f64> {
        let parts = [point.z, point.dz, point.a, point.da];
        let each =
            parts.iter().zip(self.0).flat_map(|(part, unit)| [part.re, part.im].map(|x| x / unit));
        DVector::from_iterator(size, each.take(size))
    }

    /// The point of these states; those that are left out are 0.
    pub fn point(&self, x: &DVector<f64>) -> Point {
        let at = |part: usize| {
            let place = |k: usize| x.get(2 * part + k).copied().unwrap_or(0.0);
            Plane::new(place(0), place(1)) * self.0[part]
        };
        Point { z: at(0), dz: at(1), a: at(2), da: at(3) }
    }
}

/// One state of 1 among so many.
pub(super) fn one_of(size: usize, state: usize) -> DVector<f64> {
    DVector::from_fn(size, |k, _| f64::from(u8::from(k == state)))
}
