//! Locked in a corner: the casing wave turns with the rotor, two sides push
//! (docs/theory.md, section 4).
//!
//! With rigid blades, `D = 2 c nu + nu'` and the side half-length `h = g0 tan delta`, a
//! casing held at rest in the corner of sides `a` and `b` (`psi_b = psi_a +
//! 2 delta`) and then let go would open the two gaps with
//! `q_a = f cos beta_a + (omega_c^2 - nu^2) g0 - D h` and
//! `q_b = f cos beta_b + (omega_c^2 - nu^2) g0 + D h`; the pushes cancel both.
//!
//! Where blades move (section 7), the casing follows them, as both gaps are closed: with
//! `a exp(-i psi_m) = xi + i eta` about the bisector `psi_m` of the corner, the wave is
//! `u = -R exp(i sigma)`, `sigma = n_d theta + psi_m + n_d cos delta xi`,
//! `R = g0/cos tau`, `tau = delta + n_d sin delta eta`. The sum `S` and
//! difference `D` of the pushes follow from the casing equation,
//! `S cos tau = -(R'' - sigma'^2 R + 2 c R' + omega_c^2 R) - f cos sigma`,
//! `D sin tau = -(2 sigma' R' + sigma'' R + 2 c sigma' R) + f sin sigma`, and
//! turn the blades by `k tan tau (D cos delta + i S sin delta)`,
//! `k = ratio g0/n_d`. The two unknown accelerations `xi''` and `eta''` are
//! eliminated; what is left is summed as a power series, as along a side.

use super::mode::{Ending, Next};
use super::parameters::{Blades, Parameters, Tips};
use crate::motion::Plane;
use crate::motion::event::series::{
    STRETCH, TERMS, Terms, curved_step, ended, gap, jounce, product, quotient, safe_step, slope,
    values,
};
use crate::tolerances::{LIGHT_BLADES, MOST_HALVINGS, ROOM_TO_CHANGE};

/// Returns the opening accelerations `q_a`, `q_b` of a corner at rest, `s` seconds on, and
/// their rates.
pub(super) fn opening(parameters: &Parameters, a: u32, s: f64) -> [(f64, f64); 2] {
    let (nu, ramp, c2) =
        (parameters.drive.nu(s), parameters.drive.nu_rate, 2.0 * parameters.damping);
    let (g0, h) = (parameters.clearance, parameters.half_side);
    let pulse = parameters.pulse_on(a, s);
    let centred = (parameters.omega - nu) * (parameters.omega + nu) * g0;
    let slack = -2.0 * nu * ramp * g0;
    let mut openings = [(0.0, 0.0); 2];
    for (opening, (pulse, sign)) in
        openings.iter_mut().zip([(pulse, -1.0), (pulse * parameters.turn, 1.0)])
    {
        *opening = (
            pulse.re + centred + sign * (c2 * nu + ramp) * h,
            slack - nu * pulse.im + sign * c2 * ramp * h,
        );
    }
    openings
}

/// Returns the impulses or pushes that cancel two opening rates at once:
/// `p + [[1, cos 2 delta], [cos 2 delta, 1]]^-1 q = 0`.
pub(super) fn cancelled(parameters: &Parameters, a: f64, b: f64) -> [f64; 2] {
    let Plane { re: cos, im: sin } = parameters.turn;
    let scale = 1.0 / (sin * sin);
    [-(a - cos * b) * scale, -(b - cos * a) * scale]
}

/// Returns the pushes per unit mass of both sides \[m/s^2\].
pub(super) fn pushes(parameters: &Parameters, a: u32, s: f64) -> [f64; 2] {
    let [first, second] = opening(parameters, a, s);
    cancelled(parameters, first.0, second.0)
}

