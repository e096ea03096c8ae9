//! Constants of the motion between two changes of speed: the machine in the blade frame, everything
//! per unit casing mass (docs/theory.md, section 10), and the rows that can touch.
//!
//! With `z = u exp(-i n_d theta)`, `a = alpha_c + i alpha_s` and the contact forces `Q_j` per unit
//! casing mass,
//!
//! - `z'' + drag z' + spring z = f exp(-i n_d theta) + (1 + i mu_c) sum Q_j exp(i psi_j)`
//! - `a'' + 2 c a' + omega_bd^2 a = -lever sum Q_j exp(i psi_j)`
//!
//! The blades on one side of the polygon touch together, so each side is a row with the same index.

use crate::model::Machine;
use crate::motion::Plane;
use crate::motion::point::Point;
use crate::motion::propagator::Propagator;
use crate::scene::{ModelSize, Scene};
use crate::tolerances;

/// Constants of the blade modes; absent with rigid blades.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blades {
    /// Free response of the blades.
    pub propagator: Propagator,
    /// Modal mass divided by the casing mass \[m^2\].
    pub mass: f64,
    /// Outward displacement of the tip per unit blade angle, `kappa l_b` \[m\].
    pub arm: f64,
    /// Lever arm of a contact force, `(kappa + mu) l_b` \[m\].
    pub moment: f64,
    /// Lever arm divided by the mass ratio \[1/m\].
    pub lever: f64,
}

/// Constants at one rotor speed.
#[derive(Clone, Debug)]
pub(super) struct Parameters {
    pub machine: Machine,
    /// Rotor speed \[rad/s\], and `nu = n_d` times it.
    pub speed: f64,
    pub nu: f64,
    /// Coefficient `2 zeta_c omega_c + 2 i nu` of the casing rate.
    pub drag: Plane,
    /// Coefficient `omega_c^2 - nu^2 + 2 i nu zeta_c omega_c` of the casing displacement.
    pub spring: Plane,
    /// Direction `1 + i mu_c` of a contact force with its friction.
    pub turn: Plane,
    /// Coefficient of friction, positive in the direction of increasing angle.
    pub friction: f64,
    /// Free response of the casing in the stationary frame.
    pub casing: Propagator,
    pub blades: Option<Blades>,
    /// Direction `exp(i psi)` in which a contact force of each row acts on casing and blade modes.
    pub rows: Vec<Plane>,
    /// Excess length of the longest tip on each row \[m\].
    longer: Vec<f64>,
    pub restitution: f64,
    /// Casing radius \[m\].
    pub radius: f64,
    /// Fraction of the motion's magnitude below which a gap counts as closed.
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

    /// Updates the blade response to the stiffness of the machine.
    pub(super) fn stiffen(&mut self) {
        let machine = &self.machine;
        if let Some(blades) = &mut self.blades {
            let omega = machine.omega_bd;
            blades.propagator = Propagator::new(machine.blade_damping_ratio * omega, omega * omega);
        }
    }

    /// Sets the rotor speed \[rad/s\].
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

    /// Returns the smallest gap with the casing undeformed \[m\].
    pub(super) fn least_clearance(&self) -> f64 {
        self.clearance() - self.longer.iter().copied().reduce(f64::max).unwrap_or(0.0)
    }

    /// Returns the gap of a row with the casing undeformed \[m\].
    pub(super) fn apothem(&self, row: usize) -> f64 {
        self.clearance() - self.longer.get(row).copied().unwrap_or(0.0)
    }

    /// Returns `kappa l_b`, or 0 for rigid blades \[m\].
    pub(super) fn arm(&self) -> f64 {
        self.blades.map_or(0.0, |blades| blades.arm)
    }

    /// Returns an upper bound on the rates of the free motion in the blade frame \[rad/s\].
    pub(super) fn rates(&self) -> f64 {
        let omega = self.machine.omega_c + 2.0 * self.casing.damping + self.nu.abs();
        let own = self
            .blades
            .map_or(0.0, |blades| self.machine.omega_bd + 2.0 * blades.propagator.damping);
        omega.max(own)
    }

    /// Returns the change of a row's gap by the displacements `z` and `a`.
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

    /// Returns the sum of the magnitudes of those accelerations' terms along a gap, for round-off
    /// estimates.
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

    /// Returns the accelerations of casing and blades due to contact forces, each given with its
    /// row.
    pub(super) fn pushed(&self, pushes: impl Iterator<Item = (usize, f64)>) -> (Plane, Plane) {
        self.moved(pushes.filter_map(|(row, push)| Some((*self.rows.get(row)?, push))))
    }

    /// As [`pushed`](Self::pushed), for contact forces along given directions.
    pub(super) fn moved(&self, pushes: impl Iterator<Item = (Plane, f64)>) -> (Plane, Plane) {
        let sum = pushes.fold(Plane::default(), |sum, (direction, push)| sum + direction * push);
        (self.turn * sum, sum * -self.blades.map_or(0.0, |blades| blades.lever))
    }

    /// Returns the acceleration of the gap of `row` due to a unit contact force on row `by`, the
    /// entry of `W`. Not symmetric with friction.
    pub(super) fn joint(&self, row: usize, by: usize) -> f64 {
        let (z, a) = self.pushed(std::iter::once((by, 1.0)));
        self.along(row, z, a)
    }

    /// Returns the velocity of the casing in the stationary frame, in components along the axes of
    /// the blade frame.
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

    /// Returns a bound on the displacement at any gap without pulse and contact: the energies of
    /// casing and blades can only decrease \[m\].
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

/// Returns the component of a displacement of casing and blades along the direction of a row; `arm`
/// is the outward tip displacement per unit blade angle.
pub(super) fn along(direction: Plane, arm: f64, z: Plane, a: Plane) -> f64 {
    let casing = direction.re * z.re + direction.im * z.im;
    casing - arm * (direction.re * a.re + direction.im * a.im)
}
