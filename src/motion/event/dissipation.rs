//! What a damped oscillator loses, in closed form. Exact to round-off.

use crate::motion::Plane;
use crate::motion::propagator::Propagator;
use crate::numeric::quadrature::quadrature;
use crate::tolerances::SMALL_EXPONENT;

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

#[cfg(test)]
mod tests {
    use super::*;

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
