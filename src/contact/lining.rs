//! The lining of the smooth law (docs/theory.md, section 10): no force at a distance, a
//! parabola over the first `eps` of depth, then a straight line. It gives back all that
//! is stored in it.

use crate::model::ContactSurface;

/// The lining under one blade.
#[derive(Clone, Copy, Debug)]
pub struct LiningLaw {
    /// `k_p` \[N/m\].
    pub stiffness_n_per_m: f64,
    /// `eps`, which may be zero \[m\].
    pub smoothing_m: f64,
}

impl LiningLaw {
    /// Of a contact surface.
    #[must_use]
    pub fn of(surface: &ContactSurface) -> Self {
        Self { stiffness_n_per_m: surface.stiffness_n_per_m, smoothing_m: surface.smoothing_m }
    }

    /// Push at a gap, zero or more \[N\].
    #[must_use]
    pub fn push(&self, gap: f64) -> f64 {
        let (depth, k, eps) = (-gap, self.stiffness_n_per_m, self.smoothing_m);
        if depth <= 0.0 {
            0.0
        } else if depth < eps {
            k * depth * depth / (2.0 * eps)
        } else {
            k * (depth - 0.5 * eps)
        }
    }

    /// How much the push grows as the gap closes, `-dP/dg` \[N/m\].
    #[must_use]
    pub fn slope(&self, gap: f64) -> f64 {
        let (depth, k, eps) = (-gap, self.stiffness_n_per_m, self.smoothing_m);
        if depth <= 0.0 {
            0.0
        } else if depth < eps {
            k * (depth / eps)
        } else {
            k
        }
    }

    /// Energy stored at a gap, of which `push` is the slope \[J\].
    #[must_use]
    pub fn energy(&self, gap: f64) -> f64 {
        let (depth, k, eps) = (-gap, self.stiffness_n_per_m, self.smoothing_m);
        if depth <= 0.0 {
            0.0
        } else if depth < eps {
            k * depth * depth * depth / (6.0 * eps)
        } else {
            k * (0.5 * depth * (depth - eps) + eps * eps / 6.0)
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
