//! Closed-form response of one damped coordinate, `y'' + 2 c y' + stiffness y = a` (docs/theory.md,
//! section 7).
//!
//! The solution is composed of two functions: `unit`, the motion from rest with unit rate, and
//! `ramp`, the motion from rest under `a = 1`, so that `ramp' = unit`. Both are entire functions of
//! `c` and `stiffness`: underdamped, overdamped and critically damped roots, `stiffness = 0` (the
//! casing at `Omega = Omega_c` in the blade frame) and `stiffness < 0` are the same formula,
//! evaluated in different ways only to limit round-off.
//!
//! The module also derives from it the gap of a side during free flight after the pulse.

use super::Plane;
use crate::model::{Machine, Operation};

/// Frequency of a damped oscillator, as a part of its damping, up to which it hardly swings.
const HARDLY_SWINGS: f64 = 0.3;

/// Radians of an oscillator below which its response is a power series: its closed form cancels
/// there.
const SHORT_TIME: f64 = 0.5;

/// Terms of a power series of order one that are below its round-off.
const SERIES_END: f64 = 1e-19;

/// Largest number of terms of the power series; for `rate * s = 1/2` the last one is below 1e-20.
const TERMS: usize = 18;

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
    /// Motion from unit displacement with zero rate, `1 - stiffness ramp`.
    pub hold: f64,
    /// Motion from rest with unit rate \[s\].
    pub unit: f64,
    /// Rate of `unit`.
    pub slope: f64,
    /// Motion from rest under unit forcing \[s^2\].
    pub ramp: f64,
}

impl Propagator {
    pub(super) fn new(damping: f64, stiffness: f64) -> Self {
        let discriminant = damping * damping - stiffness;
        Self { damping, stiffness, discriminant, root: discriminant.abs().sqrt() }
    }

    /// Returns the response after `s >= 0` seconds.
    pub(super) fn at(&self, s: f64) -> Response {
        let (c, q) = (self.damping, self.root);
        if self.discriminant > 0.0 && q * s > 0.2 {
            self.real_roots(s)
        } else if (c + q) * s < SHORT_TIME {
            self.series(s)
        } else {
            // Here stiffness s^2 > 0.05, so the division below loses no digits.
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
            let hold = decay * cos + c * unit;
            Response {
                hold,
                unit,
                slope: decay * cos - c * unit,
                ramp: (1.0 - hold) / self.stiffness,
            }
        }
    }

    /// Returns displacement and rate after the free motion of a response.
    pub(super) fn moved(&self, later: &Response, place: Plane, rate: Plane) -> (Plane, Plane) {
        let Response { hold, unit, slope, .. } = *later;
        (place * hold + rate * unit, rate * slope - place * (self.stiffness * unit))
    }

    fn real_roots(&self, s: f64) -> Response {
        let (c, q) = (self.damping, self.root);
        let (slow, fast) = (-self.stiffness / (c + q), -(c + q));
        let ([late, later], [early, earlier]) = (exponential(slow * s), exponential(fast * s));
        // Integral of exp(r s) from 0, smooth at r = 0.
        let integral = |r: f64, less: f64| if r == 0.0 { s } else { less / r };
        let unit = (later - earlier) / (q * 2.0);
        let slope = (slow * late - fast * early) / (q * 2.0);
        Response {
            hold: slope + c * 2.0 * unit,
            unit,
            slope,
            ramp: (integral(slow, later) - integral(fast, earlier)) / (q * 2.0),
        }
    }

    /// Evaluates the power series, for short times.
    fn series(&self, s: f64) -> Response {
        let drag = self.damping * 2.0 * s;
        let spring = self.stiffness * s * s;
        // `term` is the coefficient of s^n times s^(n-1), starting with n = 1.
        let (mut before, mut term) = (0.0, 1.0);
        let (mut slope, mut unit, mut ramp) = (1.0, 1.0, 0.5);
        for row in &STEPS {
            let next = -(drag * term + spring * before * row.over_n) * row.over_next;
            before = term;
            term = next;
            slope += next * row.next;
            unit += next;
            ramp += next * row.over_after;
            if next.abs() + before.abs() < SERIES_END {
                break;
            }
        }
        Response { hold: 1.0 - spring * ramp, unit: unit * s, slope, ramp: ramp * s * s }
    }
}

impl Propagator {
    /// Returns the damped angular frequency; `None` if the motion does not oscillate, or hardly
    /// does \[rad/s\].
    pub(super) fn swing(&self) -> Option<f64> {
        let swings = self.discriminant < 0.0 && self.root > HARDLY_SWINGS * self.damping;
        swings.then_some(self.root)
    }
}

/// Returns `exp(x)` and `exp(x) - 1`, both to full relative accuracy, from a single exponential.
fn exponential(x: f64) -> [f64; 2] {
    if x < -0.5 {
        let value = x.exp();
        [value, value - 1.0]
    } else {
        let less = x.exp_m1();
        [less + 1.0, less]
    }
}

/// Precomputed factors of the power series.
#[derive(Clone, Copy)]
struct Step {
    over_n: f64,
    over_next: f64,
    next: f64,
    over_after: f64,
}

const STEPS: [Step; TERMS] = {
    let zero = Step { over_n: 0.0, over_next: 0.0, next: 0.0, over_after: 0.0 };
    let mut steps = [zero; TERMS];
    let mut k = 0;
    while k < TERMS {
        let n = (k + 1) as f64;
        steps[k] = Step {
            over_n: 1.0 / n,
            over_next: 1.0 / (n + 1.0),
            next: n + 1.0,
            over_after: 1.0 / (n + 2.0),
        };
        k += 1;
    }
    steps
};

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
        let Response { mut ramp, mut unit, .. } = flight.at(t);
        if t > operation.pulse_s {
            let less = flight.at(t - operation.pulse_s);
            (ramp, unit) = (ramp - less.ramp, unit - less.unit);
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
                let [ramp, same] = integrated(c, stiffness, [0.0, 0.0], 1.0, s);
                let [hold, _] = integrated(c, stiffness, [1.0, 0.0], 0.0, s);
                // The integration accumulates about 20000 rounding errors.
                for (value, expected) in [
                    (response.unit, unit),
                    (response.slope, slope),
                    (response.ramp, ramp),
                    (response.unit, same),
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
        let propagator: Propagator = Propagator::new(40.0, 7e5);
        let response: Response = propagator.at(1e-12);
        assert!((response.ramp / 5e-25 - 1.0).abs() < 1e-9);
        assert!((response.unit / 1e-12 - 1.0).abs() < 1e-9);
    }
}
