//! Sheets: what a command answers, as sentences, facts, tables and charts, and its writers: text,
//! CSV, JSON and SVG. A sheet tells the result of a computation; it computes nothing itself.

pub mod check;
pub mod command;
mod contents;
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
pub mod summary;
pub mod survey;
pub mod svg;
pub mod symbols;
pub mod table;
pub mod ticks;

pub use command::{CommandLine, Provenance};
pub use contents::Sheet;
pub use history::History;

/// Wall times of a run and of its sensitivity check.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wall {
    /// Wall time of the run itself \[s\].
    pub run_s: f64,
    /// Wall time of the runs with changed input that check the sensitivity \[s\]; `None` if the
    /// check was skipped.
    pub certainty_s: Option<f64>,
}
