//! Bounds on free flight ahead: how far the casing can go, how fast the gaps can change, seen
//! from sides that turn with the rotor and with their blades, and how long a casing that
//! swings freely stays within the clearance, in closed form, whatever the blades do.

use std::f64::consts::TAU;

use super::free::dot;
use super::parameters::{Blades, Parameters, Tips};
use crate::motion::Plane;
use crate::tolerances::{LIGHT_DAMPING, ROUNDINGS};

/// Bounds over a stretch of flight ahead.
pub(super) struct Bounds {
    /// On `|u|`, `|u'|`, `|u''|`.
    pub standing: [f64; 3],
    /// On `|z|` and its first four derivatives, seen from the sides.
    pub turning: [f64; 5],
}

impl Bounds {
    /// From the state now, over `span` seconds in which the wave turns against
    /// the standing frame at rates between those of `nu`.
    pub fn new(parameters: &Parameters, u: Plane, v: Plane, span: f64, nu: [f64; 2]) -> Self {
        let (omega, c) = (parameters.omega, parameters.damping);
        let centre = parameters.drive.pulse / (omega * omega);
        let from = u - Plane::new(centre, 0.0);
        let centre = centre.abs();
        let turning = nu[0].abs().max(nu[1].abs());
        let ramp = parameters.drive.nu_rate.abs();
        // Energy about the centre never grows; every derivative costs at most
        // a factor omega + 2 c, or that and nu in the turning frame.
        let top = (v.norm_sqr() + omega * omega * from.norm_sqr()).sqrt();
        let (swing, factor) = (top / omega, omega + 2.0 * c);
        let mut standing = [swing, top, top * factor];
        let mut turned = hermite(swing, factor + turning, ramp);
        if let Some(exponents) = parameters.propagator.exponents() {
            // A sum of two exponentials, each bounded by its amplitude now: in
            // the turning frame one of them may be nearly at rest.
            let [p, q] = exponents.map(|(re, im)| Plane::new(re, im));
            let mut waves = [0.0; 3];
            let mut turned_waves = [0.0; 5];
            for (exponent, other) in [(p, q), (q, p)] {
                let amplitude = size((v - from * other) / (exponent - other));
                let rate = size(exponent);
                for (sum, term) in waves.iter_mut().zip([1.0, rate, rate * rate]) {
                    *sum += amplitude * term;
                }
                let spin = (exponent.im - nu[0]).abs().max((exponent.im - nu[1]).abs());
                let terms = hermite(amplitude, size(Plane::new(exponent.re, spin)), ramp);
                for (sum, term) in turned_waves.iter_mut().zip(terms) {
                    *sum += term;
                }
            }
            lower(&mut standing, waves);
            lower(&mut turned, turned_waves);
        }
        standing[0] += centre;
        for (sum, term) in turned.iter_mut().zip(hermite(centre, turning, ramp)) {
            *sum += term;
        }
        // Over a short span the motion now bounds the motion ahead.
        let rate = size(v) + standing[2] * span;
        standing[1] = standing[1].min(rate);
        standing[0] = standing[0].min(size(u) + standing[1] * span);
        turned[0] = turned[0].min(standing[0]);
        turned[1] = turned[1].min(standing[1] + turning * standing[0]);
        Self { standing, turning: turned }
    }

    /// Same as for `new` without pulse and ramp, of the two waves that a lightly damped casing
    /// is made of, each bounded by its amplitude now.
    pub fn of_waves(parameters: &Parameters, nu: f64, u: Plane, v: Plane) -> Option<Self> {
        let (c, swing) = (parameters.damping, parameters.propagator.swing()?);
        if c > LIGHT_DAMPING * swing {
            return None;
        }
        let (scale, own) = (0.5 / swing, c * c + swing * swing);
        let w = v + u * c;
        let (mut standing, mut turning) = ([0.0; 3], [0.0; 5]);
        let quarter = Plane::new(-u.im, u.re) * swing;
        for (wave, spin) in [(w + quarter, swing - nu), (w - quarter, -swing - nu)] {
            let amplitude = scale * size(wave);
            for (sum, factor) in standing.iter_mut().zip([1.0, own.sqrt(), own]) {
                *sum += amplitude * factor;
            }
            let square = c * c + spin * spin;
            let rate = square.sqrt();
            let factors = [1.0, rate, square, square * rate, square * square];
            for (sum, factor) in turning.iter_mut().zip(factors) {
                *sum += amplitude * factor;
            }
        }
        Some(Self { standing, turning })
    }

    /// Lowers the derivatives seen from the sides to what those in the standing
    /// frame, over the same span, and the turning make of them.
    pub fn lower_locally(&mut self, parameters: &Parameters, nu: [f64; 2]) {
        let [place, rate, bend] = self.standing;
        let factor = parameters.omega + 2.0 * parameters.damping;
        let standing = [place, rate, bend, bend * factor, bend * factor * factor];
        let turn = hermite(1.0, nu[0].abs().max(nu[1].abs()), parameters.drive.nu_rate.abs());
        lower(&mut self.turning, leibniz(standing, turn));
    }

