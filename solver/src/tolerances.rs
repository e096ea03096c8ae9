//! Every threshold, safety factor and bound of work of the solvers, with its
//! reason and what breaks if it is changed. Numbers of terms, nodes and table
//! entries stand where the tables are.

mod event;
mod harmonic;
mod lining;
mod margins;

pub(crate) use event::*;
pub use event::{MOST_EVENTS, MOST_LOOKS};
pub(crate) use harmonic::*;
pub(crate) use lining::*;
pub(crate) use margins::*;

// Round-off.

/// Part of the terms of a sum that its round-off may make: some fifty
/// roundings. Smaller: a side at rest counts as opening, and pivoting may not end.
pub(crate) const ROUND_OFF: f64 = 1e-14;

/// Part of a size that many sums in a row may round off: a thousand roundings. Smaller: a
/// wave never rests, blades that stand alike count as two, and where a casing just
/// rises to its side round-off could take it for falling.
pub(crate) const ROUNDINGS: f64 = 1e-13;

/// Part of a size up to which a pivot, a residual, a step of Newton's method, a
/// discriminant or what is left of a gap counts as zero: ten thousand roundings. Smaller:
/// equations that have no better answer are said to have none.
pub(crate) const AS_ZERO: f64 = 1e-12;

// The model.

/// Largest blade angle the model stands for \[rad\]: the model is linear in it,
/// and its square is 1 % there. Larger: results the model does not support.
pub(crate) const LARGEST_BLADE_ANGLE: f64 = 0.1;

/// Part of the way to a closed or a straight corner that blades may turn it.
/// Larger: sides could pass each other within one series.
pub(crate) const CORNER_ROOM: f64 = 0.9;

// Time.

// The verdict.

// Contact.
