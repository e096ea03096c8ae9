//! Limit cycles on a lining: waves of constant amplitude, with preload or with a clearance, and the
//! small motions about any steady wave (docs/theory.md, section 10). With preload, growth from rest
//! ends in such a wave because blades lift off.
//!
//! The conditions are `S(r) = -1/Re B(omega)` and `Im B(omega) = 0`: the stiffness of all blades
//! must match the joint compliance. The frequency is that in the limit of many blades, so the wave
//! is steady in a frame that rotates with it, where stability is an eigenvalue problem with eight
//! real states: casing and blade wave with their rates (`model::Frame`).

use super::Lining;
use super::rest::Rest;
use crate::harmonic::{RoundWhirl, error, round_whirls};
use crate::model::{Frame, Row, growth_about_wave};
use crate::scene::SceneError;

/// A wave of constant amplitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Frequency in the stationary frame \[rad/s\].
    pub omega_rad_s: f64,
    /// Frequency in the blade frame, `omega - nu` \[rad/s\].
    pub s_rad_s: f64,
    /// Stiffness of all blades against the wave, `S = |p|/|w|` \[N/m\].
    pub stiffness_n_per_m: f64,
    /// Amplitude `r = |w|` of the relative displacement, that is of the gaps \[m\].
    pub gap_amplitude_m: f64,
    /// Amplitude `|z|` of the casing \[m\].
    pub casing_m: f64,
    /// Amplitude `|a|` of the blades \[rad\].
    pub blade_rad: f64,
    /// Growth rate of the least stable small motion about the wave, other than a shift in time
    /// \[1/s\].
    pub growth_1_s: f64,
    /// Whether all those motions decay.
    pub stable: bool,
}

impl Lining<'_> {
    /// Returns every wave of constant amplitude at a speed \[rad/s\], by increasing amplitude.
    ///
    /// # Errors
    /// The stiffnesses differ by too many powers of ten.
    pub fn cycles(&self, speed: f64) -> Result<Vec<Cycle>, SceneError> {
        let lining = self.at(speed);
        let mut found = Vec::new();
        for wave in round_whirls(&self.machine, speed) {
            for r in lining.amplitudes(wave.stiffness_n_per_m) {
                found.push(lining.cycle(speed, &wave, r)?);
            }
        }
        found.sort_by(|a: &Cycle, b| a.gap_amplitude_m.total_cmp(&b.gap_amplitude_m));
        Ok(found)
    }

    fn cycle(&self, speed: f64, wave: &RoundWhirl, r: f64) -> Result<Cycle, SceneError> {
        let stiffness = wave.stiffness_n_per_m;
        let frame = Frame::at(&self.machine, speed).turning(wave.s_rad_s);
        // A change of the amplitude alters the secant stiffness; a change of the phase does not.
        let [radial, tangential] = [(1.0, 0.0), (0.0, 1.0)].map(|way| Row::fixed(&frame, way));
        let springs = [(radial, stiffness + self.stiffness_of_wave(r)[1]), (tangential, stiffness)];
        let growth = growth_about_wave(&frame.motion(&[], &springs));
        let growth = growth.ok_or_else(|| error::unsettled(speed))?;
        Ok(Cycle {
            speed_rad_s: speed,
            omega_rad_s: wave.omega_rad_s,
            s_rad_s: wave.s_rad_s,
            stiffness_n_per_m: stiffness,
            gap_amplitude_m: r,
            casing_m: wave.casing_per_w * r,
            blade_rad: wave.blades_per_w * r,
            growth_1_s: growth,
            stable: growth < 0.0,
        })
    }

    /// Returns whether waves of any amplitude stay bounded: very large ones, at which every blade
    /// lifts off for half of each revolution, must decay.
    #[must_use]
    pub fn is_bounded(&self, speed: f64) -> bool {
        !Rest::new(&self.machine, speed, self.stiffness_far_out()).grows
    }
}
