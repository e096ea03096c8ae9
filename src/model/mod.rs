//! The machine: parameters, modes, derived speeds and the contact polygon of
//! the phase groups. Solvers and file formats are elsewhere.

mod machine;
mod parameters;
mod polygon;

pub use machine::{Machine, blade_frequency};
pub use parameters::{BladedDisk, Casing, Excitation, Initial, Operation};
pub use polygon::ContactPolygon;
