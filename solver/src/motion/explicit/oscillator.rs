//! One linear coordinate under central differences, Eq. (10), in the summed form
//! that keeps its digits at small steps (docs/theory.md, section 6): the `increment`
//! `x[n] - x[n-1]` is stored next to `x`. The scheme is a linear recurrence, so `2^j`
//! free steps are one 2 x 2 matrix: a power of the map of a step (`Leap`).
//!
//! A step changes its coordinates by little: `T = 1 + S`, where `S` is small. As
//! `(1 + S)^2 = 1 + (2 S + S^2)`, squaring the change alone keeps its digits;
//! squaring `T` would round them off against the one, and a million steps add
//! that up. Once the change is no longer small, `T` itself is squared, so that a
//! motion that dies away keeps its digits too.

use std::sync::Arc;

use nalgebra::{Matrix2, SMatrix, SVector, Vector2};

use crate::model::Machine;
use crate::motion::propagator::Propagator;
use crate::tolerances::LEAP_SMALL;

/// Coefficients of the recurrence for one mass, damping and stiffness.
#[derive(Clone, Debug, PartialEq)]
pub struct Oscillator {
    /// `(m/h^2 - d/2h)/(m/h^2 + d/2h)`.
    pub ratio: f64,
    /// `k/(m/h^2 + d/2h)`.
    pub pull: f64,
    /// `1 - ratio`, without the round-off of that difference.
    pub loss: f64,
    /// Displacement that a unit force makes in one step, `1/(m/h^2 + d/2h)`.
    pub compliance: f64,
    mass: f64,
    damping: f64,
    stiffness: f64,
    step: f64,
    /// Value of `lost`, computed once.
    lost: f64,
    /// Map of many steps at once, on `(x, increment)`; none after a change of the stiffness.
    leap: Option<Leap<2>>,
}

/// Displacement and last increment of one coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coordinate {
    /// `x[n]`.
    pub x: f64,
    /// `x[n] - x[n-1]`.
    pub increment: f64,
}

impl Oscillator {
    /// Computes the coefficients for `mass`, `damping`, `stiffness` at a time step \[s\].
    pub fn new(mass: f64, damping: f64, stiffness: f64, step: f64) -> Self {
        let inertia = mass / (step * step);
        let drag = damping / (2.0 * step);
        let compliance = 1.0 / (inertia + drag);
        let ratio = (inertia - drag) * compliance;
        let pull = stiffness * compliance;
        let loss = 2.0 * drag * compliance;
        let leap = Some(Leap::new(Matrix2::new(-pull, ratio, -pull, -loss)));
        let lost = loss / (4.0 * compliance);
        Self { ratio, pull, loss, compliance, mass, damping, stiffness, step, lost, leap }
    }

    /// Returns the state at n = 0 from position and rate, so that `x[-1]` is
    /// `x - h v + h^2/2 a` with the acceleration that `force` gives.
    pub fn start(&self, x: f64, rate: f64, force: f64) -> Coordinate {
        let acceleration = (force - self.damping * rate - self.stiffness * x) / self.mass;
        Coordinate { x, increment: self.step * (rate - 0.5 * self.step * acceleration) }
    }

    /// Creates the oscillator of the casing.
    pub fn of_casing(machine: &Machine, step: f64) -> Self {
        Self::new(machine.casing_mass, machine.casing_damping, machine.casing_stiffness, step)
    }

    /// Returns a state of `start` under an additional force.
    pub fn begin(&self, at: Coordinate, force: f64) -> Coordinate {
        let change = 0.5 * self.step * self.step * force / self.mass;
        Coordinate { increment: at.increment - change, ..at }
    }

    /// Sets another stiffness from now on.
    pub fn stiffen(&mut self, stiffness: f64) {
        self.stiffness = stiffness;
        self.pull = stiffness * self.compliance;
        self.leap = None;
    }

    /// Takes one step under a force.
    pub fn step(&self, at: Coordinate, force: f64) -> Coordinate {
        let increment = self.ratio * at.increment - self.pull * at.x + self.compliance * force;
        Coordinate { x: at.x + increment, increment }
    }

    /// Takes `steps` free steps at once.
    pub fn skip(&self, at: Coordinate, steps: u64) -> Coordinate {
        let Some(leap) = &self.leap else {
            return (0..steps).fold(at, |at, _| self.step(at, 0.0));
        };
        let ahead = leap.apply(Vector2::new(at.x, at.increment), steps);
        Coordinate { x: ahead.x, increment: ahead.y }
    }

    /// Returns the rate at step n of a free coordinate, `(x[n+1] - x[n-1])/2h`.
    pub fn rate(&self, at: Coordinate, force: f64) -> f64 {
        (at.increment + self.step(at, force).increment) / (2.0 * self.step)
    }

