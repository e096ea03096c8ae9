//! Rounding to significant decimal digits, exact because it goes through the decimal text.

/// Rounds a number to `digits` significant digits, at least one.
pub fn rounded(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits.saturating_sub(1)).parse().unwrap_or(x)
}
