//! The energy balance: work of pulse and rotor against what is stored,
//! dissipated and lost in impacts.
//! (docs/theory.md, section 7.)
//!
//! Each part is integrated on its own from the closed-form motion, so that the
//! balance can fail: dissipation from the exponentials of the flight or by
//! Gauss quadrature along a side, the rotor's work from the pushes (a push `N`
//! at `y` takes the power `-N nu y` from the rotor), the losses from the
//! closing speeds. Only the summed part of a rocking motion is booked at its
//! balance.

use super::free::Free;
use super::parameters::{Drive, Parameters};
use crate::motion::Plane;
use crate::motion::event::quadrature::damped;

/// Energies per unit casing mass \[m^2/s^2\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EnergyBalance {
    /// Kinetic and potential energy at the start.
    pub start: f64,
    /// Work of the pulse.
    pub pulse: f64,
    /// Work of the rotor through the contact.
    pub rotor: f64,
    /// Dissipated by the casing damping.
    pub dissipated: f64,
    /// Lost in impacts.
    pub lost: f64,
}

impl EnergyBalance {
    /// What is missing from the balance at a state of this energy.
    pub(super) fn residual(&self, energy: f64) -> f64 {
        self.pulse + self.rotor - (energy - self.start) - self.dissipated - self.lost
    }
}

/// Kinetic and potential energy of the casing per unit mass.
pub(super) fn energy(parameters: &Parameters, u: Plane, v: Plane) -> f64 {
    0.5 * (v.norm_sqr() + parameters.propagator.stiffness * u.norm_sqr())
}

/// Energy dissipated in `s` seconds of free flight, by the casing and by the
/// blades.
pub(super) fn dissipated(parameters: &Parameters, drive: &Drive, free: &Free, s: f64) -> f64 {
    let centre = drive.pulse / parameters.propagator.stiffness;
    let from = free.place - Plane::new(centre, 0.0);
    let casing = damped(&parameters.propagator, from, free.rate, s);
    let blades = parameters.blades.map_or(0.0, |blades| {
        blades.mass * damped(&blades.propagator, free.tips.angle, free.tips.rate, s)
    });
    casing + blades
}
