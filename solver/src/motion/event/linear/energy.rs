//! Energy balance of a run, per unit casing mass; blade amplitudes; and the detection of motions
//! that leave the range of the model.
//!
//! Contact forces work on casing and blades through the slope of the wave, which moves with the
//! rotor, and through friction. The product of `mu P` and the sliding speed is heat, which the
//! rotor supplies. Its much larger part, from sliding on a casing at rest, is kept separate to
//! preserve digits.

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
    /// Work of the rotor against friction on a casing at rest, all of which becomes heat.
    pub sliding: f64,
    /// Work of friction on the motion of casing and blades, which reduces the heat.
    pub dragged: f64,
    /// Energy dissipated in the casing damping.
    pub casing: f64,
    /// Energy dissipated in the blade damping.
    pub blades: f64,
    /// Energy lost in impacts.
    pub impacts: f64,
}

impl Energies {
    /// Returns the error of the balance for a state with this energy.
    pub(super) fn residual(&self, energy: f64) -> f64 {
        let lost = self.casing + self.blades + self.impacts;
        self.pulse + self.rotor + self.growth + self.dragged - lost - (energy - self.start)
    }

    /// Adds the first `s` seconds of a stretch.
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

    /// Adds the powers at one instant, multiplied by `time` seconds.
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

    /// Adds the work of impulses at a point; its rates are the mean of those before and after.
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
        // The sides move with the rotor, so the slope of the wave does work on the casing.
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

/// Returns the scalar product of two vectors in the plane.
fn dot(a: Plane, b: Plane) -> f64 {
    a.re * b.re + a.im * b.im
}

/// Largest blade amplitude over the last one or two casing periods.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swings {
    period: f64,
    /// End of the present period \[s\].
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

    /// Records an amplitude at an instant \[rad\].
    pub(super) fn see(&mut self, t: f64, amplitude: f64) {
        if t >= self.end {
            // After a whole period without a record the previous maximum is outdated.
            self.before = if t < self.end + self.period { self.now } else { 0.0 };
            (self.now, self.end) = (0.0, t + self.period);
            self.trend.see(t, self.before);
        }
        self.now = self.now.max(amplitude);
    }

    /// Returns the amplitude to which the recorded ones tend \[rad\].
    pub(super) fn lasting(&self) -> f64 {
        self.trend.falls_to(self.largest()).unwrap_or_else(|| self.largest())
    }

    /// Discards the trend before a change of parameters.
    pub(super) fn forget(&mut self) {
        self.trend.forget();
    }

    pub(super) fn largest(&self) -> f64 {
        self.now.max(self.before)
    }
}

impl LinearEvents {
    /// Ends a motion that has left the range of the model.
    pub(super) fn check_growth(&mut self, s: f64, point: &Point) {
        let parameters = &self.parameters;
        let distance_m = size(point.z);
        let radius_m = parameters.radius;
        // No blade angle exceeds the amplitude of the modes.
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
