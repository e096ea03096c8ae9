//! Rest with all blades pressed into a lining: the four motions about it, and the
//! fastest growth among them (docs/theory.md, section 10).
//!
//! With `S0 = N k_p/2` the roots `s` of `e^{ist}` in the frame of the blades solve
//! `L_c L_a + S0 [(1 + i mu_c) L_a + c2 L_c] = 0`, with
//! `L_c = k_c - m_c (s + nu)^2 + i d_c (s + nu)` and `L_a = k_a - m_a s^2 + i d_a s`.

use nalgebra::Complex;
use serde::Serialize;

use super::Lining;
use crate::harmonic::Joint;
use crate::tolerances::{ROOT_STEPS, UNDAMPED_GROWTH};

/// One motion `e^{ist}` about rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RestRoot {
    /// Its growth rate, `-Im s` \[1/s\].
    pub growth_1_s: f64,
    /// Its frequency in the frame of the blades, `Re s`; negative runs backward over
    /// them \[rad/s\].
    pub s_rad_s: f64,
    /// Its frequency in the standing frame, `Re s + nu` \[rad/s\].
    pub omega_rad_s: f64,
}

/// The four motions about rest at one rotor speed, the fastest growth first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rest {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Stiffness of all blades together, `S0` \[N/m\].
    pub stiffness_n_per_m: f64,
    /// The motions.
    pub roots: [RestRoot; 4],
    /// Whether one of them grows, by more than round-off.
    pub grows: bool,
}

impl Rest {
    /// The motion that grows fastest, or decays slowest.
    #[must_use]
    pub fn worst(&self) -> RestRoot {
        self.roots[0]
    }
}

impl Lining<'_> {
    /// The motions about rest at a speed \[rad/s\]. With a clearance these are those of
    /// casing and blades, each by itself.
    #[must_use]
    pub fn rest(&self, speed: f64) -> Rest {
        Quartic::new(&Joint::at(self.machine, speed), self.stiffness_at_rest()).rest(speed)
    }
}

/// The quartic over a frequency, in the dimensionless unknown `t = s/scale`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quartic {
    /// The largest frequency \[rad/s\].
    pub scale: f64,
    stiffness: f64,
    nu: f64,
    /// Of casing and blades: square of the frequency and twice the damping rate.
    casing: [f64; 2],
    blades: [f64; 2],
    /// `S0 (1 + i mu_c)/m_c` and `S0 c2/m_a`.
    on_casing: Complex<f64>,
    on_blades: f64,
}

impl Quartic {
    /// Of a joint and a stiffness of all blades \[N/m\].
    pub fn new(joint: &Joint, stiffness: f64) -> Self {
        let m = joint.machine;
        let casing = m.casing_stiffness / m.casing_mass;
        let blades = m.blade_modal_stiffness / m.blade_modal_mass;
        let joined = stiffness / m.casing_mass;
        let felt = stiffness * joint.coupling_product / m.blade_modal_mass;
        let scale = joint.nu.abs().max((casing + joined).sqrt()).max((blades + felt.abs()).sqrt());
        let square = scale * scale;
        Self {
            scale,
            stiffness,
            nu: joint.nu / scale,
            casing: [casing / square, m.casing_damping / (m.casing_mass * scale)],
            blades: [blades / square, m.blade_modal_damping / (m.blade_modal_mass * scale)],
            on_casing: Complex::new(1.0, joint.casing_friction) * (joined / square),
            on_blades: felt / square,
        }
    }

    /// `L_c`, `L_a` and their derivatives.
    fn parts(&self, t: Complex<f64>) -> [[Complex<f64>; 2]; 2] {
        let of = |[square, rate]: [f64; 2], at: Complex<f64>| {
            let turned = Complex::new(0.0, rate);
            [at * turned - at * at + square, turned - at * 2.0]
        };
        [of(self.casing, t + self.nu), of(self.blades, t)]
    }

    /// Value, derivative and size of the terms.
    fn at(&self, t: Complex<f64>) -> (Complex<f64>, Complex<f64>, f64) {
        let [[c, c_slope], [a, a_slope]] = self.parts(t);
        let (joined_c, joined_a) = (c + self.on_casing, a + self.on_blades);
        // (L_c + A)(L_a + C) - A C: the poles of joined structures are on its diagonal.
        let product = self.on_casing * self.on_blades;
        let value = joined_c * joined_a - product;
        let slope = c_slope * joined_a + joined_c * a_slope;
        (value, slope, joined_c.norm() * joined_a.norm() + product.norm())
    }

    /// Residual of a root \[rad/s\] over the size of its terms, for tests.
    #[cfg(test)]
    pub fn residual(&self, s: Complex<f64>) -> f64 {
        let t = s / self.scale;
        let terms = |[square, rate]: [f64; 2], at: f64| at * at + rate * at + square;
        let casing = terms(self.casing, (t + self.nu).norm()) + self.on_casing.norm();
        let blades = terms(self.blades, t.norm()) + self.on_blades.abs();
        self.at(t).0.norm() / (casing * blades)
    }

