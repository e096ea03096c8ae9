//! Free flight: nothing touches. Two uncoupled oscillators in the standing
//! frame, in closed form, and a search for the first touch that cannot miss.
//! (docs/theory.md, section 7.)
//!
//! While `|u| < g0` no side can touch, whatever the rotor does: that costs one
//! comparison. Beyond, the gaps of the nearest sides are advanced on with a
//! bound on their second derivative in the turning frame (`advancement`); the rest
//! are kept open by a bound on the speed.

use super::advancement::{grazing_step, leaving_step, safe_step};
use super::blades::Tips;
use super::bounds::{Bounds, size};
use super::parameters::{Drive, Parameters};
use crate::motion::Plane;
use crate::tolerances::{NEAR_SIDES, RAMP_CHANGE, SHORT_LOOK, SOFT_CASING};

/// A side that the flight leaves with neither gap nor rate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaving {
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
    pub leaving: [Option<Leaving>; 2],
}

/// What one look ahead finds.
#[derive(Clone, Copy, Debug)]
pub(super) enum Look {
    /// No event before this time.
    Until(f64),
    /// This side touches now.
    Touch(u32),
    /// Nothing can touch any more, for as long as the drive does not change.
    Never,
    /// The motion went beyond the casing radius.
    Gone,
}

impl Free {
    pub(super) fn new(place: Plane, rate: Plane, tips: Tips) -> Self {
        Self { place, rate, tips, leaving: [None; 2] }
    }

    /// The blades, `s` seconds on.
    pub(super) fn tips(&self, parameters: &Parameters, s: f64) -> Tips {
        parameters.blades.map_or(self.tips, |blades| blades.free(&self.tips, s))
    }

    /// The largest angle of any blade over the first `s` seconds, `least` where
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

    /// Place and rate in the standing frame, `s` seconds on.
    pub(super) fn at(&self, parameters: &Parameters, drive: &Drive, s: f64) -> (Plane, Plane) {
        let response = parameters.propagator.at(s);
        let stiffness = parameters.propagator.stiffness;
        if drive.pulse == 0.0 {
            let place = self.place * response.hold + self.rate * response.unit;
            let rate = self.rate * response.slope - self.place * (stiffness * response.unit);
            (place, rate)
        } else {
            let forcing = Plane::new(drive.pulse, 0.0) - self.place * stiffness;
            let place = self.place + self.rate * response.unit + forcing * response.ramp;
            (place, self.rate * response.slope + forcing * response.unit)
        }
    }

    /// Whether the energy left cannot reach a side, with no pulse to come.
    pub(super) fn spent(parameters: &Parameters, place: Plane, rate: Plane) -> bool {
        let reach = parameters.omega * parameters.clearance;
        rate.norm_sqr() + parameters.omega * parameters.omega * place.norm_sqr() < reach * reach
    }

    /// Second and third derivative of the gap of `side` at the start.
    pub(super) fn curvature(
        &self,
        parameters: &Parameters,
        drive: &Drive,
        side: u32,
    ) -> (f64, f64) {
        let (c, k) = (parameters.damping, parameters.propagator.stiffness);
        let (u, v) = (self.place, self.rate);
        let a = Plane::new(drive.pulse, 0.0) - v * (2.0 * c) - u * k;
        let jerk = -a * (2.0 * c) - v * k;
        let (inward, nu) = parameters.facing(drive, side, 0.0, &self.tips);
        let (mut nu_rate, mut nu_bend) = (drive.nu_rate, 0.0);
        if let Some(blades) = &parameters.blades {
            let (c, k) = (blades.propagator.damping, blades.propagator.stiffness);
            let second = -self.tips.rate * (2.0 * c) - self.tips.angle * k;
            let third = -second * (2.0 * c) - self.tips.rate * k;
            let along = parameters.direction(side).conj() * blades.diameters;
            nu_rate += (second * along).re;
            nu_bend += (third * along).re;
        }
        let (out, i) = (inward.conj(), Plane::i());
        let second = a - i * v * (2.0 * nu) - u * Plane::new(nu * nu, nu_rate);
        let third = jerk - i * a * (3.0 * nu) - v * Plane::new(nu * nu, nu_rate) * 3.0
            + u * Plane::new(-3.0 * nu * nu_rate, nu * nu * nu - nu_bend);
        ((second * out).re, (third * out).re)
    }

