//! One coordinate under central differences, Eq. (10):
//! `(m/h^2 + d/2h) x[n+1] = f + (2m/h^2 - k) x[n] - (m/h^2 - d/2h) x[n-1]`.
//!
//! The `increment` `x[n] - x[n-1]` is stored beside `x[n]`, so that short steps keep their
//! digits: `increment[n+1] = ratio increment[n] - pull x[n] + compliance f`.

use crate::model::Machine;

/// Coefficients of the recurrence for one mass, damping and stiffness.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Oscillator {
    /// `(m/h^2 - d/2h)/(m/h^2 + d/2h)`.
    pub ratio: f64,
    /// `k/(m/h^2 + d/2h)`.
    pub pull: f64,
    /// Displacement that a unit force makes in one step, `1/(m/h^2 + d/2h)`.
    pub compliance: f64,
    /// `1 - ratio`, without the round-off of that difference.
    pub loss: f64,
    pub mass: f64,
    damping: f64,
    stiffness: f64,
    /// \[s\]
    pub step: f64,
}

/// Displacement and last increment of one coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Coordinate {
    /// `x[n]`.
    pub x: f64,
    /// `x[n] - x[n-1]`.
    pub increment: f64,
}

impl Coordinate {
    /// Returns the state after a change, given as a matrix on `[x, increment]` minus 1.
    #[inline]
    fn changed(self, [a, b, c, d]: [f64; 4]) -> Self {
        let Self { x, increment } = self;
        Self { x: x + a * x + b * increment, increment: increment + c * x + d * increment }
    }
}

impl Oscillator {
    /// Computes the coefficients for a mass, a damping and a stiffness at a time step \[s\].
    pub fn new(mass: f64, damping: f64, stiffness: f64, step: f64) -> Self {
        let inertia = mass / (step * step);
        let drag = damping / (2.0 * step);
        let compliance = 1.0 / (inertia + drag);
        let ratio = (inertia - drag) * compliance;
        let (pull, loss) = (stiffness * compliance, 2.0 * drag * compliance);
        Self { ratio, pull, compliance, loss, mass, damping, stiffness, step }
    }

    /// Creates the oscillator of the casing.
    pub fn of_casing(machine: &Machine, step: f64) -> Self {
        Self::new(machine.casing_mass, machine.casing_damping, machine.casing_stiffness, step)
    }

    /// Returns the state at n = 0 from position and rate, so that `x[-1]` is
    /// `x - h v + h^2/2 a` with the acceleration that `force` gives.
    pub fn start(&self, x: f64, rate: f64, force: f64) -> Coordinate {
        let acceleration = (force - self.damping * rate - self.stiffness * x) / self.mass;
        Coordinate { x, increment: self.step * (rate - 0.5 * self.step * acceleration) }
    }

    /// Returns by how much an additional force at n = 0 reduces the increment of `start`.
    pub fn start_shift(&self, force: f64) -> f64 {
        0.5 * self.step * self.step * force / self.mass
    }

    /// Sets another stiffness from now on.
    pub fn stiffen(&mut self, stiffness: f64) {
        self.stiffness = stiffness;
        self.pull = stiffness * self.compliance;
    }

    /// Takes one step under a force.
    #[inline]
    pub fn step(&self, at: Coordinate, force: f64) -> Coordinate {
        let increment = self.ratio * at.increment - self.pull * at.x + self.compliance * force;
        Coordinate { x: at.x + increment, increment }
    }

    /// Returns the matrix of a free step minus 1, on `[x, increment]`.
    pub fn change(&self) -> [f64; 4] {
        [-self.pull, self.ratio, -self.pull, -self.loss]
    }

    /// Returns the state after so many free steps, by the powers of two of one step: the square
    /// `(1 + S)^2 = 1 + (2 S + S^2)` keeps the digits of a small change `S`.
    pub fn fly(&self, mut at: Coordinate, steps: u64) -> Coordinate {
        let (mut change, mut left) = (self.change(), steps);
        while left > 0 {
            if left & 1 == 1 {
                at = at.changed(change);
            }
            let [a, b, c, d] = change;
            change = [
                2.0 * a + a * a + b * c,
                2.0 * b + a * b + b * d,
                2.0 * c + c * a + d * c,
                2.0 * d + c * b + d * d,
            ];
            left >>= 1;
        }
        at
    }

    /// Returns a bound on the second difference of a free coordinate whose amplitude is never above
    /// `reach`: it is `-pull x - loss increment`.
    pub fn bend(&self, reach: f64) -> f64 {
        (self.pull + self.loss * self.pull.sqrt()) * reach
    }

    /// Returns twice the discrete energy, `m (increment/h)^2 + k x[n] x[n-1]`, which free steps
    /// never increase.
    pub fn twice_energy(&self, at: Coordinate) -> f64 {
        let rate = at.increment / self.step;
        self.mass * rate * rate + self.stiffness * at.x * (at.x - at.increment)
    }

    /// Returns the energy dissipated in a step, divided by the square of the sum of the last two
    /// increments: `d/4h` in this scheme \[J/m^2\] or \[J/rad^2\].
    pub fn lost(&self) -> f64 {
        self.damping / (4.0 * self.step)
    }

    /// Returns the phase that a free coordinate turns in a step, to second order \[rad\].
    pub fn turn(&self) -> f64 {
        self.step * (self.stiffness / self.mass).sqrt()
    }

    /// Returns a bound on the joint amplitude of coordinates over all future free steps, from the
    /// ellipse of constant energy and `x = (x - increment/2) + increment/2`.
    pub fn reach(&self, coordinates: &[Coordinate]) -> f64 {
        let energy: f64 = coordinates.iter().map(|at| self.twice_energy(*at)).sum();
        let inertia = self.mass / (self.step * self.step);
        let rest = inertia - 0.25 * self.stiffness;
        (energy.max(0.0) / self.stiffness * (inertia / rest)).sqrt()
    }
}