/// Looks ahead from `s` in the corner of `a` and the next side.
pub(super) fn look(parameters: &Parameters, a: u32, s: f64, end: f64) -> Next {
    let drive = &parameters.drive;
    if drive.steady() {
        return Next::Until(end);
    }
    let [first, second] = opening(parameters, a, s);
    let pushes = cancelled(parameters, first.0, second.0);
    let rates = cancelled(parameters, first.1, second.1);
    let ramp = drive.nu_rate.abs();
    // A ramp may change the wave frequency by its own size, or by one turn a
    // period of it, in one look.
    let size = drive.nu(s).abs() + ramp.sqrt();
    let span = if ramp > 0.0 { (size / ramp).min(end - s) } else { end - s };
    let turning = drive.nu(s).abs().max(drive.nu(s + span).abs());
    let Plane { re: cos, im: sin } = parameters.turn;
    let spread = (1.0 + cos.abs()) / (sin * sin);
    let pulse = drive.pulse.abs();
    let bend =
        spread * (2.0 * ramp * ramp * parameters.clearance + pulse * (turning * turning + ramp));
    let square = (parameters.omega * parameters.omega).max(turning * turning);
    let noise = parameters.tolerance * spread * (square * parameters.clearance + pulse);
    let mut stride = span;
    for (second, (push, rate)) in [false, true].into_iter().zip(pushes.into_iter().zip(rates)) {
        if push <= noise && rate < 0.0 {
            return Next::Now(Ending::Yield(second));
        }
        stride = stride.min(safe_step(push.max(0.0) + noise, rate, bend));
    }
    Next::Until((s + stride).max(s.next_up()))
}

/// One stretch of locked motion in the corner of side `a` and the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct CornerSeries {
    pub a: u32,
    /// Length of the stretch \[s\].
    pub length: f64,
    /// Blade angles along and across the bisector, `xi` and `eta` \[rad\].
    tips: [Terms; 2],
    /// Pushes of `a` and the next side, per unit mass \[m/s^2\].
    pushes: [Terms; 2],
    /// Whether no stretch is short enough for its terms to end.
    lost: bool,
    /// Pushes below this are round-off of the terms that they add up.
    noise: f64,
}

impl CornerSeries {
    pub(super) fn new(parameters: &Parameters, blades: &Blades, a: u32, tips: &Tips) -> Self {
        let bisector = bisector(parameters, a);
        let (local, turning) = (tips.angle * bisector.conj(), tips.rate * bisector.conj());
        let spin = parameters.drive.nu.abs() + blades.diameters * tips.rate.norm();
        let fastest = parameters.omega
            + 2.0 * parameters.damping
            + spin
            + parameters.drive.nu_rate.abs().sqrt()
            + blades.omega
            + 2.0 * blades.propagator.damping;
        let mut held = Self {
            a,
            length: STRETCH / fastest,
            tips: [[0.0; TERMS]; 2],
            pushes: [[0.0; TERMS]; 2],
            noise: parameters.push_noise(),
            lost: false,
        };
        for _ in 0..MOST_HALVINGS {
            let h = held.length;
            for (terms, (angle, rate)) in
                held.tips.iter_mut().zip([(local.re, turning.re), (local.im, turning.im)])
            {
                (terms[0], terms[1]) = (angle, rate * h);
            }
            held.expand(parameters, blades, bisector);
            held.lost = !held.pushes.iter().all(|terms| ended(terms) || held.rests(terms));
            if !held.lost {
                break;
            }
            held.length *= 0.5;
        }
        held
    }

