//! Waves of constant amplitude on a lining: where the growth of rest ends as blades
//! lift off, and the whirl over a clearance (docs/theory.md, section 10).
//!
//! `S(r) = -1/Re B(omega)`, `Im B(omega) = 0`: the blades together must be as stiff as
//! the joint asks. The frequency is that of a rim of many blades, so the wave is steady
//! in a frame that turns with it, and its stability needs only eigenvalues there.

use serde::Serialize;

use super::roots::Quartic;
use super::{Lining, flow};
use crate::harmonic::{HarmonicError, Joint, RimWave, rim_waves};

/// A wave of constant amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cycle {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Its frequency in the standing frame \[rad/s\].
    pub omega_rad_s: f64,
    /// Its frequency in the frame of the blades, `omega - nu` \[rad/s\].
    pub s_rad_s: f64,
    /// Stiffness of all blades together, `S = |p|/|w|` \[N/m\].
    pub stiffness_n_per_m: f64,
    /// Amplitude `r = |w|` of the wave in the gaps \[m\].
    pub gap_amplitude_m: f64,
    /// Amplitude `|z|` of the casing \[m\].
    pub casing_m: f64,
    /// Amplitude `|a|` of the blades \[rad\].
    pub blade_rad: f64,
    /// Growth of the least stable motion about it, beside a mere shift of it in time
    /// \[1/s\].
    pub growth_1_s: f64,
    /// Whether every such motion decays.
    pub stable: bool,
}

/// What a wave on a lining comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Whirl {
    /// Every wave decays.
    Decays,
    /// A wave of constant amplitude, the smallest stable one.
    Cycle(Cycle),
    /// No wave is large enough to stop its growth.
    Unbounded,
    /// Rest grows and waves far out decay, but none of constant amplitude is stable, as
    /// without damping.
    Unsteady,
}

impl Lining<'_> {
    /// Every wave of constant amplitude at a speed \[rad/s\], by increasing amplitude.
    ///
    /// # Errors
    /// Stiffnesses that differ by too many powers of ten.
    pub fn cycles(&self, speed: f64) -> Result<Vec<Cycle>, HarmonicError> {
        let joint = Joint::at(self.machine, speed);
        let mut found = Vec::new();
        for wave in rim_waves(&joint) {
            for r in self.amplitudes(wave.stiffness_n_per_m) {
                found.push(self.cycle(&joint, speed, &wave, r)?);
            }
        }
        found.sort_by(|a: &Cycle, b| a.gap_amplitude_m.total_cmp(&b.gap_amplitude_m));
        Ok(found)
    }

    fn cycle(
        &self,
        joint: &Joint,
        speed: f64,
        wave: &RimWave,
        r: f64,
    ) -> Result<Cycle, HarmonicError> {
        let stiffness = wave.stiffness_n_per_m;
        // Along the wave the stiffness changes with the amplitude, across it does not.
        let tangent = [[stiffness + self.stiffness_change(r), 0.0], [0.0, stiffness]];
        let turns = [wave.omega_rad_s, wave.s_rad_s];
        let mut values =
            flow::eigenvalues(joint, turns, tangent).ok_or(HarmonicError::Unsettled { speed })?;
        // The wave shifted in time is the same wave: one eigenvalue is zero.
        values.sort_by(|a, b| a.norm_sqr().total_cmp(&b.norm_sqr()));
        let growth = values.iter().skip(1).map(|value| value.re).fold(f64::MIN, f64::max);
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

    /// Whether waves of any amplitude stay bounded: far out, where every blade lifts off
    /// for half of each turn, they decay.
    #[must_use]
    pub fn is_bounded(&self, speed: f64) -> bool {
        let joint = Joint::at(self.machine, speed);
        !Quartic::new(&joint, self.stiffness_far_out()).rest(speed).grows
    }

    /// What a wave comes to at a speed \[rad/s\]: with preload one that grows from rest,
    /// with a clearance one that was large enough to touch.
    ///
    /// # Errors
    /// Stiffnesses that differ by too many powers of ten.
    pub fn whirl(&self, speed: f64) -> Result<Whirl, HarmonicError> {
        let stable = self.cycles(speed)?.into_iter().find(|cycle| cycle.stable);
        Ok(match stable {
            Some(cycle) => Whirl::Cycle(cycle),
            None if !self.is_bounded(speed) => Whirl::Unbounded,
            None if self.rest(speed).grows => Whirl::Unsteady,
            None => Whirl::Decays,
        })
    }
}