    /// The four roots \[rad/s\], by the iteration of Aberth and Ehrlich.
    pub fn roots(&self) -> [Complex<f64>; 4] {
        let casing = (Complex::from(self.casing[0]) + self.on_casing).sqrt();
        let blades = Complex::from(self.blades[0] + self.on_blades).sqrt();
        // Those of uncoupled structures, pulled apart, as they may meet.
        let starts = [casing - self.nu, -casing - self.nu, blades, -blades];
        let apart = [(0.01, 0.002), (-0.013, -0.003), (0.004, -0.011), (-0.006, 0.007)];
        let mut roots = [Complex::default(); 4];
        for (root, (start, (re, im))) in roots.iter_mut().zip(starts.iter().zip(apart)) {
            *root = start + Complex::new(re, im);
        }
        for _ in 0..ROOT_STEPS {
            let mut largest = 0.0_f64;
            for k in 0..4 {
                let here = roots[k];
                let (value, slope, size) = self.at(here);
                if value.norm() <= f64::EPSILON * 0.5 * size {
                    continue;
                }
                let mut pull = slope / value;
                for (other, root) in roots.iter().enumerate() {
                    if other != k && *root != here {
                        pull -= (here - root).inv();
                    }
                }
                let step = pull.inv();
                if !(step.re.is_finite() && step.im.is_finite()) {
                    continue;
                }
                roots[k] = here - step;
                largest = largest.max(step.norm());
            }
            if largest <= 2.0 * f64::EPSILON {
                break;
            }
        }
        roots.map(|root| root * self.scale)
    }

    /// The motions about rest.
    pub fn rest(&self, speed: f64) -> Rest {
        let nu = self.nu * self.scale;
        let mut roots = self.roots().map(|s| RestRoot {
            growth_1_s: -s.im,
            s_rad_s: s.re,
            omega_rad_s: s.re + nu,
        });
        roots.sort_by(|a, b| b.growth_1_s.total_cmp(&a.growth_1_s));
        let damped = self.casing[1] > 0.0 && self.blades[1] > 0.0;
        let round_off = if damped { 0.0 } else { UNDAMPED_GROWTH * self.scale };
        Rest {
            speed_rad_s: speed,
            stiffness_n_per_m: self.stiffness,
            grows: roots[0].growth_1_s > round_off,
            roots,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::harmonic::lining::flow;
    use crate::model::ContactSurface;
    use crate::scene::Scene;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn roots_solve_the_quartic_and_are_those_of_eight_states(
            kappa in -1.0..1.0_f64, mu in 0.0..0.6_f64, tau in 0.0..0.4_f64,
            zetas in (0.0..0.3_f64, 0.0..0.3_f64), stiffness in 2.0..8.0_f64,
            speed in -900.0..900.0_f64,
        ) {
            let mut scene = Scene::base();
            for (path, value) in [
                ("casing.radius_m", 0.49988), ("bladed_disk.radial_coupling", kappa),
                ("contact.friction", mu), ("casing.tangential_ratio", tau),
                ("casing.damping_ratio", zetas.0), ("bladed_disk.damping_ratio", zetas.1),
            ] {
                scene.set(path, &value.to_string()).unwrap();
            }
            let machine = scene.machine();
            let surface =
                ContactSurface { stiffness_n_per_m: 10_f64.powf(stiffness), ..Default::default() };
            let lining = Lining::of(&machine, &surface).unwrap();
            let joint = Joint::at(&machine, speed);
            let quartic = Quartic::new(&joint, lining.stiffness_at_rest());
            for root in quartic.roots() {
                prop_assert!(quartic.residual(root) < 1e-10, "{root}");
            }
            let rest = lining.rest(speed);
            let tangent = [[rest.stiffness_n_per_m, 0.0], [0.0, rest.stiffness_n_per_m]];
            let values = flow::eigenvalues(&joint, [joint.nu, 0.0], tangent).unwrap();
            let growth = values.iter().map(|value| value.re).fold(f64::MIN, f64::max);
            // Of two roots that meet, half the digits are known.
            let near = rest.roots.iter().flat_map(|a| rest.roots.iter().map(move |b| (a, b)));
            let apart = near.filter(|(a, b)| a != b)
                .map(|(a, b)| (a.s_rad_s - b.s_rad_s).hypot(a.growth_1_s - b.growth_1_s))
                .fold(f64::INFINITY, f64::min);
            let size = quartic.scale;
            let bound = 1e-11 * size * (1.0 + size / apart);
            prop_assert!(
                (rest.worst().growth_1_s - growth).abs() < bound,
                "{} is not {growth}", rest.worst().growth_1_s
            );
        }
    }
}
