//! Drive of a motion with constant time step: the rotor and its phase, the pulse, and the
//! engine-order excitation, a torque `Q cos(E (theta + Phi_i))` on every blade, fixed in space,
//! which excites only some modes (docs/theory.md, section 8).

use crate::motion::{Plane, Pulse, Rotor};
use crate::scene::Scene;

/// Rotor, pulse and excitation at the steps `t = n h`.
#[derive(Clone, Debug)]
pub(super) struct Drive {
    /// `h` \[s\].
    pub step: f64,
    pub rotor: Rotor,
    pub pulse: Pulse,
    pub excitation: Option<EngineOrderTorque>,
    /// The pulse to fire next, from zero on.
    next_pulse: Pulse,
    /// First step on which no pulse acts any more.
    quiet_from: u64,
    /// Step index, and the mean force within that step of a pulse that was replaced in it \[N\].
    left_over: (u64, f64),
    diameters: f64,
    phasor: Phasor,
    /// Number of lobes of the casing (0 if round), and their rotation relative to the blades.
    lobes: f64,
    lobe_phasor: Phasor,
}

impl Drive {
    pub fn of(scene: &Scene, lobes: f64) -> Self {
        let (rotor, pulse) = (Rotor::of(scene), Pulse::of(scene));
        let (diameters, step) = (f64::from(scene.operation.nodal_diameters), scene.solver.step_s);
        Self {
            step,
            rotor,
            pulse,
            excitation: EngineOrderTorque::of(scene),
            next_pulse: pulse,
            quiet_from: quiet_from(&pulse, step),
            left_over: (0, 0.0),
            diameters,
            phasor: Phasor::new(&rotor, diameters, step, 0),
            lobes,
            lobe_phasor: Phasor::new(&rotor, lobes, step, 0),
        }
    }

    pub fn time_of(&self, n: u64) -> f64 {
        n as f64 * self.step
    }

    /// Returns the rotor speed at step `n` \[rad/s\].
    pub fn speed(&self, n: u64) -> f64 {
        self.rotor.speed(self.time_of(n))
    }

    /// Returns the mean force of the pulse over the step centred on `n`, for n = 0 over the half step
    /// after the start \[N\].
    #[inline]
    pub fn force(&self, n: u64) -> f64 {
        if n >= self.quiet_from {
            return 0.0;
        }
        let left_over = if n == self.left_over.0 { self.left_over.1 } else { 0.0 };
        self.pulse.mean_of_step(n, self.step) + left_over
    }

    /// Returns the excitation with its phase at step `n`.
    pub fn driven(&self, n: u64) -> Option<(&EngineOrderTorque, f64)> {
        let torque = self.excitation.as_ref()?;
        Some((torque, torque.phase(&self.rotor, self.time_of(n))))
    }

    /// Returns `exp(i n_d theta)` at step `n`, the rotation of the blade frame, and updates the cache
    /// for the following steps.
    #[inline]
    pub fn turn(&mut self, n: u64) -> Plane {
        self.phasor.at(n, &self.rotor, self.diameters, self.step)
    }

    /// Returns `exp(i m theta)` at step `n`, the rotation of the lobes, and updates the cache for the
    /// following steps.
    #[inline]
    pub fn lobe_turn(&mut self, n: u64) -> Plane {
        self.lobe_phasor.at(n, &self.rotor, self.lobes, self.step)
    }

    /// Returns both rotations a few steps before step `n`, possibly before the start.
    pub fn turns_before(&self, n: u64, back: u64) -> (Plane, Plane) {
        let before = |phasor: &Phasor, order: f64| {
            if let Some(turn) = phasor.table.get(back as usize) {
                return phasor.look(n, &self.rotor, order, self.step) * turn.conj();
            }
            let t = (n as f64 - back as f64) * self.step;
            Plane::cis(order * self.rotor.angle(t))
        };
        (before(&self.phasor, self.diameters), before(&self.lobe_phasor, self.lobes))
    }

