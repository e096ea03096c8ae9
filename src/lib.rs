//! The `rubscope` program as a library, so that tests and benchmarks can reach its
//! parts: [`sheet`] writes what the solvers of [`rubscope_solver`] return, [`machine`] makes a
//! scene of modal data, [`cli`] is the command line, [`tui`] the explorer, and [`mod@file`] writes
//! files completely or not at all.
//!
//! A program that needs the model and the solvers alone depends on `rubscope-solver`.

pub mod cli;
pub mod file;
pub mod machine;
pub mod sheet;
pub mod tui;
