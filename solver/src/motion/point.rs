//! Displacements and rates of casing and blade modes in the blade frame, and their conversion to a
//! dimensionless state vector of a linear system.

use nalgebra::DVector;

use super::Plane;

/// Displacements and rates in the blade frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Point {
    /// Casing displacement `z` \[m\], and its rate or its increment in a step.
    pub z: Plane,
    pub dz: Plane,
    /// Blade angle `a` \[rad\], and its rate or its increment in a step.
    pub a: Plane,
    pub da: Plane,
}

/// Units of the four parts of a point, chosen so that all states are of the same order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units(pub [f64; 4]);

impl Units {
    /// Creates the units from a length \[m\], the blade length \[m\] and an angular frequency
    /// \[rad/s\].
    pub fn of(length: f64, blade: f64, rate: f64) -> Self {
        Self([length, length * rate, length / blade, length / blade * rate])
    }

    /// Converts a point to the first `size` dimensionless states.
    pub fn states(&self, point: &Point, size: usize) -> DVector<f64> {
        let parts = [point.z, point.dz, point.a, point.da];
        let each =
            parts.iter().zip(self.0).flat_map(|(part, unit)| [part.re, part.im].map(|x| x / unit));
        DVector::from_iterator(size, each.take(size))
    }

    /// Converts dimensionless states to a point; missing ones are zero.
    pub fn point(&self, x: &DVector<f64>) -> Point {
        let at = |part: usize| {
            let place = |k: usize| x.get(2 * part + k).copied().unwrap_or(0.0);
            Plane::new(place(0), place(1)) * self.0[part]
        };
        Point { z: at(0), dz: at(1), a: at(2), da: at(3) }
    }
}

/// Returns a unit vector.
pub(super) fn one_of(size: usize, state: usize) -> DVector<f64> {
    DVector::from_fn(size, |k, _| f64::from(u8::from(k == state)))
}
