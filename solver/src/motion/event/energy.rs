//! Energy account of a run, and the detection of motions that leave the range of the model.
//!
//! Contact forces work on casing and blades through the slope of the wave, which moves with the
//! rotor, and through friction. The product of `mu P` and the sliding speed is heat, which the
//! rotor supplies, even with the casing at rest.

use std::f64::consts::TAU;

use super::Events;
use super::flight::amplitude;
use super::flow::{Blades, Flow};
use super::stretch::{Held, Stretch};
use crate::model::LARGEST_BLADE_ANGLE;
use crate::motion::point::Point;
use crate::motion::{EnergyAccount, Failure, FailureReason, Plane, dot, size};
use crate::numeric::quadrature::GAUSS_6;
use crate::numeric::search::bisected;

/// Instants of a free flight at which the blade angles are looked at.
const ANGLES: u32 = 64;

impl EnergyAccount {
    /// Adds the first `s` seconds of a stretch.
    pub(super) fn book(&mut self, flow: &Flow, held: &Held, stretch: &Stretch, s: f64) {
        if held.rows.is_empty() && !stretch.is_pulsed() {
            // In free motion damping takes what is gone.
            let [casing, blades] = flow.energies(&stretch.from, 0.0);
            let [casing_left, blades_left] = flow.energies(&stretch.point(flow, s), s);
            self.casing_loss_j += casing - casing_left;
            self.blade_loss_j += blades - blades_left;
            return;
        }
        if stretch.length == f64::INFINITY {
            self.add(flow, held, stretch, &stretch.from, [0.0, s]);
            return;
        }
        let half = 0.5 * s;
        let [a, b, c] = GAUSS_6;
        let nodes = [(-a.0, a.1), a, (-b.0, b.1), b, (-c.0, c.1), c];
        let times = nodes.map(|(node, _)| half + half * node);
        let points = stretch.points(flow, times);
        for ((point, s), (_, weight)) in points.iter().zip(times).zip(nodes) {
            self.add(flow, held, stretch, point, [s, half * weight]);
        }
    }

    /// Adds the powers at the point of one instant, multiplied by `time` seconds.
    fn add(
        &mut self,
        flow: &Flow,
        held: &Held,
        stretch: &Stretch,
        point: &Point,
        [s, time]: [f64; 2],
    ) {
        let v = flow.carried(point, s);
        let time_mass = time * flow.machine.casing_mass;
        if stretch.is_pulsed() {
            self.pulse_work_j += time_mass * dot(stretch.force_at(s), v);
        }
        self.casing_loss_j += time_mass * 2.0 * flow.casing.damping * v.norm_sqr();
        if let Some(Blades { propagator, mass, .. }) = flow.blades {
            self.blade_loss_j += time_mass * 2.0 * propagator.damping * mass * point.da.norm_sqr();
        }
        if !held.rows.is_empty() {
            let pushes = stretch.pushes_at(held, s);
            let each = pushes.map(|(row, push)| (flow.normal(row, point.a), push * time));
            self.push(flow, point, s, each);
        }
    }

    /// Adds the work of impulses, each with direction and normal of its row, at a point `s` seconds
    /// after the start of the stretch; its rates are the mean of those before and after.
    pub(super) fn push(
        &mut self,
        flow: &Flow,
        point: &Point,
        s: f64,
        impulses: impl Iterator<Item = ((Plane, Plane), f64)>,
    ) {
        let (mut sum, mut along, mut bases) = (0.0, Plane::default(), Plane::default());
        for ((base, normal), impulse) in impulses {
            sum += impulse;
            along += normal * impulse;
            bases += base * impulse;
        }
        let (nu, mass) = (flow.nu_at(s), flow.machine.casing_mass);
        // The sides move with the rotor, so the slope of the wave does work on the casing.
        let slope = dot(along, Plane::i() * point.z * nu);
        self.rotor_work_j += mass * slope;
        if flow.friction == 0.0 {
            return;
        }
        let sliding = flow.friction * flow.speed * flow.radius * sum;
        let on_casing = dot(Plane::i() * along * flow.turn.im, flow.carried(point, s));
        let length = flow.machine.blade_length;
        let on_blades = flow.blades.map_or(0.0, |_| -flow.friction * length * dot(bases, point.da));
        self.rotor_work_j += mass * sliding;
        self.friction_heat_j += mass * (sliding - on_casing - on_blades);
    }
}

