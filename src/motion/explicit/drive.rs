//! What drives a motion, as steps of one length see it: the rotor, the pulse and the
//! excitation.

use super::EngineOrderTorque;
use super::phasor::Phasor;
use crate::motion::{Pulse, Rotor};
use crate::scene::Scene;

/// An excitation and its phase \[rad\].
pub(in crate::motion) type Driven<'a> = Option<(&'a EngineOrderTorque, f64)>;

/// Rotor, pulse and excitation at the steps `t = n h`.
#[derive(Clone, Debug)]
pub(in crate::motion) struct Drive {
    /// `h` \[s\].
    pub step: f64,
    pub rotor: Rotor,
    pub pulse: Pulse,
    pub excitation: Option<EngineOrderTorque>,
    /// The pulse to fire next, from zero on.
    next_pulse: Pulse,
    /// A step, and the mean force in it of a pulse that another has replaced \[N\].
    left_over: (u64, f64),
    diameters: f64,
    phasor: Phasor,
}

impl Drive {
    pub fn of(scene: &Scene) -> Self {
        let (rotor, pulse) = (Rotor::of(scene), Pulse::of(scene));
        let (diameters, step) = (f64::from(scene.operation.nodal_diameters), scene.solver.step_s);
        Self {
            step,
            rotor,
            pulse,
            excitation: EngineOrderTorque::of(scene),
            next_pulse: pulse,
            left_over: (0, 0.0),
            diameters,
            phasor: Phasor::new(&rotor, diameters, step),
        }
    }

    pub fn time_of(&self, n: u64) -> f64 {
        n as f64 * self.step
    }

    /// Rotor speed at step `n` \[rad/s\].
    pub fn speed(&self, n: u64) -> f64 {
        self.rotor.speed(self.time_of(n))
    }

    /// Mean force of the pulse over the step centred on `n`, whole at n = 0 \[N\].
    pub fn force(&self, n: u64) -> f64 {
        let left_over = if n == self.left_over.0 { self.left_over.1 } else { 0.0 };
        self.pulse.mean_of_step(n, self.step) + left_over
    }

    /// The excitation with its phase at step `n`.
    pub fn driven(&self, n: u64) -> Driven<'_> {
        let torque = self.excitation.as_ref()?;
        Some((torque, torque.phase(&self.rotor, self.time_of(n))))
    }

    /// The turn of the frame of the blades at step `n`, `exp(i n_d theta)`, keeping the
    /// exact value for the steps after it.
    pub fn turn(&mut self, n: u64) -> (f64, f64) {
        self.phasor.at(n, &self.rotor, self.diameters, self.step)
    }

    /// The same, keeping nothing.
    pub fn look_at_turn(&self, n: u64) -> (f64, f64) {
        self.phasor.look(n, &self.rotor, self.diameters, self.step)
    }

    /// Fires the next pulse at step `n`; what the pulse before gave in the half step until
    /// then is kept. The change of the mean force in the half step after the start, which
    /// the start did not know; zero later \[N\].
    pub fn fire(&mut self, n: u64) -> f64 {
        let (start, half) = (self.time_of(n), 0.5 * self.step);
        let (old, next) = (self.pulse, self.next_pulse);
        self.pulse = Pulse { start, end: start + next.end, force: next.force };
        if n == 0 {
            return self.pulse.mean(0.0, half) - old.mean(0.0, half);
        }
        let until_now = Pulse { end: old.end.min(start), ..old };
        let before = if self.left_over.0 == n { self.left_over.1 } else { 0.0 };
        self.left_over = (n, before + until_now.mean(start - half, start + half));
        0.0
    }

    /// Turns with this speed and acceleration from step `n` on.
    pub fn set_speed(&mut self, n: u64, speed: f64, ramp: f64) {
        self.rotor.change(self.time_of(n), speed, ramp);
        self.phasor = Phasor::new(&self.rotor, self.diameters, self.step);
    }

    /// The excitation of a scene from now on, and its pulse when it is fired again.
    pub fn set_parameters(&mut self, scene: &Scene) {
        self.excitation = EngineOrderTorque::of(scene);
        self.next_pulse = Pulse::of(scene);
    }

    /// Whether the pulse still acts on step `n` or a later one.
    pub fn pulse_to_come(&self, n: u64) -> bool {
        let left_over = self.left_over.0 == n && self.left_over.1 != 0.0;
        let acting = self.time_of(n) - 0.5 * self.step < self.pulse.end;
        left_over || (self.pulse.force != 0.0 && acting)
    }

    /// Whether neither pulse nor ramp nor excitation acts from step `n` on.
    pub fn is_steady(&self, n: u64) -> bool {
        let over = self.pulse.force == 0.0 || self.time_of(n) > self.pulse.end + self.step;
        over && self.rotor.ramp() == 0.0 && self.excitation.is_none()
    }
}
