//! Reports: one file per format. A report takes what a computation returned
//! and a place to write to; it computes nothing itself.

pub mod check;
pub mod command;
pub mod figure;
pub mod hbm;
pub mod history;
pub mod json;
pub mod line;
pub mod map;
pub mod margins;
pub mod number;
pub mod part;
pub mod precision;
pub mod sentence;
pub mod summary;
pub mod survey;
pub mod svg;
pub mod symbols;
pub mod table;
pub mod ticks;

pub use command::{CommandLine, Provenance};
pub use history::History;

/// Wall times of a run \[s\].
#[derive(Clone, Copy, Debug, Default)]
pub struct Wall {
    /// Wall time of the run \[s\].
    pub run_s: f64,
    /// Wall time of the changed runs that test its sensitivity, if there were any \[s\].
    pub certainty_s: Option<f64>,
}
