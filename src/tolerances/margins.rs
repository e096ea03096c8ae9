//! Those of the margins.

/// Part of itself to which the smallest pulse that touches is bisected, before its
/// last digits come from the closed form. Smaller: a touch is asked for between two
/// roundings.
pub(crate) const TOUCHING_PART: f64 = 1e-12;

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

/// Part of itself to which the touching pulse of a sample is known. Larger: its spread
/// by small tolerances has no third digit.
pub(crate) const SAMPLED_TOUCH: f64 = 1e-6;

/// Factor between two values of a parameter on the way to a target. Larger: a limit
/// that goes there and back between two is missed.
pub(crate) const TARGET_FACTOR: f64 = 1.05;

/// Largest factor by which a parameter is changed for a target, both ways.
pub(crate) const TARGET_SPAN: f64 = 1e6;

/// Part of a target by which it may be missed: a limit that jumps past it is not
/// there. Smaller: round-off of a search.
pub(crate) const TARGET_REACHED: f64 = 1e-6;
