//! Random numbers of the normal distribution, the same on every machine.

use std::f64::consts::TAU;

/// Returns so many standard normal numbers of the draw with this seed (Box and Muller).
pub fn normals(seed: u32, count: u32) -> Vec<f64> {
    let mut draw = fastrand::Rng::with_seed(u64::from(seed));
    let mut normal = |_| {
        // From a number above 0 and one below 1.
        let (radius, angle) = ((-2.0 * (1.0 - draw.f64()).ln()).sqrt(), TAU * draw.f64());
        radius * angle.cos()
    };
    (0..count).map(&mut normal).collect()
}
