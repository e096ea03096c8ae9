//! All blades rub on an out-of-round casing (docs/theory.md, section 11): `m` lobes drive one wave
//! if `m = +-n_d` modulo `N`, with the force `p = -S0 e/(1 + S0 B(s))`, and none otherwise.

use super::Lining;
use crate::model::Frame;

/// Wave that the lobes of the casing drive at one rotor speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forced {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Frequency of the wave in the blade frame; negative if it runs backward over the blades
    /// \[rad/s\].
    pub s_rad_s: f64,
    /// Frequency in the stationary frame \[rad/s\].
    pub omega_rad_s: f64,
    /// Amplitude `|z|` of the casing wave; 0 if the lobes drive none \[m\].
    pub amplitude_m: f64,
    /// Largest blade angle \[rad\].
    pub blade_angle_rad: f64,
    /// Whether every blade is always in contact, as these equations assume.
    pub all_press: bool,
}

impl Lining<'_> {
    /// Returns the wave driven by `lobes` lobes of the given height \[m\] at a speed \[rad/s\],
    /// with all blades in contact.
    #[must_use]
    pub fn forced(&self, speed: f64, lobes: u32, height: f64) -> Forced {
        let here = self.at(speed);
        let (frame, machine) = (Frame::at(&self.machine, speed), &here.machine);
        let (blades, lobes) = (i64::from(machine.polygon.blades), i64::from(lobes));
        let diameters = i64::from(machine.polygon.nodal_diameters);
        let meets = |sense: i64| (lobes - sense * diameters).rem_euclid(blades) == 0;
        let sense = if meets(1) { -1.0 } else { 1.0 };
        let s = sense * lobes as f64 * speed;
        let omega = s + frame.casing.turn;
        let stiffness = 0.5 * blades as f64 * self.law.stiffness_n_per_m;
        let driven = meets(1) || meets(-1);
        let push =
            (frame.turning(s).compliance() * stiffness + 1.0).norm().recip() * stiffness * height;
        let push = if driven { push } else { 0.0 };
        let casing = frame.friction.hypot(1.0) / frame.casing.dynamic_stiffness(omega).norm();
        let deep = push / stiffness;
        Forced {
            speed_rad_s: speed,
            s_rad_s: s,
            omega_rad_s: omega,
            amplitude_m: push * casing,
            blade_angle_rad: push * frame.lever.abs() / frame.blades.dynamic_stiffness(s).norm(),
            // Change of depth: force divided by the stiffness of all blades; lobes that drive no
            // wave change it by their height.
            all_press: here.preload_m() - self.law.smoothing_m > if driven { deep } else { height },
        }
    }
}
