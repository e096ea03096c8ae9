//! The gap of one side while nothing touches, of any kind of number: the casing is a
//! damped oscillator under the pulse, and the blades only turn by (docs/theory.md,
//! section 7).

use super::propagator::Propagator;
use crate::model::{Machine, Number, Operation};

/// The casing from rest to its first contact, with rigid blades.
#[derive(Clone, Copy, Debug)]
pub struct FreeFlight<'a, T> {
    /// The machine.
    pub machine: &'a Machine<T>,
    /// Rotor and pulse.
    pub operation: &'a Operation<T>,
}

impl<T: Number> FreeFlight<'_, T> {
    /// The change of the gap of a side at `t` \[s\] by one newton of pulse \[m/N\]: the
    /// gap is the clearance and this times the pulse.
    #[must_use]
    pub fn gap_by_pulse(&self, side: u32, t: T) -> T {
        let Self { machine, operation } = *self;
        let omega = machine.omega_c;
        let flight = Propagator::new(machine.casing_damping_ratio * omega, omega * omega);
        let mut ramp = flight.at(t).ramp;
        if t.re() > operation.pulse_s.re() {
            ramp -= flight.at(t - operation.pulse_s).ramp;
        }
        let rotor = (operation.speed_rad_s + operation.speed_ramp_rad_s2 * t * 0.5) * t;
        let (turn_sin, turn_cos) = machine.nu(rotor).sin_cos();
        let (c, s) = machine.polygon.direction(side);
        ramp / machine.casing_mass * (turn_cos * c - turn_sin * s)
    }
}
