//! Studies that consist of many runs or limits of a scene: the interaction map ([`map`],
//! [`overlay`]), accuracy against cost ([`precision`]), the margins to every limit ([`margins`]),
//! the survey over nodal diameters ([`survey`]), and the paper's figures ([`figures`]).

mod axis;
pub mod figures;
pub mod map;
pub mod margins;
pub mod overlay;
pub mod precision;
pub mod survey;

pub use axis::{Axis, parse_range};
pub use map::{Cell, Doubt, Map, MapPlan};
