//! Those of the explicit solver.

/// Most rows that one step closes together: a few in an ordinary step, a hundred
/// on a rim of thousands of blades. The work grows with their cube; more are a
/// step too long for the blades.
pub(crate) const MOST_ROWS: usize = 512;

/// Most multiplications of one step on its contact rows: a tenth of a second.
/// Least-index pivoting may need any number of tries, though one or two are
/// usual.
pub(crate) const MOST_PIVOTING: usize = 100_000_000;

/// Updates of one coordinate between two questions whether to go on: some tens
/// of microseconds.
pub(crate) const UPDATES_UNASKED: usize = 4096;

/// Steps without contact before a contact counts as broken: the impact of the
/// scheme takes two steps, and its rounding may open one step between them.
/// More: two impacts count as one.
pub(crate) const BREAK_STEPS: u64 = 2;

/// Fours of mode shapes that are kept as a table, 2 MiB: those of 512 single blades. Of a
/// larger disk a row is worked out when it is asked for. Speed only.
pub(crate) const SHAPES_KEPT: usize = 1 << 16;

/// Single blades from which on all of them at once cost less by a Fourier transform than by
/// products. Speed only.
pub(crate) const SHAPES_TRANSFORMED: usize = 64;

/// Steps a corner must have been closed before it counts as held. Fewer: a crossing counts.
pub(crate) const HELD_AFTER: u64 = 64;

/// Radians of the blades between two looks for the largest angle: its square is
/// the largest part missed, and then searched for.
pub(crate) const ANGLE_LOOK: f64 = 0.125;

/// Blade phase below which sine and cosine are two terms of their series
/// \[rad\]: exact to round-off.
pub(crate) const SMALL_PHASE: f64 = 1e-4;

/// Blade phase below which sine and cosine are two and three terms of it \[rad\]: exact to
/// round-off of one. Speed only.
pub(crate) const SHORT_SERIES_PHASE: f64 = 1.5e-3;

/// Blade phase below which they are four terms of it \[rad\]: exact to round-off.
pub(crate) const SERIES_PHASE: f64 = 0.03;

/// Depths of the deepest penetration up to which another gap is looked at, as a push may
/// close it: of two modes one push closes it by at most
/// `|T|/Re T`, `sqrt(1 + mu_c^2)` of its own depth where `kappa (kappa + mu) >= 0`.
/// Smaller: a neighbour is closed a step late. Larger: speed only.
pub(crate) const NEIGHBOUR_DEPTHS: f64 = 4.0;

/// Part of a side that the casing may move in one step in contact. A
/// single longer step is an impact; see `MOST_LONG_STEPS`.
pub(crate) const LONG_STEP: f64 = 0.25;

/// Longer steps in a row after which the run has failed: what a wave does that friction
/// drives so fast is the step's doing.
pub(crate) const MOST_LONG_STEPS: u32 = 2000;

/// Part of the clearance that a single blade may rise or sink until all are looked at.
/// Speed only.
pub(crate) const TIP_SLACK: f64 = 0.02;

/// Round-off of the growth in one step of a wave on a preloaded lining, in units of the last
/// place. Smaller: a wave that nothing damps is said to grow or to die.
pub(crate) const REST_ROUNDINGS: f64 = 64.0;

/// Steps of the singular value decomposition that gives an eigenmode of that wave, at most;
/// twenty are usual.
pub(crate) const REST_STEPS: usize = 1000;

/// Times that displacements shrink where a clearance is smaller all at once: each leaves
/// what is of second order in blade angles.
pub(crate) const GIVE_WAY: usize = 4;

/// Part of the deepest gap of a step that the pushes of two rows may leave of a third: the
/// round-off of three sides that meet in one place.
pub(crate) const CLOSED_PART: f64 = 1e-9;
