//! Types that all solvers share: the state of a motion, the rotor, and the pulse.

use std::f64::consts::TAU;

use serde::Serialize;

use crate::scene::Scene;

/// The four modal coordinates and their rates at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct State {
    /// Time \[s\].
    pub t_s: f64,
    /// Casing coordinates `[u_c, u_s]` in the stationary frame \[m\].
    pub u: [f64; 2],
    /// Rates of the casing coordinates \[m/s\].
    pub v: [f64; 2],
    /// Blade coordinates `[alpha_c, alpha_s]` \[rad\].
    pub alpha: [f64; 2],
    /// Rates of the blade coordinates \[rad/s\].
    pub alpha_rate: [f64; 2],
}

impl State {
    /// Returns the amplitude of the casing wave, `|u|` \[m\].
    #[must_use]
    pub fn amplitude(&self) -> f64 {
        self.u[0].hypot(self.u[1])
    }
}

/// Rotor angle with a constant acceleration since some instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor {
    /// Time of the last change of speed or acceleration \[s\].
    since: f64,
    /// Angle at that time \[rad\].
    angle: f64,
    /// Speed at that time \[rad/s\].
    speed: f64,
    /// Acceleration since that time \[rad/s^2\].
    ramp: f64,
}

impl Rotor {
    /// Creates the rotor of a scene, with angle zero at t = 0.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        Self {
            since: 0.0,
            angle: 0.0,
            speed: scene.operation.speed_rad_s,
            ramp: scene.operation.speed_ramp_rad_s2,
        }
    }

    /// Returns the angle `theta(t)`, `theta' = Omega`, without whole turns before the last change
    /// \[rad\].
    #[must_use]
    pub fn angle(&self, t: f64) -> f64 {
        let elapsed = t - self.since;
        self.angle + (self.speed + 0.5 * self.ramp * elapsed) * elapsed
    }

    /// Returns the speed `Omega(t)` \[rad/s\].
    #[must_use]
    pub fn speed(&self, t: f64) -> f64 {
        self.speed + self.ramp * (t - self.since)
    }

    /// Returns the speed at `t`; `None` if speed or acceleration were changed after `t` \[rad/s\].
    pub fn known_speed(&self, t: f64) -> Option<f64> {
        (t >= self.since).then(|| self.speed(t))
    }

    /// Returns the mean speed over the last `window` seconds before `t`, or since the last change
    /// if that is later \[rad/s\].
    #[must_use]
    pub fn mean_speed(&self, t: f64, window: f64) -> f64 {
        self.speed(0.5 * (t + (t - window).max(self.since)))
    }

    /// Returns the acceleration \[rad/s^2\].
    #[must_use]
    pub fn ramp(&self) -> f64 {
        self.ramp
    }

    /// Sets speed and acceleration from `t` on; the angle is continuous.
    pub fn change(&mut self, t: f64, speed: f64, ramp: f64) {
        // Whole turns are dropped to keep digits; n_d is an integer, so the gaps do not change.
        self.angle = self.angle(t) % TAU;
        self.since = t;
        self.speed = speed;
        self.ramp = ramp;
    }
}

/// Rectangular force pulse on the equation of `u_c`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// Start \[s\].
    pub start: f64,
    /// End \[s\].
    pub end: f64,
    /// Force \[N\].
    pub force: f64,
}

impl Pulse {
    /// Creates the pulse of a scene, which starts at t = 0.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        Self { start: 0.0, end: scene.operation.pulse_s, force: scene.operation.pulse_n }
    }

    /// Returns the force at an instant \[N\].
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        if (self.start..self.end).contains(&t) { self.force } else { 0.0 }
    }

    /// Returns the mean force over `[from, to]`, so that the impulse is exactly `F t_p` for any
    /// step \[N\].
    #[must_use]
    pub fn mean(&self, from: f64, to: f64) -> f64 {
        let overlap = to.min(self.end) - from.max(self.start);
        if overlap > 0.0 { self.force * (overlap / (to - from)) } else { 0.0 }
    }

    /// Returns the mean force over the step centred on `t = n step`; for `n = 0` over its second
    /// half, because the motion begins there \[N\].
    #[must_use]
    pub fn mean_of_step(&self, n: u64, step: f64) -> f64 {
        let (t, half) = (n as f64 * step, 0.5 * step);
        self.mean(if n == 0 { 0.0 } else { t - half }, t + half)
    }
}
