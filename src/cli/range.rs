//! `FROM:TO:COUNT`, a range of values that a command sweeps.

use super::status::Refusal;
use crate::report::ticks::linspace;
use rubscope_solver::scene::Quantity;
use rubscope_solver::scene::units::RangeError;
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
    pub fn parse(name: &str, text: &str, of: Quantity) -> Result<Self, Refusal> {
        match parse_range(text, of) {
            Ok((from, to, count))
                if from.is_finite() && to.is_finite() && (1..=MOST).contains(&count) =>
            {
                Ok(Self { from, to, count })
            }
            Err(RangeError::End(why)) => Err(Refusal::because(format!("{name} = {text}: {why}"))),
            _ => {
                let form = format!("FROM:TO:COUNT, two numbers and a count from 1 to {MOST}");
                Err(Refusal::of(name, text, form))
            }
        }
    }

    /// Returns the values.
    pub fn values(&self) -> Vec<f64> {
        linspace(self.from, self.to, self.count)
    }
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

    #[test]
    fn other_forms_are_refused_with_the_form_that_is_allowed() {
        assert_eq!(
            Range::parse("--speed", "-10:1e2:3", Quantity::Speed).unwrap(),
            Range { from: -10.0, to: 100.0, count: 3 }
        );
        let minute = Range::parse("--speed", "0rpm:9500 rpm:3", Quantity::Speed).unwrap();
        assert!((minute.to - 994.837_673_637).abs() < 1e-8);
        let force = Range::parse("--speed", "0:43 kN:3", Quantity::Speed).unwrap_err().to_string();
        assert_eq!(force, "--speed = 0:43 kN:3: this is a force; it takes rad/s, rpm or Hz");
        for text in
            ["1:2", "1:2:0", "1:2:x", "a:2:3", "1:nan:3", "1:2:3:4", "1:2:-3", "1:2:9999999"]
        {
            let message = Range::parse("--speed", text, Quantity::Speed).unwrap_err().to_string();
            assert!(message.starts_with(&format!("--speed = {text}: allowed is FROM:TO:COUNT")));
        }
    }
}