    /// Fires the next pulse at step `n`; the force of the previous pulse in the half step before `n`
    /// is kept. Returns the change of the mean force in the first half step of the run, which the
    /// start did not include; zero for n > 0 \[N\].
    pub fn fire(&mut self, n: u64) -> f64 {
        let (start, half) = (self.time_of(n), 0.5 * self.step);
        let (old, next) = (self.pulse, self.next_pulse);
        self.pulse = Pulse { start, end: start + next.end, force: next.force };
        self.quiet_from = quiet_from(&self.pulse, self.step).max(n + 1);
        if n == 0 {
            return self.pulse.mean(0.0, half) - old.mean(0.0, half);
        }
        let until_now = Pulse { end: old.end.min(start), ..old };
        let before = if self.left_over.0 == n { self.left_over.1 } else { 0.0 };
        self.left_over = (n, before + until_now.mean(start - half, start + half));
        0.0
    }

    /// Sets speed and acceleration from step `n` on.
    pub fn set_speed(&mut self, n: u64, speed: f64, ramp: f64) {
        self.rotor.change(self.time_of(n), speed, ramp);
        self.phasor = Phasor::new(&self.rotor, self.diameters, self.step, n);
        self.lobe_phasor = Phasor::new(&self.rotor, self.lobes, self.step, n);
    }

    /// Sets the excitation and the lobes of a scene from step `n` on, and its pulse for the next fire.
    pub fn set_parameters(&mut self, n: u64, scene: &Scene, lobes: f64) {
        if lobes != self.lobes {
            self.lobes = lobes;
            self.lobe_phasor = Phasor::new(&self.rotor, lobes, self.step, n);
        }
        self.excitation = EngineOrderTorque::of(scene);
        self.next_pulse = Pulse::of(scene);
    }

    /// Returns whether the pulse still acts on step `n` or a later one.
    pub fn pulse_to_come(&self, n: u64) -> bool {
        let left_over = self.left_over.0 == n && self.left_over.1 != 0.0;
        let acting = self.time_of(n) - 0.5 * self.step < self.pulse.end;
        left_over || (self.pulse.force != 0.0 && acting)
    }

    /// Returns whether neither pulse nor ramp nor excitation acts from step `n` on.
    pub fn is_steady(&self, n: u64) -> bool {
        let over = self.pulse.force == 0.0 || self.time_of(n) > self.pulse.end + self.step;
        over && self.rotor.ramp() == 0.0 && self.excitation.is_none()
    }
}

/// Returns a step from which on a pulse does not act, one or two after its end.
fn quiet_from(pulse: &Pulse, step: f64) -> u64 {
    (pulse.end / step) as u64 + 3
}

/// `exp(i m theta)` at every step: a sine and a cosine each 64 steps and a table between them, so
/// that the value at a step does not depend on the steps before it. On a ramp each step has its
/// own.
#[derive(Clone, Debug)]
struct Phasor {
    table: Vec<Plane>,
    /// Phase of a step \[rad\].
    rate: f64,
    /// Step of the latest change of speed, and the value there.
    from: u64,
    at_from: Plane,
    block: u64,
    at_block: Plane,
}

const TABLE: u64 = 64;

impl Phasor {
    fn new(rotor: &Rotor, order: f64, step: f64, from: u64) -> Self {
        let t = from as f64 * step;
        let rate = order * rotor.speed(t) * step;
        let entry = |j: u64| Plane::cis(rate * j as f64);
        let steady = rotor.ramp() == 0.0;
        let table = if steady { (0..TABLE).map(entry).collect() } else { Vec::new() };
        let (at_from, at_block) = (Plane::cis(order * rotor.angle(t)), Plane::new(1.0, 0.0));
        Self { table, rate, from, at_from, block: u64::MAX, at_block }
    }

    /// Returns the value at step `n`, and caches the value at the beginning of its block.
    #[inline(always)]
    fn at(&mut self, n: u64, rotor: &Rotor, order: f64, step: f64) -> Plane {
        if !self.table.is_empty() && n / TABLE != self.block {
            self.block = n / TABLE;
            self.at_block = self.exact(self.block * TABLE);
        }
        self.look(n, rotor, order, step)
    }

