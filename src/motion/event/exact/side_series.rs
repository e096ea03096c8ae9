//! Sliding while the pulse acts, the speed changes or the blades move, as power
//! series in time of the equations of docs/theory.md, section 7. One stretch, no
//! longer than the time of one radian of the fastest rate, is summed to
//! round-off. A stretch is a polynomial: any instant of it can be asked for,
//! and sums of its coefficients bound its derivatives.

use std::f64::consts::FRAC_PI_2;

use super::blades::{Blades, Tips};
use super::parameters::{Drive, Parameters};
use super::slide::{Ahead, Along, push_noise};
use crate::motion::Plane;
use crate::motion::event::looks::{curved_step, leaving_step};
use crate::motion::event::series::{
    STRETCH, TERMS, Terms, ended, gap, jounce, product, quotient, slope, values,
};
use crate::tolerances::MOST_HALVINGS;

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
    pub(super) fn new(parameters: &Parameters, drive: &Drive, side: u32, from: &From) -> Self {
        let (inward, spin) = parameters.facing(drive, side, 0.0, &from.tips);
        let mut fastest =
            parameters.omega + 2.0 * parameters.damping + spin.abs() + drive.nu_rate.abs().sqrt();
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
            series.expand(parameters, drive, inward);
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
    fn expand(&mut self, parameters: &Parameters, drive: &Drive, inward: Plane) {
        let h = self.length;
        let (nu, ramp) = (drive.nu * h, drive.nu_rate * h * h);
        let (omega2, c2) =
            (parameters.omega * parameters.omega * h * h, 2.0 * parameters.damping * h);
        let (g0, pulse) = (parameters.clearance, drive.pulse * h * h);
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

    /// Speed at the start away from the upper (`true`) or lower end \[m/s\].
    pub(super) fn parting(&self, upper: bool) -> f64 {
        self.rooms[usize::from(!upper)][1] / self.length
    }

    pub(super) fn at(&self, s: f64) -> Along {
        let x = s / self.length;
        let [y, rate, _] = values(&self.y, x);
        Along { y, rate: rate / self.length, push: values(&self.push, x)[0] }
    }

    /// Whether the other side of a polygon of two may be met within the stretch:
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

    /// A bound on every blade angle over the stretch \[rad\].
    pub(super) fn largest_bound(&self) -> f64 {
        self.tips.iter().flatten().map(|term| term.abs()).sum()
    }

    /// The blades, `s` seconds on.
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
    pub(super) fn look(&self, parameters: &Parameters, drive: &Drive, s: f64) -> Ahead {
        if self.lost {
            return Ahead::Lost;
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
                return Ahead::Edge(up);
            } else {
                stride = stride.min(curved_step(now.above(noise), jounce(room), stride));
            }
        }
        let now = gap(&self.push, x);
        let noise = push_noise(parameters, drive.nu(s), y, rate / self.length, drive.pulse);
        if now.gap <= noise && now.rate < 0.0 {
            return Ahead::Release;
        }
        stride = stride.min(curved_step(now.above(noise), jounce(&self.push), stride));
        Ahead::Until((s + stride * self.length).max(s.next_up()))
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

/// Series of the tangent, `T' = (1 + T^2) angle'`.
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
