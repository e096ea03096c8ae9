//! Sliding while the pulse acts or the speed changes, as power series in time.
//!
//! The equations of `slide` with `nu(t)`, the Euler term `nu' g0` and the pulse
//! turning against the side have entire solutions; one stretch of them, no
//! longer than the time of one radian of the fastest rate, is summed to
//! round-off. A stretch is a polynomial: any instant of it can be asked for,
//! and sums of its coefficients bound its derivatives.

use super::approach::{curved_step, leaving_step};
use super::slide::{Ahead, Along, push_noise};
use super::world::{Drive, World};

/// Terms kept: `1/22!` is 1e-21.
const TERMS: usize = 22;

type Terms = [f64; TERMS];

/// One stretch of sliding on `side`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Series {
    pub side: u32,
    /// Length of the stretch \[s\].
    pub length: f64,
    /// Scale of time the terms refer to: terms are of `(s/length)^n`.
    y: Terms,
    push: Terms,
}

impl Series {
    pub(super) fn new(world: &World, drive: &Drive, side: u32, y: f64, rate: f64) -> Self {
        let turning = drive.nu.abs();
        let fastest = world.omega + 2.0 * world.damping + turning + drive.nu_rate.abs().sqrt();
        let length = 1.0 / fastest;
        let (sin, cos) = {
            let inward = drive.inward(world, side, 0.0);
            (inward.im, inward.re)
        };
        let mut terms = Self { side, length, y: [0.0; TERMS], push: [0.0; TERMS] };
        terms.expand(world, drive, [y, rate], [cos, sin]);
        terms
    }

    /// Fills the terms by the recurrence of the differential equation, with
    /// time counted in units of `length`.
    fn expand(&mut self, world: &World, drive: &Drive, [y, rate]: [f64; 2], [cos, sin]: [f64; 2]) {
        let h = self.length;
        let (nu, ramp) = (drive.nu * h, drive.nu_rate * h * h);
        let (omega2, c2) = (world.omega * world.omega * h * h, 2.0 * world.damping * h);
        let (g0, pulse) = (world.clearance, drive.pulse * h * h);
        let (mut cosine, mut sine) = ([0.0; TERMS], [0.0; TERMS]);
        (cosine[0], sine[0]) = (cos, sin);
        let y_terms = &mut self.y;
        (y_terms[0], y_terms[1]) = (y, rate * h);
        let earlier = |terms: &Terms, n: usize, k: usize| if n >= k { terms[n - k] } else { 0.0 };
        for n in 0..TERMS {
            let order = n as f64;
            if n + 1 < TERMS {
                let over = 1.0 / (order + 1.0);
                sine[n + 1] = over * (nu * cosine[n] + ramp * earlier(&cosine, n, 1));
                cosine[n + 1] = -over * (nu * sine[n] + ramp * earlier(&sine, n, 1));
            }
            // Terms of nu y and nu^2 y.
            let turned = nu * y_terms[n] + ramp * earlier(y_terms, n, 1);
            let before =
                if n >= 1 { nu * y_terms[n - 1] + ramp * earlier(y_terms, n, 2) } else { 0.0 };
            let squared = nu * turned + ramp * before;
            let slope = if n + 1 < TERMS { (order + 1.0) * y_terms[n + 1] } else { 0.0 };
            let constant = match n {
                0 => (c2 * nu + ramp) * g0,
                1 => c2 * ramp * g0,
                _ => 0.0,
            };
            if n + 2 < TERMS {
                y_terms[n + 2] = (constant - c2 * slope - omega2 * y_terms[n] + squared
                    - pulse * sine[n])
                    / ((order + 1.0) * (order + 2.0));
            }
            let held = match n {
                0 => (nu * nu - omega2) * g0,
                1 => 2.0 * nu * ramp * g0,
                2 => ramp * ramp * g0,
                _ => 0.0,
            };
            let coriolis = 2.0 * (nu * slope + ramp * order * y_terms[n]);
            self.push[n] =
                (held - coriolis - c2 * turned - ramp * y_terms[n] - pulse * cosine[n]) / (h * h);
        }
        // The last term of the push lacks its Coriolis part; it is below round-off.
        self.push[TERMS - 1] = 0.0;
    }

    pub(super) fn at(&self, s: f64) -> Along {
        let x = s / self.length;
        let [y, rate, _] = values(&self.y, x, 0);
        let [push, _, _] = values(&self.push, x, 0);
        Along { y, rate: rate / self.length, push }
    }

    /// Looks ahead from `s`, before which nothing happens, within the stretch.
    pub(super) fn look(&self, world: &World, drive: &Drive, s: f64) -> Ahead {
        let x = s / self.length;
        let [displacement, rate, acceleration] = values(&self.y, x, 1);
        let (along, span) = (jerk(&self.y), 1.0 - x);
        let mut stride = f64::INFINITY;
        for up in [true, false] {
            let sign = if up { -1.0 } else { 1.0 };
            let room = world.half_side + sign * self.y[0];
            let gap = room + sign * displacement;
            let closing = sign * rate;
            let noise = world.tolerance * (room + displacement.abs());
            if s == 0.0 && room == 0.0 && self.y[1] == 0.0 {
                let tail: f64 = self.y.iter().skip(4).map(|term| term.abs()).sum();
                let [second, third] = [sign * 2.0 * self.y[2], sign * 6.0 * self.y[3]];
                stride = stride.min(leaving_step(second, third, 24.0 * tail));
            } else if gap <= noise && closing < 0.0 {
                return Ahead::Edge(up);
            } else {
                let gap = gap.max(0.0) + noise;
                stride = stride.min(curved_step(gap, closing, sign * acceleration, along, span));
            }
        }
        let [push, push_rate, push_bend] = values(&self.push, x, 0);
        let noise = push_noise(
            world,
            drive.nu(s),
            self.y[0] + displacement,
            rate / self.length,
            drive.pulse,
        );
        if push <= noise && push_rate < 0.0 {
            return Ahead::Release;
        }
        let push_jerk = jerk(&self.push);
        let push = push.max(0.0) + noise;
        stride = stride.min(curved_step(push, push_rate, push_bend, push_jerk, span));
        let stride = stride * self.length;
        Ahead::Until((s + stride).max(s.next_up()))
    }
}

/// Value from term `first` on, and first and second derivative, by Horner.
fn values(terms: &Terms, x: f64, first: usize) -> [f64; 3] {
    let (mut value, mut rate, mut bend) = (0.0, 0.0, 0.0);
    for (n, &term) in terms.iter().enumerate().rev() {
        bend = bend * x + rate;
        rate = rate * x + value;
        value = value * x + if n >= first { term } else { 0.0 };
    }
    [value, rate, 2.0 * bend]
}

/// Bound on the third derivative over the stretch, `0 <= x <= 1`.
fn jerk(terms: &Terms) -> f64 {
    let factor = |n: f64| n * (n - 1.0) * (n - 2.0);
    terms.iter().enumerate().skip(3).map(|(n, term)| factor(n as f64) * term.abs()).sum()
}
