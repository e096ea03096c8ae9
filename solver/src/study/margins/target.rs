//! Inverse problem: the value of one parameter that moves a limit to a given value. The search goes
//! outward from the present value by equal ratios until the limit passes the wanted value, then
//! bisects to the last digit.

use serde::Serialize;
use strum::VariantNames;
use thiserror::Error;

use super::closed::{CLOSED, values};
use super::limit::LimitName;
use super::parameters::{PARAMETERS, Parameter, parameter};
use super::touching;
use crate::motion::GoOn;
use crate::scene::units::UnitError;
use crate::scene::{CheckedScene, Quantity};
use crate::tolerances::{TARGET_FACTOR, TARGET_REACHED, TARGET_SPAN};

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
        let from = self.by.of(scene);
        let mut walk = Walk { target: *self, scene, go_on, met: None, tried: [from; 2] };
        let start = self.by.walked(scene).1;
        let solved = match walk.bracket(start)? {
            Some(ends) => walk.halve(ends)?,
            None => None,
        };
        let (to, reached) = solved.unzip();
        let Self { name, wanted, by } = *self;
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

/// A value of the searched quantity, and the excess of the limit over the wanted value there.
type Place = (f64, f64);

impl Walk<'_> {
    /// Returns the excess of the limit over the wanted value; the inner `None` if there is no such
    /// scene or limit, the outer one if `go_on` stopped the search.
    fn at(&mut self, walked: f64) -> Option<Option<f64>> {
        let value = self.target.by.value_at(self.scene, walked);
        if !(self.go_on)() {
            return None;
        }
        let scene = self.target.by.set(self.scene, value).and_then(|scene| scene.checked());
        let Ok(scene) = scene else { return Some(None) };
        let limit = match CLOSED.iter().position(|closed| *closed == self.target.name) {
            Some(place) => values(&scene)[place],
            None => touching::smallest(&scene).map(|touch| touch.pulse_n),
        };
        if let Some(limit) = limit {
            let [low, high] = self.tried;
            self.tried = [low.min(value), high.max(value)];
            let [least, most] = self.met.unwrap_or([limit; 2]);
            self.met = Some([least.min(limit), most.max(limit)]);
        }
        Some(limit.map(|limit| limit - self.target.wanted))
    }

    /// Returns two neighbouring values between which the limit passes the wanted one, the nearest
    /// to the present value. The inner `None` if there are none, the outer one if `go_on` stopped
    /// the search.
    fn bracket(&mut self, from: f64) -> Option<Option<[Place; 2]>> {
        // If the present value is zero, the search goes only upward, from a value small enough for
        // any unit.
        let up_only = from == 0.0;
        let (start, span) =
            if up_only { (1.0 / TARGET_SPAN, TARGET_SPAN.powi(3)) } else { (from, TARGET_SPAN) };
        let steps = (span.ln() / TARGET_FACTOR.ln()).ceil() as i32;
        let largest = self.target.by.largest();
        let first = self.at(from)?;
        let mut ends = [1, -1].map(|sign| (sign, first.map(|value| (from, value))));
        for step in 1..=steps + 1 {
            for (sign, before) in &mut ends {
                if up_only && *sign < 0 {
                    continue;
                }
                // The last step downward goes to zero itself.
                let value = match (*sign, step > steps) {
                    (-1, true) => 0.0,
                    (_, true) => continue,
                    _ => (start * TARGET_FACTOR.powi(*sign * step)).clamp(-largest, largest),
                };
                let now = self.at(value)?.map(|excess| (value, excess));
                if let Some(((_, one), (_, other))) = before.zip(now)
                    && (one <= 0.0) != (other <= 0.0)
                {
                    return Some(before.zip(now).map(|(before, now)| [before, now]));
                }
                *before = now;
            }
        }
        Some(None)
    }

    /// Bisects, and returns the parameter and the limit there; the inner `None` if the limit jumps.
    fn halve(&mut self, [mut low, mut high]: [Place; 2]) -> Option<Option<(f64, f64)>> {
        for _ in 0..200 {
            let middle = 0.5 * (low.0 + high.0);
            if middle == low.0 || middle == high.0 {
                break;
            }
            let Some(excess) = self.at(middle)? else { return Some(None) };
            if (excess <= 0.0) == (low.1 <= 0.0) {
                low = (middle, excess);
            } else {
                high = (middle, excess);
            }
        }
        let (value, excess) = if low.1.abs() <= high.1.abs() { low } else { high };
        let [least, most] = self.met.unwrap_or_default();
        let size = self.target.wanted.abs().max(least.abs()).max(most.abs());
        let limit = self.target.wanted + excess;
        let value = self.target.by.value_at(self.scene, value);
        Some((excess.abs() <= TARGET_REACHED * size).then_some((value, limit)))
    }
}
