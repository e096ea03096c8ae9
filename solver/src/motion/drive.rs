//! What every solver shares: the state it reports, the rotor that turns and the
//! pulse that starts the motion.

use std::f64::consts::TAU;

use serde::Serialize;

use crate::scene::Scene;

/// The four coordinates and their rates at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct State {
    /// Time \[s\].
    pub t_s: f64,
    /// Casing coordinates `[u_c, u_s]`, standing frame \[m\].
    pub u: [f64; 2],
    /// Their rates \[m/s\].
    pub v: [f64; 2],
    /// Blade coordinates `[alpha_c, alpha_s]` \[rad\].
    pub alpha: [f64; 2],
    /// Their rates \[rad/s\].
    pub alpha_rate: [f64; 2],
}

impl State {
    /// Amplitude of the casing wave, `|u|` \[m\].
    #[must_use]
    pub fn amplitude(&self) -> f64 {
        self.u[0].hypot(self.u[1])
    }
}

/// The rotor angle: a speed and a constant acceleration from some instant on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor {
    since: f64,
    angle: f64,
    speed: f64,
    ramp: f64,
}

impl Rotor {
    /// Rotor of a scene: angle zero at t = 0.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        Self {
            since: 0.0,
            angle: 0.0,
            speed: scene.operation.speed_rad_s,
            ramp: scene.operation.speed_ramp_rad_s2,
        }
    }

    /// Angle `theta(t)`, `theta' = Omega` \[rad\].
    #[must_use]
    pub fn angle(&self, t: f64) -> f64 {
        let elapsed = t - self.since;
        self.angle + (self.speed + 0.5 * self.ramp * elapsed) * elapsed
    }

    /// Speed `Omega(t)` \[rad/s\].
    #[must_use]
    pub fn speed(&self, t: f64) -> f64 {
        self.speed + self.ramp * (t - self.since)
    }

    /// The speed at `t`, unless another speed or acceleration held then \[rad/s\].
    pub fn known_speed(&self, t: f64) -> Option<f64> {
        (t >= self.since).then(|| self.speed(t))
    }

    /// Mean speed over the last `window` seconds before `t`, as far as this speed
    /// and acceleration reach back \[rad/s\].
    #[must_use]
    pub fn mean_speed(&self, t: f64, window: f64) -> f64 {
        self.speed(0.5 * (t + (t - window).max(self.since)))
    }

    /// Acceleration \[rad/s^2\].
    #[must_use]
    pub fn ramp(&self) -> f64 {
        self.ramp
    }

    /// From `t` on, turn with this speed and acceleration; the angle goes on.
    pub fn change(&mut self, t: f64, speed: f64, ramp: f64) {
        // Whole turns are dropped to keep digits; n_d is whole, so gaps do not notice.
        self.angle = self.angle(t) % TAU;
        self.since = t;
        self.speed = speed;
        self.ramp = ramp;
    }
}

/// A rectangular pulse on the `u_c` equation.
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
    /// Pulse of a scene, from t = 0.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        Self { start: 0.0, end: scene.operation.pulse_s, force: scene.operation.pulse_n }
    }

    /// Force at an instant \[N\].
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        if (self.start..self.end).contains(&t) { self.force } else { 0.0 }
    }

    /// Mean force over `[from, to]`, so that steps of any size sum to exactly
    /// `F t_p` \[N\].
    #[must_use]
    pub fn mean(&self, from: f64, to: f64) -> f64 {
        let overlap = to.min(self.end) - from.max(self.start);
        if overlap > 0.0 { self.force * (overlap / (to - from)) } else { 0.0 }
    }

    /// Mean force over the step of this length centred on `t = n step`; at n = 0 over its
    /// second half, which is all there is of it \[N\].
    #[must_use]
    pub fn mean_of_step(&self, n: u64, step: f64) -> f64 {
        let (t, half) = (n as f64 * step, 0.5 * step);
        self.mean(if n == 0 { 0.0 } else { t - half }, t + half)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pulse_means_sum_to_the_impulse_at_any_step() {
        let pulse = Pulse { start: 0.0, end: 50e-6, force: 20e3 };
        for step in [1e-3, 7.3e-5, 1e-5, 3.1e-7] {
            let first = 0.5 * pulse.mean(0.0, 0.5 * step);
            let later: f64 = (1..2000)
                .map(|n| pulse.mean((f64::from(n) - 0.5) * step, (f64::from(n) + 0.5) * step))
                .sum();
            let impulse = step * (first + later);
            assert!((impulse - 1.0).abs() < 1e-12, "{impulse} at {step}");
        }
    }

    #[test]
    fn a_changed_rotor_goes_on_from_its_angle() {
        let mut rotor = Rotor { since: 0.0, angle: 0.0, speed: 500.0, ramp: -100.0 };
        let before = rotor.angle(0.02);
        rotor.change(0.02, rotor.speed(0.02), -100.0);
        assert!((rotor.angle(0.02) - before).rem_euclid(TAU) < 1e-12);
        assert_eq!(rotor.speed(0.02), 498.0);
    }
}
