//! Free flight: nothing touches. Two uncoupled oscillators in the standing
//! frame, in closed form, and a search for the first touch that cannot miss.
//! (docs/theory.md, section 7.)
//!
//! While `|u| < g0` no side can touch, whatever the rotor does: that costs one
//! comparison. Beyond, the gaps of the nearest sides are advanced on with a
//! bound on their second derivative in the turning frame (`event::series`); the rest
//! are kept open by a bound on the speed.

use super::bounds::{Bounds, rise, size};
use super::mode::{Ending, Next};
use super::parameters::{Parameters, Tips};
use crate::motion::Plane;
use crate::motion::event::series::{Gap, curved_step, leaving_step, safe_step};
use crate::tolerances::{
    LONG_LOOK, LONGEST_LOOK, NEAR_SIDES, RAMP_CHANGE, SHORT_LOOK, SOFT_CASING,
};

/// Sides whose gaps are looked at one by one, those next to the casing wave.
const NEAREST: u32 = 7;

/// A side that the flight leaves with neither gap nor rate.
#[derive(Clone, Copy, Debug)]
pub(super) struct OpenedSide {
    pub side: u32,
    /// Second derivative of its gap \[m/s^2\], zero or more.
    pub bend: f64,
    /// Third derivative \[m/s^3\].
    pub twist: f64,
}

/// Free flight from a state in the standing frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Free {
    pub place: Plane,
    pub rate: Plane,
    /// Blades at the start.
    pub tips: Tips,
    pub opened: [Option<OpenedSide>; 2],
}

/// Second and third derivative of a flight in the standing frame, ready to be seen
/// from sides that turn.
struct Bends {
    u: Plane,
    v: Plane,
    second: Plane,
    third: Plane,
}

impl Bends {
    fn new(parameters: &Parameters, u: Plane, v: Plane) -> Self {
        let (c, k) = (parameters.damping, parameters.propagator.stiffness);
        let second = Plane::new(parameters.drive.pulse, 0.0) - v * (2.0 * c) - u * k;
        Self { u, v, second, third: -second * (2.0 * c) - v * k }
    }

    /// As a frame sees them that turns with `nu` and its next two derivatives, in the
    /// directions of the standing frame.
    fn turned(&self, nu: f64, nu_rate: f64, nu_bend: f64) -> [Plane; 2] {
        let Self { u, v, second: a, third } = *self;
        let i = Plane::i();
        let second = a - i * v * (2.0 * nu) - u * Plane::new(nu * nu, nu_rate);
        let jerk = third - i * a * (3.0 * nu) - v * Plane::new(nu * nu, nu_rate) * 3.0
            + u * Plane::new(-3.0 * nu * nu_rate, nu * nu * nu - nu_bend);
        [second, jerk]
    }

    /// Those of the gap of a side which faces along `inward` and turns with `nu`,
    /// of that `nu_rate` \[rad/s^2\] with the rotor.
    fn of(
        &self,
        parameters: &Parameters,
        side: u32,
        tips: &Tips,
        inward: Plane,
        nu: f64,
        mut nu_rate: f64,
    ) -> (f64, f64) {
        let mut nu_bend = 0.0;
        if let Some(blades) = &parameters.blades {
            let (c, k) = (blades.propagator.damping, blades.propagator.stiffness);
            let second = -tips.rate * (2.0 * c) - tips.angle * k;
            let third = -second * (2.0 * c) - tips.rate * k;
            let along = parameters.direction(side).conj() * blades.diameters;
            nu_rate += (second * along).re;
            nu_bend = (third * along).re;
        }
        let [second, jerk] = self.turned(nu, nu_rate, nu_bend);
        (dot(second, inward), dot(jerk, inward))
    }
}

/// Returns the part of a vector along a direction.
pub(super) fn dot(a: Plane, direction: Plane) -> f64 {
    a.re * direction.re + a.im * direction.im
}

impl Free {
    pub(super) fn new(place: Plane, rate: Plane, tips: Tips) -> Self {
        Self { place, rate, tips, opened: [None; 2] }
    }

