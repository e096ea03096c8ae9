//! Sensitivities `d ln(limit)/d ln(parameter)` by central differences of the limits themselves.

use super::parameters::{clearance_share, scaled};
use crate::numeric::rounding::rounded;
use crate::scene::keys::{CASING_RADIUS, CLEARANCE_KEY};
use crate::scene::{Key, Scene};

/// Relative change of a parameter. A smaller one would amplify the round-off of a limit, 1e-16 to
/// 1e-13, which is divided by it. With a larger one the error of fourth order would reach the fourth
/// digit of a limit that changes a hundred times as much as its parameter.
pub(super) const CHANGE: f64 = 2e-4;

/// Largest meaningful sensitivity: here one per cent of the parameter changes the limit by 100 %,
/// which no linearisation describes.
const MOST: f64 = 100.0;

/// Number of digits of a sensitivity, and the magnitude below which it is set to zero, above its
/// round-off of 1e-12 to 1e-9.
const DIGITS: usize = 8;
const ROUND_OFF: f64 = 1e-6;

/// Returns the sensitivities of several limits to one parameter. `limits` returns their values in a
/// changed scene, always as many and in the same order, NaN for a limit that does not exist.
/// `change` is the relative change of the parameter, usually `CHANGE`. `None` without a derivative,
/// and above `MOST`.
///
/// A length acts through the clearance, which is a small difference of two lengths, and directly; the
/// two contributions are computed separately.
pub(super) fn sensitivities(
    scene: &Scene,
    by: &Key,
    change: f64,
    limits: impl Fn(&Scene) -> Vec<f64>,
) -> Vec<Option<f64>> {
    let mut found = differences(scene, by, change, &limits);
    let share = clearance_share(by, scene);
    if share != 0.0 {
        let through = differences(scene, &CLEARANCE_KEY, change, &limits);
        found.iter_mut().zip(through).for_each(|(by, through)| *by += share * through);
    }
    let told = |by: f64| {
        let by = if by.abs() < ROUND_OFF { 0.0 } else { rounded(by, DIGITS) };
        // A limit that changes its sign has no logarithm of a ratio.
        (by.abs() <= MOST).then_some(by)
    };
    found.into_iter().map(told).collect()
}

/// Returns `d ln(limit)/d ln(parameter)` from central differences of logarithms, which are exact for
/// a power of the parameter. Differences over the whole and over half the change are combined so that
/// the error is of fourth order (Richardson).
fn differences(
    scene: &Scene,
    by: &Key,
    change: f64,
    limits: &impl Fn(&Scene) -> Vec<f64>,
) -> Vec<f64> {
    // A relative change of zero is zero, and the radius acts through the clearance only.
    if by.real(scene) == 0.0 || by.path == CASING_RADIUS {
        return vec![0.0; limits(scene).len()];
    }
    let slopes = |part: f64| {
        let [low, high] = [-part, part].map(|part| scaled(by, scene, change * part));
        let over = logarithm(by.real(&high), by.real(&low));
        let slope = move |(high, low)| logarithm(high, low) / over;
        limits(&high).into_iter().zip(limits(&low)).map(slope)
    };
    slopes(1.0).zip(slopes(0.5)).map(|(whole, half)| (4.0 * half - whole) / 3.0).collect()
}

/// Returns `ln(to/from)` without cancellation.
fn logarithm(to: f64, from: f64) -> f64 {
    ((to - from) / from).ln_1p()
}
