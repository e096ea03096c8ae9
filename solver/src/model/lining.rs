//! Elastic lining of the casing, used by the smooth contact law (docs/theory.md, section 10).
//!
//! With the depth `d = -g` the contact force is zero for `d <= 0`, `k_p d^2/(2 eps)` up to the
//! depth `eps`, and `k_p (d - eps/2)` beyond. The lining is conservative: it returns all the energy
//! that it stores.

use super::ContactSurface;

/// Force law of the lining under one blade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiningLaw {
    /// Stiffness `k_p` \[N/m\].
    pub stiffness_n_per_m: f64,
    /// Depth `eps` of the parabolic part; zero for a purely linear law \[m\].
    pub smoothing_m: f64,
}

impl LiningLaw {
    /// Creates the law from the stiffness and the smoothing depth of a contact surface.
    #[must_use]
    pub fn of(surface: &ContactSurface) -> Self {
        Self { stiffness_n_per_m: surface.stiffness_n_per_m, smoothing_m: surface.smoothing_m }
    }

    /// Returns the contact force at a gap, positive in compression \[N\].
    #[must_use]
    pub fn push(&self, gap: f64) -> f64 {
        let (depth, k, eps) = (-gap, self.stiffness_n_per_m, self.smoothing_m);
        if depth <= 0.0 {
            0.0
        } else if depth < eps {
            k * depth * depth / (eps * 2.0)
        } else {
            k * (depth - eps * 0.5)
        }
    }

    /// Returns the contact stiffness `-dP/dg` at a gap \[N/m\].
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

    /// Returns the energy stored at a gap, `-integral of P dg` from the open gap \[J\].
    #[must_use]
    pub fn energy(&self, gap: f64) -> f64 {
        let (depth, k, eps) = (-gap, self.stiffness_n_per_m, self.smoothing_m);
        if depth <= 0.0 {
            0.0
        } else if depth < eps {
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
