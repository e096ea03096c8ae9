//! Inverse problem: the value of one parameter that moves a limit to a given value. The search goes
//! outward from the present value by equal ratios until the limit passes the wanted value, then
//! bisects to the last digit.

use serde::Serialize;
use strum::VariantNames;
use thiserror::Error;

use super::evaluated::Evaluated;
use super::limit::LimitName;
use super::parameters::{PARAMETERS, Parameter, parameter};
use crate::motion::GoOn;
use crate::numeric::search::try_bisected;
use crate::scene::units::UnitError;
use crate::scene::{CheckedScene, Quantity};

/// Factor between successive values of the parameter in the search. With a larger one a limit that
/// passes the target and returns between two values would be missed.
const TARGET_FACTOR: f64 = 1.05;

/// Largest factor by which the search increases or decreases the parameter.
const TARGET_SPAN: f64 = 1e6;

/// Relative deviation from the target up to which it counts as reached. A limit that jumps past the
/// target deviates by more; the round-off of the search deviates by less.
const TARGET_REACHED: f64 = 1e-6;

/// Reason why a target was rejected.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TargetError {
    /// The text has another form.
    #[error("target {text}: allowed is NAME=VALUE, such as omega_lock=450, NAME one of {}", LimitName::VARIANTS.join(", "))]
    Form {
        /// Text as given.
        text: String,
    },
    /// The value has a unit of another quantity.
    #[error("target {text}: {why}")]
    Unit {
        /// Text as given.
        text: String,
        /// What is wrong with the unit, and which units are allowed.
        why: UnitError,
    },
    /// There is no such parameter.
    #[error("parameter {path}: allowed is one of {}", paths())]
    Parameter {
        /// Path as given.
        path: String,
    },
}

/// Lists the paths of all parameters.
fn paths() -> String {
    PARAMETERS.iter().map(|parameter| parameter.path).collect::<Vec<_>>().join(", ")
}

/// A limit, its wanted value, and the parameter to change.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    name: LimitName,
    wanted: f64,
    by: &'static Parameter,
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
    pub fn parse(text: &str, by: &str) -> Result<Self, TargetError> {
        let form = || TargetError::Form { text: text.to_string() };
        let (name, value) = text.split_once('=').ok_or_else(form)?;
        let name: LimitName = name.trim().parse().map_err(|_| form())?;
        let wanted = Quantity::of(name.quantity().unit()).read(value);
        let wanted = wanted.map_err(|why| match why {
            UnitError::NoNumber => form(),
            why => TargetError::Unit { text: text.to_string(), why },
        })?;
        if !wanted.is_finite() {
            return Err(form());
        }
        let refused = || TargetError::Parameter { path: by.to_string() };
        Ok(Self { name, wanted, by: parameter(by.trim()).ok_or_else(refused)? })
    }

    /// Searches for the value; `None` if `go_on` returned false.
    #[must_use]
    pub fn solve(&self, scene: &CheckedScene, go_on: GoOn<'_>) -> Option<Found> {
        let Self { name, wanted, by } = *self;
        let from = by.of(scene);
        let mut walk = Walk { target: *self, scene, go_on, met: None, tried: [from; 2] };
        let found = match walk.bracket().and_then(|ends| walk.halve(ends)) {
            Ok(found) => Some(found),
            Err(End::Nowhere) => None,
            Err(End::Stopped) => return None,
        };
        let (to, reached) = found.unzip();
        let Walk { met, tried, .. } = walk;
        Some(Found { name, wanted, by: by.path, from, to, reached, met, tried })
    }
}

/// A search in progress.
struct Walk<'a> {
    target: Target,
    scene: &'a CheckedScene,
    go_on: GoOn<'a>,
    /// As in [`Found`], up to now.
    met: Option<[f64; 2]>,
    tried: [f64; 2],
}

/// Why there is no result: no such scene or limit, or `go_on` stopped the search.
enum End {
    Nowhere,
    Stopped,
}

impl Walk<'_> {
    /// Returns the excess of the limit over the wanted value at a value of the searched quantity.
    fn excess(&mut self, walked: f64) -> Result<f64, End> {
        let Target { name, wanted, by } = self.target;
        let value = by.value_at(self.scene, walked);
        if !(self.go_on)() {
            return Err(End::Stopped);
        }
        let scene = by.set(self.scene, value).and_then(|scene| scene.checked());
        let scene = scene.map_err(|_| End::Nowhere)?;
        let limit = Evaluated::of(&scene).values(name).first().copied().ok_or(End::Nowhere)?;
        let [low, high] = self.tried;
        self.tried = [low.min(value), high.max(value)];
        let [least, most] = self.met.unwrap_or([limit; 2]);
        self.met = Some([least.min(limit), most.max(limit)]);
        Ok(limit - wanted)
    }

    /// Returns two neighbouring values between which the limit passes the wanted one, the nearest
    /// to the present value.
    fn bracket(&mut self) -> Result<[f64; 2], End> {
        let from = self.target.by.walked(self.scene).1;
        // If the present value is zero, the search goes only upward, from a value small enough for
        // any unit.
        let up_only = from == 0.0;
        let (start, span) =
            if up_only { (1.0 / TARGET_SPAN, TARGET_SPAN.powi(3)) } else { (from, TARGET_SPAN) };
        let steps = (span.ln() / TARGET_FACTOR.ln()).ceil() as i32;
        let largest = self.target.by.largest();
        let is_above = |walk: &mut Self, value| match walk.excess(value) {
            Ok(excess) => Ok(Some((value, excess > 0.0))),
            Err(End::Nowhere) => Ok(None),
            Err(End::Stopped) => Err(End::Stopped),
        };
        let first = is_above(self, from)?;
        let mut ends = vec![(1, first), (-1, first)];
        ends.truncate(if up_only { 1 } else { 2 });
        for step in 1..=steps + 1 {
            for (sign, before) in &mut ends {
                // The last step downward goes to zero itself.
                let value = match (*sign, step > steps) {
                    (-1, true) => 0.0,
                    (_, true) => continue,
                    _ => (start * TARGET_FACTOR.powi(*sign * step)).clamp(-largest, largest),
                };
                let now = is_above(self, value)?;
                if let Some((before, now)) = before.zip(now)
                    && before.1 != now.1
                {
                    return Ok([before.0, now.0]);
                }
                *before = now;
            }
        }
        Err(End::Nowhere)
    }

    /// Bisects, and returns the parameter and the limit there, unless the limit jumps.
    fn halve(&mut self, [low, high]: [f64; 2]) -> Result<(f64, f64), End> {
        let above = self.excess(high)? > 0.0;
        let ends = try_bisected([low, high], 0.0, |at| Ok((self.excess(at)? > 0.0) == above))?;
        let [low, high] = [self.excess(ends[0])?, self.excess(ends[1])?];
        let (at, excess) = if low.abs() <= high.abs() { (ends[0], low) } else { (ends[1], high) };
        let [least, most] = self.met.unwrap_or_default();
        let size = self.target.wanted.abs().max(least.abs()).max(most.abs());
        let reached = excess.abs() <= TARGET_REACHED * size;
        let value = self.target.by.value_at(self.scene, at);
        reached.then_some((value, self.target.wanted + excess)).ok_or(End::Nowhere)
    }
}