    /// Returns the blades, `s` seconds on.
    pub(super) fn tips(&self, parameters: &Parameters, s: f64) -> Tips {
        parameters.blades.map_or(self.tips, |blades| blades.free(&self.tips, s))
    }

    /// Returns the largest angle of any blade over the first `s` seconds, `least` where
    /// none is larger \[rad\].
    pub(super) fn largest_angle(&self, parameters: &Parameters, s: f64, least: f64) -> f64 {
        let Some(blades) = &parameters.blades else { return least };
        if blades.amplitude(&self.tips) <= least {
            return least;
        }
        let ends = [0.0, s].map(|t| parameters.largest(&self.tips(parameters, t)));
        let mut most = least.max(ends[0]).max(ends[1]);
        // A blade's first turning point is its largest angle: later ones are
        // damped.
        for side in 0..parameters.machine.polygon.sides {
            let direction = parameters.direction(side).conj();
            let (angle, rate) = ((self.tips.angle * direction).re, (self.tips.rate * direction).re);
            let turning_point = blades.propagator.first_rest(angle, rate).filter(|&time| time < s);
            if let Some(time) = turning_point {
                most = most.max((self.tips(parameters, time).angle * direction).re.abs());
            }
        }
        most
    }

    /// Returns the place and rate in the standing frame, `s` seconds on.
    pub(super) fn at(&self, parameters: &Parameters, s: f64) -> (Plane, Plane) {
        let response = parameters.propagator.at(s);
        let stiffness = parameters.propagator.stiffness;
        if parameters.drive.pulse == 0.0 {
            let place = self.place * response.hold + self.rate * response.unit;
            let rate = self.rate * response.slope - self.place * (stiffness * response.unit);
            (place, rate)
        } else {
            let forcing = Plane::new(parameters.drive.pulse, 0.0) - self.place * stiffness;
            let place = self.place + self.rate * response.unit + forcing * response.ramp;
            (place, self.rate * response.slope + forcing * response.unit)
        }
    }

    /// Returns whether the energy left cannot reach a side, with no pulse to come.
    pub(super) fn spent(parameters: &Parameters, place: Plane, rate: Plane) -> bool {
        let reach = parameters.omega * parameters.clearance;
        rate.norm_sqr() + parameters.omega * parameters.omega * place.norm_sqr() < reach * reach
    }

    /// Returns the second and third derivative of the gap of `side` at the start.
    pub(super) fn curvature(&self, parameters: &Parameters, side: u32) -> (f64, f64) {
        let bends = Bends::new(parameters, self.place, self.rate);
        let (inward, nu) = parameters.facing(side, 0.0, &self.tips);
        bends.of(parameters, side, &self.tips, inward, nu, parameters.drive.nu_rate)
    }

