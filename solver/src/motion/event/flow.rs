//! Equations of motion in the blade frame, everything per unit casing mass, and the rows that can
//! touch (docs/theory.md, section 7; for other tips docs/theory.md, section 10).
//!
//! With `z = u exp(-i n_d theta)`, `a = alpha_c + i alpha_s`, `nu = n_d Omega` and the contact force
//! `Q_j` of row `j` per unit casing mass,
//!
//! - `z'' + drag z' + spring z = f exp(-i n_d theta) + (1 + i mu_c) sum Q_j n_j`
//! - `a'' + 2 c a' + omega_bd^2 a = -sum Q_j lever_j exp(i psi_j)`
//!
//! The blades on one side of the polygon touch together, so each side is a row with the same index.
//! With `alpha = Re[a exp(-i psi)]`, the normal `n = exp(i psi + i d alpha)` and
//! `x + i y = z conj(n)` its gap is
//!
//! - `apothem + x - kappa l_b alpha`, and `lever = ((kappa + mu) l_b - d y)/mass`
//!
//! where `d = n_d` for radial tips without friction, the paper's model, and 0 for the others, whose
//! slope and friction move the blades far more than the phase does.

use crate::model::Machine;
use crate::motion::point::Point;
use crate::motion::propagator::Propagator;
use crate::motion::{Plane, across, dot, size, turned};
use crate::scene::{ModelSize, Scene};

/// Gaps below this part of the motion's size count as closed: a few roundings. Larger: impacts come
/// that much early. Smaller: a touch may be searched again and again.
pub(crate) const EVENT: f64 = 1e-15;

/// Stiff blades are solved as rigid ones if they are this much faster than all other rates. Smaller:
/// their vibration is missed.
const RIGID_RATES: f64 = 100.0;

/// Part of the clearance by which such blades may move a gap. Larger: gaps are wrong in as many
/// digits.
const RIGID_GAP: f64 = 1e-9;

/// Assumed bound on the casing speed besides that of pulse and start: clearances per radian of the
/// casing's rates.
const CLEARANCES_A_RADIAN: f64 = 10.0;

/// Constants of the blade modes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blades {
    /// Free response of the blades.
    pub propagator: Propagator,
    /// Modal mass divided by the casing mass \[m^2\].
    pub mass: f64,
    /// Outward displacement of the tip per unit blade angle, `kappa l_b` \[m\].
    pub arm: f64,
    /// Lever arm of a contact force, `(kappa + mu) l_b` \[m\].
    moment: f64,
    /// Coefficient `d` of the blade angle in the phase of a gap.
    pub diameters: f64,
}

/// Gradient of a gap, and what a unit contact force accelerates, at one point of the motion.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Face {
    /// `exp(i psi)`.
    pub base: Plane,
    /// Change of the gap with `z`, and direction of the force without friction.
    pub normal: Plane,
    /// Change of the gap with `-a` \[m\].
    lift: Plane,
    /// Acceleration of the casing.
    pub casing: Plane,
    /// Angular acceleration of the blades \[1/m\].
    pub blades: Plane,
}

impl Face {
    /// Returns the change of the gap by the casing displacement `z` and the blade angle `a` \[m\].
    pub(super) fn along(&self, z: Plane, a: Plane) -> f64 {
        dot(self.normal, z) - dot(self.lift, a)
    }

    /// Returns the acceleration of this gap by a unit contact force on `by`, the entry of `W`. Not
    /// symmetric with friction.
    pub(super) fn joint(&self, by: &Self) -> f64 {
        self.along(by.casing, by.blades)
    }
}

/// Returns the accelerations by contact forces on these faces, or the jumps of the rates by impulses.
pub(super) fn pushed<'a>(pushes: impl Iterator<Item = (&'a Face, f64)>) -> (Plane, Plane) {
    let (mut z, mut a) = (Plane::default(), Plane::default());
    for (face, push) in pushes {
        z += face.casing * push;
        a += face.blades * push;
    }
    (z, a)
}

