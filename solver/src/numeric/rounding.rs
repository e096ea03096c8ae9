//! Round-off as a part of a size, and rounding to significant decimal digits, exact because it goes
//! through the decimal text.

/// Part of the terms of a sum that its round-off may make: some fifty
/// roundings. Smaller: a side at rest counts as opening, and pivoting may not end.
pub(crate) const ROUND_OFF: f64 = 1e-14;

/// Part of a size that many sums in a row may round off: a thousand roundings. Smaller: a
/// wave never rests, blades that stand alike count as two, and where a casing just
/// rises to its side round-off could take it for falling.
pub(crate) const ROUNDINGS: f64 = 1e-13;

/// Part of a size up to which a pivot, a residual, a step of Newton's method, a
/// discriminant or what is left of a gap counts as zero: ten thousand roundings. Smaller:
/// equations that have no better answer are said to have none.
pub(crate) const AS_ZERO: f64 = 1e-12;

/// Rounds a number to `digits` significant digits, at least one.
pub fn rounded(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits.saturating_sub(1)).parse().unwrap_or(x)
}
