//! Many runs of one scene: the interaction map.

mod adaptive;
mod axis;
pub mod map;

pub use axis::{Axis, AxisError};
pub use map::{Cell, Map, MapPlan, Progress};
