//! Sliding on one side of the polygon: in closed form at a constant rotor speed without pulse
//! (docs/theory.md, section 5), and as power series in time while the pulse acts, the speed
//! changes or the blades move (section 7). `y` grows backward, towards decreasing angle:
//! `y = g0 tan delta` is the corner with the side of next lower phase.
//!
//! One stretch of the series, no longer than the time of one radian of the fastest rate, is
//! summed to round-off. It is a polynomial: any instant of it can be asked for, and sums of
//! its coefficients bound its derivatives.

use std::f64::consts::FRAC_PI_2;

use super::mode::{Ending, Next};
use super::parameters::{Blades, Parameters, Tips};
use crate::motion::Plane;
use crate::motion::event::series::{
    Gap, STRETCH, TERMS, Terms, curved_step, ended, gap, jounce, leaving_step, product, quotient,
    slope, values,
};
use crate::motion::propagator::Propagator;
use crate::tolerances::{LONGEST_LOOK, MOST_HALVINGS, SIDE_GROWTH, SIDE_LOOK};

/// Sliding on `side` from `y` with rate `rate`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slide {
    pub side: u32,
    /// Position along the side, backward from its middle \[m\].
    pub y: f64,
    /// Its rate \[m/s\].
    pub rate: f64,
    propagator: Propagator,
    /// Acceleration at rest at the start \[m/s^2\].
    pull: f64,
}

/// Position, rate and push at one instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Along {
    /// Position along the side \[m\].
    pub y: f64,
    /// Its rate \[m/s\].
    pub rate: f64,
    /// Push per unit mass \[m/s^2\].
    pub push: f64,
}

impl Along {
    /// Returns the place and rate in a frame where the side's gap opens along `direction`, and
    /// which sees the side turn with `spin` \[rad/s\].
    pub(super) fn seen(&self, clearance: f64, (direction, spin): (Plane, f64)) -> (Plane, Plane) {
        let place = Plane::new(-clearance, self.y);
        let rate = Plane::new(0.0, self.rate) + Plane::i() * place * spin;
        (place * direction, rate * direction)
    }
}

impl Slide {
    pub(super) fn new(parameters: &Parameters, side: u32, y: f64, rate: f64) -> Self {
        let propagator = propagator(parameters, parameters.drive.nu);
        let drag = 2.0 * parameters.damping * parameters.drive.nu * parameters.clearance;
        Self { side, y, rate, propagator, pull: drag - propagator.stiffness * y }
    }

    /// Returns the displacement from the start and rate, `s` seconds on.
    fn moved(&self, s: f64) -> (f64, f64) {
        let response = self.propagator.at(s);
        let displacement = self.rate * response.unit + self.pull * response.ramp;
        (displacement, self.rate * response.slope + self.pull * response.unit)
    }

    pub(super) fn at(&self, parameters: &Parameters, s: f64) -> Along {
        let (displacement, rate) = self.moved(s);
        let y = self.y + displacement;
        Along { y, rate, push: parameters.push(parameters.drive.nu, 0.0, y, rate, 0.0) }
    }

    /// Returns the fastest rate of the motion along the side \[1/s\].
    pub(super) fn fastest(&self) -> f64 {
        2.0 * self.propagator.damping + self.propagator.stiffness.abs().sqrt()
    }

