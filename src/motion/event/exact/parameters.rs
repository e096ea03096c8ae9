//! What does not change along a run, and what is constant between events.

use std::f64::consts::PI;

use super::blades::{Blades, Tips};
use crate::model::Machine;
use crate::motion::Plane;
use crate::motion::propagator::Propagator;
use crate::scene::Scene;
use crate::tolerances::{self, ROUND_OFF};

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
            machine,
        }
    }

    /// `exp(i psi)` of a side.
    pub(super) fn direction(&self, side: u32) -> Plane {
        let (cos, sin) = self.machine.polygon.direction(side);
        Plane::new(cos, sin)
    }

    /// `exp(i (psi + n_d alpha))` of a side, the direction in which its gap opens as
    /// the rotor sees it, and the rate `n_d alpha'`.
    pub(super) fn normal(&self, side: u32, tips: &Tips) -> (Plane, f64) {
        let direction = self.direction(side);
        let Some(blades) = &self.blades else { return (direction, 0.0) };
        let along = direction.conj() * blades.diameters;
        (direction * Plane::cis((tips.angle * along).re), (tips.rate * along).re)
    }

    /// Half the length of the side `a` towards the next \[m\].
    pub(super) fn half_length(&self, a: u32, tips: &Tips) -> f64 {
        match self.blades {
            None => self.half_side,
            Some(_) => self.clearance * self.half_angle(a, tips).tan(),
        }
    }

    /// `exp(2 i tau)`, the turn from a side to the next.
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

    /// Round-off of the pushes of a corner: of the accelerations that cancel in
    /// them \[m/s^2\].
    pub(super) fn push_noise(&self, drive: &Drive) -> f64 {
        let square = (self.omega * self.omega).max(drive.nu * drive.nu);
        let spread = if self.corners { self.turn.im.abs() } else { 1.0 };
        ROUND_OFF * (square * self.clearance + drive.pulse.abs()) / spread
    }

    /// Push per unit mass that keeps the casing on a side at `y` with rate
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
    /// `n_d theta`, `s` seconds on \[rad\].
    pub(super) fn phase(&self, s: f64) -> f64 {
        self.phase + (self.nu + 0.5 * self.nu_rate * s) * s
    }

    /// `n_d Omega`, `s` seconds on \[rad/s\].
    pub(super) fn nu(&self, s: f64) -> f64 {
        self.nu + self.nu_rate * s
    }

    /// The pulse times `exp(i beta)` of a side, the direction that opens its gap,
    /// `s` seconds on \[m/s^2\].
    pub(super) fn pulse_on(&self, parameters: &Parameters, side: u32, s: f64) -> Plane {
        // Nearly always there is none: no sine then.
        if self.pulse == 0.0 {
            return Plane::default();
        }
        parameters.direction(side) * Plane::cis(self.phase(s)) * self.pulse
    }

    /// Whether neither pulse nor ramp acts.
    pub(super) fn steady(&self) -> bool {
        self.pulse == 0.0 && self.nu_rate == 0.0
    }
}
