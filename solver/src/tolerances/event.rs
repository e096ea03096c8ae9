//! Those of the event solver.

/// Gaps below this part of the motion's size count as closed in the event
/// solver: a few roundings. Larger: impacts come that much early. Smaller: a
/// touch may be looked at again and again.
pub(crate) const EVENT: f64 = 1e-15;

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
pub const MOST_EVENTS: u64 = 10_000_000;

/// Most looks ahead in one run: a minute or two of work. An undamped casing that
/// bounces for hours asks for them.
pub const MOST_LOOKS: u64 = 100_000_000;

/// Looks between two questions whether to go on: a look takes a microsecond, on
/// a polygon of thousands of sides some fifty.
pub(crate) const LOOKS_UNASKED: u64 = 16;

/// Most mode changes in a row that take no time. Physical ones are a few; more
/// are a loop.
pub const MOST_EVENTS_AT_ONCE: u32 = 1000;

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

/// Part of the forces that add up to a push of a held corner (`Machine::push_scale`) above
/// which its sign is certain. At such a push of the paper's machine, a step of 1e-7 s predicts
/// a gap of 1e-15 of the clearance: a few roundings. Smaller: next to the limit of a lock round-off decides
/// the sign, and a longer run contradicts the proof.
pub(crate) const CERTAIN_PUSH: f64 = 1e-8;

/// Looks at a function for its largest value, at most.
pub(crate) const PEAK_LOOKS: f64 = 10_000.0;

// Of those that are linear in the blade angles.

/// Most rows that push at once: casing and blades have four modes, and more pushes on
/// them could not be told apart.
pub(crate) const MOST_HELD: usize = 4;

/// Most rows that one impact or one instant without rates may bring together. The work grows
/// with their fourth power.
pub(crate) const MOST_TOUCHING: usize = 12;

/// Part of the clearance up to which a gap that has just opened keeps its own digits,
/// beside those of the state. Smaller: a short excursion is lost in round-off.
pub(crate) const JUST_OPENED: f64 = 1e-6;
