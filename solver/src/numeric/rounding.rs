//! Relative tolerances for round-off, and rounding to significant decimal digits.

/// Round-off of one sum, relative to its terms: about fifty roundings. With a smaller value a side
/// at rest would count as opening, and pivoting might not end.
pub(crate) const ROUND_OFF: f64 = 1e-14;

/// Round-off of many sums in a row, relative to their size: about five hundred roundings. With a
/// smaller value a wave would never come to rest, and a casing that just reaches its side could be
/// taken for one that falls short of it.
pub(crate) const ROUNDINGS: f64 = 1e-13;

/// A pivot or a residual counts as zero up to this part of the largest entry: about five thousand
/// roundings. With a smaller value equations would count as unsolved although no number solves them
/// better.
pub(crate) const AS_ZERO: f64 = 1e-12;

/// Rounds a number to `digits` significant digits, at least one. Exact, because it goes through the
/// decimal text.
pub fn rounded(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits.saturating_sub(1)).parse().unwrap_or(x)
}
