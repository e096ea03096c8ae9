//! Every threshold, safety factor and bound of work of the solvers, with its
//! reason and what breaks if it is changed. Numbers of terms, nodes and table
//! entries stand where the tables are.

// The model.

/// Largest blade angle the model stands for \[rad\]: the model is linear in it,
/// and its square is 1 % there. Larger: results the model does not support.
pub(crate) const LARGEST_BLADE_ANGLE: f64 = 0.1;

/// Part of the way to a closed or a straight corner that blades may turn it.
/// Larger: sides could pass each other within one series.
pub(crate) const CORNER_ROOM: f64 = 0.9;

// The verdict.

/// Part of the run, at its end, over which the verdict is judged. Shorter: a
/// pause in a bounce is taken for decay or lock.
pub(crate) const LAST_PART: f64 = 0.1;

/// Relative change that no trustworthy verdict may notice: below any
/// measurement, above round-off by six digits. Smaller: a sensitive run is not
/// found.
pub(crate) const PERTURBATION: f64 = 1e-9;

/// Part of a casing period by which a lock may come earlier or later. Larger: a
/// lock time with no correct digit is trusted.
pub(crate) const LOCK_MOMENT: f64 = 0.1;

/// Part of its tolerance at which the event solver is tried again.
pub(crate) const FINER: f64 = 0.1;

/// Looks at a run on the way to its verdict, at most. More: a run of many
/// casing periods costs more to look at than to solve.
pub(crate) const RUN_LOOKS: f64 = 1e6;

/// Impacts kept one by one; later ones are only counted, so that a long slip
/// needs no memory.
pub(crate) const IMPACTS_KEPT: usize = 1000;

/// Looks at the wave for its speed, at most, so that a long run is not slowed
/// down.
pub(crate) const WAVE_LOOKS: f64 = 100_000.0;

/// Looks for each turn of the fastest motion. Two or fewer: a half turn is
/// taken for its opposite.
pub(crate) const WAVE_LOOKS_A_TURN: f64 = 16.0;

/// How many times the effect of a tiny change a decision must be away from a tie
/// for the run to be certain. One: three in a hundred thousand runs are taken for
/// certain that are not, at 0.3 thirty times as many. More: runs are made that find
/// nothing.
pub(crate) const TIE: f64 = 5.0;

/// Part of its size up to which the sign of a value decides nothing certain: the
/// round-off of two runs, with four digits in hand.
pub(crate) const RIGID_TIE: f64 = 1e-11;

/// As `RIGID_TIE`, where blades move, of which the derivative takes no notice: in
/// the paper's scenes they shift gaps and pushes by 1e-7 of themselves. Smaller: a
/// decision that the blades make is missed.
pub(crate) const MOVING_TIE: f64 = 1e-6;

/// Part of an excursion along a side up to which its end is a tie.
pub(crate) const TIE_EXCURSION: f64 = 1e-9;

/// Mass ratio of the blades in a corner up to which the casing is followed as if
/// they were rigid.
pub(crate) const LIGHTEST_BLADES: f64 = 1e-6;

/// Phase of the blades up to which it is \[rad\].
pub(crate) const TIE_BLADES: f64 = 1e-4;

/// Gaps up to this many times the reach of a change, as they are foreseen at a look, are
/// asked for a near miss. Smaller: what a look foresees may be a little more.
pub(crate) const NEAR_MISS_REACH: f64 = 30.0;

/// Steps from a look to the least gap of a side that is nearly missed: each has twice
/// the digits.
pub(crate) const NEAR_MISS_STEPS: usize = 3;

// The event solver.

/// Gaps below this part of the motion's size count as closed in the event
/// solver: a few roundings. Larger: impacts come that much early. Smaller: a
/// touch may be looked at again and again.
pub(crate) const EVENT: f64 = 1e-15;

/// Part of the terms of a sum that its round-off may make: some fifty
/// roundings. Smaller: a side at rest counts as opening.
pub(crate) const ROUND_OFF: f64 = 1e-14;

/// A start this close to a side, in parts of the clearance, is on it. A scene
/// may have computed coordinates; see its check.
pub(crate) const ON_A_SIDE: f64 = 1e-12;

/// A touch within this many tolerances of a corner meets both of its sides.
/// Smaller: two impacts at one instant, in an order made by round-off.
pub(crate) const AT_A_CORNER: f64 = 16.0;

/// A closing speed below this part of `omega_c g0` is a touch and not counted
/// as an impact: round-off of the rates of sides that stay in contact.
pub(crate) const SOFT_TOUCH: f64 = 1e-12;

