//! All blades rub a casing that is out of round (docs/theory.md, section 11): lobes of `m`
//! drive one wave where `m = +-n_d` modulo `N`, `p = -S0 e/(1 + S0 B(s))`, and none otherwise.

use serde::Serialize;

use super::Lining;
use crate::harmonic::Joint;

/// The wave that the lobes of a casing drive at one rotor speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Forced {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Its frequency in the frame of the blades and in the standing frame \[rad/s\].
    pub s_rad_s: f64,
    /// The frequency in the standing frame \[rad/s\].
    pub omega_rad_s: f64,
    /// Amplitude `|z|` of the casing wave \[m\].
    pub amplitude_m: f64,
    /// Largest blade angle \[rad\].
    pub blade_angle_rad: f64,
    /// Whether every blade presses all the time, as these equations assume.
    pub all_press: bool,
}

impl Lining<'_> {
    /// Returns the wave that `lobes` lobes of this height drive at a speed, of blades that all
    /// press \[rad/s, m\].
    #[must_use]
    pub fn forced(&self, speed: f64, lobes: u32, height: f64) -> Forced {
        let here = self.at(speed);
        let (joint, machine) = (Joint::at(&self.machine, speed), &here.machine);
        let (blades, lobes) = (i64::from(machine.polygon.blades), i64::from(lobes));
        let diameters = i64::from(machine.polygon.nodal_diameters);
        let meets = |sense: i64| (lobes - sense * diameters).rem_euclid(blades) == 0;
        let sense = if meets(1) { -1.0 } else { 1.0 };
        let s = sense * lobes as f64 * speed;
        let omega = s + joint.nu;
        let stiffness = 0.5 * blades as f64 * self.stiffness_n_per_m;
        let driven = meets(1) || meets(-1);
        let push = (joint.compliance(omega) * stiffness + 1.0).norm().recip() * stiffness * height;
        let push = if driven { push } else { 0.0 };
        let friction = machine.friction_at(speed);
        let moment = (machine.radial_coupling + friction).abs() * machine.blade_length;
        let casing = joint.casing_friction.hypot(1.0) / joint.casing_stiffness(omega).norm();
        let deep = push / stiffness;
        Forced {
            speed_rad_s: speed,
            s_rad_s: s,
            omega_rad_s: omega,
            amplitude_m: push * casing,
            blade_angle_rad: push * moment / joint.blade_stiffness(s).norm(),
            // A push is the stiffness of one blade times its depth; lobes of others drive none.
            all_press: here.preload_m() - self.smoothing_m > if driven { deep } else { height },
        }
    }
}