    /// Adds what the motion of the blades does to the gaps: bounds on the
    /// derivatives of `z exp(-i n_d alpha)`.
    pub fn shift(&mut self, blades: &Blades, tips: &Tips) {
        let [a, b, c, d] = blades.turning(tips);
        let factor = [
            1.0,
            a,
            b + a * a,
            c + 3.0 * a * b + a * a * a,
            d + 4.0 * a * c + 3.0 * b * b + 6.0 * a * a * b + a * a * a * a,
        ];
        self.turning = leibniz(self.turning, factor);
    }
}

/// Returns bounds on a product and its first four derivatives from those of its factors.
fn leibniz([z0, z1, z2, z3, z4]: [f64; 5], [e0, e1, e2, e3, e4]: [f64; 5]) -> [f64; 5] {
    [
        z0 * e0,
        z1 * e0 + z0 * e1,
        z2 * e0 + 2.0 * z1 * e1 + z0 * e2,
        z3 * e0 + 3.0 * z2 * e1 + 3.0 * z1 * e2 + z0 * e3,
        z4 * e0 + 4.0 * z3 * e1 + 6.0 * z2 * e2 + 4.0 * z1 * e3 + z0 * e4,
    ]
}

/// Returns `|p|`, without the care `hypot` takes at the ends of the number range: no
/// length or rate of a casing is near them, and it took a quarter of a run.
pub(super) fn size(p: Plane) -> f64 {
    p.norm_sqr().sqrt()
}

/// Returns bounds on `size exp(mu t - i ramp t^2/2)`, `|mu| <= rate`, and its first four
/// derivatives.
fn hermite(size: f64, rate: f64, ramp: f64) -> [f64; 5] {
    let square = rate * rate;
    let fourth = square * square + 6.0 * square * ramp + 3.0 * ramp * ramp;
    let third = rate * (square + 3.0 * ramp);
    [size, size * rate, size * (square + ramp), size * third, size * fourth]
}

fn lower<const N: usize>(bounds: &mut [f64; N], others: [f64; N]) {
    for (bound, other) in bounds.iter_mut().zip(others) {
        *bound = bound.min(other);
    }
}

/// Returns the time over which a casing that swings freely stays within the clearance \[s\]: where
/// it rises to it is known.
pub(super) fn rise(parameters: &Parameters, swing: f64, u: Plane, v: Plane) -> f64 {
    // The square of its distance: but for damping, which only makes it smaller, a constant
    // and one wave of twice the frequency.
    let w = (v + u * parameters.damping) / swing;
    let (place, rate) = (u.norm_sqr(), w.norm_sqr());
    let (mean, cos, sin) = (0.5 * (place + rate), 0.5 * (place - rate), dot(u, w));
    let wave = (cos * cos + sin * sin).sqrt();
    let most = mean + wave;
    let room = parameters.clearance * parameters.clearance - ROUNDINGS * most;
    if most < room {
        return f64::INFINITY;
    }
    if u.norm_sqr() > room - ROUNDINGS * most {
        // Round-off does not tell whether it rises or falls through.
        return 0.0;
    }
    let angle = sin.atan2(cos) - ((room - mean) / wave).clamp(-1.0, 1.0).acos();
    angle.rem_euclid(TAU) / (2.0 * swing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn parameters(zeta: &str) -> Parameters {
        Parameters::new(&Scene::base().with(&[("casing.damping_ratio", zeta)]).unwrap())
    }

    #[test]
    fn it_ends_where_the_casing_reaches_the_clearance() {
        let (mut ends, mut never) = (0, 0);
        for zeta in ["0", "1e-3", "0.05"] {
            let parameters = parameters(zeta);
            let g0 = parameters.clearance;
            let swing = parameters.propagator.swing().unwrap();
            for k in 0..400 {
                let u = Plane::cis(0.7 * f64::from(k)) * (g0 * f64::from(k % 20) / 20.0);
                let v = Plane::cis(1.9 * f64::from(k)) * (5e-4 * f64::from(k));
                let time = rise(&parameters, swing, u, v);
                let radius = |t: f64| {
                    let response = parameters.propagator.at(t);
                    (u * response.hold + v * response.unit).norm()
                };
                // Half a period has all of it.
                let span = time.min(TAU / (2.0 * swing));
                for j in 0..=500 {
                    let t = span * f64::from(j) / 500.0;
                    assert!(radius(t) <= g0 * (1.0 + 1e-12), "{zeta} {k}: {t} of {time}");
                }
                if time.is_finite() && zeta == "0" {
                    assert!((radius(time) / g0 - 1.0).abs() < 1e-9, "{k}: {}", radius(time));
                    ends += 1;
                }
                never += usize::from(time.is_infinite());
            }
        }
        assert!(ends > 150 && never > 50, "{ends} {never}");
    }

    #[test]
    fn at_the_clearance_itself_nothing_is_passed() {
        let parameters = parameters("0");
        for rate in [Plane::new(0.1, 0.05), Plane::new(-0.1, 0.05), Plane::new(0.0, 0.2)] {
            for part in [1.0, 1.0 - 1e-16, 1.0 - 1e-15, 1.0 - 1e-14] {
                let u = Plane::new(parameters.clearance * part, 0.0);
                assert_eq!(rise(&parameters, parameters.omega, u, rate), 0.0, "{rate} {part}");
            }
        }
    }
}
