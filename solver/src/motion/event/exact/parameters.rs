//! What does not change along a run, and what is constant between events: the machine, rotor
//! and pulse, and the blades of the four-coordinate model, two damped oscillators in the
//! turning frame, `a = alpha_c + i alpha_s`, that shift the phases of the sides
//! (docs/theory.md, section 4).
//!
//! A blade of phase `psi` stands at the angle `alpha = Re[a exp(-i psi)]`, so a
//! group's gap is `g0 + Re[u exp(-i gamma)]` with `gamma = n_d theta + psi +
//! n_d alpha`. With `u = (-g0 + i y) exp(i gamma)` on a side, a push `N` turns
//! the blades by the moment `N n_d y` on the mode along `exp(i psi)`: the
//! contact feels the mass ratio `ratio y^2`, `ratio = m_c n_d^2/M_blade`.

use std::f64::consts::PI;

use crate::model::Machine;
use crate::motion::Plane;
use crate::motion::propagator::Propagator;
use crate::scene::{ModelSize, Scene};
use crate::tolerances::{
    self, CERTAIN_PUSH, CLEARANCES_A_RADIAN, FOLLOWING_GAP, FOLLOWING_RATES, ROUND_OFF,
};

/// The machine in the units the solver works with: everything per unit mass.
#[derive(Clone, Debug)]
pub(super) struct Parameters {
    pub machine: Machine,
    /// Clearance `g0` \[m\].
    pub clearance: f64,
    /// Where a side ends, `g0 tan delta`; without corners, the casing radius,
    /// beyond which a sliding motion is given up \[m\].
    pub half_side: f64,
    /// Casing frequency \[rad/s\].
    pub omega: f64,
    /// `zeta_c omega_c` \[1/s\].
    pub damping: f64,
    /// Response of the free casing.
    pub propagator: Propagator,
    /// The blades, where they move.
    pub blades: Option<Blades>,
    /// Blades too stiff for the casing to notice: their angles follow the pushes.
    pub following: Option<Blades>,
    /// Casing modal mass \[kg\].
    pub mass: f64,
    /// Cosine and sine of the angle `2 delta` between neighbouring sides.
    pub turn: Plane,
    /// Whether the polygon has corners.
    pub corners: bool,
    /// Beyond this the motion is given up: the casing radius \[m\].
    pub reach: f64,
    /// Gaps below this part of the motion's size count as closed.
    pub tolerance: f64,
    pub drive: Drive,
}

impl Parameters {
    pub(super) fn new(scene: &Scene) -> Self {
        let machine = scene.machine();
        let corners = machine.polygon.has_corners();
        let damping = machine.casing_damping_ratio * machine.omega_c;
        let blades = Blades::of(scene, &machine);
        let negligible = blades.is_some_and(|blades| blades.negligible(scene, &machine));
        let twice = 2.0 * PI / f64::from(machine.polygon.sides);
        Self {
            clearance: machine.clearance(),
            half_side: if corners { machine.polygon.half_side() } else { scene.casing.radius_m },
            omega: machine.omega_c,
            damping,
            propagator: Propagator::new(damping, machine.omega_c * machine.omega_c),
            blades: if negligible { None } else { blades },
            following: if negligible { blades } else { None },
            mass: machine.casing_mass,
            turn: Plane::cis(twice),
            corners,
            reach: scene.casing.radius_m,
            tolerance: tolerances::EVENT,
            drive: Drive::default(),
            machine,
        }
    }

    /// Takes the machine at a rotor speed \[rad/s\]; what it gives to blades at these
    /// angles, per unit casing mass \[m^2/s^2\].
    pub(super) fn turn_at(&mut self, speed: f64, tips: &Tips) -> f64 {
        let stored = |parameters: &Self| {
            let of = |blades: Blades| 0.5 * blades.mass * blades.propagator.stiffness;
            parameters.blades.map_or(0.0, of) * tips.angle.norm_sqr()
        };
        let before = stored(self);
        self.machine.turn_at(speed);
        self.clearance = self.machine.clearance();
        if self.corners {
            self.half_side = self.machine.polygon.half_side();
        }
        for blades in self.blades.iter_mut().chain(&mut self.following) {
            blades.turn_at(&self.machine);
        }
        stored(self) - before
    }

    /// Returns `exp(i psi)` of a side.
    pub(super) fn direction(&self, side: u32) -> Plane {
        let (cos, sin) = self.machine.polygon.direction(side);
        Plane::new(cos, sin)
    }

    /// Returns `exp(i (psi + n_d alpha))` of a side, the direction in which its gap opens as
    /// the rotor sees it, and the rate `n_d alpha'`.
    pub(super) fn normal(&self, side: u32, tips: &Tips) -> (Plane, f64) {
        let direction = self.direction(side);
        let Some(blades) = &self.blades else { return (direction, 0.0) };
        let along = direction.conj() * blades.diameters;
        (direction * Plane::cis((tips.angle * along).re), (tips.rate * along).re)
    }

    /// Returns half the length of the side `a` towards the next \[m\].
    pub(super) fn half_length(&self, a: u32, tips: &Tips) -> f64 {
        match self.blades {
            None => self.half_side,
            Some(_) => self.clearance * self.half_angle(a, tips).tan(),
        }
    }

    /// Returns `exp(2 i tau)`, the turn from a side to the next.
    pub(super) fn turn_between(&self, a: u32, tips: &Tips) -> Plane {
        match self.blades {
            None => self.turn,
            Some(_) => Plane::cis(2.0 * self.half_angle(a, tips)),
        }
    }

    /// Mass ratio of a push: it opens its own gap by `1 + coupling y^2` \[1/m^2\].
    pub(super) fn coupling(&self) -> f64 {
        self.blades.map_or(0.0, |blades| blades.ratio)
    }