    fn expand(&mut self, parameters: &Parameters, blades: &Blades, bisector: Plane) {
        let drive = &parameters.drive;
        let h = self.length;
        let (nu, ramp) = (drive.nu * h, drive.nu_rate * h * h);
        let (omega2, c2) =
            (parameters.omega * parameters.omega * h * h, 2.0 * parameters.damping * h);
        let (g0, pulse) = (parameters.clearance, drive.pulse * h * h);
        let (sin_d, cos_d) = parameters.machine.polygon.delta.sin_cos();
        let (along, across) = (blades.diameters * cos_d, blades.diameters * sin_d);
        let k = blades.ratio * g0 / blades.diameters;
        let zero = [0.0; TERMS];
        let Self { tips: [xi, eta], pushes: [first, second], .. } = self;
        let start = bisector * Plane::cis(drive.phase + along * xi[0]);
        let (mut cos, mut sin) = (zero, zero);
        (cos[0], sin[0]) = (start.re, start.im);
        // tau', sigma', their squares; tan, sec, their products.
        let (mut tau, mut sigma, mut tau2, mut sigma2) = (zero, zero, zero, zero);
        let (mut tan, mut sec, mut tan2, mut both, mut sec2) = (zero, zero, zero, zero, zero);
        let tau_start = parameters.machine.polygon.delta + across * eta[0];
        (tan[0], sec[0]) = (tau_start.tan(), 1.0 / tau_start.cos());
        let (mut radius_rate, mut curve, mut steep, mut bent) = (zero, zero, zero, zero);
        let (mut free_xi, mut free_eta) = (zero, zero);
        let (mut across_sum, mut along_sum) = (zero, zero);
        let (mut sum, mut difference, mut share_sum, mut share) = (zero, zero, zero, zero);
        let (mut spin_rate, mut spin_place) = (zero, zero);
        for n in 0..TERMS {
            let order = n as f64;
            let constant = if n == 0 { 1.0 } else { 0.0 };
            tau[n] = across * slope(eta, n);
            sigma[n] = along * slope(xi, n) + [nu, ramp].get(n).unwrap_or(&0.0);
            tau2[n] = product(&tau, &tau, n);
            sigma2[n] = product(&sigma, &sigma, n);
            tan2[n] = product(&tan, &tan, n);
            both[n] = product(&tan, &sec, n);
            sec2[n] = product(&sec, &sec, n);
            if n + 1 < TERMS {
                tan[n + 1] = (product(&sec2, &tau, n)) / (order + 1.0);
                sec[n + 1] = product(&both, &tau, n) / (order + 1.0);
                sin[n + 1] = product(&cos, &sigma, n) / (order + 1.0);
                cos[n + 1] = -product(&sin, &sigma, n) / (order + 1.0);
            }
            // R = g0 sec, R' = g0 sec tan tau'; the part of R'' without tau''.
            radius_rate[n] = g0 * product(&both, &tau, n);
            curve[n] = tan2[n] + sec2[n];
            steep[n] = product(&curve, &tau2, n);
            bent[n] = g0 * product(&sec, &steep, n);
            free_xi[n] = blades.free_term(xi, n, h);
            free_eta[n] = blades.free_term(eta, n, h);
            // S (1 + g0 n_d k sin^2 delta (sec tan)^2) = -sec (...).
            across_sum[n] = bent[n] - g0 * product(&sigma2, &sec, n)
                + c2 * radius_rate[n]
                + omega2 * g0 * sec[n]
                + pulse * cos[n]
                + g0 * across * product(&both, &free_eta, n);
            share_sum[n] = constant + g0 * across * k * sin_d * product(&both, &both, n);
            sum[n] = quotient(-product(&sec, &across_sum, n), &share_sum, &sum, n);
            // D tan (1 + g0 n_d k cos^2 delta sec^2) = sec (...).
            spin_rate[n] = product(&sigma, &radius_rate, n);
            spin_place[n] = product(&sigma, &sec, n);
            along_sum[n] = pulse * sin[n]
                - 2.0 * spin_rate[n]
                - c2 * g0 * spin_place[n]
                - g0 * (ramp * sec[n] + along * product(&sec, &free_xi, n));
            share[n] = tan[n] + g0 * along * k * cos_d * product(&tan, &sec2, n);
            difference[n] = quotient(product(&sec, &along_sum, n), &share, &difference, n);
            if n + 2 < TERMS {
                let over = 1.0 / ((order + 1.0) * (order + 2.0));
                xi[n + 2] = over * (free_xi[n] + k * cos_d * product(&tan, &difference, n));
                eta[n + 2] = over * (free_eta[n] + k * sin_d * product(&tan, &sum, n));
            }
            first[n] = 0.5 * (sum[n] - difference[n]) / (h * h);
            second[n] = 0.5 * (sum[n] + difference[n]) / (h * h);
        }
        for pushes in [first, second] {
            // These lack what the last blade terms would add: round-off.
            pushes[TERMS - 2..].fill(0.0);
        }
    }

    /// Returns the place and rate of the casing in the standing frame, `s` seconds on.
    pub(super) fn standing(&self, parameters: &Parameters, s: f64) -> (Plane, Plane) {
        let diameters = parameters.blades.map_or(0.0, |blades| blades.diameters);
        let (sin, cos) = parameters.machine.polygon.delta.sin_cos();
        let [[xi, xi_rate, _], [eta, eta_rate, _]] =
            self.tips.map(|terms| values(&terms, s / self.length));
        let tau = parameters.machine.polygon.delta + diameters * sin * eta;
        let radius = parameters.clearance / tau.cos();
        let growth = radius * tau.tan() * diameters * sin * eta_rate / self.length;
        let spin = parameters.drive.nu(s) + diameters * cos * xi_rate / self.length;
        let turned = bisector(parameters, self.a)
            * Plane::cis(parameters.drive.phase(s) + diameters * cos * xi);
        (-turned * radius, -turned * Plane::new(growth, spin * radius))
    }

