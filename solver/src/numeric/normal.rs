//! Normally distributed random numbers, reproducible on every machine.

use std::f64::consts::TAU;

/// Returns `count` standard normal numbers for a seed (Box-Muller transform).
pub fn normals(seed: u32, count: u32) -> Vec<f64> {
    let mut draw = fastrand::Rng::with_seed(u64::from(seed));
    let mut normal = |_| {
        // `1 - f64()` lies in (0, 1], so the logarithm is finite.
        let (radius, angle) = ((-2.0 * (1.0 - draw.f64()).ln()).sqrt(), TAU * draw.f64());
        radius * angle.cos()
    };
    (0..count).map(&mut normal).collect()
}