    /// Returns the round-off of the pushes of a corner: of the accelerations that cancel in
    /// them \[m/s^2\].
    pub(super) fn push_noise(&self) -> f64 {
        let square = (self.omega * self.omega).max(self.drive.nu * self.drive.nu);
        let spread = if self.corners { self.turn.im.abs() } else { 1.0 };
        ROUND_OFF * (square * self.clearance + self.drive.pulse.abs()) / spread
    }

    /// Returns the push of a corner above which its sign is certain \[m/s^2\].
    pub(super) fn certain_push(&self) -> f64 {
        CERTAIN_PUSH * self.machine.push_scale(self.drive.nu) / self.mass
    }

    /// Returns the pulse times `exp(i beta)` of a side, the direction that opens its gap,
    /// `s` seconds on \[m/s^2\].
    pub(super) fn pulse_on(&self, side: u32, s: f64) -> Plane {
        // Nearly always there is none: no sine then.
        if self.drive.pulse == 0.0 {
            return Plane::default();
        }
        self.direction(side) * Plane::cis(self.drive.phase(s)) * self.drive.pulse
    }

    /// Returns the push per unit mass that keeps the casing on a side at `y` with rate
    /// `rate`, while the wave turns by `nu` against the standing frame and the
    /// pulse has the component `pulse` along `exp(i beta)` \[m/s^2\]; negative
    /// where the side would have to pull.
    pub(super) fn push(&self, nu: f64, nu_rate: f64, y: f64, rate: f64, pulse: f64) -> f64 {
        -(self.omega * self.omega - nu * nu) * self.clearance
            - 2.0 * nu * rate
            - (2.0 * self.damping * nu + nu_rate) * y
            - pulse
    }
}

/// Rotor and pulse from the start of a segment on.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Drive {
    /// `n_d theta` at the start, modulo a turn \[rad\].
    pub phase: f64,
    /// `n_d Omega` at the start \[rad/s\].
    pub nu: f64,
    /// `n_d` times the acceleration \[rad/s^2\].
    pub nu_rate: f64,
    /// Pulse force over casing mass on the `u_c` equation \[m/s^2\].
    pub pulse: f64,
}

impl Drive {
    /// Returns `n_d theta`, `s` seconds on \[rad\].
    pub(super) fn phase(&self, s: f64) -> f64 {
        self.phase + (self.nu + 0.5 * self.nu_rate * s) * s
    }

    /// Returns `n_d Omega`, `s` seconds on \[rad/s\].
    pub(super) fn nu(&self, s: f64) -> f64 {
        self.nu + self.nu_rate * s
    }

    /// Returns whether neither pulse nor ramp acts.
    pub(super) fn steady(&self) -> bool {
        self.pulse == 0.0 && self.nu_rate == 0.0
    }
}

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
    /// Creates the blades of a scene, if they move and can be moved: not in the rigid
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

    /// Becomes as stiff as a machine at some speed has them.
    fn turn_at(&mut self, machine: &Machine) {
        self.omega = machine.omega_bd;
        let damping = machine.blade_damping_ratio * self.omega;
        self.propagator = Propagator::new(damping, self.omega * self.omega);
    }

    /// Returns whether the casing cannot tell them from rigid ones, and they are so much
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

    /// Returns the angles of blades that follow these pushes at once.
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

    /// Returns the largest angle of blades at rest after this impulse at `y` \[rad\].
    pub(super) fn kicked(&self, y: f64, impulse: f64) -> f64 {
        let rate = self.ratio / self.diameters * (y * impulse).abs();
        self.propagator
            .first_rest(0.0, rate)
            .map_or(0.0, |time| rate * self.propagator.at(time).unit)
    }

    /// Returns the blade angles of the free blades, `s` seconds on.
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

    /// Returns the largest angle the blades reach if left alone \[rad\].
    pub(super) fn amplitude(&self, tips: &Tips) -> f64 {
        (tips.angle.norm_sqr() + tips.rate.norm_sqr() / (self.omega * self.omega)).sqrt()
    }

    /// Returns the kinetic and potential energy per unit casing mass.
    pub(super) fn energy(&self, tips: &Tips) -> f64 {
        let stored = tips.rate.norm_sqr() + self.omega * self.omega * tips.angle.norm_sqr();
        0.5 * self.mass * stored
    }

    /// Returns bounds on the first four derivatives of `n_d alpha` from now on.
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
    /// Returns the largest angle of any blade \[rad\].
    pub(super) fn largest(&self, tips: &Tips) -> f64 {
        self.machine.polygon.largest_component(tips.angle.re, tips.angle.im)
    }

    /// Returns `exp(i gamma)` of a side, the direction that opens its gap, and `gamma'`.
    pub(super) fn facing(&self, side: u32, s: f64, tips: &Tips) -> (Plane, f64) {
        let direction = self.direction(side);
        let diameters = self.blades.map_or(0.0, |blades| blades.diameters);
        let shift = diameters * (tips.angle * direction.conj()).re;
        let spin = self.drive.nu(s) + diameters * (tips.rate * direction.conj()).re;
        (direction * Plane::cis(self.drive.phase(s) + shift), spin)
    }

    /// Returns half the angle between a side and the next \[rad\].
    pub(super) fn half_angle(&self, a: u32, tips: &Tips) -> f64 {
        let diameters = self.blades.map_or(0.0, |blades| blades.diameters);
        let between = self.direction(self.machine.polygon.next(a)) - self.direction(a);
        let shift = (tips.angle * between.conj()).re;
        self.machine.polygon.delta + 0.5 * diameters * shift
    }
}
