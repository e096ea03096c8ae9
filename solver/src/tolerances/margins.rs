//! Those of the margins.

/// Looks over the first swing for how far the casing moves. Fewer: more of the swings after
/// it are looked at. Speed only.
pub(crate) const SWING_LOOKS: u32 = 64;

/// Part of the way from the middle of a side to its corner, and of a radian of the casing,
/// between two looks for the nearest instant. Larger: its slope has several zeros between
/// two looks.
pub(crate) const TOUCHING_LOOK: f64 = 0.25;

/// Most casing periods in which the first touch is looked for. More: an undamped
/// casing takes longer than a hundredth of a second. Fewer: a blade that passes
/// nearer later is missed.
pub(crate) const TOUCHING_PERIODS: f64 = 1000.0;

/// Factor between two values of a parameter on the way to a target. Larger: a limit
/// that goes there and back between two is missed.
pub(crate) const TARGET_FACTOR: f64 = 1.05;

/// Largest factor by which a parameter is changed for a target, both ways.
pub(crate) const TARGET_SPAN: f64 = 1e6;

/// Part of a target by which it may be missed: a limit that jumps past it is not
/// there. Smaller: round-off of a search.
pub(crate) const TARGET_REACHED: f64 = 1e-6;
