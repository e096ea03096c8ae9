//! The lining of the smooth law (docs/theory.md, section 10): no force at a distance, a
//! parabola over the first `eps` of depth, then a straight line. It gives back all that
//! is stored in it.

use super::{ContactSurface, Number};

/// The lining under one blade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiningLaw<T = f64> {
    /// `k_p` \[N/m\].
    pub stiffness_n_per_m: T,
    /// `eps`, which may be zero \[m\].
    pub smoothing_m: T,
}

impl<T: Number> LiningLaw<T> {
    /// Of a contact surface.
    #[must_use]
    pub fn of(surface: &ContactSurface<T>) -> Self {
        Self { stiffness_n_per_m: surface.stiffness_n_per_m, smoothing_m: surface.smoothing_m }
    }

    /// Push at a gap, zero or more \[N\].
    #[must_use]
    pub fn push(&self, gap: T) -> T {
        let (depth, k, eps) = (-gap, self.stiffness_n_per_m, self.smoothing_m);
        if depth.re() <= 0.0 {
            T::zero()
        } else if depth.re() < eps.re() {
            k * depth * depth / (eps * 2.0)
        } else {
            k * (depth - eps * 0.5)
        }
    }

    /// How much the push grows as the gap closes, `-dP/dg` \[N/m\].
    #[must_use]
    pub fn slope(&self, gap: T) -> T {
        let (depth, k, eps) = (-gap, self.stiffness_n_per_m, self.smoothing_m);
        if depth.re() <= 0.0 {
            T::zero()
        } else if depth.re() < eps.re() {
            k * (depth / eps)
        } else {
            k
        }
    }

    /// Energy stored at a gap, of which `push` is the slope \[J\].
    #[must_use]
    pub fn energy(&self, gap: T) -> T {
        let (depth, k, eps) = (-gap, self.stiffness_n_per_m, self.smoothing_m);
        if depth.re() <= 0.0 {
            T::zero()
        } else if depth.re() < eps.re() {
            k * depth * depth * depth / (eps * 6.0)
        } else {
            k * (depth * 0.5 * (depth - eps) + eps * eps / 6.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lining(smoothing_m: f64) -> LiningLaw {
        LiningLaw::of(&ContactSurface {
            stiffness_n_per_m: 27e3,
            smoothing_m,
            ..ContactSurface::default()
        })
    }

    #[test]
    fn the_push_is_the_slope_of_the_energy_and_has_no_jump() {
        for smoothing in [0.0, 1e-6, 1e-5] {
            let lining = lining(smoothing);
            for place in -40..10 {
                let (gap, step) = (0.5e-6 * f64::from(place) + 1e-8, 1e-10);
                let slope = (lining.energy(gap - step) - lining.energy(gap + step)) / (2.0 * step);
                assert!((slope - lining.push(gap)).abs() < 1e-5, "{smoothing} {gap}: {slope}");
            }
            let beside = 1e-15;
            for edge in [0.0, -smoothing] {
                let jump = lining.push(edge - beside) - lining.push(edge + beside);
                assert!(jump.abs() < 1e-9, "{smoothing} {edge}: {jump}");
            }
        }
    }
}