    #[inline]
    fn look(&self, n: u64, rotor: &Rotor, order: f64, step: f64) -> Plane {
        let Some(turn) = self.table.get((n % TABLE) as usize) else {
            return Plane::cis(order * rotor.angle(n as f64 * step));
        };
        let block = n / TABLE;
        let at_block = if block == self.block { self.at_block } else { self.exact(block * TABLE) };
        at_block * turn
    }

    /// Returns the value at step `n` at constant speed. The round-off of a phase of many turns would
    /// shake a held tip, so what the product loses is turned after.
    fn exact(&self, n: u64) -> Plane {
        let steps = n as f64 - self.from as f64;
        let phase = self.rate * steps;
        let lost = self.rate.mul_add(steps, -phase);
        self.at_from * Plane::cis(phase) * Plane::new(1.0, lost)
    }
}

/// The excitation of one scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EngineOrderTorque {
    amplitude: f64,
    order: u32,
    blades: u32,
}

impl EngineOrderTorque {
    /// Creates the excitation of a scene; none where its amplitude is zero.
    pub fn of(scene: &Scene) -> Option<Self> {
        let amplitude = scene.excitation.amplitude_nm;
        let (order, blades) = (scene.excitation.order, scene.bladed_disk.blades);
        (amplitude != 0.0).then_some(Self { amplitude, order, blades })
    }

    /// Returns whether it excites modes with this number of nodal diameters.
    pub fn drives(&self, diameters: u32) -> bool {
        let (k, order) = (diameters % self.blades, self.order % self.blades);
        k == order || (k + order).is_multiple_of(self.blades)
    }

    /// Returns the phase `E theta` at an instant \[rad\].
    pub fn phase(&self, rotor: &Rotor, t: f64) -> f64 {
        f64::from(self.order) * rotor.angle(t)
    }

    /// Returns `sum_i (cos, sin)(k Phi_i) Q_i` for `k` diameters at a phase \[N m\].
    pub fn torque_on(&self, diameters: u32, phase: f64) -> [f64; 2] {
        let (k, order) = (diameters % self.blades, self.order % self.blades);
        let half = 0.5 * f64::from(self.blades) * self.amplitude;
        let (sin, cos) = phase.sin_cos();
        let mut torque = [0.0; 2];
        if (k + order).is_multiple_of(self.blades) {
            torque[0] += half * cos;
            torque[1] += half * sin;
        }
        if k == order {
            torque[0] += half * cos;
            torque[1] -= half * sin;
        }
        torque
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn a_phase_of_many_turns_keeps_what_its_product_loses() {
        let mut phasor = Phasor::new(&Rotor::of(&Scene::base()), 3.0, 1e-6, 0);
        // The product is 2^30 + 1 + 2^-10 + 2^-40, whose last term a number of 53 bits drops.
        let (two, steps) = (2.0_f64, (1 << 30) + 1);
        phasor.rate = 1.0 + two.powi(-40);
        let (sin, cos) = (two.powi(30) + 1.0 + two.powi(-10)).sin_cos();
        let seen = phasor.exact(steps);
        let rest = two.powi(-40);
        let apart = (seen.re - (cos - rest * sin)).hypot(seen.im - (sin + rest * cos));
        assert!(apart < 1e-15, "{apart}");
    }

    #[test]
    fn a_look_at_a_phase_is_the_phase_of_a_step_taken() {
        for ramp in ["0", "-300"] {
            let scene = Scene::base().with(&[("operation.speed_ramp_rad_s2", ramp)]).unwrap();
            let rotor = Rotor::of(&scene);
            let mut phasor = Phasor::new(&rotor, 3.0, 1e-6, 0);
            for n in [0, 1, 63, 64, 65, 1000, 12_345, 12_346, 70] {
                let seen = phasor.look(n, &rotor, 3.0, 1e-6);
                let (sin, cos) = (3.0 * rotor.angle(n as f64 * 1e-6)).sin_cos();
                assert_eq!(seen, phasor.at(n, &rotor, 3.0, 1e-6));
                // Round-off of an angle of 18 rad, twice.
                let apart = (seen.re - cos).hypot(seen.im - sin);
                assert!(apart < 8e-15, "{n}: {apart}");
            }
        }
    }
}
