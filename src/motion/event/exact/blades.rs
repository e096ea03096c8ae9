//! The blades of the four-coordinate model: two damped oscillators in the
//! turning frame, `a = alpha_c + i alpha_s`, that shift the phases of the sides.
//! (docs/theory.md, section 4.)
//!
//! A blade of phase `psi` stands at the angle `alpha = Re[a exp(-i psi)]`, so a
//! group's gap is `g0 + Re[u exp(-i gamma)]` with `gamma = n_d theta + psi +
//! n_d alpha`. With `u = (-g0 + i y) exp(i gamma)` on a side, a push `N` turns
//! the blades by the moment `N n_d y` on the mode along `exp(i psi)`: the
//! contact feels the mass ratio `ratio y^2`, `ratio = m_c n_d^2/M_blade`.

use super::parameters::{Drive, Parameters};
use crate::model::Machine;
use crate::motion::Plane;
use crate::motion::propagator::Propagator;
use crate::scene::{ModelSize, Scene};
use crate::tolerances::{CLEARANCES_A_RADIAN, FOLLOWING_GAP, FOLLOWING_RATES};

/// What the casing feels of the blades.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blades {
    pub propagator: Propagator,
    /// Blade frequency `omega_bd` \[rad/s\].
    pub omega: f64,
    /// `n_d`.
    pub diameters: f64,
    /// `m_c n_d^2/M_blade` \[1/m^2\].
    pub ratio: f64,
    /// Blade modal mass over casing mass \[m^2\].
    pub mass: f64,
}

/// Blade angles and rates, `alpha_c + i alpha_s`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tips {
    /// \[rad\]
    pub angle: Plane,
    /// \[rad/s\]
    pub rate: Plane,
}

impl Blades {
    /// The blades of a scene, if they move and can be moved: not in the rigid
    /// model, and not without nodal diameters, where no force turns them.
    pub(super) fn of(scene: &Scene, machine: &Machine) -> Option<Self> {
        let moving = scene.solver.model == ModelSize::Modal && machine.nodal_diameters > 0.0;
        let (omega, diameters) = (machine.omega_bd, machine.nodal_diameters);
        let mass = machine.blade_modal_mass / machine.casing_mass;
        moving.then(|| Self {
            propagator: Propagator::new(machine.blade_damping_ratio * omega, omega * omega),
            omega,
            diameters,
            ratio: diameters * diameters / mass,
            mass,
        })
    }

    /// Whether the casing cannot tell them from rigid ones, and they are so much
    /// faster than the motion that their angles follow the pushes at once.
    pub(super) fn negligible(&self, scene: &Scene, machine: &Machine) -> bool {
        let operation = &scene.operation;
        let last = operation.speed_rad_s + operation.speed_ramp_rad_s2 * scene.solver.end_s;
        let nu = machine.nu(operation.speed_rad_s.abs().max(last.abs()));
        let rates = machine.omega_c + nu;
        let clearance = machine.clearance();
        let half_side =
            if machine.polygon.has_corners() { machine.polygon.half_side() } else { return false };
        // Largest push per unit mass that lasts, and largest impulse.
        let pulse = operation.pulse_n.abs() / machine.casing_mass;
        let start = scene.initial.v_c_m_s.hypot(scene.initial.v_s_m_s);
        let speed = pulse * operation.pulse_s + start + CLEARANCES_A_RADIAN * rates * clearance;
        let push = pulse + rates * rates * clearance + 2.0 * nu * speed;
        let moment_arm = self.ratio / self.diameters * half_side;
        let angle = moment_arm * (push / self.omega + speed) / self.omega;
        // Gaps shift by n_d times the angle and the place along the side.
        self.omega > FOLLOWING_RATES * rates
            && self.diameters * angle * half_side < FOLLOWING_GAP * clearance
    }

    /// Angles of blades that follow these pushes at once.
    pub(super) fn following(
        &self,
        parameters: &Parameters,
        pushes: [Option<(u32, f64)>; 2],
        y: [f64; 2],
    ) -> Tips {
        let moment_arm = self.ratio / self.diameters / self.propagator.stiffness;
        let mut tips = Tips::default();
        for ((side, push), y) in pushes.into_iter().flatten().zip(y) {
            tips.angle += parameters.direction(side) * (moment_arm * push * y);
        }
        tips
    }

    /// Largest angle of blades at rest after this impulse at `y` \[rad\].
    pub(super) fn kicked(&self, y: f64, impulse: f64) -> f64 {
        let rate = self.ratio / self.diameters * (y * impulse).abs();
        self.propagator
            .first_rest(0.0, rate)
            .map_or(0.0, |time| rate * self.propagator.at(time).unit)
    }

    /// Blade angles of the free blades, `s` seconds on.
    pub(super) fn free(&self, tips: &Tips, s: f64) -> Tips {
        if *tips == Tips::default() {
            return *tips;
        }
        let response = self.propagator.at(s);
        Tips {
            angle: tips.angle * response.hold + tips.rate * response.unit,
            rate: tips.rate * response.slope
                - tips.angle * (self.propagator.stiffness * response.unit),
        }
    }

    /// Largest angle the blades reach if left alone \[rad\].
    pub(super) fn amplitude(&self, tips: &Tips) -> f64 {
        (tips.angle.norm_sqr() + tips.rate.norm_sqr() / (self.omega * self.omega)).sqrt()
    }

    /// Kinetic and potential energy per unit casing mass.
    pub(super) fn energy(&self, tips: &Tips) -> f64 {
        let stored = tips.rate.norm_sqr() + self.omega * self.omega * tips.angle.norm_sqr();
        0.5 * self.mass * stored
    }

    /// Bounds on the first four derivatives of `n_d alpha` from now on.
    pub(super) fn turning(&self, tips: &Tips) -> [f64; 4] {
        let first = self.diameters * self.amplitude(tips) * self.omega;
        let factor = self.omega + 2.0 * self.propagator.damping;
        [first, first * factor, first * factor * factor, first * factor * factor * factor]
    }
}

impl PartialEq for Tips {
    fn eq(&self, other: &Self) -> bool {
        self.angle == other.angle && self.rate == other.rate
    }
}

impl Parameters {
    /// The largest angle of any blade \[rad\].
    pub(super) fn largest(&self, tips: &Tips) -> f64 {
        self.machine.polygon.largest_component(tips.angle.re, tips.angle.im)
    }

    /// `exp(i gamma)` of a side, the direction that opens its gap, and `gamma'`.
    pub(super) fn facing(&self, drive: &Drive, side: u32, s: f64, tips: &Tips) -> (Plane, f64) {
        let direction = self.direction(side);
        let diameters = self.blades.map_or(0.0, |blades| blades.diameters);
        let shift = diameters * (tips.angle * direction.conj()).re;
        let spin = drive.nu(s) + diameters * (tips.rate * direction.conj()).re;
        (direction * Plane::cis(drive.phase(s) + shift), spin)
    }

    /// Half the angle between a side and the next \[rad\].
    pub(super) fn half_angle(&self, a: u32, tips: &Tips) -> f64 {
        let diameters = self.blades.map_or(0.0, |blades| blades.diameters);
        let between = self.direction(self.machine.polygon.next(a)) - self.direction(a);
        let shift = (tips.angle * between.conj()).re;
        self.machine.polygon.delta + 0.5 * diameters * shift
    }
}
