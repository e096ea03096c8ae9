//! Where the energy of a run comes from and goes to, per unit casing mass.
//!
//! The pushes work on casing and blades: through the slope of the wave, which turns
//! with the rotor, and by friction. `mu P` times the sliding speed is heat, and the
//! rotor pays for it; the far larger part of it that moves nothing is kept apart.

use super::parameters::{Parameters, Point};
use super::stretch::{Held, Stretch};
use crate::motion::Plane;
use crate::motion::event::quadrature::damped;
use crate::numeric::quadrature::GAUSS_8;

/// Energies per unit casing mass \[m^2/s^2\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ledger {
    /// Kinetic and potential energy at the start.
    pub start: f64,
    /// Work of the pulse.
    pub pulse: f64,
    /// Work of the rotor through the slope of the casing wave.
    pub rotor: f64,
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

impl Ledger {
    /// What is missing from the balance at a state of this energy.
    pub(super) fn residual(&self, energy: f64) -> f64 {
        let lost = self.casing + self.blades + self.impacts;
        self.pulse + self.rotor + self.dragged - lost - (energy - self.start)
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
        let (mut sum, mut casing, mut tips) = (0.0, Plane::default(), Plane::default());
        for (row, impulse) in impulses {
            if let Some(row) = parameters.rows.get(row) {
                sum += impulse;
                casing += row.casing * impulse;
                tips += row.tip * impulse;
            }
        }
        // The sides turn with the rotor: their slope carries the casing along.
        let slope = dot(casing, Plane::i() * point.z * parameters.nu);
        let sliding = parameters.friction * parameters.speed * parameters.radius * sum;
        let on_casing = dot(Plane::i() * casing * parameters.turn.im, parameters.carried(point));
        let length = parameters.machine.blade_length;
        let on_blades =
            parameters.blades.map_or(0.0, |_| -parameters.friction * length * dot(tips, point.da));
        self.rotor += slope;
        self.sliding += sliding;
        self.dragged += on_casing + on_blades;
    }
}

/// The real scalar product of two vectors of the plane.
fn dot(a: Plane, b: Plane) -> f64 {
    a.re * b.re + a.im * b.im
}
