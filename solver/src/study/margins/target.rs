//! The value of one parameter that puts a limit where it is wanted: outward from its
//! value in the scene by equal factors until the limit passes the wanted value, then
//! by halving to the last digit.

use serde::Serialize;
use strum::VariantNames;
use thiserror::Error;

use super::closed::{CLOSED, values};
use super::limit::LimitName;
use super::parameters::{PARAMETERS, Parameter, Parameters, parameter};
use super::touching;
use crate::motion::GoOn;
use crate::scene::units::UnitError;
use crate::scene::{CheckedScene, Quantity};
use crate::tolerances::{TARGET_FACTOR, TARGET_REACHED, TARGET_SPAN};

/// Why a target was refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TargetError {
    /// Text of another form.
    #[error("target {text}: allowed is NAME=VALUE, such as omega_lock=450, NAME one of {}", LimitName::VARIANTS.join(", "))]
    Form {
        /// As given.
        text: String,
    },
    /// A value of another quantity.
    #[error("target {text}: {why}")]
    Unit {
        /// As given.
        text: String,
        /// What it is, and which units are allowed.
        why: UnitError,
    },
    /// No parameter.
    #[error("parameter {path}: allowed is one of {}", paths())]
    Parameter {
        /// As given.
        path: String,
    },
}

/// The paths of all parameters.
fn paths() -> String {
    PARAMETERS.iter().map(|parameter| parameter.path).collect::<Vec<_>>().join(", ")
}

/// A limit, where it is wanted, and the parameter that may change.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    name: LimitName,
    wanted: f64,
    by: &'static Parameter,
}

/// What was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Found {
    /// The limit.
    pub name: LimitName,
    /// Where it is wanted.
    pub wanted: f64,
    /// Path of the parameter.
    pub by: &'static str,
    /// Its value in the scene.
    pub from: f64,
    /// Its value that puts the limit there, the nearest to that of the scene; none if
    /// there is none.
    pub to: Option<f64>,
    /// The limit with that value.
    pub reached: Option<f64>,
    /// Smallest and largest value of the limit that were met on the way.
    pub met: Option<[f64; 2]>,
    /// Smallest and largest value of the parameter that were tried.
    pub tried: [f64; 2],
}

impl Target {
    /// Reads `NAME=VALUE` and the path of a parameter.
    ///
    /// # Errors
    /// Text of another form, an unknown limit, a value that is no finite number, or a
    /// path that is no parameter.
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

    /// Looks for the value; none where `go_on` said no on the way.
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

/// A search under way.
struct Walk<'a> {
    target: Target,
    scene: &'a CheckedScene,
    go_on: GoOn<'a>,
    met: Option<[f64; 2]>,
    tried: [f64; 2],
}

/// A value of what is walked over, and by how much the limit is above the wanted value.
type Place = (f64, f64);

impl Walk<'_> {
    /// The limit at a value of the parameter, less the wanted value; none inside where
    /// there is no such scene or no such limit, none where told to stop.
    fn at(&mut self, walked: f64) -> Option<Option<f64>> {
        let value = self.target.by.value_at(self.scene, walked);
        if !(self.go_on)() {
            return None;
        }
        let scene = self.target.by.set(self.scene, value).and_then(|scene| scene.checked());
        let Ok(scene) = scene else { return Some(None) };
        let limit = match CLOSED.iter().position(|closed| *closed == self.target.name) {
            Some(place) => values(&Parameters::<f64>::of(&scene))[place],
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

    /// Two neighbouring values between which the limit passes the wanted one, the
    /// nearest to that of the scene.
    fn bracket(&mut self, from: f64) -> Option<Option<[Place; 2]>> {
        // From zero upward, where the scene has zero: from so little that it may be of any
        // unit.
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
                // The last step downward is to zero itself.
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

    /// The place in between, and the limit there; none inside where it jumps.
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