/// Where blades move, rocking is summed once the rest of it takes less than
/// this part of the time of one radian: the blades do not notice. Larger: they
/// do.
pub(crate) const BRIEF_ROCKING: f64 = 1e-6;

/// Most mode changes of one run of the event solver. A million take a second,
/// ten where blades move; ten times that is a scene to be looked at. Smaller:
/// long bounces fail.
pub(crate) const MOST_EVENTS: u64 = 10_000_000;

/// Most looks ahead in one run: a minute or two of work. An undamped casing that
/// bounces for hours asks for them.
pub(crate) const MOST_LOOKS: u64 = 100_000_000;

/// Looks between two questions whether to go on: a look takes a microsecond, on
/// a polygon of thousands of sides some fifty.
pub(crate) const LOOKS_UNASKED: u64 = 16;

/// Most mode changes in a row that take no time. Physical ones are a few; more
/// are a loop.
pub(crate) const MOST_EVENTS_AT_ONCE: u32 = 1000;

/// Radians of all rates that take no time: ten digits below what a clock of
/// double precision resolves in one. Zero: a side that lets go and closes again
/// by round-off, in steps as small as numbers are, does so for ever.
pub(crate) const AN_INSTANT: f64 = 1e-26;

/// Tolerances that may be chosen. Finer than round-off has no meaning; coarser
/// moves impacts by more than the clearance resolves.
pub(crate) const EVENT_RANGE: std::ops::RangeInclusive<f64> = 1e-16..=1e-3;

/// Part of all rates by which a ramp may change the turning rate in one look
/// ahead. Larger: the bounds of that look are loose, and looks are many.
pub(crate) const RAMP_CHANGE: f64 = 0.1;

/// Part of the clearance from which on the gaps of single sides are looked at.
/// Speed only: below it one distance bounds all of them.
pub(crate) const NEAR_SIDES: f64 = 0.9;

/// Radians of all rates below which a look ahead asks for a better bound. Speed
/// only.
pub(crate) const SHORT_LOOK: f64 = 1e-6;

/// Radians of the motion along a side that one look ahead covers at most. Larger:
/// the bound on what its third derivative leaves out is loose. Speed only.
pub(crate) const SIDE_LOOK: f64 = 1.0;

/// `exp(SIDE_LOOK)`, rounded up: how much a motion along a side can grow in one
/// look. Smaller: a contact could be missed.
pub(crate) const SIDE_GROWTH: f64 = 2.72;

/// Radians of all rates beyond which a look ahead need not ask single sides: the
/// casing stays away from all of them. Speed only.
pub(crate) const LONG_LOOK: f64 = 0.1;

/// Radians of the casing that one look ahead covers at most, where nothing else bounds
/// it: next to a side that seems to rest. Infinite: sums of infinities.
pub(crate) const LONGEST_LOOK: f64 = 1e6;

/// Part of the largest swing by which the casing counts as reaching the blades too
/// early: a thousand roundings. Smaller: where it just rises to them round-off could
/// take it for falling, and a whole period would be passed.
pub(crate) const RISE_MARGIN: f64 = 1e-13;

/// Part of its frequency up to which damping is light: two waves then bound the motion
/// well. Speed only.
pub(crate) const LIGHT_DAMPING: f64 = 0.3;

/// Part of all rates below which the casing is soft: it may swing so far that
/// nothing bounds it over a whole period. Smaller: looks without number.
pub(crate) const SOFT_CASING: f64 = 0.1;

/// Rocking is summed where both sides push by more than this many Coriolis
/// terms of the speed. Less: a side could let go on the way.
pub(crate) const ROCKING_MARGIN: f64 = 4.0;

/// Radians of the side motion within which an excursion is a power series of
/// ten orders.
pub(crate) const ROCKING_TURN: f64 = 0.03;

/// Part by which pulse or ramp may change the accelerations until the limit.
/// Larger: its time is wrong in as many digits.
pub(crate) const ROCKING_STEADY: f64 = 1e-9;

/// Part of a sum that its last two orders may be.
pub(crate) const ROCKING_TAIL: f64 = 1e-15;

/// Part of the largest term that two of the last terms of a power series may
/// be: what is dropped is then round-off.
pub(crate) const SERIES_TAIL: f64 = 1e-12;

/// Halvings of a stretch whose series does not end. Ten decades of rates are
/// thirty.
pub(crate) const MOST_HALVINGS: usize = 60;

