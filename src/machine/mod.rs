//! One's own machine: the table of a modal analysis, the scene file made of it, and questions about
//! values that look like a slip of a unit.

mod build;
mod doubts;
mod table;

pub use build::{Family, ModalData};
pub use doubts::doubts;
pub use table::{ModeTable, read_modes};
