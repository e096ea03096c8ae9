//! `FROM:TO:COUNT`, a range of values that a command sweeps; and whole numbers in a range.

use crate::sheet::ticks::linspace;
use rubscope_solver::scene::{Quantity, SceneError};
use rubscope_solver::study::parse_range;

/// Largest number of values in a range of an option.
const MOST: usize = 100_000;

/// Evenly spaced values of a quantity in its SI unit, both ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// First value.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Number of values, at least one.
    pub count: usize,
}

impl Range {
    /// Parses `FROM:TO:COUNT`. `name` is the option as typed, for the error message.
    ///
    /// # Errors
    /// The text has another form, an end is not a finite number of the quantity, or the count is
    /// outside 1 to 100,000.
    pub fn parse(name: &str, text: &str, of: Quantity) -> Result<Self, SceneError> {
        let form = format!("FROM:TO:COUNT, two numbers and a count from 1 to {MOST}");
        let ([from, to], count) = parse_range(name, text, of, &form)?;
        if from.is_finite() && to.is_finite() && (1..=MOST).contains(&count) {
            return Ok(Self { from, to, count });
        }
        Err(SceneError::refused(name, text, form))
    }

    /// Returns the values.
    pub fn values(&self) -> Vec<f64> {
        linspace(self.from, self.to, self.count)
    }
}

/// Parses a whole number in a range.
///
/// # Errors
/// States the range.
pub fn whole<const LEAST: u32, const MOST: u32>(text: &str) -> Result<u32, String> {
    let count = text.parse().ok().filter(|count| (LEAST..=MOST).contains(count));
    count.ok_or_else(|| format!("allowed is a whole number from {LEAST} to {MOST}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_are_exact_and_whole_steps_stay_whole() {
        assert_eq!(linspace(0.0, 500.0, 501)[499], 499.0);
        assert_eq!(linspace(-0.1, 0.3, 7).last(), Some(&0.3));
        assert_eq!(linspace(4.0, 9.0, 1), [4.0]);
        assert!(linspace(4.0, 9.0, 0).is_empty());
        assert_eq!(linspace(500.0, -500.0, 3), [500.0, 0.0, -500.0]);
    }
}
