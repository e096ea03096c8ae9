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
        let mut walk =
            Walk { target: *self, scene, go_on, stopped: false, met: None, tried: [from; 2] };
        let found = walk.bracket().and_then(|ends| walk.halve(ends));
        let (to, reached) = found.unzip();
        let Walk { met, tried, stopped, .. } = walk;
        (!stopped).then_some(Found { name, wanted, by: by.path, from, to, reached, met, tried })
    }
}

/// A search in progress.
struct Walk<'a> {
    target: Target,
    scene: &'a CheckedScene,
    go_on: GoOn<'a>,
    /// Whether `go_on` has returned false.
    stopped: bool,
    /// As in [`Found`], up to now.
    met: Option<[f64; 2]>,
    tried: [f64; 2],
}

impl Walk<'_> {
    /// Returns the excess of the limit over the wanted value at a value of the searched quantity;
    /// `None` without such a scene or limit, and once the search has stopped.
    fn excess(&mut self, walked: f64) -> Option<f64> {
        let Target { name, wanted, by } = self.target;
        self.stopped |= !(self.go_on)();
        if self.stopped {
            return None;
        }
        let value = value_at(by, self.scene, walked);
        let scene = changed(by, self.scene, value).and_then(|scene| scene.checked()).ok()?;
        let limit = Evaluated::of(&scene).values(name).first().copied()?;
        let [low, high] = self.tried;
        self.tried = [low.min(value), high.max(value)];
        let [least, most] = self.met.unwrap_or([limit; 2]);
        self.met = Some([least.min(limit), most.max(limit)]);
        Some(limit - wanted)
    }

    /// Returns two neighbouring values between which the limit passes the wanted one, the nearest
    /// to the present value.
    fn bracket(&mut self) -> Option<[f64; 2]> {
        let by = self.target.by;
        let from = walked(by).real(self.scene);
        // If the present value is zero, the search goes only upward, from a value small enough for
        // any unit.
        let up_only = from == 0.0;
        let (start, span) =
            if up_only { (1.0 / TARGET_SPAN, TARGET_SPAN.powi(3)) } else { (from, TARGET_SPAN) };
        let steps = (span.ln() / TARGET_FACTOR.ln()).ceil() as i32;
        let first = self.excess(from).map(|excess| (from, excess > 0.0));
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
                let value = value.clamp(-largest(by), largest(by));
                let now = self.excess(value).map(|excess| (value, excess > 0.0));
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

    /// Bisects, and returns the parameter and the limit there, unless the limit jumps.
    fn halve(&mut self, ends: [f64; 2]) -> Option<(f64, f64)> {
        let above = self.excess(ends[1])? > 0.0;
        let is_far = |at| self.excess(at).map(|excess| (excess > 0.0) == above).ok_or(());
        let [low, high] = try_bisected(ends, 0.0, is_far).ok()?;
        let both = [(low, self.excess(low)?), (high, self.excess(high)?)];
        let nearer = |a: &(f64, f64), b: &(f64, f64)| a.1.abs().total_cmp(&b.1.abs());
        let (at, excess) = both.into_iter().min_by(nearer)?;
        let [least, most] = self.met.unwrap_or_default();
        let size = self.target.wanted.abs().max(least.abs()).max(most.abs());
        let reached = excess.abs() <= TARGET_REACHED * size;
        let value = value_at(self.target.by, self.scene, at);
        reached.then_some((value, self.target.wanted + excess))
    }
}
