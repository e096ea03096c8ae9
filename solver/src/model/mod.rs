//! The machine: parameters, modes, characteristic speeds, and the contact polygon of the phase
//! groups.
//!
//! Symbols and equations are in docs/theory.md, section 1; signs and numbering in section 2. Order
//! in which to read: `parameters` (input data), `machine` (modal quantities and coincidences),
//! `polygon` (contact geometry), `lock` (lock speeds and forces), `frame` (motion and contact rows in
//! the frame of the blades); then the extensions `lining`,
//! `spin`, `tips` and `tip_corner`.

mod frame;
mod lining;
mod lock;
mod machine;
mod parameters;
mod polygon;
mod spin;
mod tip_corner;
mod tips;

pub(crate) use frame::growth_about_wave;
pub use frame::{Frame, Motion, Row, Structure};
pub use lining::LiningLaw;
pub use lock::LockWindow;
pub(crate) use machine::CERTAIN_PUSH;
pub use machine::{Machine, blade_frequency};
pub(crate) use parameters::given_frequency;
pub use parameters::{
    BladedDisk, Casing, ContactSurface, Excitation, Initial, Mode, ModePart, Operation,
    neighbour_stiffness,
};
pub use polygon::{ContactPolygon, SideLeft};
pub(crate) use polygon::{fraction_of_turn, gcd};
pub use tip_corner::TipCorner;
pub(crate) use tips::Tips;

/// Largest blade angle for which results are valid \[rad\]. The model is linear in the angle, whose
/// square is 1 % there.
pub(crate) const LARGEST_BLADE_ANGLE: f64 = 0.1;