    /// Returns a bound on every blade angle over the stretch \[rad\].
    pub(super) fn largest_bound(&self) -> f64 {
        self.tips.iter().flatten().map(|term| term.abs()).sum()
    }

    /// Returns the blades, `s` seconds on.
    pub(super) fn tips(&self, parameters: &Parameters, s: f64) -> Tips {
        let [[xi, xi_rate, _], [eta, eta_rate, _]] =
            self.tips.map(|terms| values(&terms, s / self.length));
        let bisector = bisector(parameters, self.a);
        Tips {
            angle: Plane::new(xi, eta) * bisector,
            rate: Plane::new(xi_rate, eta_rate) * bisector / self.length,
        }
    }

    /// Returns the pushes of both sides per unit mass \[m/s^2\].
    pub(super) fn pushes(&self, s: f64) -> [f64; 2] {
        let push =
            |terms| if self.rests(&terms) { 0.0 } else { values(&terms, s / self.length)[0] };
        self.pushes.map(push)
    }

    /// Returns the distance of both contacts from the middle of their sides \[m\].
    pub(super) fn half_side(&self, parameters: &Parameters, s: f64) -> f64 {
        parameters.clearance * parameters.half_angle(self.a, &self.tips(parameters, s)).tan()
    }

    /// Whether, at constant speed, no push can vanish any more: what bends the blades at
    /// rest, and what is left of their vibration about it, moves the pushes by less than
    /// half of what they are.
    pub(super) fn for_good(&self, parameters: &Parameters, blades: &Blades, s: f64) -> bool {
        let (sin, cos) = parameters.machine.polygon.delta.sin_cos();
        let rest = pushes(parameters, self.a, 0.0);
        let least = rest[0].min(rest[1]);
        let moment = blades.ratio / blades.diameters * parameters.half_side;
        let offset = Plane::new((rest[1] - rest[0]) * cos, (rest[1] + rest[0]) * sin);
        let rest = offset * bisector(parameters, self.a) * (moment / blades.propagator.stiffness);
        let tips = self.tips(parameters, s);
        let left = Tips { angle: tips.angle - rest, rate: tips.rate };
        // An angle, its rate and its acceleration enter the pushes with at most
        // these rates squared, times the distance of the corner over sin delta.
        let rates = parameters.drive.nu.abs()
            + parameters.omega
            + blades.omega
            + 2.0 * (parameters.damping + blades.propagator.damping);
        let turned = blades.diameters * (blades.amplitude(&left) + rest.norm());
        let change = 2.0 * turned * rates * rates * parameters.clearance / (sin * cos);
        let light = blades.ratio * parameters.half_side * parameters.half_side < LIGHT_BLADES;
        light && least > parameters.certain_push() && change < ROOM_TO_CHANGE * least
    }

    /// Returns whether a push is nothing but round-off.
    fn rests(&self, push: &Terms) -> bool {
        push.iter().map(|term| term.abs()).sum::<f64>() <= self.noise
    }

    /// Looks ahead from `s`, before which nothing happens, within the stretch.
    pub(super) fn look(&self, parameters: &Parameters, s: f64) -> Next {
        if self.lost {
            return Next::Now(Ending::Lost);
        }
        let x = s / self.length;
        let mut stride = 1.0 - x;
        for (terms, second) in self.pushes.iter().zip([false, true]) {
            let now = gap(terms, x);
            let size: f64 = terms.iter().map(|term| term.abs()).sum();
            if self.rests(terms) {
                // A side that holds without a push, as at the critical speed
                // itself, is not opened by round-off.
                continue;
            }
            let noise = parameters.tolerance * size;
            if now.gap <= noise && now.rate < 0.0 {
                return Next::Now(Ending::Yield(second));
            }
            stride = stride.min(curved_step(now.above(noise), jounce(terms), stride));
        }
        Next::Until((s + stride * self.length).max(s.next_up()))
    }
}

/// Returns `exp(i psi_m)`, half-way between a side and the next.
fn bisector(parameters: &Parameters, a: u32) -> Plane {
    parameters.direction(a) * Plane::cis(parameters.machine.polygon.delta)
}