    /// Looks ahead from `s`, before which nothing happens, to at most `end`.
    pub(super) fn look(&self, parameters: &Parameters, s: f64, end: f64) -> Next {
        let drive = &parameters.drive;
        let (u, v) = self.at(parameters, s);
        if drive.pulse == 0.0 && Self::spent(parameters, u, v) {
            return Next::Until(end);
        }
        let radius = size(u);
        if !parameters.corners && radius > parameters.reach {
            return Next::Now(Ending::Gone);
        }
        // A ramp may change the turning rate by a tenth of all rates in one look.
        let (nu, rates) = (drive.nu(s), parameters.omega + drive.nu(s).abs());
        let change = drive.nu_rate.abs();
        let span = if change > 0.0 {
            RAMP_CHANGE * (rates * rates).max(change).sqrt() / change
        } else {
            f64::INFINITY
        };
        let clearance = parameters.clearance;
        let mut stride: f64 = 0.0;
        let swing = if drive.pulse == 0.0 { parameters.propagator.swing() } else { None };
        if let Some(swing) = swing.filter(|_| radius < clearance) {
            stride = rise(parameters, swing, u, v);
            if stride * rates > LONG_LOOK {
                return Next::Until((s + stride.min(end - s)).max(s.next_up()));
            }
        }
        let span = span.min(end - s);
        let tips = self.tips(parameters, s);
        let soft = parameters.omega < SOFT_CASING * rates;
        let waves =
            if drive.steady() && !soft { Bounds::of_waves(parameters, nu, u, v) } else { None };
        let mut bounds = waves.unwrap_or_else(|| {
            Bounds::new(parameters, u, v, span, [nu, drive.nu(s + span.min(1e9))])
        });
        if let Some(blades) = &parameters.blades {
            bounds.shift(blades, &tips);
        }
        if radius < clearance && swing.is_none() {
            let [place, rate, acceleration] = bounds.standing;
            let margin = (clearance - radius) * (clearance + radius);
            let closing = -2.0 * (u.re * v.re + u.im * v.im);
            stride = safe_step(margin, closing, 2.0 * (rate * rate + place * acceleration));
            if stride * rates < SHORT_LOOK {
                // These bounds hold for the whole span, which a strong pulse makes
                // useless; this one asks for the acceleration alone.
                stride = stride.max(safe_step(clearance - radius, -size(v), acceleration));
            }
        }
        if radius > NEAR_SIDES * clearance {
            let mut near_span = span;
            if soft {
                // It may swing so far that nothing bounds it over a whole period.
                near_span = span.min(1.0 / rates);
                let nu = [nu, drive.nu(s + near_span)];
                bounds = Bounds::new(parameters, u, v, near_span, nu);
                bounds.lower_locally(parameters, nu);
                if let Some(blades) = &parameters.blades {
                    bounds.shift(blades, &tips);
                }
            }
            match self.sides(parameters, s, (u, v, tips), &bounds, near_span) {
                Ok(near) => stride = stride.max(near),
                Err(touch) => return Next::Now(touch),
            }
        }
        Next::Until((s + stride.min(span)).max(s.next_up()))
    }

