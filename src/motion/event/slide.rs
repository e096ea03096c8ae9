//! Sliding on one side of the polygon at a constant rotor speed, no pulse: the
//! motion and the push along a side of docs/theory.md, section 5. `y` grows backward,
//! towards decreasing angle: `y = g0 tan delta` is the corner with the side of next
//! lower phase.

use super::advancement::{curved_step, leaving_step};
use super::parameters::{Drive, Parameters};
use crate::motion::Plane;
use crate::motion::propagator::Propagator;

/// Sliding on `side` from `y` with rate `rate`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slide {
    pub side: u32,
    /// Position along the side, backward from its middle \[m\].
    pub y: f64,
    /// Its rate \[m/s\].
    pub rate: f64,
    propagator: Propagator,
    /// Acceleration at rest at the start \[m/s^2\].
    pull: f64,
}

/// Position, rate and push at one instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Along {
    /// Position along the side \[m\].
    pub y: f64,
    /// Its rate \[m/s\].
    pub rate: f64,
    /// Push per unit mass \[m/s^2\].
    pub push: f64,
}

impl Along {
    /// Place and rate in a frame where the side's gap opens along `direction`, and
    /// which sees the side turn with `spin` \[rad/s\].
    pub(super) fn seen(&self, clearance: f64, (direction, spin): (Plane, f64)) -> (Plane, Plane) {
        let place = Plane::new(-clearance, self.y);
        let rate = Plane::new(0.0, self.rate) + Plane::i() * place * spin;
        (place * direction, rate * direction)
    }
}

/// What one look ahead along a side finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ahead {
    /// No event before this time.
    Until(f64),
    /// The upper (`true`) or lower end of the side is reached now.
    Edge(bool),
    /// The push vanishes now.
    Release,
    /// The motion grows too fast to be followed.
    Lost,
}

impl Slide {
    pub(super) fn new(
        parameters: &Parameters,
        drive: &Drive,
        side: u32,
        y: f64,
        rate: f64,
    ) -> Self {
        let propagator = propagator(parameters, drive.nu);
        let drag = 2.0 * parameters.damping * drive.nu * parameters.clearance;
        Self { side, y, rate, propagator, pull: drag - propagator.stiffness * y }
    }

    /// Displacement from the start and rate, `s` seconds on.
    fn moved(&self, s: f64) -> (f64, f64) {
        let response = self.propagator.at(s);
        let displacement = self.rate * response.unit + self.pull * response.ramp;
        (displacement, self.rate * response.slope + self.pull * response.unit)
    }

    pub(super) fn at(&self, parameters: &Parameters, drive: &Drive, s: f64) -> Along {
        let (displacement, rate) = self.moved(s);
        let y = self.y + displacement;
        Along { y, rate, push: parameters.push(drive.nu, 0.0, y, rate, 0.0) }
    }

    /// Fastest rate of the motion along the side \[1/s\].
    pub(super) fn fastest(&self) -> f64 {
        2.0 * self.propagator.damping + self.propagator.stiffness.abs().sqrt()
    }

    /// Looks ahead from `s`, before which nothing happens.
    pub(super) fn look(&self, parameters: &Parameters, drive: &Drive, s: f64) -> Ahead {
        let (displacement, rate) = self.moved(s);
        let (kappa, c, nu) = (self.propagator.stiffness, self.propagator.damping, drive.nu);
        let pull = self.pull - kappa * displacement;
        let acceleration = pull - 2.0 * c * rate;
        let third = -2.0 * c * acceleration - kappa * rate;
        // The motion from here on, relative to here, and its derivatives are
        // bounded by their scale now times exp(fastest * t), one more factor
        // `fastest` each; over `span` the exponential is below 1.65.
        let fastest = self.fastest();
        let span = if fastest > 0.0 { 0.5 / fastest } else { f64::INFINITY };
        let bend = 1.65 * (rate.abs() * fastest + pull.abs());
        let jerk = bend * fastest;
        let mut stride = span;
        for up in [true, false] {
            let sign = if up { -1.0 } else { 1.0 };
            let room = parameters.half_side + sign * self.y;
            let gap = room + sign * displacement;
            let closing = sign * rate;
            let noise = parameters.tolerance * (room + self.rate.abs() * s);
            if s == 0.0 && room == 0.0 && rate == 0.0 {
                let jounce = jerk * fastest;
                stride = stride.min(leaving_step(sign * acceleration, sign * third, jounce));
            } else if gap <= noise && closing < 0.0 {
                return Ahead::Edge(up);
            } else {
                let gap = gap.max(0.0) + noise;
                stride = stride.min(curved_step(gap, closing, sign * acceleration, jerk, span));
            }
        }
        let y = self.y + displacement;
        let push = parameters.push(nu, 0.0, y, rate, 0.0);
        let push_rate = -2.0 * nu * (acceleration + c * rate);
        let noise = push_noise(parameters, nu, y, rate, 0.0);
        if push <= noise && push_rate < 0.0 {
            return Ahead::Release;
        }
        let push_bend = -2.0 * nu * (third + c * acceleration);
        let push_jerk = 2.0 * nu.abs() * jerk * (fastest + c);
        let push = push.max(0.0) + noise;
        stride = stride.min(curved_step(push, push_rate, push_bend, push_jerk, span));
        Ahead::Until((s + stride).max(s.next_up()))
    }
}

/// Response along a side at the wave frequency `nu`. The difference of squares
/// is taken as a product, so that it is exactly zero at `nu = omega_c`.
pub(super) fn propagator(parameters: &Parameters, nu: f64) -> Propagator {
    Propagator::new(parameters.damping, (parameters.omega - nu) * (parameters.omega + nu))
}

/// Round-off of the push \[m/s^2\].
pub(super) fn push_noise(parameters: &Parameters, nu: f64, y: f64, rate: f64, pulse: f64) -> f64 {
    let square = (parameters.omega * parameters.omega).max(nu * nu);
    parameters.tolerance
        * (square * (parameters.clearance + y.abs()) + 2.0 * nu.abs() * rate.abs() + pulse.abs())
}
