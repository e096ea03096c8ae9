//! Integrals over a motion that is known in closed form: what a damped oscillator loses,
//! and Gauss quadrature where there is no closed form. Exact to round-off.

use crate::motion::Plane;
use crate::motion::propagator::Propagator;
use crate::tolerances::{FEW_NODES, MOST_PANELS, SMALL_EXPONENT};

/// Energy per unit mass that a free damped oscillator loses in `s` seconds.
pub(in crate::motion::event) fn damped(
    propagator: &Propagator,
    from: Plane,
    rate: Plane,
    s: f64,
) -> f64 {
    if propagator.damping == 0.0 || (from.norm_sqr() == 0.0 && rate.norm_sqr() == 0.0) {
        return 0.0;
    }
    let power = 2.0 * propagator.damping;
    let Some(exponents) = propagator.exponents() else {
        // Near critical damping all is over after some forty periods.
        let omega = propagator.stiffness.sqrt();
        let [sum, _] = quadrature(s.min(200.0 / omega), 2.0 * omega, |t| {
            let response = propagator.at(t);
            let rate = rate * response.slope - from * (propagator.stiffness * response.unit);
            [rate.norm_sqr(), 0.0]
        });
        return power * sum;
    };
    let [p, q] = exponents.map(|(re, im)| Plane::new(re, im));
    let speeds = [(p, q), (q, p)]
        .map(|(exponent, other)| (exponent, exponent * (rate - from * other) / (exponent - other)));
    let mut sum = 0.0;
    for (first, a) in speeds {
        for (second, b) in speeds {
            let exponent = first + second.conj();
            sum += (a * b.conj() * integral(exponent, s)).re;
        }
    }
    power * sum
}

/// Integral of `exp(r t)` from 0 to `s`.
fn integral(r: Plane, s: f64) -> Plane {
    let x = r * s;
    if x.norm_sqr() < SMALL_EXPONENT {
        return (Plane::new(1.0, 0.0) + x * 0.5 + x * x / 6.0) * s;
    }
    // exp(x) - 1 with the digits of small x kept.
    let half = (0.5 * x.im).sin();
    let re = x.re.exp_m1() * x.im.cos() - 2.0 * half * half;
    Plane::new(re, x.re.exp() * x.im.sin()) / r
}

/// Integrals over `[0, s]` of two functions whose fastest rate is `rate`, by
/// Gauss quadrature with eight points every four radians: an error of 1e-13.
pub(in crate::motion::event) fn quadrature(
    s: f64,
    rate: f64,
    integrand: impl Fn(f64) -> [f64; 2],
) -> [f64; 2] {
    let mut sums = [0.0; 2];
    if s <= 0.0 {
        return sums;
    }
    let turns = rate * s;
    // Four points err by 6e-10 of the ninth power of the angle.
    let rule: &[(f64, f64)] = if turns < FEW_NODES { &GAUSS_4 } else { &GAUSS_8 };
    let panels = (0.25 * turns).ceil().clamp(1.0, MOST_PANELS);
    let half = 0.5 * s / panels;
    let mut panel = 0.0;
    while panel < panels {
        let middle = (2.0 * panel + 1.0) * half;
        for &(node, weight) in rule {
            for signed in [-node, node] {
                let values = integrand(middle + half * signed);
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += half * weight * value;
                }
            }
        }
        panel += 1.0;
    }
    sums
}

/// Nodes and weights of one half of the interval.
const GAUSS_4: [(f64, f64); 2] = [
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];
pub(in crate::motion::event) const GAUSS_8: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrature_is_exact_for_what_the_solver_asks() {
        for (s, rate) in [(1.0, 1.0), (7.0, 1.0), (0.04, 1.0), (3.0, 5.0)] {
            let [a, b] = quadrature(s, rate, |t| [(rate * t).sin(), 1.0]);
            // Both rules err by round-off at these angles.
            assert!((a - (1.0 - (rate * s).cos()) / rate).abs() < 1e-13 * s.max(1.0));
            assert!((b - s).abs() < 1e-14 * s);
        }
    }

    #[test]
    fn integral_of_an_exponential_is_smooth_through_zero() {
        for scale in [1.0, 1e-2, 1e-4, 1.001e-4, 1e-9] {
            let r = Plane::new(-0.3, 1.1) * scale;
            let expected = quadrature(1.0, 2.0, |t| {
                let value = (r * t).exp();
                [value.re, value.im]
            });
            let value = integral(r, 1.0);
            assert!((value.re - expected[0]).abs() + (value.im - expected[1]).abs() < 1e-14);
        }
    }
}