/// The equations at one rotor speed.
#[derive(Clone, Debug)]
pub(super) struct Flow {
    pub machine: Machine,
    /// Rotor speed \[rad/s\], and `nu = n_d` times it.
    pub speed: f64,
    pub nu: f64,
    /// Rate of `nu` \[rad/s^2\].
    pub nu_rate: f64,
    /// Direction `1 + i mu_c` of a contact force with its friction.
    pub turn: Plane,
    /// Coefficient of friction, positive in the direction of increasing angle.
    pub friction: f64,
    /// Free response of the casing in the stationary frame.
    pub casing: Propagator,
    /// Constants of the blade modes; `None` for blades that do not move.
    pub blades: Option<Blades>,
    /// Whether the blades are too stiff for the casing to notice and are solved as rigid ones.
    pub solved_as_rigid: bool,
    /// Direction `exp(i psi)` of each row.
    pub rows: Vec<Plane>,
    /// Excess length of the longest tip on each row \[m\].
    longer: Vec<f64>,
    /// Excess length of the longest tip \[m\].
    longest: f64,
    pub restitution: f64,
    /// Casing radius \[m\].
    pub radius: f64,
    /// Fraction of the motion's magnitude below which a gap counts as closed.
    pub tolerance: f64,
}

impl Flow {
    pub(super) fn new(scene: &Scene) -> Self {
        let machine = scene.machine();
        let direction = |side| {
            let (cos, sin) = machine.polygon.direction(side);
            Plane::new(cos, sin)
        };
        let (omega, omega_bd) = (machine.omega_c, machine.omega_bd);
        let radial = machine.radial_coupling == 0.0 && machine.friction == 0.0;
        let moving =
            scene.solver.model != ModelSize::Rigid && !(radial && machine.nodal_diameters == 0.0);
        let blades = moving.then(|| Blades {
            propagator: Propagator::new(
                machine.blade_damping_ratio * omega_bd,
                omega_bd * omega_bd,
            ),
            mass: machine.blade_modal_mass / machine.casing_mass,
            arm: machine.radial_coupling * machine.blade_length,
            moment: 0.0,
            diameters: if radial { machine.nodal_diameters } else { 0.0 },
        });
        let solved_as_rigid = radial && blades.is_some_and(|own| own.are_rigid(scene, &machine));
        let longer: Vec<f64> =
            (0..machine.polygon.sides).map(|side| machine.longest_of_side(side)).collect();
        let mut flow = Self {
            rows: (0..machine.polygon.sides).map(direction).collect(),
            longest: longer.iter().copied().reduce(f64::max).unwrap_or(0.0),
            longer,
            casing: Propagator::new(machine.casing_damping_ratio * omega, omega * omega),
            blades: blades.filter(|_| !solved_as_rigid),
            solved_as_rigid,
            speed: 0.0,
            nu: 0.0,
            nu_rate: 0.0,
            turn: Plane::default(),
            friction: 0.0,
            restitution: scene.contact.restitution,
            radius: scene.casing.radius_m,
            tolerance: EVENT,
            machine,
        };
        flow.turn_at(scene.operation.speed_rad_s, scene.operation.speed_ramp_rad_s2);
        flow
    }

    /// Updates the blade response to the stiffness of the machine.
    pub(super) fn stiffen(&mut self) {
        let machine = &self.machine;
        if let Some(blades) = &mut self.blades {
            let omega = machine.omega_bd;
            blades.propagator = Propagator::new(machine.blade_damping_ratio * omega, omega * omega);
        }
    }

    /// Sets speed \[rad/s\] and acceleration \[rad/s^2\] of the rotor.
    pub(super) fn turn_at(&mut self, speed: f64, ramp: f64) {
        let machine = &self.machine;
        self.turn = Plane::new(1.0, machine.casing_friction_at(speed));
        self.friction = machine.friction_at(speed);
        let slope = machine.radial_coupling + self.friction;
        if let Some(blades) = &mut self.blades {
            blades.moment = slope * machine.blade_length;
        }
        (self.speed, self.nu, self.nu_rate) = (speed, machine.nu(speed), machine.nu(ramp));
    }

    /// Returns the coefficients of `z`, a polynomial of the time from now on.
    pub(super) fn spring(&self) -> [Plane; 3] {
        let (nu, ramp, damping) = (self.nu, self.nu_rate, 2.0 * self.casing.damping);
        // The difference of squares as a product is exactly zero at nu = omega_c.
        let omega = self.machine.omega_c;
        [
            Plane::new((omega - nu) * (omega + nu), nu * damping + ramp),
            Plane::new(-2.0 * nu * ramp, damping * ramp),
            Plane::new(-ramp * ramp, 0.0),
        ]
    }

    /// Returns the coefficients of `z'` in the same way.
    pub(super) fn drag(&self) -> [Plane; 2] {
        let damping = 2.0 * self.casing.damping;
        [Plane::new(damping, 2.0 * self.nu), Plane::new(0.0, 2.0 * self.nu_rate)]
    }