    /// Returns twice the discrete energy, `m (increment/h)^2 + k x[n] x[n-1]`, which free steps
    /// never increase.
    pub fn twice_energy(&self, at: Coordinate) -> f64 {
        let rate = at.increment / self.step;
        self.mass * rate * rate + self.stiffness * at.x * (at.x - at.increment)
    }

    /// Returns the factor of the energy loss by damping: the loss is this times the square of the
    /// sum of two successive increments \[J/rad^2\] or \[J/m^2\].
    pub fn lost(&self) -> f64 {
        self.lost
    }

    /// Returns the approximate phase of a free coordinate per step \[rad\].
    pub fn turn(&self) -> f64 {
        self.step * (self.stiffness / self.mass).sqrt()
    }

    /// Returns the largest `|x|` around the first turning point of a free coordinate, if it comes
    /// within `steps` steps; zero otherwise.
    pub fn turning_point(&self, at: Coordinate, steps: u64) -> f64 {
        let damping = 0.5 * self.damping / self.mass;
        let propagator = Propagator::new(damping, self.stiffness / self.mass);
        // The time of a continuous coordinate; steps turn a part of a step
        // earlier or later, as far as their own angle squared.
        let Some(time) = propagator.first_rest(at.x, self.rate(at, 0.0)) else { return 0.0 };
        let nearest = time / self.step;
        if nearest >= steps as f64 + 1.0 {
            return 0.0;
        }
        let around = (nearest * self.turn() * self.turn()).ceil() as u64 + 1;
        let first = (nearest as u64).saturating_sub(around);
        let last = (nearest as u64 + around + 1).min(steps);
        // Around it the steps rise and then fall.
        let size = |steps| self.skip(at, steps).x.abs();
        let (mut low, mut high) = (first, last);
        while high > low + 1 {
            let middle = low + (high - low) / 2;
            if size(middle + 1) > size(middle) { low = middle + 1 } else { high = middle }
        }
        size(low).max(size(high))
    }

    /// Returns `reach` for these coordinates together.
    pub fn reach_of(&self, coordinates: [Coordinate; 2]) -> (f64, f64) {
        self.reach(coordinates.into_iter().map(|at| self.twice_energy(at)).sum())
    }

    /// Returns bounds on `|x|` and on `|increment|` over all free steps to come, for one or more
    /// coordinates of this kind with this sum of `twice_energy`.
    pub fn reach(&self, twice_energy: f64) -> (f64, f64) {
        let inertia = self.mass / (self.step * self.step);
        let rest = inertia - 0.25 * self.stiffness;
        let energy = twice_energy.max(0.0);
        // x = (x - increment/2) + increment/2 on the ellipse of constant energy.
        let position = (energy / self.stiffness * (inertia / rest)).sqrt();
        (position, (energy / rest).sqrt())
    }
}

/// Largest number of steps that can be taken at once, as a power of two.
pub(in crate::motion::explicit) const LARGEST: usize = 40;
/// Powers of a map of `N` coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::motion::explicit) struct Leap<const N: usize> {
    /// `T^(2^j) - 1`, as long as it is small.
    changes: Arc<[SMatrix<f64, N, N>]>,
    /// `T^(2^j)`, from the last of the changes on.
    powers: Arc<[SMatrix<f64, N, N>]>,
}

impl<const N: usize> Leap<N> {
    /// Computes the powers of the map that adds `change` times the coordinates to them.
    pub fn new(change: SMatrix<f64, N, N>) -> Self {
        let mut changes = vec![change];
        let is_small = |change: &SMatrix<f64, N, N>| change.diagonal().amax() < LEAP_SMALL;
        while changes.len() <= LARGEST
            && let Some(last) = changes.last().filter(|last| is_small(last))
        {
            changes.push(last * 2.0 + last * last);
        }
        let mut powers = Vec::new();
        if let Some(last) = changes.last() {
            powers.push(SMatrix::identity() + last);
        }
        while let Some(last) = powers.last().filter(|_| changes.len() + powers.len() <= LARGEST + 1)
        {
            powers.push(last * last);
        }
        Self { changes: changes.into(), powers: powers.into() }
    }

    /// Returns the coordinates after `2^exponent` steps, for an exponent up to `LARGEST`.
    pub fn doubled(&self, at: SVector<f64, N>, exponent: usize) -> SVector<f64, N> {
        match self.changes.get(exponent) {
            Some(change) => at + change * at,
            None => self.powers[exponent + 1 - self.changes.len()] * at,
        }
    }

