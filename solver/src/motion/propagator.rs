//! Closed-form response of one damped coordinate, `y'' + 2 c y' + stiffness y = a` (docs/theory.md,
//! section 7).
//!
//! The free motion is composed of `unit`, the motion from rest with unit rate, and its rate; the
//! motion from rest under `a = 1` is its integral. All are entire functions of `c` and `stiffness`:
//! underdamped, overdamped and critically damped roots, `stiffness = 0` (the casing at `Omega =
//! Omega_c` in the blade frame) and `stiffness < 0` are the same formula, evaluated in different ways
//! only to limit round-off.
//!
//! The module also derives from it the gap of a side during free flight after the pulse.

use super::Plane;
use crate::model::{Machine, Operation};
use crate::numeric::quadrature::GAUSS_6;

/// Frequency of a damped oscillator, as a part of its damping, up to which it hardly swings.
const HARDLY_SWINGS: f64 = 0.3;

/// Half the difference of two real roots, times the time, from which on their exponentials are subtracted.
const FAR_APART: f64 = 0.2;

/// Radians of an oscillator below which its response to a constant force is integrated: the closed
/// form cancels there.
const SHORT_TIME: f64 = 0.5;

/// Coefficients of the equation, prepared for evaluation at any time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Propagator {
    /// Damping `c` \[1/s\], zero or more.
    pub damping: f64,
    /// Stiffness per unit mass, of any sign \[1/s^2\].
    pub stiffness: f64,
    /// Discriminant `c^2 - stiffness`; negative for complex roots.
    discriminant: f64,
    /// Square root of the magnitude of the discriminant.
    root: f64,
}

/// Response at one instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Response {
    /// Motion from unit displacement with zero rate.
    pub hold: f64,
    /// Motion from rest with unit rate \[s\].
    pub unit: f64,
    /// Rate of `unit`.
    pub slope: f64,
}

impl Propagator {
    pub(super) fn new(damping: f64, stiffness: f64) -> Self {
        let discriminant = damping * damping - stiffness;
        Self { damping, stiffness, discriminant, root: discriminant.abs().sqrt() }
    }

    /// Returns the response after `s >= 0` seconds.
    pub(super) fn at(&self, s: f64) -> Response {
        let (c, q) = (self.damping, self.root);
        if self.discriminant > 0.0 && q * s > FAR_APART {
            // The slow root as a quotient, which does not cancel.
            let (slow, fast) = (-self.stiffness / (c + q), -(c + q));
            let (late, early) = ((slow * s).exp(), (fast * s).exp());
            let (unit, slope) =
                ((late - early) / (2.0 * q), (slow * late - fast * early) / (2.0 * q));
            return Response { hold: slope + 2.0 * c * unit, unit, slope };
        }
        let (cos, sin) = if self.discriminant > 0.0 {
            ((q * s).cosh(), (q * s).sinh() / q)
        } else if q > 0.0 {
            let (sin, cos) = (q * s).sin_cos();
            (cos, sin / q)
        } else {
            // A double root.
            (1.0, s)
        };
        let decay = (-c * s).exp();
        let unit = decay * sin;
        Response { hold: decay * cos + c * unit, unit, slope: decay * cos - c * unit }
    }

    /// Returns the motion from rest under unit forcing, of a stiffness above zero \[s^2\].
    fn ramp(&self, s: f64) -> f64 {
        if (self.damping + self.root) * s > SHORT_TIME {
            return (1.0 - self.at(s).hold) / self.stiffness;
        }
        let half = 0.5 * s;
        let both = |node: f64| self.at(half - half * node).unit + self.at(half + half * node).unit;
        GAUSS_6.iter().map(|(node, weight)| half * weight * both(*node)).sum()
    }

    /// Returns displacement and rate after the free motion of a response.
    pub(super) fn moved(&self, later: &Response, place: Plane, rate: Plane) -> (Plane, Plane) {
        let Response { hold, unit, slope, .. } = *later;
        (place * hold + rate * unit, rate * slope - place * (self.stiffness * unit))
    }

    /// Returns the damped angular frequency; `None` if the motion does not oscillate, or hardly
    /// does \[rad/s\].
    pub(super) fn swing(&self) -> Option<f64> {
        let swings = self.discriminant < 0.0 && self.root > HARDLY_SWINGS * self.damping;
        swings.then_some(self.root)
    }
}

/// Free motion of the casing from rest to its first contact, with rigid blades.
#[derive(Clone, Copy, Debug)]
pub struct FreeFlight<'a> {
    /// Machine, whose blades are taken as rigid.
    pub machine: &'a Machine,
    /// Rotor speed and pulse.
    pub operation: &'a Operation,
}