    /// Returns the turn `n_d theta` of the rotor in `s` seconds \[rad\].
    pub(super) fn turned(&self, s: f64) -> f64 {
        (self.nu + 0.5 * self.nu_rate * s) * s
    }

    /// Returns `nu` after `s` seconds \[rad/s\].
    pub(super) fn nu_at(&self, s: f64) -> f64 {
        self.nu + self.nu_rate * s
    }

    /// Returns the clearance `g0` \[m\].
    pub(super) fn clearance(&self) -> f64 {
        self.machine.clearance()
    }

    /// Returns the smallest gap with the casing undeformed \[m\].
    pub(super) fn least_clearance(&self) -> f64 {
        self.clearance() - self.longest
    }

    /// Returns the gap of a row with the casing undeformed \[m\].
    pub(super) fn apothem(&self, row: usize) -> f64 {
        self.clearance() - self.longer.get(row).copied().unwrap_or(0.0)
    }

    /// Returns `kappa l_b`, or 0 for rigid blades \[m\].
    pub(super) fn arm(&self) -> f64 {
        self.blades.map_or(0.0, |blades| blades.arm)
    }

    /// Returns the coefficient `d` of the blade angle in the phases of the gaps.
    pub(super) fn diameters(&self) -> f64 {
        self.blades.map_or(0.0, |blades| blades.diameters)
    }

    /// Returns an upper bound on the rates of the free casing in the blade frame \[rad/s\].
    pub(super) fn casing_rates(&self) -> f64 {
        let ramp = self.nu_rate.abs().sqrt();
        self.machine.omega_c + 2.0 * self.casing.damping + self.nu.abs() + ramp
    }

    /// Returns the rate of the motion along a side with rigid blades, without pulse and ramp; not
    /// much less than that of the free casing \[rad/s\].
    pub(super) fn side_rates(&self) -> f64 {
        let drag = 2.0 * (self.turn.im * self.nu).abs();
        let own = 2.0 * self.casing.damping + self.spring()[0].re.abs().sqrt() + drag;
        own.max(0.1 * self.casing_rates())
    }

    /// Returns an upper bound on the rates of casing and blades \[rad/s\].
    pub(super) fn rates(&self) -> f64 {
        let own = |blades: Blades| self.machine.omega_bd + 2.0 * blades.propagator.damping;
        self.casing_rates().max(self.blades.map_or(0.0, own))
    }

    /// Returns the direction `exp(i psi)` of a row, and its normal with the blades at the angle `a`.
    pub(super) fn normal(&self, row: usize, a: Plane) -> (Plane, Plane) {
        let base = self.rows.get(row).copied().unwrap_or_default();
        let phase = self.diameters() * dot(base, a);
        (base, if phase == 0.0 { base } else { turned(base, phase) })
    }

    /// Returns the face of a row at a point.
    #[inline]
    pub(super) fn face(&self, row: usize, point: &Point) -> Face {
        let (base, normal) = self.normal(row, point.a);
        let Some(blades) = &self.blades else {
            return Face { base, normal, casing: self.turn * base, ..Face::default() };
        };
        let y = blades.diameters * across(normal, point.z);
        let (lift, lever) = (blades.arm - y, (blades.moment - y) / blades.mass);
        let (lift, blades) = (base * lift, base * -lever);
        Face { base, normal, lift, casing: self.turn * normal, blades }
    }

    /// Returns the gap of a row \[m\].
    pub(super) fn gap(&self, row: usize, point: &Point) -> f64 {
        let (base, normal) = self.normal(row, point.a);
        self.apothem(row) + dot(normal, point.z) - self.arm() * dot(base, point.a)
    }

    /// Returns the gap of a row with its face at the point \[m\].
    pub(super) fn gap_at(&self, row: usize, face: &Face, point: &Point) -> f64 {
        self.apothem(row) + dot(face.normal, point.z) - self.arm() * dot(face.base, point.a)
    }

