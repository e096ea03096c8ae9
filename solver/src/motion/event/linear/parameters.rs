//! What does not change between two changes of speed: the machine in the frame of the
//! blades, everything per unit casing mass (docs/theory.md, section 10), and what can touch.
//!
//! With `z = u exp(-i n_d theta)`, `a = alpha_c + i alpha_s` and the pushes `Q_j` per
//! unit casing mass,
//!
//! `z'' + drag z' + spring z = f exp(-i n_d theta) + (1 + i mu_c) sum Q_j exp(i psi_j)`,
//! `a'' + 2 c a' + omega_bd^2 a = -lever sum Q_j exp(i psi_j)`.
//!
//! The blades of one side of the polygon touch together: each side is one row, of the same
//! number.

use crate::model::Machine;
use crate::motion::Plane;
use crate::motion::point::Point;
use crate::motion::propagator::Propagator;
use crate::scene::{ModelSize, Scene};
use crate::tolerances;

/// The blade modes, where they move.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blades {
    /// Response of the free blades.
    pub propagator: Propagator,
    /// Modal mass over casing mass \[m^2\].
    pub mass: f64,
    /// How far outward a blade angle of 1 rad moves the tip, `kappa l_b` \[m\].
    pub arm: f64,
    /// Moment arm of a push, `(kappa + mu) l_b` \[m\].
    pub moment: f64,
    /// That over the mass ratio \[1/m\].
    pub lever: f64,
}

/// The machine at one speed.
#[derive(Clone, Debug)]
pub(super) struct Parameters {
    pub machine: Machine,
    /// Rotor speed \[rad/s\], and `nu = n_d` times it.
    pub speed: f64,
    pub nu: f64,
    /// `2 zeta_c omega_c + 2 i nu`.
    pub drag: Plane,
    /// `omega_c^2 - nu^2 + 2 i nu zeta_c omega_c`.
    pub spring: Plane,
    /// `1 + i mu_c`.
    pub turn: Plane,
    /// Friction coefficient in the direction of increasing angle.
    pub friction: f64,
    /// Response of the free casing in the standing frame.
    pub casing: Propagator,
    pub blades: Option<Blades>,
    /// Direction `exp(i psi)` in which a push of each row moves casing and blade modes.
    pub rows: Vec<Plane>,
    /// How much the longest tip of each row is longer \[m\].
    longer: Vec<f64>,
    pub restitution: f64,
    /// Casing radius \[m\].
    pub radius: f64,
    /// Gaps below this part of the motion's size count as closed.
    pub tolerance: f64,
}

impl Parameters {
    pub(super) fn new(scene: &Scene) -> Self {
        let machine = scene.machine();
        let direction = |side| {
            let (cos, sin) = machine.polygon.direction(side);
            Plane::new(cos, sin)
        };
        let moving = scene.solver.model != ModelSize::Rigid;
        let (omega, omega_bd) = (machine.omega_c, machine.omega_bd);
        let blades = moving.then(|| Blades {
            propagator: Propagator::new(
                machine.blade_damping_ratio * omega_bd,
                omega_bd * omega_bd,
            ),
            mass: machine.blade_modal_mass / machine.casing_mass,
            arm: machine.radial_coupling * machine.blade_length,
            moment: 0.0,
            lever: 0.0,
        });
        let mut parameters = Self {
            rows: (0..machine.polygon.sides).map(direction).collect(),
            longer: (0..machine.polygon.sides).map(|side| machine.longest_of_side(side)).collect(),
            casing: Propagator::new(machine.casing_damping_ratio * omega, omega * omega),
            blades,
            speed: 0.0,
            nu: 0.0,
            drag: Plane::default(),
            spring: Plane::default(),
            turn: Plane::default(),
            friction: 0.0,
            restitution: scene.contact.restitution,
            radius: scene.casing.radius_m,
            tolerance: tolerances::EVENT,
            machine,
        };
        parameters.turn_at(scene.operation.speed_rad_s);
        parameters
    }

    /// Gives the blades the stiffness of the machine.
    pub(super) fn stiffen(&mut self) {
        let machine = &self.machine;
        if let Some(blades) = &mut self.blades {
            let omega = machine.omega_bd;
            blades.propagator = Propagator::new(machine.blade_damping_ratio * omega, omega * omega);
        }
    }

    /// Takes another rotor speed \[rad/s\].
    pub(super) fn turn_at(&mut self, speed: f64) {
        let machine = &self.machine;
        let (nu, damping) = (machine.nu(speed), 2.0 * self.casing.damping);
        self.drag = Plane::new(damping, 2.0 * nu);
        self.spring = Plane::new(self.casing.stiffness - nu * nu, nu * damping);
        self.turn = Plane::new(1.0, machine.casing_friction_at(speed));
        self.friction = machine.friction_at(speed);
        let slope = machine.radial_coupling + self.friction;
        if let Some(blades) = &mut self.blades {
            blades.moment = slope * machine.blade_length;
            blades.lever = blades.moment / blades.mass;
        }
        (self.speed, self.nu) = (speed, nu);
    }

    /// Returns the clearance `g0` \[m\].
    pub(super) fn clearance(&self) -> f64 {
        self.machine.clearance()
    }

    /// Returns the smallest gap of a casing at rest \[m\].
    pub(super) fn least_clearance(&self) -> f64 {
        self.clearance() - self.longer.iter().copied().reduce(f64::max).unwrap_or(0.0)
    }

