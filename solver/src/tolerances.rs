//! Every threshold, safety factor and bound of work of the solvers, with its
//! reason and what breaks if it is changed. Numbers of terms, nodes and table
//! entries stand where the tables are.

mod event;
mod explicit;
mod harmonic;
mod lining;
mod margins;

pub(crate) use event::*;
pub use event::{MOST_EVENTS, MOST_LOOKS};
pub(crate) use explicit::*;
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

/// Part of a step by which an end that is so many steps may fall short of them. Smaller: a
/// run ends a step before its end.
pub(crate) const STEP_ROUND_OFF: f64 = 1e-6;

// The verdict.

/// Part of the run, at its end, over which the verdict is judged. Shorter: a
/// pause in a bounce is taken for decay or lock.
pub const LAST_PART: f64 = 0.1;

/// Swing of the blade tips, as a part of the clearance, above which a slip is a whirl:
/// blades that move contact rather than follow it. Smaller: blades that friction shakes
/// count.
pub(crate) const WHIRL_SWING: f64 = 0.25;

/// Part of the clearance below which a wave on a lining is at rest.
pub(crate) const WAVE_AT_REST: f64 = 1e-3;

/// The same below which there is no wave, only round-off.
pub(crate) const WAVE_ROUND_OFF: f64 = 1e-12;

/// Part of a wave on a lining now to which it must fall, as it goes, to be dying. Larger: a
/// wave that comes down to its limit cycle is said to die.
pub(crate) const WAVE_DYING: f64 = 0.5;

/// Part of the wave of half a last part before, below which it dies where too little was
/// seen of it since a change: above it by the round-off of extremes.
pub(crate) const WAVE_FALLS_SOON: f64 = 1.0 - 1e-6;

/// Relative change that no trustworthy verdict may notice: below any
/// measurement, above round-off by six digits. Smaller: a sensitive run is not
/// found.
pub(crate) const PERTURBATION: f64 = 1e-9;

/// Part of the elastic force of the casing by which a contact that only pushes may pull at
/// the end of a run. Smaller: round-off of forces in balance fails a run. Larger: a
/// run whose result is wrong goes unnoticed.
pub(crate) const PULL_ROUND_OFF: f64 = 1e-9;

/// Part of a casing period by which a lock may come earlier or later. Larger: a
/// lock time with no correct digit is trusted.
pub(crate) const LOCK_MOMENT: f64 = 0.1;

/// Part of its tolerance at which the event solver is tried again.
pub(crate) const FINER: f64 = 0.1;

/// Part of its step with which a run by steps is tried again. Nearer to one: fewer verdicts
/// that depend on the step are found. Smaller: it costs more than the run itself.
pub(crate) const OTHER_STEP: f64 = 0.5;

/// Looks at a run in each casing period, for a verdict that is proved. Speed only.
pub(crate) const LOOKS_A_PERIOD: u64 = 4;

/// Casing periods of a run that are looked at one by one, at most. More: a run of many
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

// Contact.

/// Part of the gaps that round-off may leave open before the equations of a
/// step count as singular.
pub(crate) const SINGULAR: f64 = 1e-3;

/// Most penetrating rows of different sides that begin closed: more are too many for two
/// coordinates and soft blades, and closing them costs more than finding those that push.
pub(crate) const FEW_ROWS: usize = 4;
