//! Many runs of one scene: the interaction map, and speed against error.

mod adaptive;
mod axis;
pub mod map;
pub mod overlay;
pub mod part;
pub mod precision;

pub use axis::{Axis, AxisError};
pub use map::{Cell, Map, MapPlan, Progress};
pub use part::{PartError, Shard};
