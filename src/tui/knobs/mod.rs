//! The knobs of the explorer: keys of the scene with a label and a step size. Names, units, bounds
//! and descriptions come from the key table. Read `knob` first, then `table`.

mod bars;
mod inert;
mod knob;
mod naming;
mod number;
mod range;
mod table;

pub use knob::{Group, Knob};
pub use naming::{Fit, called, fit, plain};
pub use range::KnobRange;
pub use table::{KNOBS, knob_of, place_of};
