//! Free flight of casing and blades without contact and pulse, in closed form, and a lower bound on
//! its duration: while the casing stays within a circle that no side enters, no gap can close.

use std::f64::consts::TAU;

use super::flow::Flow;
use crate::motion::point::Point;
use crate::motion::propagator::Propagator;
use crate::motion::{Plane, dot, size};
use crate::numeric::rounding::ROUNDINGS;

impl Flow {
    /// Returns the point after `s` seconds of free motion without pulse.
    pub(super) fn flown(&self, from: &Point, s: f64) -> Point {
        let fly = |propagator: &Propagator, place: Plane, rate: Plane| {
            propagator.moved(&propagator.at(s), place, rate)
        };
        let back = Plane::cis(-self.turned(s));
        let (u, v) = fly(&self.casing, from.z, self.carried(from, 0.0));
        let (z, v) = (u * back, v * back);
        let (a, da) = self
            .blades
            .map_or_else(Default::default, |blades| fly(&blades.propagator, from.a, from.da));
        Point { z, dz: v - Plane::i() * z * self.nu_at(s), a, da }
    }

    /// Returns the distance from the centre within which no gap can close during a free motion that
    /// starts here: the energy of the blades can only decrease \[m\].
    pub(super) fn room(&self, point: &Point) -> f64 {
        let Some(blades) = &self.blades else { return self.least_clearance() };
        let angle = amplitude(point.a, point.da, blades.propagator.stiffness);
        self.least_clearance() - blades.arm.abs() * angle
    }

    /// Returns a bound on the distance of the casing from its centre in a free motion that starts
    /// here \[m\].
    pub(super) fn reach(&self, point: &Point, s: f64) -> f64 {
        amplitude(point.z, self.carried(point, s), self.casing.stiffness)
    }

    /// Returns how long no gap can close in a free flight that starts here \[s\]; infinite if none
    /// ever can, 0 if that is not known.
    pub(super) fn safe_flight(&self, point: &Point) -> f64 {
        let room = self.room(point);
        if self.reach(point, 0.0) < room {
            return f64::INFINITY;
        }
        match self.casing.swing() {
            Some(swing) if size(point.z) < room => self.rise(swing, point, room),
            _ => 0.0,
        }
    }

    /// Returns the time until a casing that swings with the frequency `swing` reaches the distance
    /// `room` from the centre. But for damping, which only reduces it, the square of its distance is
    /// a constant and one wave of twice the frequency.
    fn rise(&self, swing: f64, point: &Point, room: f64) -> f64 {
        let u = point.z;
        let w = (self.carried(point, 0.0) + u * self.casing.damping) / swing;
        let (place, rate) = (u.norm_sqr(), w.norm_sqr());
        let (mean, cos, sin) = (0.5 * (place + rate), 0.5 * (place - rate), dot(u, w));
        let wave = (cos * cos + sin * sin).sqrt();
        let most = mean + wave;
        let square = room * room - ROUNDINGS * most;
        if most < square {
            return f64::INFINITY;
        }
        if place > square - ROUNDINGS * most {
            // Within round-off it is unknown whether the distance rises or falls.
            return 0.0;
        }
        let angle = sin.atan2(cos) - ((square - mean) / wave).clamp(-1.0, 1.0).acos();
        angle.rem_euclid(TAU) / (2.0 * swing)
    }
}

/// Returns the amplitude of a damped oscillation from its displacement and rate.
pub(super) fn amplitude(place: Plane, rate: Plane, stiffness: f64) -> f64 {
    (place.norm_sqr() + rate.norm_sqr() / stiffness).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn flow(zeta: &str) -> Flow {
        Flow::new(&Scene::base().with(&[("casing.damping_ratio", zeta)]).unwrap())
    }

    #[test]
    fn it_ends_where_the_casing_reaches_the_clearance() {
        let (mut ends, mut never) = (0, 0);
        for zeta in ["0", "1e-3", "0.05"] {
            let flow = flow(zeta);
            let g0 = flow.clearance();
            for k in 0..400 {
                let z = Plane::cis(0.7 * f64::from(k)) * (g0 * f64::from(k % 20) / 20.0);
                let v = Plane::cis(1.9 * f64::from(k)) * (5e-4 * f64::from(k));
                let point = Point { z, dz: v - Plane::i() * z * flow.nu, ..Point::default() };
                let time = flow.safe_flight(&point);
                // Half a period has all of it.
                let span = time.min(TAU / (2.0 * flow.machine.omega_c));
                for j in 0..=500 {
                    let z = flow.flown(&point, span * f64::from(j) / 500.0).z;
                    assert!(z.norm() <= g0 * (1.0 + 1e-12), "{zeta} {k}: {time}");
                }
                if time.is_finite() && zeta == "0" {
                    let radius = flow.flown(&point, time).z.norm();
                    assert!((radius / g0 - 1.0).abs() < 1e-9, "{k}: {radius}");
                    ends += 1;
                }
                never += usize::from(time.is_infinite());
            }
        }
        assert!(ends > 150 && never > 50, "{ends} {never}");
    }

    #[test]
    fn at_the_clearance_itself_nothing_is_passed() {
        let flow = flow("0");
        for rate in [Plane::new(0.1, 0.05), Plane::new(-0.1, 0.05), Plane::new(0.0, 0.2)] {
            for part in [1.0, 1.0 - 1e-16, 1.0 - 1e-15, 1.0 - 1e-14] {
                let z = Plane::new(flow.clearance() * part, 0.0);
                let point = Point { z, dz: rate, ..Point::default() };
                assert_eq!(flow.safe_flight(&point), 0.0, "{rate} {part}");
            }
        }
    }
}
