//! One's own machine: the table of a modal analysis, and the scene file made of it.

mod build;
mod table;

pub use build::{Family, ModalData};
pub use table::{ModeTable, read_modes};
