//! Steps of a knob through round mantissas. With a lining, the clearance can become negative; then
//! all blades rub at rest.

use rubscope_solver::scene::{ContactLaw, Scene};

/// Mantissas of fine steps: two digits. Coarse steps use 1, 2 and 5.
const FINE: &[f64] = &[
    1.0, 1.1, 1.2, 1.3, 1.5, 1.6, 1.8, 2.0, 2.2, 2.4, 2.7, 3.0, 3.3, 3.6, 3.9, 4.3, 4.7, 5.0, 5.6,
    6.2, 6.8, 7.5, 8.2, 9.1,
];
const COARSE: &[f64] = &[1.0, 2.0, 5.0];

pub(super) fn mantissas(coarse: bool) -> &'static [f64] {
    if coarse { COARSE } else { FINE }
}

/// Returns the next number above or below `x` with one of `mantissas`. Magnitudes below `least` are
/// skipped: a step down from `least` leads to zero.
pub(super) fn decades(x: f64, up: bool, mantissas: &[f64], least: f64) -> f64 {
    if x.abs() < least * (1.0 - 1e-9) {
        return if up { least } else { 0.0 };
    }
    if x < 0.0 {
        return -decades(-x, !up, mantissas, least);
    }
    let power = x.log10().floor() as i32;
    let candidates = (power - 1..=power + 1).flat_map(|p| {
        // Parsing gives the double that is nearest to the decimal number.
        mantissas.iter().filter_map(move |m| format!("{m}e{p}").parse::<f64>().ok())
    });
    let next = if up {
        candidates.filter(|c| *c > x * (1.0 + 1e-9)).fold(f64::INFINITY, f64::min)
    } else {
        candidates.filter(|c| *c < x * (1.0 - 1e-9)).fold(0.0, f64::max)
    };
    if !next.is_finite() {
        x
    } else if next < least * (1.0 - 1e-9) {
        0.0
    } else {
        next
    }
}

/// Smallest positive clearance that steps reach, without a lining \[m\].
const LEAST: f64 = 1e-9;
/// Smallest positive clearance that steps reach on a lining \[m\]; one more step down changes its
/// sign.
const LEAST_ON_LINING: f64 = 1e-6;

/// Returns the clearance one step above or below `x` \[m\]. On a lining, steps skip zero.
pub(super) fn turned(x: f64, up: bool, coarse: bool, scene: &Scene) -> f64 {
    let lining = scene.solver.contact == ContactLaw::Smooth;
    let least = if lining { LEAST_ON_LINING } else { LEAST };
    let next = decades(x, up, mantissas(coarse), least);
    match next == 0.0 && lining {
        true if up => least,
        true => -least,
        false => next,
    }
}
