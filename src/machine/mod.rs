//! One's own machine: the table of a modal analysis, the scene file made of it, and questions about
//! values that look like a slip of a unit.

mod build;
mod cells;
mod columns;
mod doubts;
mod error;
mod marks;
mod range;
mod table;

pub use build::{Family, ModalData};
pub use doubts::doubts;
pub use error::TableError;
pub use range::range_doubt;
pub use table::{ModeTable, read_modes};
