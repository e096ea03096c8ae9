//! Sensitivities `d ln(limit)/d ln(parameter)` by central differences of the limits themselves.

use super::parameters::{CLEARANCE, Parameter, parameter};
use crate::numeric::rounding::rounded;
use crate::scene::Scene;

/// Relative change of a parameter. Smaller: round-off of a limit, 1e-16 to 1e-13, is divided by it.
/// Larger: the error of the two differences together, of fourth order, spoils the fourth digit where
/// a limit changes a hundred times as much as its parameter.
pub(super) const CHANGE: f64 = 2e-4;

/// Largest meaningful sensitivity: here one per cent of the parameter changes the limit by 100 %,
/// which no linearisation describes.
const MOST: f64 = 100.0;

/// Digits of a sensitivity, and its size below which it is zero: round-off, 1e-12 to 1e-9, is
/// divided by nothing larger.
const DIGITS: usize = 8;
const ROUND_OFF: f64 = 1e-6;

/// Returns the sensitivities of several limits to one parameter. `limits` returns their values in a
/// changed scene, always as many and in the same order; not a number where there is no such limit.
/// `change` is the relative change of the parameter, usually `CHANGE`. `None` without a derivative,
/// and above `MOST`.
///
/// A length acts through the clearance, a small difference of two lengths, and by itself; each of
/// both parts is a difference over `change`.
pub(super) fn sensitivities(
    scene: &Scene,
    by: &Parameter,
    change: f64,
    limits: impl Fn(&Scene) -> Vec<f64>,
) -> Vec<Option<f64>> {
    let mut found = differences(scene, by, change, &limits);
    let share = by.clearance_share(scene);
    if let Some(clearance) = parameter(CLEARANCE).filter(|_| share != 0.0) {
        let through = differences(scene, clearance, change, &limits);
        found.iter_mut().zip(through).for_each(|(by, through)| *by += share * through);
    }
    let told = |by: f64| {
        let by = if by.abs() < ROUND_OFF { 0.0 } else { rounded(by, DIGITS) };
        // A limit that changes its sign has no logarithm of a ratio.
        (by.abs() <= MOST).then_some(by)
    };
    found.into_iter().map(told).collect()
}

/// Returns the differences of logarithms, which are exact for a power of the parameter. Those over
/// the whole and the half of the change together have an error of fourth order (Richardson).
fn differences(
    scene: &Scene,
    by: &Parameter,
    change: f64,
    limits: &impl Fn(&Scene) -> Vec<f64>,
) -> Vec<f64> {
    // A relative change of zero is zero.
    if by.of(scene) == 0.0 || by.is_radius() {
        return vec![0.0; limits(scene).len()];
    }
    let slopes = |part: f64| {
        let [low, high] = [-part, part].map(|part| by.scaled(scene, change * part));
        let over = logarithm(by.of(&high), by.of(&low));
        let slope = move |(high, low)| logarithm(high, low) / over;
        limits(&high).into_iter().zip(limits(&low)).map(slope)
    };
    slopes(1.0).zip(slopes(0.5)).map(|(whole, half)| (4.0 * half - whole) / 3.0).collect()
}

/// Returns `ln(to/from)` without cancellation.
fn logarithm(to: f64, from: f64) -> f64 {
    ((to - from) / from).ln_1p()
}