    /// Returns the gap of a row of a casing at rest \[m\].
    pub(super) fn apothem(&self, row: usize) -> f64 {
        self.clearance() - self.longer.get(row).copied().unwrap_or(0.0)
    }

    /// Returns `kappa l_b`, or 0 where the blades do not move \[m\].
    pub(super) fn arm(&self) -> f64 {
        self.blades.map_or(0.0, |blades| blades.arm)
    }

    /// Returns the sum of all rates of the free motion, seen from the blades \[rad/s\].
    pub(super) fn rates(&self) -> f64 {
        let omega = self.machine.omega_c + 2.0 * self.casing.damping + self.nu.abs();
        let own = self
            .blades
            .map_or(0.0, |blades| self.machine.omega_bd + 2.0 * blades.propagator.damping);
        omega.max(own)
    }

    /// Returns the share of a displacement of casing and blades along a row.
    pub(super) fn along(&self, row: usize, z: Plane, a: Plane) -> f64 {
        self.rows.get(row).map_or(0.0, |direction| along(*direction, self.arm(), z, a))
    }

    /// Returns the gap of a row \[m\].
    pub(super) fn gap(&self, row: usize, point: &Point) -> f64 {
        self.apothem(row) + self.along(row, point.z, point.a)
    }

    /// Returns the accelerations of casing and blades without contact forces.
    pub(super) fn free(&self, point: &Point, force: Plane) -> (Plane, Plane) {
        let z = force - self.spring * point.z - self.drag * point.dz;
        let a = self.blades.map_or_else(Plane::default, |blades| {
            let Propagator { damping, stiffness, .. } = blades.propagator;
            -(point.a * stiffness + point.da * (2.0 * damping))
        });
        (z, a)
    }

    /// Returns the sum of the magnitudes of the terms of such accelerations along a gap.
    pub(super) fn size_of_free(&self, point: &Point, force: Plane) -> f64 {
        let casing = size(force)
            + (self.casing.stiffness + self.nu * self.nu) * size(point.z)
            + size(self.drag) * size(point.dz);
        let blades = self.blades.map_or(0.0, |blades| {
            let Propagator { damping, stiffness, .. } = blades.propagator;
            stiffness * size(point.a) + 2.0 * damping * size(point.da)
        });
        casing + self.arm().abs() * blades
    }

    /// Returns what these contact forces, each with its row, add to the accelerations of casing
    /// and blades.
    pub(super) fn pushed(&self, pushes: impl Iterator<Item = (usize, f64)>) -> (Plane, Plane) {
        self.moved(pushes.filter_map(|(row, push)| Some((*self.rows.get(row)?, push))))
    }

    /// Returns the same for contact forces along these directions.
    pub(super) fn moved(&self, pushes: impl Iterator<Item = (Plane, f64)>) -> (Plane, Plane) {
        let sum = pushes.fold(Plane::default(), |sum, (direction, push)| sum + direction * push);
        (self.turn * sum, sum * -self.blades.map_or(0.0, |blades| blades.lever))
    }

    /// Returns how much a unit contact force on row `by` opens `row`: `W`, not symmetric under
    /// friction.
    pub(super) fn joint(&self, row: usize, by: usize) -> f64 {
        let (z, a) = self.pushed(std::iter::once((by, 1.0)));
        self.along(row, z, a)
    }

    /// Returns the velocity of the casing in the fixed frame, along the axes of the blades.
    pub(super) fn carried(&self, point: &Point) -> Plane {
        point.dz + Plane::i() * point.z * self.nu
    }

    /// Returns the energy per unit casing mass \[m^2/s^2\].
    pub(super) fn energy(&self, point: &Point) -> f64 {
        let casing = self.carried(point).norm_sqr() + self.casing.stiffness * point.z.norm_sqr();
        let blades = self.blades.map_or(0.0, |blades| {
            let stiffness = blades.propagator.stiffness;
            blades.mass * (point.da.norm_sqr() + stiffness * point.a.norm_sqr())
        });
        0.5 * (casing + blades)
    }

    /// Returns a bound of the displacement at a gap without pulse and contact, as both energies
    /// only fall \[m\].
    pub(super) fn swing(&self, point: &Point) -> f64 {
        let reach = |place: Plane, rate: Plane, stiffness: f64| {
            (place.norm_sqr() + rate.norm_sqr() / stiffness).sqrt()
        };
        let casing = reach(point.z, self.carried(point), self.casing.stiffness);
        casing
            + self.blades.map_or(0.0, |blades| {
                blades.arm.abs() * reach(point.a, point.da, blades.propagator.stiffness)
            })
    }

    /// Returns the largest angle of any blade \[rad\].
    pub(super) fn largest_angle(&self, a: Plane) -> f64 {
        self.machine.polygon.largest_component(a.re, a.im)
    }
}

/// Returns the length of a vector.
pub(super) fn size(vector: Plane) -> f64 {
    vector.norm_sqr().sqrt()
}

/// Returns the share of a displacement of casing and blades, whose tips rise by `arm`, along the
/// direction of a row.
pub(super) fn along(direction: Plane, arm: f64, z: Plane, a: Plane) -> f64 {
    let casing = direction.re * z.re + direction.im * z.im;
    casing - arm * (direction.re * a.re + direction.im * a.im)
}
