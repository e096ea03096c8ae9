//! Those of the event solver of what goes beyond the paper.

/// Most rows that push at once: casing and blades have four modes, and more pushes on
/// them could not be told apart.
pub(crate) const MOST_HELD: usize = 4;

/// Most rows that one impact or one instant without rates may join. The work grows
/// with their fourth power.
pub(crate) const MOST_JOINED: usize = 12;

/// Part of its largest entry below which a pivot of a small matrix counts as zero.
pub(crate) const ZERO_PIVOT: f64 = 1e-12;

/// Part of the clearance up to which a gap that has just opened keeps its own digits,
/// beside those of the state. Smaller: a short excursion is lost in round-off.
pub(crate) const JUST_OPENED: f64 = 1e-6;

/// Part of the clearance by which a wave at rest in the frame of the blades may still
/// move in one stretch: round-off. Smaller: it never rests.
pub(crate) const AT_REST: f64 = 1e-13;

/// Part of the clearance within which the energy must keep the gaps open for the rest
/// of the run to be free. Smaller: round-off decides.
pub(crate) const FREE_MARGIN: f64 = 1e-12;
