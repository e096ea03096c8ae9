//! The blades of the four-coordinate model: two damped oscillators in the
//! turning frame, `a = alpha_c + i alpha_s`, that shift the phases of the sides.
//!
//! A blade of phase `psi` stands at the angle `alpha = Re[a exp(-i psi)]`, so a
//! group's gap is `g0 + Re[u exp(-i gamma)]` with `gamma = n_d theta + psi +
//! n_d alpha`. With `u = (-g0 + i y) exp(i gamma)` on a side, a push `N` turns
//! the blades by the moment `N n_d y` on the mode along `exp(i psi)`: the
//! contact feels the mass ratio `ratio y^2`, `ratio = m_c n_d^2/M_blade`.

use super::kernel::Kernel;
use super::world::{Drive, Plane, World};
use crate::model::Machine;
use crate::scene::{ModelSize, Scene};

/// What the casing feels of the blades.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blades {
    pub kernel: Kernel,
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
            kernel: Kernel::new(machine.blade_damping_ratio * omega, omega * omega),
            omega,
            diameters,
            ratio: diameters * diameters / mass,
            mass,
        })
    }

    /// Blade angles of the free blades, `s` seconds on.
    pub(super) fn free(&self, tips: &Tips, s: f64) -> Tips {
        if *tips == Tips::default() {
            return *tips;
        }
        let response = self.kernel.at(s);
        Tips {
            angle: tips.angle * response.hold + tips.rate * response.unit,
            rate: tips.rate * response.slope - tips.angle * (self.kernel.stiffness * response.unit),
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
        let factor = self.omega + 2.0 * self.kernel.damping;
        [first, first * factor, first * factor * factor, first * factor * factor * factor]
    }
}

impl PartialEq for Tips {
    fn eq(&self, other: &Self) -> bool {
        self.angle == other.angle && self.rate == other.rate
    }
}

impl World {
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
        let between = self.direction(self.machine.rim.next(a)) - self.direction(a);
        let shift = (tips.angle * between.conj()).re;
        self.machine.rim.delta + 0.5 * diameters * shift
    }
}
