//! An engine-order excitation of the blades in the time domain: a torque
//! `Q cos(E (theta + Phi_i))` on every blade, fixed in the standing frame, which
//! only some modes feel (docs/theory.md, section 8).

use crate::motion::Rotor;
use crate::scene::Scene;

/// The excitation of one scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EngineOrderTorque {
    amplitude: f64,
    order: u32,
    blades: u32,
}

impl EngineOrderTorque {
    /// The excitation of a scene; none where its amplitude is zero.
    #[must_use]
    pub fn of(scene: &Scene) -> Option<Self> {
        let amplitude = scene.excitation.amplitude_nm;
        let (order, blades) = (scene.excitation.order, scene.bladed_disk.blades);
        (amplitude != 0.0).then_some(Self { amplitude, order, blades })
    }

    /// Nodal diameters of the modes that feel it, at most half the blades.
    #[must_use]
    pub fn diameters(&self) -> u32 {
        let order = self.order % self.blades;
        order.min(self.blades - order)
    }

    /// Phase `E theta` at an instant \[rad\].
    #[must_use]
    pub fn phase(&self, rotor: &Rotor, t: f64) -> f64 {
        f64::from(self.order) * rotor.angle(t)
    }

    /// `sum_i (cos, sin)(k Phi_i) Q_i` for `k` diameters at a phase \[N m\].
    #[must_use]
    pub fn torque_on(&self, diameters: u32, phase: f64) -> [f64; 2] {
        let (k, order) = (diameters % self.blades, self.order % self.blades);
        let half = 0.5 * f64::from(self.blades) * self.amplitude;
        let (sin, cos) = phase.sin_cos();
        let mut torque = [0.0; 2];
        if (k + order).is_multiple_of(self.blades) {
            torque[0] += half * cos;
            torque[1] += half * sin;
        }
        if k == order {
            torque[0] += half * cos;
            torque[1] -= half * sin;
        }
        torque
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn torque_on_a_mode_pair_is_the_sum_over_blades() {
        for blades in [1, 2, 5, 22] {
            for (diameters, order) in [(3, 3), (3, 19), (3, 25), (4, 3), (0, 22), (11, 11), (2, 0)]
            {
                let excitation = EngineOrderTorque { amplitude: 1.7, order, blades };
                let phase = 0.6;
                let [c, s] = excitation.torque_on(diameters, phase);
                let mut sum = [0.0; 2];
                for i in 0..blades {
                    let angle = TAU * f64::from(i) / f64::from(blades);
                    let torque = 1.7 * (phase + f64::from(order) * angle).cos();
                    sum[0] += torque * (f64::from(diameters) * angle).cos();
                    sum[1] += torque * (f64::from(diameters) * angle).sin();
                }
                // Round-off of N terms with phases up to 25 turns.
                let close = (c - sum[0]).abs() + (s - sum[1]).abs() < 1e-11;
                assert!(close, "{blades} {diameters} {order}: {c} {s} {sum:?}");
            }
        }
    }
}
