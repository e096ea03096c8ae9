//! Axis of a map: a numeric key of the scene, or the clearance, over a range of values with equal
//! differences or equal ratios.

use serde::{Deserialize, Serialize};

use crate::scene::{Allowed, Key, Quantity, Scene, SceneError, Value, keys, read_ends};

/// Largest number of values on an axis.
pub const MOST_VALUES: u32 = 100_000;

/// Largest ratio between the ends of a logarithmic axis, beyond that of any quantity of a machine.
const MOST_FACTOR: f64 = 1e30;

/// Form of an axis in words.
const FORM: &str = "PATH=FROM:TO:COUNT or PATH=log:FROM:TO:COUNT";

/// Reads `FROM:TO:COUNT`, with ends of the given quantity. Errors refer to the option or key `name`,
/// of which `allowed` is the form in words.
///
/// # Errors
/// The text has another form, or an end is of another quantity.
pub fn parse_range(
    name: &str,
    text: &str,
    of: Quantity,
    allowed: &str,
) -> Result<([f64; 2], usize), SceneError> {
    let (ends, count) = read_ends(name, text, of, allowed)?;
    let count = count.and_then(|count| count.trim().parse().ok());
    Ok((ends, count.ok_or_else(|| SceneError::refused(name, text, allowed))?))
}

/// A key and its values along one axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Dotted path of the key.
    pub path: String,
    /// First value, in the unit of the key.
    pub from: f64,
    /// Last value, in the unit of the key.
    pub to: f64,
    /// Number of values.
    pub count: u32,
    /// Whether the values have equal ratios instead of equal differences.
    pub log: bool,
}

/// Writes the axis in the form that [`Axis::parse`] reads.
impl std::fmt::Display for Axis {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { path, from, to, count, log } = self;
        write!(out, "{path}={}{from:?}:{to:?}:{count}", if *log { "log:" } else { "" })
    }
}

impl Axis {
    /// Creates an axis over a numeric key; both ends are checked, and rounded for a whole-numbered
    /// key.
    ///
    /// # Errors
    /// The key is unknown or not numeric, or the range is not allowed.
    pub fn new(path: &str, from: f64, to: f64, count: u64, log: bool) -> Result<Self, SceneError> {
        let key = key_of(path)?;
        let whole = matches!(key.allowed, Allowed::Whole { .. });
        let [from, to] = if whole { [from.round(), to.round()] } else { [from, to] };
        let refused = |allowed: &str| {
            let (log, from, to) =
                (if log { "log:" } else { "" }, Value::Real(from), Value::Real(to));
            let range = format!("{log}{from}:{to}:{count}");
            SceneError::refused(format!("axis {path}"), range, allowed)
        };
        let allowed = u32::try_from(count).ok().filter(|count| (1..=MOST_VALUES).contains(count));
        let count = allowed.ok_or_else(|| refused("a count from 1 to 100000"))?;
        if log && !(from > 0.0 && to > 0.0) {
            return Err(refused("log: with both ends above 0"));
        }
        // A larger ratio could make that of two neighbouring values infinite or zero.
        if log && !(1.0 / MOST_FACTOR..=MOST_FACTOR).contains(&(to / from)) {
            return Err(refused("log: with ends that differ by a factor of at most 1e30"));
        }
        // The second end is checked even for a single value, because it is displayed.
        for end in [from, to] {
            key.check(&as_value(key, end))?;
        }
        Ok(Self { path: path.to_string(), from, to, count, log })
    }

    /// Reads `PATH=FROM:TO:COUNT` or `PATH=log:FROM:TO:COUNT`.
    ///
    /// # Errors
    /// The text has another form, or [`new`](Self::new) rejects the axis.
    pub fn parse(text: &str) -> Result<Self, SceneError> {
        let form = || SceneError::refused("axis", text, FORM);
        let Some((path, range)) = text.split_once('=') else {
            // A key alone lacks its range, unless it can have none.
            let refused = key_of(text).err().filter(|why| why.is_of("axis"));
            return Err(refused.unwrap_or_else(form));
        };
        let (path, range) = (path.trim(), range.trim());
        let ends = range.strip_prefix("log:");
        let (log, ends) = (ends.is_some(), ends.unwrap_or(range));
        let name = format!("axis {path}");
        let ([from, to], count) = parse_range(&name, ends, key_of(path)?.quantity(), FORM)?;
        Self::new(path, from, to, count as u64, log)
    }

