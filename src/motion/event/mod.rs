//! Event-driven solvers: between two changes of contact the motion is known in closed
//! form or as a series to round-off, and the next change is found, not stepped over.
//!
//! Two ways to move between events: `exact` in the blade angles (the paper's model), and
//! `linear` in them (inclined and rubbing tips, restitution, other diameters). Below both
//! are the clock, the looks ahead that pass nothing, series and integrals.

mod clock;
mod dissipation;
mod exact;
mod linear;
mod series;

pub use exact::ExactEvents;
pub use linear::LinearEvents;
