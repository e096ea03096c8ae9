//! Inverse problem: the value of one parameter that moves a limit to a given value. The search goes
//! outward from the present value by equal ratios until the limit passes the wanted value, then
//! bisects to the last digit.

use serde::Serialize;
use strum::VariantNames;

use super::evaluated::Evaluated;
use super::limit::LimitName;
use super::parameters::{changed, largest, parameter, value_at, walked};
use crate::motion::GoOn;
use crate::numeric::search::try_bisected;
use crate::scene::units::UnitError;
use crate::scene::{CheckedScene, Key, Quantity, SceneError};

/// Factor between successive values of the parameter in the search. With a larger one a limit that
/// passes the target and returns between two values would be missed.
const TARGET_FACTOR: f64 = 1.05;

/// Largest factor by which the search increases or decreases the parameter.
const TARGET_SPAN: f64 = 1e6;

/// Relative deviation from the target up to which it counts as reached. A limit that jumps past the
/// target deviates by more; the round-off of the search deviates by less.
const TARGET_REACHED: f64 = 1e-6;

/// A limit, its wanted value, and the parameter to change.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    name: LimitName,
    wanted: f64,
    by: &'static Key,
}

/// Result of the search.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Found {
    /// Name of the limit.
    pub name: LimitName,
    /// Wanted value of the limit.
    pub wanted: f64,
    /// Path of the parameter.
    pub by: &'static str,
    /// Value of the parameter in the scene.
    pub from: f64,
    /// Nearest value of the parameter that gives the wanted limit; `None` if none was found.
    pub to: Option<f64>,
    /// Value of the limit at `to`; `None` if `to` is.
    pub reached: Option<f64>,
    /// Smallest and largest value of the limit found during the search; `None` if the limit did not
    /// exist anywhere.
    pub met: Option<[f64; 2]>,
    /// Smallest and largest value of the parameter used in the search.
    pub tried: [f64; 2],
}

impl Target {
    /// Reads `NAME=VALUE`, and the path of a parameter.
    ///
    /// # Errors
    /// The text has another form, the limit is unknown, the value is not a finite number, or the
    /// path is not that of a parameter.
    pub fn parse(text: &str, by: &str) -> Result<Self, SceneError> {
        let refused = |why| {
            let names = LimitName::VARIANTS.join(", ");
            let allowed = format!("NAME=VALUE, such as omega_lock=450, NAME one of {names}");
            SceneError::not_read("target", text, why, allowed)
        };
        let form = || refused(UnitError::NoNumber);
        let (name, value) = text.split_once('=').ok_or_else(form)?;
        let name: LimitName = name.trim().parse().map_err(|_| form())?;
        let wanted = Quantity::of(name.quantity().unit()).read(value).map_err(refused)?;
        if !wanted.is_finite() {
            return Err(form());
        }
        Ok(Self { name, wanted, by: parameter(by.trim())? })
    }

    /// Searches for the value; `None` if `go_on` returned false.
    #[must_use]
    pub fn solve(&self, scene: &CheckedScene, go_on: GoOn<'_>) -> Option<Found> {
        let Self { name, wanted, by } = *self;
        let from = by.real(scene);
        let (mut met, mut tried, mut stopped) = (None, [from; 2], false);
        // How much the limit exceeds the wanted value at a value of the searched quantity.
        let mut excess = |walked: f64| {
            stopped |= !go_on();
            if stopped {
                return None;
            }
            let value = value_at(by, scene, walked);
            let scene = changed(by, scene, value).and_then(|scene| scene.checked()).ok()?;
            let limit = Evaluated::of(&scene).values(name).first().copied()?;
            tried = [f64::min(tried[0], value), f64::max(tried[1], value)];
            let [least, most] = met.unwrap_or([limit; 2]);
            met = Some([f64::min(least, limit), f64::max(most, limit)]);
            Some(limit - wanted)
        };
        let ends = bracket(walked(by).real(scene), largest(by), &mut excess);
        let found = ends.and_then(|ends| halve(ends, &mut excess));
        let [least, most] = met.unwrap_or_default();
        let size = wanted.abs().max(least.abs()).max(most.abs());
        let reached = found.filter(|(_, excess)| excess.abs() <= TARGET_REACHED * size);
        let (to, reached) =
            reached.map(|(at, excess)| (value_at(by, scene, at), wanted + excess)).unzip();
        (!stopped).then_some(Found { name, wanted, by: by.path, from, to, reached, met, tried })
    }
}

/// Returns two neighbouring values of the searched quantity between which `excess` changes its sign,
/// the nearest to the present value `from`, with magnitudes up to `largest`. `excess` is `None` where
/// the scene is not allowed or has no such limit.
fn bracket(
    from: f64,
    largest: f64,
    excess: &mut impl FnMut(f64) -> Option<f64>,
) -> Option<[f64; 2]> {
    // If the present value is zero, the search goes only upward, from a value small enough for any
    // unit.
    let up_only = from == 0.0;
    let (start, span) =
        if up_only { (1.0 / TARGET_SPAN, TARGET_SPAN.powi(3)) } else { (from, TARGET_SPAN) };
    let steps = (span.ln() / TARGET_FACTOR.ln()).ceil() as i32;
    let first = excess(from).map(|excess| (from, excess > 0.0));
    let mut ends = vec![(1, first), (-1, first)];
    ends.truncate(if up_only { 1 } else { 2 });
    for step in 1..=steps + 1 {
        for (sign, before) in &mut ends {
            // The last step downward goes to zero itself.
            let value = match (*sign, step > steps) {
                (-1, true) => 0.0,
                (_, true) => continue,
                _ => start * TARGET_FACTOR.powi(*sign * step),
            };
            let value = value.clamp(-largest, largest);
            let now = excess(value).map(|excess| (value, excess > 0.0));
            if let Some((before, now)) = before.zip(now)
                && before.1 != now.1
            {
                return Some([before.0, now.0]);
            }
            *before = now;
        }
    }
    None
}

/// Bisects between two values, and returns the one with the smaller `excess`, and that.
fn halve(ends: [f64; 2], excess: &mut impl FnMut(f64) -> Option<f64>) -> Option<(f64, f64)> {
    let above = excess(ends[1])? > 0.0;
    let is_far = |at| excess(at).map(|excess| (excess > 0.0) == above).ok_or(());
    let [low, high] = try_bisected(ends, 0.0, is_far).ok()?;
    let both = [(low, excess(low)?), (high, excess(high)?)];
    both.into_iter().min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
}
