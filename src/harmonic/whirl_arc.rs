//! Whirl along one side of the polygon (docs/theory.md, section 10): one group holds
//! while casing and blades move, linear in eight states; then the next group is struck.
//!
//! Lengths are counted in `g0`, blade angles in `g0/l_b`, pushes in `k_c g0`, time in
//! `1/omega_c`. The frame is turned so that the side that holds is at phase 0: there
//! `w = z - kappa l_b a = -1 + i y`, and the push is along the real axis.

use nalgebra::{Complex, SMatrix, SVector};

use super::joint::Joint;

/// `z`, `l_b a/g0` and their rates, as real and imaginary parts.
pub(super) type States = SVector<f64, 8>;
/// The same and the integral of the push.
type Extended = SMatrix<f64, 9, 9>;
/// The blades and the rate of `y`: what is free just after a corner.
pub(super) type Free = SVector<f64, 5>;

/// The motion along a side and over a corner, at one speed and in one direction.
#[derive(Clone, Debug)]
pub(super) struct WhirlArc {
    rates: Extended,
    /// The push, a row over the states.
    push: SVector<f64, 8>,
    /// Change of the two rates by a unit of impulse at phase 0.
    struck: [Complex<f64>; 2],
    /// Change of the rate of `w` by it.
    response: Complex<f64>,
    kappa: f64,
    /// Half a side, `tan delta`.
    half: f64,
    /// Phase of the next side.
    turn: f64,
}

/// The end of an arc: the states just after the next corner, in its frame, the place
/// along the side just before it, the impulse, and the integral of the push.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArcEnd {
    pub states: States,
    pub place: f64,
    pub impulse: f64,
    pub pushed: f64,
}

impl WhirlArc {
    /// At the speed of a joint, where the contact passes over the blades in a direction
    /// (1 with the phase, -1 against it).
    pub fn of(joint: &Joint, direction: f64) -> Self {
        let machine = joint.machine;
        let kappa = machine.radial_coupling;
        let lever = kappa + machine.friction_at(joint.nu);
        let inertia = machine.blade_length * machine.blade_length * machine.casing_mass
            / machine.blade_modal_mass;
        let turn = joint.nu / machine.omega_c;
        let rate = machine.omega_bd / machine.omega_c;
        let drag = 2.0 * machine.casing_damping_ratio;
        let blade_drag = 2.0 * machine.blade_damping_ratio * rate;
        let struck =
            [Complex::new(1.0, joint.casing_friction), Complex::new(-lever * inertia, 0.0)];
        let response = struck[0] - struck[1] * kappa;
        // Accelerations without contact, a row of states each.
        let mut free = SMatrix::<f64, 4, 8>::zeros();
        let stiff = turn * turn - 1.0;
        for (row, other, sign) in [(0, 1, 1.0), (1, 0, -1.0)] {
            free[(row, row)] = stiff;
            free[(row, other)] = sign * drag * turn;
            free[(row, 4 + row)] = -drag;
            free[(row, 4 + other)] = sign * 2.0 * turn;
            free[(2 + row, 2 + row)] = -rate * rate;
            free[(2 + row, 6 + row)] = -blade_drag;
        }
        // Re w'' = 0 gives the push.
        let along = free.row(0) - free.row(2) * kappa;
        let push: SVector<f64, 8> = (along / -response.re).transpose();
        let mut rates = Extended::zeros();
        for k in 0..4 {
            rates[(k, 4 + k)] = 1.0;
        }
        let force = [struck[0].re, struck[0].im, struck[1].re, struck[1].im];
        for (k, part) in force.into_iter().enumerate() {
            for column in 0..8 {
                rates[(4 + k, column)] = free[(k, column)] + part * push[column];
            }
        }
        for column in 0..8 {
            rates[(8, column)] = push[column];
        }
        let delta = machine.polygon.delta;
        Self {
            rates,
            push,
            struck,
            response,
            kappa,
            half: delta.tan() * direction,
            turn: 2.0 * delta * direction,
        }
    }

    /// Whether a corner leaves the wave a part of its speed along the next side.
    pub fn passes(&self) -> bool {
        let kept = self.response * Complex::from_polar(1.0, self.turn);
        // At a right angle nothing is kept but round-off.
        self.response.re > 0.0 && kept.re > 4.0 * f64::EPSILON * kept.norm()
    }

    /// The states just after a corner.
    pub fn start(&self, free: &Free) -> States {
        let a = Complex::new(free[0], free[1]);
        let a_rate = Complex::new(free[2], free[3]);
        let z = Complex::new(-1.0, self.half) + a * self.kappa;
        let z_rate = Complex::new(0.0, free[4]) + a_rate * self.kappa;
        States::from([z.re, z.im, a.re, a.im, z_rate.re, z_rate.im, a_rate.re, a_rate.im])
    }

    /// What is free of such states.
    pub fn free(&self, states: &States) -> Free {
        Free::from([states[2], states[3], states[6], states[7], states[5] - self.kappa * states[7]])
    }

    /// The motion over a time.
    pub fn over(&self, time: f64) -> Extended {
        (self.rates * time).exp()
    }

    /// Applies a motion to states; the last is the integral of the push.
    pub fn moved(motion: &Extended, states: &States) -> (States, f64) {
        let after = motion.fixed_view::<8, 8>(0, 0) * states;
        let pushed = motion.fixed_view::<1, 8>(8, 0) * states;
        (after, pushed[0])
    }

    /// The push at some states.
    pub fn push(&self, states: &States) -> f64 {
        self.push.dot(states)
    }

    /// Place along the side, from `half` to `-half`.
    pub fn place(&self, states: &States) -> f64 {
        states[1] - self.kappa * states[3]
    }

    /// Half a side with the sign of the direction.
    pub fn half(&self) -> f64 {
        self.half
    }

    /// Rates of the states while the side holds.
    pub fn rates(&self, states: &States) -> States {
        self.rates.fixed_view::<8, 8>(0, 0) * states
    }

    /// Strikes the next side and turns the frame to it. Linear in the states.
    pub fn corner(&self, states: &States, pushed: f64) -> ArcEnd {
        let back = Complex::from_polar(1.0, -self.turn);
        let pair = |k: usize| Complex::new(states[k], states[k + 1]) * back;
        let [z, a, mut z_rate, mut a_rate] = [pair(0), pair(2), pair(4), pair(6)];
        let closing = (z_rate - a_rate * self.kappa).re;
        let impulse = -closing / self.response.re;
        z_rate += self.struck[0] * impulse;
        a_rate += self.struck[1] * impulse;
        let place = self.place(states);
        let states =
            States::from([z.re, z.im, a.re, a.im, z_rate.re, z_rate.im, a_rate.re, a_rate.im]);
        ArcEnd { states, place, impulse, pushed }
    }

    /// The end of an arc of this time.
    pub fn end(&self, motion: &Extended, free: &Free) -> ArcEnd {
        let (states, pushed) = Self::moved(motion, &self.start(free));
        self.corner(&states, pushed)
    }
}