impl FreeFlight<'_> {
    /// Returns the casing displacement at `t` per unit of pulse force \[m/N\], the rotation of the
    /// blades relative to the wave until then \[rad\], and the rates of both.
    #[must_use]
    pub fn moved_by_pulse(&self, t: f64) -> [(f64, f64); 2] {
        let Self { machine, operation } = *self;
        let omega = machine.omega_c;
        let flight = Propagator::new(machine.casing_damping_ratio * omega, omega * omega);
        let (mut ramp, mut unit) = (flight.ramp(t), flight.at(t).unit);
        if t > operation.pulse_s {
            let later = t - operation.pulse_s;
            (ramp, unit) = (ramp - flight.ramp(later), unit - flight.at(later).unit);
        }
        let gained = operation.speed_ramp_rad_s2 * t;
        let [angle, speed] =
            [(operation.speed_rad_s + 0.5 * gained) * t, operation.speed_rad_s + gained];
        let mass = machine.casing_mass;
        [(ramp / mass, machine.nu(angle)), (unit / mass, machine.nu(speed))]
    }

    /// Returns the change of a side's gap at `t` per unit of pulse force \[m/N\], and its rate. The
    /// gap is the clearance plus this value times the pulse.
    #[must_use]
    pub fn gap_by_pulse(&self, side: u32, t: f64) -> [f64; 2] {
        let [(moved, turn), (rate, turn_rate)] = self.moved_by_pulse(t);
        let (turn_sin, turn_cos) = turn.sin_cos();
        let (c, s) = self.machine.polygon.direction(side);
        let (along, across) = (turn_cos * c - turn_sin * s, turn_sin * c + turn_cos * s);
        [moved * along, rate * along - moved * turn_rate * across]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integrates by the classical Runge-Kutta method, with steps so short that only round-off
    /// remains.
    fn integrated(c: f64, stiffness: f64, start: [f64; 2], a: f64, s: f64) -> [f64; 2] {
        let steps = 20_000;
        let h = s / f64::from(steps);
        let rate = |x: [f64; 2]| [x[1], a - 2.0 * c * x[1] - stiffness * x[0]];
        let along = |x: [f64; 2], k: [f64; 2], h: f64| [x[0] + h * k[0], x[1] + h * k[1]];
        let mut x = start;
        for _ in 0..steps {
            let k1 = rate(x);
            let k2 = rate(along(x, k1, 0.5 * h));
            let k3 = rate(along(x, k2, 0.5 * h));
            let k4 = rate(along(x, k3, h));
            for i in 0..2 {
                x[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
        x
    }

    #[test]
    fn every_kind_of_root_agrees_with_an_integration() {
        for (c, stiffness) in [
            (0.0, 1.0),
            (0.05, 1.0),
            (1.0, 1.0),
            (1.0, 1.0 + 1e-9),
            (1.0, 1.0 - 1e-9),
            (0.97, 1.0),
            (3.0, 1.0),
            (0.3, 0.0),
            (0.0, 0.0),
            (0.3, 1e-13),
            (0.05, -2.0),
            (0.0, -2.0),
            (2.0, 1e-3),
        ] {
            let propagator = Propagator::new(c, stiffness);
            for s in [1e-9, 1e-3, 0.11, 0.3, 0.49, 0.51, 0.8, 1.7, 5.0] {
                let response = propagator.at(s);
                let [unit, slope] = integrated(c, stiffness, [0.0, 1.0], 0.0, s);
                let [ramp, _] = integrated(c, stiffness, [0.0, 0.0], 1.0, s);
                let own = if stiffness > 1e-9 { propagator.ramp(s) } else { ramp };
                let [hold, _] = integrated(c, stiffness, [1.0, 0.0], 0.0, s);
                // The integration accumulates about 20000 rounding errors.
                for (value, expected) in [
                    (response.unit, unit),
                    (response.slope, slope),
                    (own, ramp),
                    (response.hold, hold),
                ] {
                    let error =
                        (value - expected).abs() / expected.abs().max(slope.abs()).max(unit);
                    assert!(
                        error < 1e-11,
                        "c {c}, stiffness {stiffness}, s {s}: {value} {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn short_times_keep_relative_digits() {
        let propagator = Propagator::new(40.0, 7e5);
        assert!((propagator.ramp(1e-12) / 5e-25 - 1.0).abs() < 1e-9);
        assert!((propagator.at(1e-12).unit / 1e-12 - 1.0).abs() < 1e-9);
    }
}
