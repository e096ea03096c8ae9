//! Where the energy of a run comes from and goes to, per unit casing mass; how far the blades
//! swing; and motions that leave the range of the model.
//!
//! The pushes work on casing and blades: through the slope of the wave, which turns
//! with the rotor, and by friction. `mu P` times the sliding speed is heat, and the
//! rotor pays for it; the far larger part of it that moves nothing is kept apart.

use std::f64::consts::TAU;

use super::LinearEvents;
use super::parameters::{Parameters, size};
use super::stretch::{Held, Stretch};
use crate::motion::point::Point;
use crate::motion::propagator::damped;
use crate::motion::verdict::Trend;
use crate::motion::{FailureReason, Plane};
use crate::numeric::quadrature::GAUSS_8;
use crate::tolerances::LARGEST_BLADE_ANGLE;

/// Energies per unit casing mass \[m^2/s^2\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Energies {
    /// Kinetic and potential energy at the start.
    pub start: f64,
    /// Work of the pulse.
    pub pulse: f64,
    /// Work of the rotor through the slope of the casing wave.
    pub rotor: f64,
    /// Work of blades that grow with the speed.
    pub growth: f64,
    /// Its work against friction on a casing at rest: all of it becomes heat.
    pub sliding: f64,
    /// What friction does on the motion of casing and blades: less heat.
    pub dragged: f64,
    /// Lost in the damping of the casing.
    pub casing: f64,
    /// Lost in the damping of the blades.
    pub blades: f64,
    /// Lost in impacts.
    pub impacts: f64,
}

impl Energies {
    /// What is missing from the balance at a state of this energy.
    pub(super) fn residual(&self, energy: f64) -> f64 {
        let lost = self.casing + self.blades + self.impacts;
        self.pulse + self.rotor + self.growth + self.dragged - lost - (energy - self.start)
    }

    /// Books the first `s` seconds of a stretch.
    pub(super) fn book(&mut self, parameters: &Parameters, held: &Held, stretch: &Stretch, s: f64) {
        if stretch.free {
            let from = stretch.from();
            self.casing += damped(&parameters.casing, from.z, parameters.carried(from), s);
            if let Some(blades) = parameters.blades {
                self.blades += blades.mass * damped(&blades.propagator, from.a, from.da, s);
            }
            return;
        }
        if stretch.length == f64::INFINITY {
            self.add(parameters, held, stretch, 0.0, s);
            return;
        }
        let half = 0.5 * s;
        for (node, weight) in GAUSS_8 {
            for signed in [-node, node] {
                self.add(parameters, held, stretch, half + half * signed, half * weight);
            }
        }
    }

    /// Adds the powers at one instant, for `time` seconds.
    fn add(&mut self, parameters: &Parameters, held: &Held, stretch: &Stretch, s: f64, time: f64) {
        let point = stretch.point(parameters, s);
        let v = parameters.carried(&point);
        self.pulse += time * dot(stretch.force_at(s), v);
        self.casing += time * 2.0 * parameters.casing.damping * v.norm_sqr();
        if let Some(blades) = parameters.blades {
            self.blades +=
                time * 2.0 * blades.propagator.damping * blades.mass * point.da.norm_sqr();
        }
        if !held.rows.is_empty() {
            let pushes = held.with(stretch.pushes_at(s));
            self.push(parameters, &point, pushes.map(|(row, push)| (row, push * time)));
        }
    }

    /// Books impulses at a place with these rates (the mean of before and after).
    pub(super) fn push(
        &mut self,
        parameters: &Parameters,
        point: &Point,
        impulses: impl Iterator<Item = (usize, f64)>,
    ) {
        let (mut sum, mut along) = (0.0, Plane::default());
        for (row, impulse) in impulses {
            if let Some(direction) = parameters.rows.get(row) {
                sum += impulse;
                along += direction * impulse;
            }
        }
        // The sides turn with the rotor: their slope carries the casing along.
        let slope = dot(along, Plane::i() * point.z * parameters.nu);
        let sliding = parameters.friction * parameters.speed * parameters.radius * sum;
        let on_casing = dot(Plane::i() * along * parameters.turn.im, parameters.carried(point));
        let length = parameters.machine.blade_length;
        let on_blades =
            parameters.blades.map_or(0.0, |_| -parameters.friction * length * dot(along, point.da));
        self.rotor += slope;
        self.sliding += sliding;
        self.dragged += on_casing + on_blades;
    }
}

/// The real scalar product of two vectors of the plane.
fn dot(a: Plane, b: Plane) -> f64 {
    a.re * b.re + a.im * b.im
}

/// The largest amplitude of the blades over the last casing period or two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swings {
    period: f64,
    /// When the period of now ends \[s\].
    end: f64,
    before: f64,
    now: f64,
    trend: Trend,
}

impl Swings {
    pub(super) fn new(parameters: &Parameters, end: f64) -> Self {
        let period = TAU / parameters.machine.omega_c;
        Self { period, end: period, before: 0.0, now: 0.0, trend: Trend::over(end) }
    }

    /// Sees an amplitude at an instant \[rad\].
    pub(super) fn see(&mut self, t: f64, amplitude: f64) {
        if t >= self.end {
            // After a whole period without a look nothing of before is left.
            self.before = if t < self.end + self.period { self.now } else { 0.0 };
            (self.now, self.end) = (0.0, t + self.period);
            self.trend.see(t, self.before);
        }
        self.now = self.now.max(amplitude);
    }

    /// The largest that lasts, as they go \[rad\].
    pub(super) fn lasting(&self) -> f64 {
        self.trend.falls_to(self.largest()).unwrap_or_else(|| self.largest())
    }

    /// Forgets what was before a change on the way.
    pub(super) fn forget(&mut self) {
        self.trend.forget();
    }

    pub(super) fn largest(&self) -> f64 {
        self.now.max(self.before)
    }
}

impl LinearEvents {
    /// Fails a motion that has grown beyond what the model describes.
    pub(super) fn check_growth(&mut self, s: f64, point: &Point) {
        let parameters = &self.parameters;
        let distance_m = size(point.z);
        let radius_m = parameters.radius;
        // No blade bends more than its modes together.
        let angle_rad = match size(point.a) {
            most if most > LARGEST_BLADE_ANGLE => parameters.largest_angle(point.a),
            most => most,
        };
        let (drags, tip_m_s) = (parameters.turn.im != 0.0, parameters.speed.abs() * radius_m);
        let along = || parameters.machine.tangential_ratio * parameters.carried(point).norm();
        let reason = if angle_rad > LARGEST_BLADE_ANGLE {
            FailureReason::BladeAngle { angle_rad }
        } else if distance_m > radius_m && !parameters.machine.polygon.has_corners() {
            FailureReason::NoCorner { radius_m }
        } else if distance_m > radius_m {
            FailureReason::Displacement { distance_m, radius_m }
        } else if drags && along() > tip_m_s {
            FailureReason::CasingSpeed { speed_m_s: along(), tip_m_s }
        } else {
            return;
        };
        self.fail(s, reason);
    }
}