    /// Looks ahead from `s`, before which nothing happens.
    pub(super) fn look(&self, parameters: &Parameters, s: f64) -> Next {
        let (displacement, rate) = self.moved(s);
        let (stiffness, c, nu) =
            (self.propagator.stiffness, self.propagator.damping, parameters.drive.nu);
        let pull = self.pull - stiffness * displacement;
        let acceleration = pull - 2.0 * c * rate;
        let third = -2.0 * c * acceleration - stiffness * rate;
        // The acceleration from here on obeys the equation without forcing. Each
        // derivative costs a factor `fastest`, and the time ahead exp(fastest t).
        let fastest = self.fastest();
        let span = (SIDE_LOOK / fastest).min(LONGEST_LOOK / parameters.omega);
        let jounce =
            SIDE_GROWTH * fastest * (third.abs() + acceleration.abs() * (fastest + 2.0 * c));
        let mut stride = span;
        for up in [rate > 0.0, rate <= 0.0] {
            let sign = if up { -1.0 } else { 1.0 };
            let room = parameters.half_side + sign * self.y;
            let gap = room + sign * displacement;
            let rate = sign * rate;
            let noise = parameters.tolerance * (room + self.rate.abs() * s);
            let (bend, twist) = (sign * acceleration, sign * third);
            if s == 0.0 && room == 0.0 && rate == 0.0 {
                stride = stride.min(leaving_step(bend, twist, jounce));
            } else if gap <= noise && rate < 0.0 {
                return Next::Now(Ending::Edge(up));
            } else {
                let now = Gap { gap, rate, bend, twist };
                stride = stride.min(curved_step(now.above(noise), jounce, stride));
            }
        }
        let y = self.y + displacement;
        let push = parameters.push(nu, 0.0, y, rate, 0.0);
        let push_rate = -2.0 * nu * (acceleration + c * rate);
        let noise = push_noise(parameters, nu, y, rate, 0.0);
        if push <= noise && push_rate < 0.0 {
            return Next::Now(Ending::Release);
        }
        let fourth = -2.0 * c * third - stiffness * acceleration;
        let now = Gap {
            gap: push,
            rate: push_rate,
            bend: -2.0 * nu * (third + c * acceleration),
            twist: -2.0 * nu * (fourth + c * third),
        };
        let push_jounce = 2.0 * nu.abs() * jounce * (fastest + c);
        stride = stride.min(curved_step(now.above(noise), push_jounce, stride));
        Next::Until((s + stride).max(s.next_up()))
    }
}

/// Returns the response along a side at the wave frequency `nu`. The difference of squares
/// is taken as a product, so that it is exactly zero at `nu = omega_c`.
pub(super) fn propagator(parameters: &Parameters, nu: f64) -> Propagator {
    Propagator::new(parameters.damping, (parameters.omega - nu) * (parameters.omega + nu))
}

/// Returns the round-off of the push \[m/s^2\].
pub(super) fn push_noise(parameters: &Parameters, nu: f64, y: f64, rate: f64, pulse: f64) -> f64 {
    let square = (parameters.omega * parameters.omega).max(nu * nu);
    parameters.tolerance
        * (square * (parameters.clearance + y.abs()) + 2.0 * nu.abs() * rate.abs() + pulse.abs())
}

/// One stretch of sliding on `side`.
#[derive(Clone, Copy, Debug)]
pub(super) struct SideSeries {
    pub side: u32,
    /// Length of the stretch \[s\].
    pub length: f64,
    y: Terms,
    push: Terms,
    /// Distances to the upper and lower end of the side \[m\].
    rooms: [Terms; 2],
    /// Blade angle along the side and across it \[rad\].
    tips: [Terms; 2],
    /// Whether no stretch is short enough for its terms to end.
    lost: bool,
}

/// Where a stretch begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct From {
    /// Position along the side \[m\].
    pub y: f64,
    /// Its rate \[m/s\].
    pub rate: f64,
    /// Blade angles.
    pub tips: Tips,
    /// The end of the side it starts at, upper (`true`) or lower.
    pub edge: Option<bool>,
    /// Whether it starts there at rest against the other side.
    pub resting: bool,
}

impl SideSeries {
    pub(super) fn new(parameters: &Parameters, side: u32, from: &From) -> Self {
        let (inward, spin) = parameters.facing(side, 0.0, &from.tips);
        let mut fastest = parameters.omega
            + 2.0 * parameters.damping
            + spin.abs()
            + parameters.drive.nu_rate.abs().sqrt();
        if let Some(blades) = &parameters.blades {
            fastest += blades.omega + 2.0 * blades.propagator.damping;
        }
        let local = from.tips.angle * parameters.direction(side).conj();
        let turning = from.tips.rate * parameters.direction(side).conj();
        let mut series = Self {
            side,
            length: STRETCH / fastest,
            y: [0.0; TERMS],
            push: [0.0; TERMS],
            rooms: [[0.0; TERMS]; 2],
            tips: [[0.0; TERMS]; 2],
            lost: false,
        };
        // Without moving blades the solution is entire and one try is enough.
        for halvings in 0..MOST_HALVINGS {
            let h = series.length;
            (series.y[0], series.y[1]) = (from.y, from.rate * h);
            for (terms, (angle, rate)) in
                series.tips.iter_mut().zip([(local.re, turning.re), (local.im, turning.im)])
            {
                (terms[0], terms[1]) = (angle, rate * h);
            }
            series.expand(parameters, inward);
            series.enclose(parameters, from);
            let exact = ended(&series.y) && ended(&series.push) && series.rooms.iter().all(ended);
            series.lost = parameters.blades.is_some() && !exact;
            // Bounds over a short stretch are close ones.
            let near = halvings < 10 && series.may_meet_other(parameters);
            if !series.lost && !near {
                break;
            }
            series.length *= 0.5;
        }
        series
    }

