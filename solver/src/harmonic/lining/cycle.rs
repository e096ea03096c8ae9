//! Limit cycles on a lining: waves of constant amplitude, at which the growth of rest ends because
//! blades lift off, or which exist over a clearance; and the small motions about any steady wave
//! (docs/theory.md, section 10).
//!
//! The conditions are `S(r) = -1/Re B(omega)` and `Im B(omega) = 0`: the stiffness of all blades
//! must match the joint compliance. The frequency is that in the limit of many blades, so the wave
//! is steady in a frame that rotates with it, where stability is an eigenvalue problem with eight
//! real states: casing and blade wave with their rates. With `z -> z e^{ist}` every time derivative
//! becomes `d/dt + i omega` for the casing and `d/dt + i s` for the blades; a steady state in the
//! blade frame has `omega = nu`, `s = 0`.

use nalgebra::{Complex, DMatrix};
use serde::Serialize;

use super::Lining;
use super::rest::Quartic;
use crate::harmonic::{HarmonicError, Joint, RoundWhirl, round_whirls};
use crate::numeric::eigen::eigenvalues;

/// A wave of constant amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
    pub fn cycles(&self, speed: f64) -> Result<Vec<Cycle>, HarmonicError> {
        let lining = self.at(speed);
        let joint = Joint::at(&self.machine, speed);
        let mut found = Vec::new();
        for wave in round_whirls(&joint) {
            for r in lining.amplitudes(wave.stiffness_n_per_m) {
                found.push(lining.cycle(&joint, speed, &wave, r)?);
            }
        }
        found.sort_by(|a: &Cycle, b| a.gap_amplitude_m.total_cmp(&b.gap_amplitude_m));
        Ok(found)
    }

    fn cycle(
        &self,
        joint: &Joint,
        speed: f64,
        wave: &RoundWhirl,
        r: f64,
    ) -> Result<Cycle, HarmonicError> {
        let stiffness = wave.stiffness_n_per_m;
        // A radial change of the amplitude changes the secant stiffness, a tangential one does not.
        let tangent = [[stiffness + self.stiffness_change(r), 0.0], [0.0, stiffness]];
        let turns = [wave.omega_rad_s, wave.s_rad_s];
        let mut values =
            small_motions(joint, turns, tangent).ok_or(HarmonicError::Unsettled { speed })?;
        // A wave shifted in time is the same wave, so one eigenvalue is zero.
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

    /// Returns whether waves of any amplitude stay bounded: very large ones, at which every blade
    /// lifts off for half of each revolution, must decay.
    #[must_use]
    pub fn is_bounded(&self, speed: f64) -> bool {
        let joint = Joint::at(&self.machine, speed);
        !Quartic::new(&joint, self.stiffness_far_out()).rest(speed).grows
    }
}

/// Real 2x2 matrix that acts on `(Re w, Im w)`.
pub(super) type Tangent = [[f64; 2]; 2];

/// Returns the eigenvalues, growth rate and frequency, of the motions about a wave with the casing
/// frequency `omega` and the blade frequency `s` \[rad/s\], whose contact force changes by
/// `dp = -tangent dw` \[N/m\]; `None` if the eigenvalues overflow.
pub(super) fn small_motions(
    joint: &Joint,
    [omega, s]: [f64; 2],
    tangent: Tangent,
) -> Option<Vec<Complex<f64>>> {
    let m = &*joint.machine;
    let friction = joint.casing_friction;
    let (kappa, length) = (m.radial_coupling, m.blade_length);
    // Blade coordinates are lengths at the tip; time is in units of the fastest frequency.
    let rate = omega.abs().max(s.abs()).max(m.omega_c).max(m.omega_bd);
    let lead = kappa + joint.machine.friction_at(joint.nu);
    let blade_mass = m.blade_modal_mass / (length * length);
    let mut matrix = DMatrix::zeros(8, 8);
    let parts = [
        (omega, m.casing_mass, m.casing_damping, m.casing_stiffness),
        (s, m.blade_modal_mass, m.blade_modal_damping, m.blade_modal_stiffness),
    ];
    for (part, (turn, mass, damping, stiffness)) in parts.into_iter().enumerate() {
        let (at, to) = (4 * part, 4 * part + 2);
        let (turn, drag) = (turn / rate, damping / (mass * rate));
        let spring = stiffness / (mass * rate * rate) - turn * turn;
        for k in 0..2 {
            matrix[(at + k, to + k)] = 1.0;
            matrix[(to + k, at + k)] -= spring;
            matrix[(to + k, to + k)] -= drag;
        }
        // Terms -(2 i turn) times the rate and -(i turn drag) times the displacement.
        for (row, column, sign) in [(0, 1, 1.0), (1, 0, -1.0)] {
            matrix[(to + row, to + column)] += sign * 2.0 * turn;
            matrix[(to + row, at + column)] += sign * turn * drag;
        }
    }
    // Contact force dp = -T (dz - kappa da), with da as a length at the tip.
    let square = rate * rate;
    for column in 0..2 {
        for (from, gain) in [(0, 1.0), (4, -kappa)] {
            let push = [-tangent[0][column] * gain, -tangent[1][column] * gain];
            let on_casing = [push[0] - friction * push[1], push[1] + friction * push[0]];
            for row in 0..2 {
                matrix[(2 + row, from + column)] += on_casing[row] / (m.casing_mass * square);
                matrix[(6 + row, from + column)] -= lead * push[row] / (blade_mass * square);
            }
        }
    }
    let values = eigenvalues(matrix)?;
    Some(values.into_iter().map(|value| value * rate).collect())
}
