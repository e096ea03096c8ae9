//! The machine, and nothing else: parameters, modes and derived speeds, and
//! the rim as a polygon of phase groups. No solver and no file format here.

mod machine;
mod parameters;
mod rim;

pub use machine::{Machine, blade_frequency};
pub use parameters::{BladedDisk, Casing, Excitation, Initial, Operation};
pub use rim::Rim;
