//! Significant decimal digits, without error: by the shortest text of a number.

/// A number rounded to so many significant digits, at least one.
pub fn rounded(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits.saturating_sub(1)).parse().unwrap_or(x)
}