    /// Returns whether the key is whole-numbered.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        keys::find_varied(&self.path).is_ok_and(|key| matches!(key.allowed, Allowed::Whole { .. }))
    }

    /// Returns value number `index`, from 0. Both ends are exact; values of a whole-numbered key
    /// are rounded.
    #[must_use]
    pub fn value(&self, index: u32) -> f64 {
        let value = match index {
            0 => self.from,
            _ if index + 1 >= self.count => self.to,
            _ => self.value_at(f64::from(index)),
        };
        if self.is_whole() { value.round() } else { value }
    }

    /// Returns the value at a position between 0 (first) and `count - 1` (last).
    #[must_use]
    pub fn value_at(&self, place: f64) -> f64 {
        let span = f64::from(self.count.max(2) - 1);
        if self.log {
            self.from * (self.to / self.from).powf(place / span)
        } else {
            // This order of operations gives round values for a round step, except that the zero
            // between ends of opposite sign has the round-off of the range.
            let range = self.to - self.from;
            let value = self.from + range * place / span;
            if value.abs() > 4.0 * f64::EPSILON * range.abs() { value } else { 0.0 }
        }
    }

    /// Returns the position of a value, from 0 (first) to `count - 1` (last); outside the axis
    /// beyond these.
    #[must_use]
    pub fn place(&self, value: f64) -> f64 {
        let span = f64::from(self.count.max(2) - 1);
        if self.log {
            span * (value / self.from).ln() / (self.to / self.from).ln()
        } else {
            span * (value - self.from) / (self.to - self.from)
        }
    }

    /// Returns all values in order.
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        (0..self.count).map(|index| self.value(index)).collect()
    }

    /// Sets the key of a scene to value number `index`.
    ///
    /// # Errors
    /// The key does not allow the value.
    pub fn apply(&self, scene: &mut Scene, index: u32) -> Result<(), SceneError> {
        let key = keys::find_varied(&self.path)?;
        scene.set_value(key, as_value(key, self.value(index)))
    }
}

/// Returns the key of an axis, which must be numeric.
fn key_of(path: &str) -> Result<&'static Key, SceneError> {
    let key = keys::find_varied(path)?;
    if !matches!(key.allowed, Allowed::Real { .. } | Allowed::Whole { .. }) {
        return Err(SceneError::refused(
            "axis",
            path,
            "a key with a number, such as casing.damping_ratio",
        ));
    }
    Ok(key)
}

/// Converts a number to the value type of a key.
fn as_value(key: &Key, value: f64) -> Value {
    match key.allowed {
        Allowed::Whole { .. } if value >= 0.0 => Value::Whole(value.round() as u64),
        _ => Value::Real(value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_exact_and_spacing_is_even_or_by_factors() {
        let axis = Axis::parse("operation.speed_rad_s=0:500:501").unwrap();
        assert_eq!((axis.value(0), axis.value(500)), (0.0, 500.0));
        assert!((axis.value(300) - 300.0).abs() < 1e-12);
        let axis = Axis::parse("operation.pulse_n=log:1e3:1e6:4").unwrap();
        for (value, expected) in axis.values().iter().zip([1e3, 1e4, 1e5, 1e6]) {
            assert!((value / expected - 1.0).abs() < 1e-12);
        }
        assert_eq!(Axis::parse("operation.speed_rad_s=7:9:1").unwrap().values(), [7.0]);
        let axis = Axis::parse("bladed_disk.longest_tip_m=-190e-6:190e-6:7").unwrap();
        assert_eq!(axis.value(3), 0.0);
    }

    #[test]
    fn ends_may_have_units() {
        let axis = Axis::parse("operation.pulse_n=log:1kN:1 MN:4").unwrap();
        assert_eq!((axis.from, axis.to), (1e3, 1e6));
        let axis = Axis::parse("clearance=50um:0.2 mm:4").unwrap();
        assert_eq!((axis.from, axis.to), (50e-6, 0.2e-3));
        let refused = Axis::parse("operation.speed_rad_s=0:43 kN:4").unwrap_err().to_string();
        assert_eq!(
            refused,
            "axis operation.speed_rad_s = 0:43 kN:4: this is a force; it takes rad/s, rpm or Hz"
        );
    }

    #[test]
    fn the_clearance_is_an_axis_though_it_is_no_key() {
        let axis = Axis::parse("clearance=50e-6:200e-6:4").unwrap();
        let mut scene = Scene::base();
        axis.apply(&mut scene, 1).unwrap();
        assert!((scene.clearance() - 1e-4).abs() < 1e-15);
        assert!(Axis::parse("clearance=0:inf:4").is_err());
    }

    #[test]
    fn whole_keys_take_whole_values() {
        let axis = Axis::parse("operation.nodal_diameters=2:6:5").unwrap();
        let mut scene = Scene::base();
        axis.apply(&mut scene, 3).unwrap();
        assert_eq!(scene.operation.nodal_diameters, 5);
    }
}
