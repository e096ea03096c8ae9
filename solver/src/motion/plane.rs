//! Points and vectors in the plane of the two casing coordinates.

/// Point or vector in the plane of the two casing coordinates, as a complex number.
pub(super) type Plane = nalgebra::Complex<f64>;

/// Returns the component of a vector along a direction.
#[inline(always)]
pub(super) fn dot(direction: Plane, vector: Plane) -> f64 {
    direction.re * vector.re + direction.im * vector.im
}

/// Returns the component of a vector across a direction, a quarter turn ahead of it.
#[inline(always)]
pub(super) fn across(direction: Plane, vector: Plane) -> f64 {
    direction.re * vector.im - direction.im * vector.re
}

/// Returns the length of a vector, without the care of `hypot` at the ends of the number range.
#[inline(always)]
pub(super) fn size(vector: Plane) -> f64 {
    vector.norm_sqr().sqrt()
}