    /// Returns the coordinates after `steps` steps.
    pub fn apply(&self, mut at: SVector<f64, N>, steps: u64) -> SVector<f64, N> {
        let near = self.changes.len();
        let mut left = steps;
        while left > 0 {
            let bit = left.trailing_zeros() as usize;
            left &= left - 1;
            if let Some(change) = self.changes.get(bit) {
                at += change * at;
            } else if let Some(power) = self.powers.get(bit + 1 - near) {
                at = power * at;
            }
        }
        at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_free_steps_equal_single_steps() {
        let casing = Oscillator::new(2.0, 175.7, 1.544e6, 1e-6);
        let start = casing.start(3e-5, 0.2, 0.0);
        let mut stepped = start;
        for _ in 0..54_321 {
            stepped = casing.step(stepped, 0.0);
        }
        let skipped = casing.skip(start, 54_321);
        // Round-off of 5e4 steps, against an amplitude of 2e-4.
        assert!((stepped.x - skipped.x).abs() < 1e-15, "{stepped:?} {skipped:?}");
    }

    #[test]
    fn energy_never_grows_and_bounds_the_motion() {
        let casing = Oscillator::new(2.0, 10.0, 1.544e6, 1e-4);
        let mut at = casing.start(1e-4, 0.1, 0.0);
        let mut energy = casing.twice_energy(at);
        let (farthest, longest) = casing.reach(energy);
        for _ in 0..10_000 {
            at = casing.step(at, 0.0);
            let next = casing.twice_energy(at);
            assert!(next <= energy * (1.0 + 1e-13));
            assert!(at.x.abs() <= farthest * (1.0 + 1e-12));
            assert!(at.increment.abs() <= longest * (1.0 + 1e-12));
            energy = next;
        }
    }

    #[test]
    fn second_order_in_free_flight() {
        let error = |step: f64| {
            let casing = Oscillator::new(2.0, 175.7, 1.544e6, step);
            let steps = (0.01 / step).round() as u64;
            let decay = 175.7 / 4.0;
            let omega = (1.544e6_f64 / 2.0 - decay * decay).sqrt();
            let exact = (-decay * 0.01_f64).exp()
                * ((omega * 0.01).cos() + decay / omega * (omega * 0.01).sin());
            (casing.skip(casing.start(1.0, 0.0, 0.0), steps).x - exact).abs()
        };
        let order = (error(1e-5) / error(5e-6)).log2();
        assert!((order - 2.0).abs() < 0.01, "{order}");
    }
}

#[cfg(test)]
mod powers_tests {
    use super::*;
    use nalgebra::{Matrix2, Vector2};

    /// A turn by `angle` that shrinks by `loss` each step.
    fn turn(angle: f64, loss: f64) -> Matrix2<f64> {
        let versine = 2.0 * (0.5 * angle).sin().powi(2);
        let shrunk = loss + versine - loss * versine;
        let sine = (1.0 - loss) * angle.sin();
        Matrix2::new(-shrunk, -sine, sine, -shrunk)
    }

    #[test]
    fn a_billion_small_turns_keep_their_digits() {
        // Angles that are whole numbers of 2^-40, so that their multiples are exact.
        for angle in [3.0, 1001.0, 1e6, 1e11].map(|x: f64| x.round() / 2f64.powi(40)) {
            let leap = Leap::new(turn(angle, 0.0));
            for steps in [1, 7, 1000, 123_456_789, 1_000_000_007_u64] {
                let at = leap.apply(Vector2::new(1.0, 0.0), steps);
                let (sin, cos) = (angle * steps as f64).sin_cos();
                // A rounding for each doubling and for each radian turned through.
                let allowed = 1e-16 * (40.0 + 2.0 * angle * steps as f64);
                let error = (at - Vector2::new(cos, sin)).norm();
                assert!(error < allowed, "{angle} {steps}: {error}");
            }
        }
    }

    #[test]
    fn a_motion_that_dies_away_keeps_its_digits() {
        let leap = Leap::new(turn(1e-6, 2e-6));
        let steps = 30_000_000_u64;
        let size = leap.apply(Vector2::new(1.0, 0.0), steps).norm();
        let expected = (steps as f64 * (-2e-6_f64).ln_1p()).exp();
        assert!((size / expected - 1.0).abs() < 1e-13, "{size} {expected}");
    }

    #[test]
    fn every_number_of_steps_has_its_power() {
        let leap = Leap::new(Matrix2::zeros());
        assert_eq!(leap.changes.len() + leap.powers.len(), LARGEST + 2);
        let halving = Leap::new(Matrix2::new(-0.5, 0.0, 0.0, -0.5));
        assert_eq!(halving.apply(Vector2::new(1.0, 1.0), 5).x, 1.0 / 32.0);
        assert_eq!(halving.changes.len() + halving.powers.len(), LARGEST + 2);
    }
}
