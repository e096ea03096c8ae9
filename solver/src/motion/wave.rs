//! Rotational speed of the casing wave over the end of a run.

use std::f64::consts::{PI, TAU};

use super::{Motion, State};
use crate::model::Machine;
use crate::motion::LAST_PART;
use crate::scene::CheckedScene;

/// Largest number of observations of the wave, so that they do not slow down a long run.
const MOST_OBSERVATIONS: f64 = 100_000.0;

/// Number of observations in one revolution of the fastest motion. With two or fewer the direction
/// of a half turn would be ambiguous.
const OBSERVATIONS_PER_TURN: f64 = 16.0;

/// Accumulates the angle through which the casing wave turns over the last part of the run, or over
/// as much of its end as [`MOST_OBSERVATIONS`] allows. Between two observations the wave turns by
/// less than half a revolution.
#[derive(Clone, Debug)]
pub(super) struct WaveTracker {
    /// End of the run \[s\].
    end: f64,
    /// Time of the next observation; infinite after the end \[s\].
    next: f64,
    /// Time \[s\] and wave angle \[rad\] of the first observation; `None` before it.
    first: Option<(f64, f64)>,
    /// Time \[s\] and wave angle \[rad\] of the latest observation.
    last: (f64, f64),
    /// Angle through which the wave has turned from the first to the latest observation \[rad\].
    turned: f64,
}

/// Returns the time between two observations \[s\] at a rotor speed \[rad/s\].
fn interval(machine: &Machine, speed: f64) -> f64 {
    TAU / OBSERVATIONS_PER_TURN / (machine.nu(speed.abs()) + machine.omega_c)
}

impl WaveTracker {
    pub fn over(scene: &CheckedScene) -> Self {
        let end = scene.solver.end_s;
        let shortest = interval(&scene.machine(), scene.fastest_rad_s());
        let next = ((1.0 - LAST_PART) * end).max(end - MOST_OBSERVATIONS * shortest);
        Self { end, next, first: None, last: (0.0, 0.0), turned: 0.0 }
    }

    /// Returns the time of the next observation; infinite after the end \[s\].
    pub fn next_observation(&self) -> f64 {
        self.next
    }

    /// Returns whether a wave was observed.
    pub fn has_observed(&self) -> bool {
        self.first.is_some()
    }

    /// Ends the observations because the speed is not needed.
    pub fn stop(&mut self) {
        self.next = f64::INFINITY;
    }

    /// Records a motion at the time of the next observation.
    pub fn observe(&mut self, motion: &Motion) {
        let speed = motion.rotor().speed(motion.t_s());
        self.see(motion.state(), interval(motion.machine(), speed));
    }

    /// Records a state, and when to observe the next one.
    fn see(&mut self, state: State, interval: f64) {
        self.next =
            if self.next < self.end { (self.next + interval).min(self.end) } else { f64::INFINITY };
        if state.amplitude() == 0.0 {
            return;
        }
        let angle = state.u[1].atan2(state.u[0]);
        if self.first.is_none() {
            self.first = Some((state.t_s, angle));
        } else {
            self.turned += (angle - self.last.1 + PI).rem_euclid(TAU) - PI;
        }
        self.last = (state.t_s, angle);
    }

    /// Returns the mean frequency of the wave divided by `n_d`; `None` before the second
    /// observation, and for `n_d = 0` \[rad/s\].
    pub fn speed(&self, machine: &Machine) -> Option<f64> {
        let elapsed = self.last.0 - self.first?.0;
        let speed = self.turned / elapsed / machine.nodal_diameters;
        (elapsed > 0.0 && speed.is_finite()).then_some(speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// Returns the measured speed of a wave that turns at a constant rate, and the number of
    /// observations.
    fn found(scene: &CheckedScene, rate: f64) -> (f64, u32) {
        let mut wave = WaveTracker::over(scene);
        let (machine, mut count) = (scene.machine(), 0);
        while wave.next_observation() <= scene.solver.end_s {
            let (t_s, speed) = (wave.next_observation(), scene.operation.speed_rad_s);
            let (sin, cos) = (machine.nodal_diameters * rate * t_s).sin_cos();
            wave.see(State { t_s, u: [cos, sin], ..State::default() }, interval(&machine, speed));
            count += 1;
        }
        (wave.speed(&machine).unwrap(), count)
    }

    #[test]
    fn no_half_turn_hides_in_a_long_run() {
        // The event solver has no limit on the end time.
        let mut scene = Scene::base().as_reference();
        for end in [1e-3, 0.1, 100.0, 1e4, 1e6] {
            scene.solver.end_s = end;
            for rate in [500.0, 385.3, -292.9] {
                let (speed, count) = found(&scene.checked().unwrap(), rate);
                // Angles of up to 1e9 rad have lost some digits.
                assert!((speed / rate - 1.0).abs() < 1e-6, "{speed} {rate} over {end} s");
                assert!(count <= 100_002, "{count}");
            }
        }
    }
}