/// Blades this much faster than all other rates follow the pushes at once, if
/// they also are stiff. Smaller: their vibration is missed.
pub(crate) const FOLLOWING_RATES: f64 = 100.0;

/// Part of the clearance by which such blades may move a gap. Larger: the gaps
/// of the report are wrong in as many digits.
pub(crate) const FOLLOWING_GAP: f64 = 1e-9;

/// Speed of the casing that is allowed for, in clearances for each radian of
/// its rates, beside that of pulse and start.
pub(crate) const CLEARANCES_A_RADIAN: f64 = 10.0;

/// Mass ratio of the blades in a corner below which their inertia changes its
/// pushes by less than the room left to them.
pub(crate) const LIGHT_BLADES: f64 = 1e-3;

/// Part of a push, multiplier or gap that its changes may be for its sign to
/// stay. Twice the bound is kept in hand.
pub(crate) const ROOM_TO_CHANGE: f64 = 0.5;

/// Looks at a function for its largest value, at most.
pub(crate) const PEAK_LOOKS: f64 = 10_000.0;

/// Part of the rates below which two roots of an oscillator are nearly one: a
/// sum of two exponentials then loses digits.
pub(crate) const DOUBLE_ROOT: f64 = 0.3;

/// Radians of an oscillator below which its response is a power series: its
/// closed form cancels there.
pub(crate) const SHORT_TIME: f64 = 0.5;

/// Terms of a power series of order one that are below its round-off.
pub(crate) const SERIES_END: f64 = 1e-19;

/// Square of an exponent below which its integral is a power series of three
/// terms.
pub(crate) const SMALL_EXPONENT: f64 = 1e-8;

/// Radians over which four Gauss nodes are exact to round-off.
pub(crate) const FEW_NODES: f64 = 0.3;

/// Panels of one quadrature, at most: of the energy balance of one segment.
pub(crate) const MOST_PANELS: f64 = 1e7;

// The explicit solver.

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

/// Rows of shapes that are kept of a larger ring, for the blades near contact.
/// Fewer: they are made anew in every step. Speed only.
pub(crate) const ROWS_NEAR: usize = 16;

/// Blades that are looked at before the bound on all others, at most. Speed only.
pub(crate) const BLADES_FIRST: usize = 8;

/// Blades that cost as much one by one as all of them at once, for each unit of
/// the sum of the prime factors of their number. Speed only.
pub(crate) const FEW_BLADES: usize = 4;

/// Steps a corner must have been closed before it is held. Fewer: maps are made
/// for contacts that end.
pub(crate) const HELD_AFTER: u64 = 64;

/// Steps until a corner that could not be held is tried again. Speed only.
pub(crate) const HELD_AGAIN: u64 = 4096;

/// Change of a blade angle by which the step of a corner is differentiated
/// \[rad\]: the cube of it and round-off over it are both 1e-12 of the map.
pub(crate) const HELD_PROBE: f64 = 1e-6;

/// Largest blade phase `n_d alpha` of a vibration whose square the affine map
/// may leave out \[rad\]: it makes 1e-11 of the angles.
pub(crate) const HELD_PHASE: f64 = 1e-5;

/// Newton steps to the modes at rest; two reach round-off.
pub(crate) const HELD_CORRECTIONS: usize = 6;

/// Radians of the blades between two looks for the largest angle: its square is
/// the largest part missed, and then searched for.
pub(crate) const ANGLE_LOOK: f64 = 0.125;

/// Largest entry on the diagonal of the change of a leap that is kept as a
/// change. Beyond, digits are lost less in the map itself.
pub(crate) const LEAP_SMALL: f64 = 0.25;

/// Growths of a sliding wave, as powers of e, in one leap: beyond, it has gone from
/// round-off to the clearance. Speed only.
pub(crate) const LEAP_FOLDS: f64 = 8.0;

/// Part of the clearance that a neighbour of a side has left, up to which a predicted
/// penetration needs no look at the neighbour. Speed only.
pub(crate) const SLIDING_DEPTH: f64 = 1e-2;

/// Largest blade phase `n_d alpha` of a side that is slid on without sine and cosine
/// \[rad\]: its cube is round-off of a gap, as any other step has it.
pub(crate) const SLIDING_PHASE: f64 = 1e-5;

/// Mass ratio of the blades of a side below which its third power is round-off of a
/// push.
pub(crate) const LIGHT_PUSH: f64 = 1e-6;

