//! Reports: one file per format. A report formats the result of a computation and writes it; it
//! computes nothing itself.

pub mod check;
pub mod command;
pub mod figure;
pub mod hbm;
pub mod history;
pub mod line;
pub mod map;
pub mod margins;
pub mod number;
pub mod part;
pub mod precision;
pub mod sentence;
mod sheet;
pub mod summary;
pub mod survey;
pub mod svg;
pub mod symbols;
pub mod table;
pub mod ticks;

pub use command::{CommandLine, Provenance};
pub use history::History;
pub use sheet::Sheet;

/// Wall times of a run and of its sensitivity check.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wall {
    /// Wall time of the run itself \[s\].
    pub run_s: f64,
    /// Wall time of the runs with changed input that check the sensitivity \[s\]; `None` if the
    /// check was skipped.
    pub certainty_s: Option<f64>,
}