    /// Returns the time over which no side can close, `span` at most, or the side that touches
    /// now.
    fn sides(
        &self,
        parameters: &Parameters,
        s: f64,
        (u, v, tips): (Plane, Plane, Tips),
        bounds: &Bounds,
        span: f64,
    ) -> Result<f64, Ending> {
        let drive = &parameters.drive;
        let polygon = &parameters.machine.polygon;
        let nu = drive.nu(s);
        let turn = Plane::cis(drive.phase(s));
        let z = u * turn.conj();
        let rate = (v - Plane::i() * u * nu) * turn.conj();
        let bends = Bends::new(parameters, u, v);
        let [second, third] = bends.turned(nu, drive.nu_rate, 0.0).map(|x| x * turn.conj());
        // Round-off of the closed form: that of the terms it adds up.
        let terms = size(self.place) + size(self.rate) * s.min(1.0 / parameters.omega) + size(u);
        let noise = parameters.tolerance * (parameters.clearance + terms);
        let [_, speed, bend, _, jounce] = bounds.turning;
        // Blades may turn sides by less than half a corner, or all are asked.
        let shift = parameters.blades.map_or(0.0, |b| b.diameters * b.amplitude(&tips));
        let nearest = polygon.nearest_side(z.re, z.im);
        let all = polygon.sides <= NEAREST || shift > 0.5 * polygon.delta;
        let count = if all { polygon.sides } else { NEAREST };
        // Beyond, what the fourth derivative may do is more than any gap there is.
        let most = (48.0 * (parameters.clearance + size(u)) / jounce).sqrt().sqrt();
        let mut stride = span.min(most).min(LONGEST_LOOK / parameters.omega);
        if !all {
            // The others lie at least so many half corners away from `z`.
            let angle = f64::from(NEAREST) * polygon.delta - shift;
            let open = parameters.clearance - size(z) * angle.cos();
            stride = stride.min(open.max(0.0) / speed);
        }
        for k in 0..count {
            // The nearest first: what it leaves of the stride, others rarely shorten.
            let offset = if k % 2 == 1 { k.div_ceil(2) } else { polygon.sides - k / 2 };
            let side = (nearest + offset) % polygon.sides;
            let mut normal = parameters.direction(side);
            let mut closing = dot(rate, normal);
            let mut spin = 0.0;
            if let Some(blades) = &parameters.blades {
                let turned = blades.diameters * dot(tips.angle, normal);
                spin = blades.diameters * dot(tips.rate, normal);
                normal *= Plane::cis(turned);
                closing = dot(rate - Plane::i() * z * spin, normal);
            }
            let gap = parameters.clearance + dot(z, normal);
            let opened = self.opened.iter().flatten().find(|opened| opened.side == side);
            let safe = match opened {
                Some(opened) if s == 0.0 => leaving_step(opened.bend, opened.twist, jounce),
                _ if gap <= noise && closing < 0.0 => return Err(Ending::Touch(side)),
                _ if gap + stride * (closing - 0.5 * bend * stride) > 0.0 && gap > 0.0 => stride,
                _ => {
                    let (bend, twist) = if parameters.blades.is_none() {
                        (dot(second, normal), dot(third, normal))
                    } else {
                        let (inward, nu_rate) = (normal * turn, drive.nu_rate);
                        bends.of(parameters, side, &tips, inward, nu + spin, nu_rate)
                    };
                    let now = Gap { gap, rate: closing, bend, twist };
                    curved_step(now.above(noise), jounce, stride)
                }
            };
            stride = stride.min(safe);
        }
        Ok(stride)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::event::exact::parameters::Drive;
    use crate::scene::Scene;

    /// Looks until something touches, whether it does, and the least gap of any side on
    /// the way there, sampled plainly.
    fn flight(changes: &[(&str, &str)], place: Plane, rate: Plane) -> (usize, bool, f64) {
        let event = [("solver.kind", "event"), ("solver.contact", "unilateral")];
        let rigid = [("solver.model", "rigid")];
        let scene = Scene::base().with(&[&event[..], &rigid, changes].concat()).unwrap();
        let mut parameters = Parameters::new(&scene);
        let diameters = parameters.machine.nodal_diameters;
        let nu = diameters * scene.operation.speed_rad_s;
        let nu_rate = diameters * scene.operation.speed_ramp_rad_s2;
        parameters.drive = Drive { phase: 0.3, nu, nu_rate, pulse: 0.0 };
        let free = Free::new(place, rate, Tips::default());
        let (mut s, mut looks, mut touches, end) = (0.0, 0, false, 0.02);
        while s < end && looks < 10_000 {
            looks += 1;
            match free.look(&parameters, s, end) {
                Next::Until(later) => s = later,
                Next::Now(_) => {
                    touches = true;
                    break;
                }
            }
        }
        let mut least = f64::INFINITY;
        for k in 0..=4000 {
            let t = s.min(end) * f64::from(k) / 4000.0;
            let z = free.at(&parameters, t).0 * Plane::cis(-parameters.drive.phase(t));
            for side in 0..parameters.machine.polygon.sides {
                least = least.min(parameters.machine.polygon.gap(side, z.re, z.im));
            }
        }
        (looks, touches, least)
    }

    #[test]
    fn no_look_passes_a_contact_and_looks_are_few() {
        let (mut all, mut touched, mut most) = (0, 0, 0);
        for zeta in ["0", "0.05", "0.6", "1.4"] {
            for (speed, ramp) in [("0", "0"), ("292.9", "0"), ("500", "0"), ("480", "3e3")] {
                for (blades, diameters) in [("3", "1"), ("22", "3"), ("101", "3")] {
                    let changes = [
                        ("casing.damping_ratio", zeta),
                        ("operation.speed_rad_s", speed),
                        ("operation.speed_ramp_rad_s2", ramp),
                        ("bladed_disk.blades", blades),
                        ("operation.nodal_diameters", diameters),
                    ];
                    for k in 0..12 {
                        let turn = Plane::cis(2.4 * f64::from(k));
                        let speed = 0.02 * f64::from(1 + k * k);
                        let rate = turn * Plane::cis(1.1 * f64::from(k)) * speed;
                        let (looks, touches, least) = flight(&changes, turn * 9.3e-5, rate);
                        assert!(least > -1e-18, "{changes:?} {k}: {least}");
                        all += looks;
                        most = most.max(looks);
                        touched += usize::from(touches);
                    }
                }
            }
        }
        assert!(touched > 200, "{touched}");
        assert!(most < 300 && all < 15 * touched, "{most}, {all} looks for {touched} touches");
    }
}