/// Part of their phases by which blades of one side that stand alike may
/// differ: the round-off of the sums that their angles are.
pub(crate) const SAME_ANGLE: f64 = 1e-13;

/// Blade phase below which sine and cosine are two terms of their series
/// \[rad\]: exact to round-off.
pub(crate) const SMALL_PHASE: f64 = 1e-4;

// Contact.

/// Part of the gaps that round-off may leave open before the equations of a
/// step count as singular.
pub(crate) const SINGULAR: f64 = 1e-3;

/// Part of the terms of a gap that counts as zero in the test for an open row
/// among repeated rows.
pub(crate) const OPEN_ROW: f64 = 1e-12;

/// Part of the deepest gap that counts as zero in principal pivoting.
pub(crate) const PIVOT_GAP: f64 = 1e-14;

// Harmonic balance.

/// Newton steps from one start; five are usual.
pub(crate) const NEWTON_STEPS: usize = 40;

/// How much a Newton step must shrink: by half where the branch is about to
/// fold, and a little room. Larger: a start may end on another branch.
pub(crate) const NEWTON_SHRINK: f64 = 0.75;

/// Largest Newton step, as a part of the unknowns, and of the turns \[rad\], in
/// which alone the equations are not bilinear.
pub(crate) const NEWTON_LARGEST: f64 = 0.1;

/// How much the determinant may change from one softness to the next: it goes
/// to zero at a fold, and is another one on another branch.
pub(crate) const NEWTON_ALIKE: std::ops::Range<f64> = 0.5..2.0;

/// Shortest stride of the softness.
pub(crate) const NEWTON_STRIDE: f64 = 1e-6;

/// Most strides of the softness.
pub(crate) const NEWTON_STRIDES: usize = 500;

/// Residual that is accepted close to a fold, where the equations are ill-
/// conditioned.
pub(crate) const NEAR_A_FOLD: f64 = 1e-11;

/// Part of an angle at which Newton steps that no longer shrink have converged.
pub(crate) const CONVERGED: f64 = 1e-7;

/// A compliance below which the corner cannot open by a part of itself that a
/// number resolves, at any speed whose square a number holds.
pub(crate) const AS_GOOD_AS_RIGID: f64 = 1e-290;

/// Most points of one branch.
pub(crate) const BRANCH_POINTS: usize = 20_000;

/// What the widest corner leaves of a right angle, where the amplitude would be
/// infinite \[rad\].
pub(crate) const LEFT_OPEN: f64 = 1e-3;

/// Neighbours on a branch are an arc from the first to the second of these
/// steps apart, and the last two of a leg at most the third.
pub(crate) const APART: [f64; 3] = [0.9, 1.1, 1.5];

/// The largest speed over `Omega_c`: squares of it leave room for what they are
/// multiplied with.
pub(crate) const FASTEST: f64 = 1e100;

/// Most changes of character looked for between two neighbouring speeds.
pub(crate) const BRANCH_CHANGES: usize = 16;

/// Real parts of eigenvalues up to this part of the rate are round-off: a
/// nearly defective pair is known to half its digits.
pub(crate) const NEUTRAL: f64 = 1e-8;

/// As `NEUTRAL`, as a part of the fastest eigenvalue.
pub(crate) const NEUTRAL_OF_ALL: f64 = 1e-14;

/// Part of its terms that the last Hurwitz determinant must be for its sign to
/// be clear; else eigenvalues are asked.
pub(crate) const CLEAR_SIGN: f64 = 1e-9;

/// As `CLEAR_SIGN`, for the coefficients of odd order.
pub(crate) const CLEAR_DAMPING: f64 = 1e-6;

/// Part by which the discriminant of two equal roots may be negative.
pub(crate) const EQUAL_ROOTS: f64 = 1e-12;

/// QR steps for one eigenvalue or pair; three are usual.
pub(crate) const QR_STEPS: usize = 60;

/// Each multiple of this many QR steps has an exceptional shift, as in LAPACK.
pub(crate) const QR_EXCEPTIONAL: usize = 10;

/// From this QR step on a coupling is small if it is round-off of the whole
/// matrix.
pub(crate) const QR_LAST_RESORT: usize = 40;

/// Samples of one period on which the largest truncation errors are looked for.
pub(crate) const SPECTRUM_SAMPLES: usize = 2048;

/// Most harmonics of a spectrum.
pub(crate) const HARMONICS: u32 = 512;

/// Exponent below which the mean of an exponential is a power series.
pub(crate) const SMALL_RATE: f64 = 1e-6;
