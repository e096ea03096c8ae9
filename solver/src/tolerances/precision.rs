//! Those of a reference by time steps, for what the event solver does not know.

/// Steps at most, each half of the one before. More: the coarsest are too long to tell
/// anything. Fewer: no order is seen.
pub(crate) const REFERENCE_STEPS: usize = 8;

/// Steps at least: three changes of the end, and two orders.
pub(crate) const REFERENCE_STEPS_LEAST: usize = 4;

/// Changes of the end, of the finest steps, that are asked whether they fall. Of changes
/// without a pattern one row in a hundred passes, with five one in thirty; of one impact one
/// in nine does not. More: the coarsest steps are of another motion.
pub(crate) const CHANGES_ASKED: usize = 6;

/// How far two orders in a row may be from a whole number, for the end to be
/// extrapolated. Larger: an order is seen by chance, and the extrapolated end is worse than
/// that of the finest step.
pub(crate) const ORDER_CLEAR: f64 = 0.1;

/// Least order, over the changes that are asked, with which the finest step is a
/// reference. One is that of the scheme in contact. Smaller: a chaotic run has one.
pub(crate) const ORDER_LEAST: f64 = 0.5;

/// Largest error of a reference, in clearances. Larger: it tells nothing of a row.
pub(crate) const REFERENCE_WORST: f64 = 1e-2;
