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

/// Part of itself to which the smallest lasting pulse is known by the event solver.
/// Larger: its sensitivities, which are differences, lose their fourth digit.
pub(crate) const LASTING_EDGE: f64 = 1e-10;

/// The same by the explicit solver, whose edge is rough with its step. Smaller: more
/// runs, and no better.
pub(crate) const LASTING_EDGE_BY_STEPS: f64 = 1e-6;

/// The same of the other edges of bands, which are only shown. Larger: the thinnest
/// islands have no width.
pub(crate) const LASTING_PART: f64 = 1e-5;

/// How far from its place an edge is sought again, at most, as a part of it. Larger: a
/// neighbouring band is taken for it. Smaller: it is lost where it moves fast.
pub(crate) const LASTING_REACH: f64 = 0.02;

/// The same by the explicit solver. Smaller: changes are so small that the steps at
/// which contacts happen to fall make the difference.
pub(crate) const LASTING_REACH_BY_STEPS: f64 = 0.2;

/// Part of what is left that is cut off each time on the way to an edge that has moved, on
/// the side where nothing lasts. Speed only.
pub(crate) const LASTING_CUT: f64 = 0.15;

/// Change of a parameter by which the edge of lasting is differentiated, as a part of
/// that reach. Larger: an edge that moves twenty times as much is lost. Smaller:
/// round-off, and for the explicit solver the steps at which contacts happen to fall,
/// make the difference.
pub(crate) const LASTING_CHANGE: f64 = 0.05;

/// Part by which the two differences may disagree for an edge to be smooth.
pub(crate) const LASTING_SMOOTH: f64 = 0.05;

/// Factor between the first and the largest pulse that last for them to be a zone: a
/// quarter of a decade. Smaller: an island at the end of the search is taken for it.
pub(crate) const LASTING_ZONE: f64 = 1.78;

/// Most work of one of the runs of a search: updates of a coordinate. A search makes
/// some thousand runs, so more of them are many minutes.
pub(crate) const LASTING_WORK: f64 = 5e7;

/// Factor between two values of a parameter on the way to a target. Larger: a limit
/// that goes there and back between two is missed.
pub(crate) const TARGET_FACTOR: f64 = 1.05;

/// Largest factor by which a parameter is changed for a target, both ways.
pub(crate) const TARGET_SPAN: f64 = 1e6;

/// Part of a target by which it may be missed: a limit that jumps past it is not
/// there. Smaller: round-off of a search.
pub(crate) const TARGET_REACHED: f64 = 1e-6;
