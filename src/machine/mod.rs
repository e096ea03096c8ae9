//! The user's own machine: the table of a modal analysis, the scene file built from it, and questions
//! about values that look like a unit error.

mod build;
mod cells;
mod columns;
mod doubts;
mod marks;
mod table;

pub use build::{Family, ModalData};
pub use doubts::{doubts, range_doubt};
pub use table::{ModeTable, read_modes};
