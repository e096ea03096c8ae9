//! The machine, and nothing else: parameters, modes and derived speeds, and
//! the polygon as a polygon of phase groups. No solver and no file format here.

mod machine;
mod parameters;
mod polygon;

pub use machine::{Machine, blade_frequency};
pub use parameters::{BladedDisk, Casing, Excitation, Initial, Operation};
pub use polygon::ContactPolygon;