    /// Returns the rows whose gaps may be smaller than `gap`: the nearest, which is looked for from the
    /// row `near` on, those after it, and those before it.
    pub(super) fn near(
        &self,
        point: &Point,
        gap: f64,
        near: Option<usize>,
    ) -> impl Iterator<Item = usize> + use<> {
        let (z, sides) = (point.z, self.rows.len());
        let turned = (self.arm().abs() + self.diameters() * size(z)) * size(point.a);
        let most = gap + turned - self.least_clearance();
        let open = |row: usize| dot(self.rows[row], z);
        let next = |row: usize| if row + 1 == sides { 0 } else { row + 1 };
        let last = |row: usize| if row == 0 { sides - 1 } else { row - 1 };
        let nearest = || self.machine.polygon.nearest_side(z.re, z.im) as usize;
        let mut nearest = near.unwrap_or_else(nearest);
        while open(next(nearest)) < open(nearest) {
            nearest = next(nearest);
        }
        while open(last(nearest)) < open(nearest) {
            nearest = last(nearest);
        }
        let (mut up, mut end) = (0, nearest);
        while up < sides && open(end) <= most {
            (up, end) = (up + 1, next(end));
        }
        let (mut all, mut end) = (up, last(nearest));
        while (1..sides).contains(&all) && open(end) <= most {
            (all, end) = (all + 1, last(end));
        }
        (0..all).map(move |k| {
            let row = if k < up { nearest + k } else { nearest + sides - (k + 1 - up) };
            if row < sides { row } else { row - sides }
        })
    }

    /// Returns the rate of the gap of a row \[m/s\].
    pub(super) fn gap_rate(&self, row: usize, point: &Point) -> f64 {
        self.face(row, point).along(point.dz, point.da)
    }

    /// Returns the acceleration of the gap of a face at this point, for the accelerations `free` of
    /// casing and blades \[m/s^2\].
    pub(super) fn gap_bend(&self, face: &Face, point: &Point, free: (Plane, Plane)) -> f64 {
        let turning = self.diameters() * dot(face.base, point.da);
        let (across, along) = (across(face.normal, point.dz), dot(face.normal, point.z));
        face.along(free.0, free.1) + turning * (2.0 * across - turning * along)
    }

    /// Returns the accelerations of casing and blades without contact forces.
    pub(super) fn free(&self, point: &Point, force: Plane) -> (Plane, Plane) {
        let z = force - self.spring()[0] * point.z - self.drag()[0] * point.dz;
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
            + size(self.drag()[0]) * size(point.dz);
        let blades = self.blades.map_or(0.0, |blades| {
            let Propagator { damping, stiffness, .. } = blades.propagator;
            let lift = blades.arm.abs() + blades.diameters * size(point.z);
            lift * (stiffness * size(point.a) + 2.0 * damping * size(point.da))
        });
        casing + blades
    }

    /// Returns the velocity of the casing in the stationary frame, in components along the axes of
    /// the blade frame, `s` seconds after the start of the stretch.
    pub(super) fn carried(&self, point: &Point, s: f64) -> Plane {
        point.dz + Plane::i() * point.z * self.nu_at(s)
    }

    /// Returns the energies of casing and blades `s` seconds after the start of the stretch \[J\].
    pub(super) fn energies(&self, point: &Point, s: f64) -> [f64; 2] {
        let casing = self.carried(point, s).norm_sqr() + self.casing.stiffness * point.z.norm_sqr();
        let blades = self.blades.map_or(0.0, |blades| {
            let stiffness = blades.propagator.stiffness;
            blades.mass * (point.da.norm_sqr() + stiffness * point.a.norm_sqr())
        });
        [casing, blades].map(|twice| 0.5 * self.machine.casing_mass * twice)
    }

    /// Returns their sum \[J\].
    pub(super) fn energy(&self, point: &Point, s: f64) -> f64 {
        let [casing, blades] = self.energies(point, s);
        casing + blades
    }

    /// Returns the largest angle of any blade \[rad\].
    pub(super) fn largest_angle(&self, a: Plane) -> f64 {
        self.machine.polygon.largest_component(a.re, a.im)
    }
}

impl Blades {
    /// Returns whether these blades act on the casing as rigid ones: they are so much faster than the
    /// motion that their angles follow the contact forces statically, and these are small.
    fn are_rigid(&self, scene: &Scene, machine: &Machine) -> bool {
        let operation = &scene.operation;
        let nu = machine.nu(scene.fastest_rad_s());
        let (rates, omega) = (machine.omega_c + nu, machine.omega_bd);
        let (clearance, half_side) = (machine.clearance(), machine.polygon.half_side());
        // Bounds on a lasting contact force and on an impulse, per unit mass.
        let pulse = operation.pulse_n.abs() / machine.casing_mass;
        let start = scene.initial.v_c_m_s.hypot(scene.initial.v_s_m_s);
        let speed = pulse * operation.pulse_s + start + CLEARANCES_A_RADIAN * rates * clearance;
        let push = pulse + rates * rates * clearance + 2.0 * nu * speed;
        let moment_arm = self.diameters / self.mass * half_side;
        let angle = moment_arm * (push / omega + speed) / omega;
        omega > RIGID_RATES * rates && self.diameters * angle * half_side < RIGID_GAP * clearance
    }
}