impl Events {
    /// Returns the first instant within `s` seconds at which a blade angle is beyond the range of the
    /// model \[s\].
    fn first_beyond(&self, s: f64) -> Option<f64> {
        let (flow, stretch) = (&self.flow, &self.stretch);
        let (from, stiffness) = (&stretch.from, flow.blades.as_ref()?.propagator.stiffness);
        let reach = if stretch.free {
            amplitude(from.a, from.da, stiffness)
        } else {
            size(from.a) + stretch.swing
        };
        if reach <= LARGEST_BLADE_ANGLE {
            return None;
        }
        let is_beyond = |s: f64| flow.largest_angle(stretch.point(flow, s).a) > LARGEST_BLADE_ANGLE;
        let part = s.min(TAU / stiffness.sqrt()) / 32.0;
        let high = (0..=32).map(|k| part * f64::from(k)).find(|&s| is_beyond(s))?;
        Some(bisected([(high - part).max(0.0), high], is_beyond)[1])
    }

    /// Ends a motion whose blades leave the range of the model in the first `s` seconds of the stretch.
    ///
    /// # Errors
    /// They do.
    pub(super) fn check_angles(&mut self, s: f64) -> Result<(), Failure> {
        let Some(s) = self.first_beyond(s) else { return Ok(()) };
        let angle_rad = self.flow.largest_angle(self.stretch.point(&self.flow, s).a);
        self.fail(s, FailureReason::BladeAngle { angle_rad });
        self.run.failure.clone().map_or(Ok(()), Err)
    }

    /// Ends a motion that has left the range of the model in the first `s` seconds of the stretch.
    pub(super) fn check_growth(&mut self, s: f64, point: &Point) {
        if self.check_angles(s).is_err() {
            return;
        }
        let flow = &self.flow;
        let distance_m = size(point.z);
        let radius_m = flow.radius;
        let (drags, tip_m_s) = (flow.turn.im != 0.0, flow.speed.abs() * radius_m);
        let along = || flow.machine.tangential_ratio * flow.carried(point, s).norm();
        let reason = if distance_m > radius_m && !flow.machine.polygon.has_corners() {
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

    /// Returns the largest blade angle up to `s` seconds into the stretch \[rad\].
    pub(super) fn widest_until(&self, s: f64) -> f64 {
        let (flow, stretch) = (&self.flow, &self.stretch);
        let Some(Blades { propagator, .. }) = &flow.blades else { return 0.0 };
        let (polygon, mut near) = (&flow.machine.polygon, 0);
        let mut wider = |widest: f64, a: Plane| match size(a) <= widest {
            true => widest,
            false => widest.max(polygon.largest_component_near(a.re, a.im, &mut near)),
        };
        let (mut a, mut da) = (stretch.from.a, stretch.from.da);
        if !stretch.free {
            let angle = |part: u32| stretch.point(flow, s * f64::from(part) / 4.0).a;
            return (0..=4).map(angle).fold(self.run.widest, wider);
        }
        let mut widest = self.run.widest;
        if amplitude(a, da, propagator.stiffness) > widest {
            // The largest amplitude of free blades occurs within their first period.
            let later = propagator.at(s.min(TAU / flow.machine.omega_bd) / f64::from(ANGLES));
            widest = wider(widest, a);
            for _ in 0..ANGLES {
                (a, da) = propagator.moved(&later, a, da);
                widest = wider(widest, a);
            }
        }
        widest
    }
}
