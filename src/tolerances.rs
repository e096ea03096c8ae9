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
