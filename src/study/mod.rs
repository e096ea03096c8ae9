//! Many runs of one scene: the interaction map.

mod adaptive;
mod axis;
pub mod map;
pub mod overlay;
pub mod part;

pub use axis::{Axis, AxisError};
pub use map::{Cell, Map, MapPlan, Progress};
pub use part::{PartError, Shard};
