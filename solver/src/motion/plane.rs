//! Points and vectors in the plane of the two casing coordinates.

/// Blade phase below which sine and cosine are two terms of their series
/// \[rad\]: exact to round-off.
const SMALL_PHASE: f64 = 1e-4;

/// Blade phase below which sine and cosine are two and three terms of their series \[rad\]: exact to
/// the round-off of 1. Speed only.
pub(super) const SHORT_SERIES_PHASE: f64 = 1.5e-3;

/// Blade phase below which they are four terms of their series \[rad\]: exact to round-off.
pub(super) const SERIES_PHASE: f64 = 0.03;

/// Point or vector in the plane of the two casing coordinates, as a complex number.
pub(super) type Plane = num_complex::Complex<f64>;

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

/// Returns a direction turned by a small blade phase, exact to round-off.
#[inline(always)]
pub(super) fn turned(direction: Plane, phase: f64) -> Plane {
    let q = phase * phase;
    let (sin, cos) = if phase.abs() < SMALL_PHASE {
        (phase * (1.0 - q * (1.0 / 6.0)), 1.0 - 0.5 * q)
    } else if phase.abs() < SERIES_PHASE {
        series(phase)
    } else {
        phase.sin_cos()
    };
    Plane::new(direction.re * cos - direction.im * sin, direction.im * cos + direction.re * sin)
}

/// Returns sine and cosine of a phase below `SERIES_PHASE`.
#[inline(always)]
pub(super) fn series(phase: f64) -> (f64, f64) {
    let q = phase * phase;
    let sin = q * (1.0 / 6.0) * (1.0 - q * (1.0 / 20.0) * (1.0 - q * (1.0 / 42.0)));
    let cos =
        q * 0.5 * (1.0 - q * (1.0 / 12.0) * (1.0 - q * (1.0 / 30.0) * (1.0 - q * (1.0 / 56.0))));
    (phase - phase * sin, 1.0 - cos)
}

/// Returns sine and cosine of a phase below `SHORT_SERIES_PHASE`.
#[inline(always)]
pub(super) fn short_series(phase: f64) -> (f64, f64) {
    let q = phase * phase;
    (phase - (phase * (1.0 / 6.0)) * q, (1.0 - q * 0.5) + (q * q) * (1.0 / 24.0))
}