    /// Looks ahead from `s`, before which nothing happens, to at most `end`; with
    /// bounds of higher order where it is `stalled` next to a side.
    pub(super) fn look(
        &self,
        parameters: &Parameters,
        drive: &Drive,
        s: f64,
        end: f64,
        stalled: bool,
    ) -> Look {
        let (u, v) = self.at(parameters, drive, s);
        if drive.pulse == 0.0 && Self::spent(parameters, u, v) {
            return Look::Never;
        }
        let radius = size(u);
        if !parameters.corners && radius > parameters.reach {
            return Look::Gone;
        }
        // A ramp may change the turning rate by a tenth of all rates in one look.
        let (nu, rates) = (drive.nu(s), parameters.omega + drive.nu(s).abs());
        let change = drive.nu_rate.abs();
        let span = if change > 0.0 {
            RAMP_CHANGE * (rates * rates).max(change).sqrt() / change
        } else {
            f64::INFINITY
        };
        let span = span.min(end - s);
        let tips = self.tips(parameters, s);
        let mut bounds =
            Bounds::new(parameters, drive, u, v, span, [nu, drive.nu(s + span.min(1e9))]);
        if let Some(blades) = &parameters.blades {
            bounds.shift(blades, &tips);
        }
        let clearance = parameters.clearance;
        let mut stride: f64 = 0.0;
        if radius < clearance {
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
            if parameters.omega < SOFT_CASING * rates {
                // It may swing so far that nothing bounds it over a whole period.
                near_span = span.min(1.0 / rates);
                let nu = [nu, drive.nu(s + near_span)];
                bounds = Bounds::new(parameters, drive, u, v, near_span, nu);
                bounds.lower_locally(parameters, drive, nu);
                if let Some(blades) = &parameters.blades {
                    bounds.shift(blades, &tips);
                }
            }
            match self.sides(parameters, drive, s, (u, v, tips), &bounds, stalled) {
                Look::Until(near) => stride = stride.max(near.min(near_span)),
                found => return found,
            }
        }
        Look::Until((s + stride.min(span)).max(s.next_up()))
    }

    /// Time over which no side can close, or the side that touches now.
    fn sides(
        &self,
        parameters: &Parameters,
        drive: &Drive,
        s: f64,
        (u, v, tips): (Plane, Plane, Tips),
        bounds: &Bounds,
        stalled: bool,
    ) -> Look {
        let polygon = &parameters.machine.polygon;
        let back = Plane::cis(-drive.phase(s));
        let z = u * back;
        let rate = (v - Plane::i() * u * drive.nu(s)) * back;
        // Round-off of the closed form: that of the terms it adds up.
        let terms = size(self.place) + size(self.rate) * s.min(1.0 / parameters.omega) + size(u);
        let noise = parameters.tolerance * (parameters.clearance + terms);
        let [_, speed, bend, _, jounce] = bounds.turning;
        // Blades may turn sides by less than half a corner, or all are asked.
        let shift = parameters.blades.map_or(0.0, |b| b.diameters * b.amplitude(&tips));
        let nearest = polygon.nearest_side(z.re, z.im);
        let (first, count) = if polygon.sides <= 6 || shift > 0.5 * polygon.delta {
            (0, polygon.sides)
        } else {
            (polygon.previous(nearest), 3)
        };
        let mut stride = f64::INFINITY;
        if count < polygon.sides {
            // The others lie at least three half corners away from `z`.
            let open = parameters.clearance - size(z) * (3.0 * polygon.delta - shift).cos();
            stride = open.max(0.0) / speed;
        }
        for k in 0..count {
            let side = (first + k) % polygon.sides;
            let mut normal = parameters.direction(side);
            let mut closing = rate.re * normal.re + rate.im * normal.im;
            if let Some(blades) = &parameters.blades {
                let turned = blades.diameters * (tips.angle * normal.conj()).re;
                let spin = blades.diameters * (tips.rate * normal.conj()).re;
                normal *= Plane::cis(turned);
                let local = (rate - Plane::i() * z * spin) * normal.conj();
                closing = local.re;
            }
            let gap = parameters.clearance + z.re * normal.re + z.im * normal.im;
            let leaving = self.leaving.iter().flatten().find(|leaving| leaving.side == side);
            let safe = match leaving {
                Some(leaving) if s == 0.0 => leaving_step(leaving.bend, leaving.twist, jounce),
                _ if gap <= noise && closing < 0.0 => return Look::Touch(side),
                _ if stalled => {
                    let gap = gap.max(0.0) + noise;
                    let now = Self::new(u, v, tips);
                    let (bend_now, twist) = now.curvature(parameters, &drive.at(s), side);
                    safe_step(gap, closing, bend)
                        .max(grazing_step(gap, closing, bend_now, twist, jounce))
                }
                _ => safe_step(gap.max(0.0) + noise, closing, bend),
            };
            stride = stride.min(safe);
        }
        Look::Until(stride)
    }
}