    /// Fills the terms by the recurrence of the differential equations, with
    /// time counted in units of `length`.
    fn expand(&mut self, parameters: &Parameters, inward: Plane) {
        let h = self.length;
        let (nu, ramp) = (parameters.drive.nu * h, parameters.drive.nu_rate * h * h);
        let (omega2, c2) =
            (parameters.omega * parameters.omega * h * h, 2.0 * parameters.damping * h);
        let (g0, pulse) = (parameters.clearance, parameters.drive.pulse * h * h);
        let blades = parameters.blades.as_ref();
        let diameters = blades.map_or(0.0, |blades| blades.diameters);
        let (mut cos, mut sin) = ([0.0; TERMS], [0.0; TERMS]);
        (cos[0], sin[0]) = (inward.re, inward.im);
        let (mut mu, mut squared, mut free) = ([0.0; TERMS], [0.0; TERMS], [0.0; TERMS]);
        let (mut share, mut y_slope) = ([0.0; TERMS], [0.0; TERMS]);
        let Self { y, push, tips: [along, across], .. } = self;
        for n in 0..TERMS {
            let over = 1.0 / ((n as f64 + 1.0) * (n as f64 + 2.0));
            mu[n] = diameters * slope(along, n) + [nu, ramp].get(n).unwrap_or(&0.0);
            squared[n] = product(&mu, &mu, n);
            y_slope[n] = slope(y, n);
            if n + 1 < TERMS {
                sin[n + 1] = product(&cos, &mu, n) / (n as f64 + 1.0);
                cos[n + 1] = -product(&sin, &mu, n) / (n as f64 + 1.0);
            }
            let constant = if n == 0 { 1.0 } else { 0.0 };
            let euler = if n == 0 { ramp } else { 0.0 };
            let mut held = (squared[n] - constant * omega2) * g0
                - 2.0 * product(&y_slope, &mu, n)
                - c2 * product(y, &mu, n)
                - ramp * y[n]
                - pulse * cos[n];
            let mut mu_slope = euler;
            if let Some(blades) = blades {
                free[n] = blades.free_term(along, n, h);
                held -= diameters * product(y, &free, n);
                share[n] = constant + blades.ratio * product(y, y, n);
                push[n] = quotient(held, &share, push, n);
                let answer = free[n] + blades.ratio / diameters * product(push, y, n);
                mu_slope += diameters * answer;
                if n + 2 < TERMS {
                    along[n + 2] = answer * over;
                    across[n + 2] = blades.free_term(across, n, h) * over;
                }
            } else {
                push[n] = held;
            }
            if n + 2 < TERMS {
                let centred = product(y, &squared, n) - omega2 * y[n];
                let drag = c2 * (mu[n] * g0 - y_slope[n]);
                y[n + 2] = (centred + drag + mu_slope * g0 - pulse * sin[n]) * over;
            }
        }
        // The last terms of the push lack their Coriolis part: round-off.
        push[TERMS - 2..].fill(0.0);
        push.iter_mut().for_each(|term| *term /= h * h);
    }

    /// Fills the distances to both ends of the side.
    fn enclose(&mut self, parameters: &Parameters, from: &From) {
        let (sin, cos) = parameters.machine.polygon.delta.sin_cos();
        for (room, (upper, sign)) in self.rooms.iter_mut().zip([(true, -1.0), (false, 1.0)]) {
            *room = [0.0; TERMS];
            room[0] = parameters.half_side;
            if let (Some(blades), true) = (&parameters.blades, parameters.corners) {
                // Half the angle to the neighbour: delta, and what blades add.
                let scale = blades.diameters * sin;
                let mut angle: Terms = std::array::from_fn(|n| {
                    scale * (cos * self.tips[1][n] - sign * sin * self.tips[0][n])
                });
                angle[0] += parameters.machine.polygon.delta;
                *room = tangent(&angle).map(|term| parameters.clearance * term);
            }
            for (term, y) in room.iter_mut().zip(&self.y) {
                *term += sign * y;
            }
            if from.edge == Some(upper) {
                room[0] = 0.0;
                if from.resting {
                    room[1] = 0.0;
                }
            }
        }
    }

