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

/// Free steps that are worth a block; below, deciding costs as much as
/// stepping. Speed only.
pub(crate) const SHORTEST_BLOCK: u64 = 8;

/// As `SHORTEST_BLOCK`, for many blades that are coordinates of their own: a
/// leap of them and the look for their largest angle cost as much as a hundred
/// steps, of few blades less. Speed only.
pub(crate) const SHORTEST_BLOCK_OF_BLADES: u64 = 128;

/// Most blades whose mode shapes are kept as a table, at most 128 KiB. Larger
/// rings keep one turn of them. Speed only.
pub(crate) const SHAPES_KEPT: u32 = 128;

/// Blades that cost as much one by one as all of them at once, for each doubling of their
/// number; so many rows of shapes are kept of a larger ring. Speed only.
pub(crate) const FEW_BLADES: usize = 6;

/// The same of blades whose torques are given back, too. Speed only.
pub(crate) const FEW_PRESSED: usize = 2;

/// Steps a corner must have been closed before it is held. Fewer: maps are made
/// for contacts that end.
pub(crate) const HELD_AFTER: u64 = 64;

/// Steps until a corner that could not be held is tried again. Speed only.
pub(crate) const HELD_AGAIN: u64 = 4096;

/// Change of a blade angle by which the step of a corner is differentiated
/// \[rad\]: of what contact does in the map, its square is 1e-11 and round-off over it 1e-10.
pub(crate) const HELD_PROBE: f64 = 1e-6;

/// Part of a predicted gap that a step of the map may leave, as a push bends the blades:
/// it makes 1e-11 of the angles at rest, on which the pushes of both sides nearly cancel.
pub(crate) const HELD_LEFT: f64 = 1e-12;

/// Largest blade phase `n_d alpha` whose cube the gap of a side that is slid on may leave
/// out \[rad\]: it makes round-off.
pub(crate) const SMALL_TURN: f64 = 1e-5;

/// Largest blade phases whose square, cube and fourth power the map of a held corner may
/// leave out \[rad\]: they make 1e-10 of the pushes.
pub(crate) const SMALL_TURNS: [f64; 3] = [1e-5, 2e-4, 1e-3];

/// Roundings of what is left, over the square of the sine of a corner: a flat one loses
/// digits of its pushes by as much.
pub(crate) const HELD_ROUNDINGS: f64 = 16.0;

/// Most that the map of a lock of tips that rise or rub may let a deviation grow before it
/// dies: friction feeds it for a while. Larger: digits of the map are lost by as much.
pub(crate) const MOST_GROWTH: f64 = 100.0;

/// Newton steps to the modes at rest; two reach round-off.
pub(crate) const HELD_CORRECTIONS: usize = 6;

/// Radians of the blades between two looks for the largest angle: its square is
/// the largest part missed, and then searched for.
pub(crate) const ANGLE_LOOK: f64 = 0.125;

/// Largest entry on the diagonal of the change of a leap that is kept as a
/// change. Beyond, digits are lost less in the map itself.
pub(crate) const LEAP_SMALL: f64 = 0.25;

/// Part of the clearance that a neighbour of a side has left, up to which a predicted
/// penetration needs no look at the neighbour. Speed only.
pub(crate) const SLIDING_DEPTH: f64 = 1e-2;

/// Part of a push that blades may take away at most where a side is slid along, of tips
/// that friction turns into the casing: nearer to one, single steps say why they fail.
pub(crate) const SLIDING_SHARE: f64 = 0.5;

/// Part of the way in a step that ends a motion beyond the paper, below which a slide need
/// not look at it. Speed only.
pub(crate) const SLIDING_WAY: f64 = 0.5;

/// Mass ratio of the blades of a side below which its third power is round-off of a
/// push.
pub(crate) const LIGHT_PUSH: f64 = 1e-6;

/// Blade phase below which sine and cosine are two terms of their series
/// \[rad\]: exact to round-off.
pub(crate) const SMALL_PHASE: f64 = 1e-4;

/// Blade phase below which sine and versine are two terms of it \[rad\]: exact to
/// round-off of one.
pub(crate) const SHORT_SERIES_PHASE: f64 = 1.5e-3;

/// Blade phase below which they are four terms of it \[rad\]: exact to round-off.
pub(crate) const SERIES_PHASE: f64 = 0.03;

/// Depths of the deepest penetration up to which another gap is looked at beyond the
/// paper, as a push may close it: of two modes one push closes it by at most
/// `|T|/Re T`, `sqrt(1 + mu_c^2)` of its own depth where `kappa (kappa + mu) >= 0`.
/// Smaller: a neighbour is closed a step late. Larger: speed only.
pub(crate) const NEIGHBOUR_DEPTHS: f64 = 4.0;

/// Part of a side that the casing may move in one step in contact beyond the paper. A
/// single longer step is an impact; see `MOST_LONG_STEPS`.
pub(crate) const LONG_STEP: f64 = 0.25;

/// Longer steps in a row after which the run has failed: what a wave does that friction
/// drives so fast is the step's doing.
pub(crate) const MOST_LONG_STEPS: u32 = 2000;

/// Part of the clearance that a single blade may rise or sink until all are looked at.
/// Speed only.
pub(crate) const TIP_SLACK: f64 = 0.02;

/// Part of the clearance and of the casing's way by which the rows near a lining are
/// looked for beyond those that press: smaller, they are looked for more often; larger,
/// more open rows are counted along. No result depends on it.
pub(crate) const LINING_MARGIN: f64 = 0.05;

/// The same for the rows near a rigid casing. Speed only.
pub(crate) const TIP_MARGIN: f64 = 0.005;

/// Sizes of a wave on a preloaded lining that are tried for whether it dies, and how much
/// smaller each is than the one before: down to 1e-9 of what lifts a blade.
pub(crate) const DIES_LOOKS: i32 = 400;
/// Round-off of one step of such a wave, in units of the last place.
pub(crate) const DIES_ROUNDINGS: f64 = 64.0;
/// Steps to one of its motions; twenty are usual.
pub(crate) const DIES_STEPS: usize = 1000;
/// See `DIES_LOOKS`.
pub(crate) const DIES_SMALLER: f64 = 0.95;

/// Times that displacements shrink where a clearance is smaller all at once: each leaves
/// what is of second order in blade angles.
pub(crate) const GIVE_WAY: usize = 4;

/// Part of the deepest gap of a step that the pushes of two rows may leave of a third: the
/// round-off of three sides that meet in one place.
pub(crate) const CLOSED_PART: f64 = 1e-9;
