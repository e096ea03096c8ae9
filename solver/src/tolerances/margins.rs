//! Those of the margins.

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

/// Steps away from a quantity, as parts of it, at which a run is asked whether its verdict is
/// still the same. Closer together: more islands are found, by more runs.
pub(crate) const CHANGE_STEPS: [f64; 7] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0];

/// Digits of a value that is tried. Fewer: a change is not found to its three digits. More: a
/// value that is shown does not give the same run.
pub(crate) const CHANGE_DIGITS: usize = 4;

/// Part of a value to which a change of the verdict is found: three digits. Smaller: more runs
/// for digits that no machine has.
pub(crate) const CHANGE_FOUND: f64 = 1e-3;

/// Most runs on one side of a quantity: those steps, and halvings of the widest of them to
/// three digits of a value that is a hundredth of the present one.
pub(crate) const CHANGE_RUNS: usize = 20;

/// Largest value that is tried of a damping ratio that is zero, more than structures have.
pub(crate) const CHANGE_OF_ZERO: f64 = 0.1;