    /// Returns the speed at the start away from the upper (`true`) or lower end \[m/s\].
    pub(super) fn parting(&self, upper: bool) -> f64 {
        self.rooms[usize::from(!upper)][1] / self.length
    }

    pub(super) fn at(&self, s: f64) -> Along {
        let x = s / self.length;
        let [y, rate, _] = values(&self.y, x);
        Along { y, rate: rate / self.length, push: values(&self.push, x)[0] }
    }

    /// Returns whether the other side of a polygon of two may be met within the stretch:
    /// blades that turn by `x` leave it open by `2 cos x (g0 cos x + y sin x)`.
    pub(super) fn may_meet_other(&self, parameters: &Parameters) -> bool {
        let Some(blades) = parameters.blades.filter(|_| parameters.machine.polygon.sides == 2)
        else {
            return false;
        };
        let ends = |terms: &Terms| {
            let change: f64 = terms.iter().skip(1).map(|term| term.abs()).sum();
            [terms[0] - change, terms[0] + change]
        };
        let turned = ends(&self.tips[0]).map(|angle| blades.diameters * angle);
        turned.iter().any(|x| x.abs() >= FRAC_PI_2)
            || ends(&self.y)
                .iter()
                .any(|y| turned.iter().any(|x| y * x.tan() <= -parameters.clearance))
    }

    /// Returns a bound on every blade angle over the stretch \[rad\].
    pub(super) fn largest_bound(&self) -> f64 {
        self.tips.iter().flatten().map(|term| term.abs()).sum()
    }

    /// Returns the blades, `s` seconds on.
    pub(super) fn tips(&self, parameters: &Parameters, s: f64) -> Tips {
        if parameters.blades.is_none() {
            return Tips::default();
        }
        let x = s / self.length;
        let [[along, along_rate, _], [across, across_rate, _]] =
            [values(&self.tips[0], x), values(&self.tips[1], x)];
        let direction = parameters.direction(self.side);
        Tips {
            angle: Plane::new(along, across) * direction,
            rate: Plane::new(along_rate, across_rate) * direction / self.length,
        }
    }

    /// Looks ahead from `s`, before which nothing happens, within the stretch.
    pub(super) fn look(&self, parameters: &Parameters, s: f64) -> Next {
        if self.lost {
            return Next::Now(Ending::Lost);
        }
        let x = s / self.length;
        let [y, rate, _] = values(&self.y, x);
        let mut stride = 1.0 - x;
        for (room, up) in self.rooms.iter().zip([true, false]) {
            let now = gap(room, x);
            let noise = parameters.tolerance * (room[0].abs() + room[1].abs() * x);
            if s == 0.0 && room[0] == 0.0 && room[1] == 0.0 {
                let tail: f64 = room.iter().skip(4).map(|term| term.abs()).sum();
                stride = stride.min(leaving_step(2.0 * room[2], 6.0 * room[3], 24.0 * tail));
            } else if now.gap <= noise && now.rate < 0.0 {
                return Next::Now(Ending::Edge(up));
            } else {
                stride = stride.min(curved_step(now.above(noise), jounce(room), stride));
            }
        }
        let now = gap(&self.push, x);
        let noise = push_noise(
            parameters,
            parameters.drive.nu(s),
            y,
            rate / self.length,
            parameters.drive.pulse,
        );
        if now.gap <= noise && now.rate < 0.0 {
            return Next::Now(Ending::Release);
        }
        stride = stride.min(curved_step(now.above(noise), jounce(&self.push), stride));
        Next::Until((s + stride * self.length).max(s.next_up()))
    }
}

impl Blades {
    /// Term `n` of the acceleration of a free blade coordinate, in units of the
    /// stretch `h`.
    pub(super) fn free_term(&self, angle: &Terms, n: usize, h: f64) -> f64 {
        -2.0 * self.propagator.damping * h * slope(angle, n)
            - self.propagator.stiffness * h * h * angle[n]
    }
}

/// Returns the series of the tangent, `T' = (1 + T^2) angle'`.
fn tangent(angle: &Terms) -> Terms {
    let (mut result, mut factor, mut rate) = ([0.0; TERMS], [0.0; TERMS], [0.0; TERMS]);
    result[0] = angle[0].tan();
    for n in 0..TERMS - 1 {
        rate[n] = slope(angle, n);
        factor[n] = product(&result, &result, n) + if n == 0 { 1.0 } else { 0.0 };
        result[n + 1] = product(&factor, &rate, n) / (n as f64 + 1.0);
    }
    result
}
