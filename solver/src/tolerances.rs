//! Thresholds, safety factors and bounds of work of the solvers, each with its reason and what breaks
//! if it is changed. Those that rule one file stand there, as all of the event solver do, and so do
//! numbers of terms, nodes and table entries.

mod harmonic;
mod lining;
mod margins;

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

// Time.

// The verdict.

// Contact.
