//! How long a casing that swings freely stays within the clearance: in closed form,
//! whatever the blades do.

use std::f64::consts::TAU;

use super::free::dot;
use super::parameters::Parameters;
use crate::motion::Plane;
use crate::tolerances::RISE_MARGIN;

/// Time over which a casing that swings freely stays within the clearance \[s\]: where
/// it rises to it is known.
pub(super) fn rise(parameters: &Parameters, swing: f64, u: Plane, v: Plane) -> f64 {
    // The square of its distance: but for damping, which only makes it smaller, a constant
    // and one wave of twice the frequency.
    let w = (v + u * parameters.damping) / swing;
    let (place, rate) = (u.norm_sqr(), w.norm_sqr());
    let (mean, cos, sin) = (0.5 * (place + rate), 0.5 * (place - rate), dot(u, w));
    let wave = (cos * cos + sin * sin).sqrt();
    let most = mean + wave;
    let room = parameters.clearance * parameters.clearance - RISE_MARGIN * most;
    if most < room {
        return f64::INFINITY;
    }
    if u.norm_sqr() > room - RISE_MARGIN * most {
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
