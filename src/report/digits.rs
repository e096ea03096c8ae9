//! Numbers in the digits that hold: those that tiny changes of a run leave alone.

use std::cell::Cell;

use super::number::rounded;

/// Digits that are shown where all of them hold.
const MOST: u32 = 6;

/// How the numbers of one run are told.
#[derive(Debug, Default)]
pub struct Digits {
    /// Whether it is known how far changes move them.
    known: bool,
    left_out: Cell<bool>,
    none: Cell<bool>,
}

impl Digits {
    /// Of a run of which it is `known` how far changes move its numbers.
    #[must_use]
    pub fn of(known: bool) -> Self {
        Self { known, ..Self::default() }
    }

    /// `x` as `show` writes it, in the digits that hold where changes move it by
    /// `spread`, or make that there is no such number.
    pub fn told(&self, x: f64, spread: Option<f64>, show: impl Fn(f64) -> String) -> String {
        let spread = if self.known { spread.unwrap_or(f64::INFINITY) } else { 0.0 };
        match held(x, spread) {
            MOST.. => show(x),
            0 => {
                self.none.set(true);
                format!("about {}", show(rounded(x, 1)))
            }
            some => {
                self.left_out.set(true);
                show(rounded(x, some as usize))
            }
        }
    }

    /// What was not told, if there is such.
    pub fn note(&self) -> Option<&'static str> {
        if self.none.get() {
            Some("No digit holds of what is \"about\": a change of 1e-9 moves it by as much.")
        } else if self.left_out.get() {
            Some("Digits that a change of 1e-9 moves are left out.")
        } else {
            None
        }
    }
}

/// How many digits of `x` hold, up to all that are shown: changes move it by no more
/// than half a unit of the last of them.
fn held(x: f64, spread: f64) -> u32 {
    // Zero has no digits to lose.
    if spread == 0.0 || x == 0.0 {
        return MOST;
    }
    let first = x.abs().log10().floor();
    let digits = (first + 1.0 - (2.0 * spread).log10()).floor();
    (1..=MOST).rev().find(|&count| f64::from(count) <= digits).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::number::short;

    #[test]
    fn only_digits_that_hold_are_told() {
        for (x, spread, text) in [
            (2.68635e-6, 0.0, "2.68635e-6"),
            (2.68635e-6, 1e-13, "2.68635e-6"),
            (2.68635e-6, 5.33e-9, "2.7e-6"),
            (-244.416, 0.004, "-244.42"),
            (-244.416, 0.006, "-244.4"),
            (-244.416, 0.6, "-240"),
            (2.68635e-6, 1.4e-6, "about 3e-6"),
            (2.68635e-6, f64::INFINITY, "about 3e-6"),
            (0.0, 1e-9, "0"),
        ] {
            assert_eq!(Digits::of(true).told(x, Some(spread), short), text, "{x} {spread}");
        }
    }

    #[test]
    fn what_was_not_told_is_said() {
        let digits = Digits::of(true);
        assert_eq!((digits.told(1.25, Some(0.0), short), digits.note()), ("1.25".into(), None));
        let _ = digits.told(1.25, Some(0.04), short);
        assert!(digits.note().unwrap().contains("left out"));
        // A run that changes have none of has no number that holds.
        let _ = digits.told(1.25, None, short);
        assert!(digits.note().unwrap().contains("No digit holds"));
        assert_eq!(Digits::of(false).told(1.25, None, short), "1.25");
    }
}
