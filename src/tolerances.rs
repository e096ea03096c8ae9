//! Every threshold, safety factor and bound of work of the solvers, with its
//! reason and what breaks if it is changed.

/// Largest blade angle the model stands for \[rad\]: the model is linear in it,
/// and its square is 1 % there. Larger: results the model does not support.
pub(crate) const LARGEST_BLADE_ANGLE: f64 = 0.1;

/// Most mode changes of one run of the event solver. A million impacts take a
/// second; fifty times that is a scene to be looked at. Smaller: long bounces fail.
pub(crate) const MOST_EVENTS: u64 = 50_000_000;

/// Most looks ahead within one segment: minutes of work without an event.
pub(crate) const MOST_LOOKS: u64 = 1_000_000_000;

/// Most mode changes in a row that take no time. Physical ones are a few; more
/// are a loop.
pub(crate) const MOST_EVENTS_AT_ONCE: u32 = 1000;

/// Gaps below this part of the motion's size count as closed in the event
/// solver: a few roundings. Larger: impacts come that much early. Smaller: a
/// touch may be looked at again and again.
pub(crate) const EVENT: f64 = 1e-15;

/// Part of the terms of a sum that its round-off may make: some fifty roundings.
/// Smaller: a side at rest counts as opening.
pub(crate) const ROUND_OFF: f64 = 1e-14;

/// A start this close to a side, in parts of the clearance, is on it. A scene may
/// have computed coordinates; see its check.
pub(crate) const ON_A_SIDE: f64 = 1e-12;

/// A touch within this many tolerances of a corner meets both of its sides.
/// Smaller: two impacts at one instant, in an order made by round-off.
pub(crate) const AT_A_CORNER: f64 = 16.0;

/// A closing speed below this part of `omega_c g0` is a touch and not counted as
/// an impact: round-off of the rates of sides that stay in contact.
pub(crate) const SOFT_TOUCH: f64 = 1e-12;

/// Where blades move, rocking is summed once the rest of it takes less than this
/// part of the time of one radian: the blades do not notice. Larger: they do.
pub(crate) const BRIEF_ROCKING: f64 = 1e-6;

/// Part of the way to a closed or a straight corner that blades may turn it.
/// Larger: sides could pass each other within one series.
pub(crate) const CORNER_ROOM: f64 = 0.9;
