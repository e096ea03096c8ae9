//! Many runs of one scene: the interaction map, speed against error, the margins to
//! every limit, and the paper's figures.

mod axis;
pub mod figures;
pub mod map;
pub mod margins;
pub mod overlay;
pub mod precision;
pub mod survey;

pub use axis::{Axis, AxisError, parse_range};
pub use map::{Cell, Cells, Map, MapPlan};
