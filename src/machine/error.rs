//! Reasons why a table of modes is refused, each in one line.

use rubscope_solver::scene::SceneError;
use thiserror::Error;

/// Error of a table of modes.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TableError {
    /// The file contains no text.
    #[error("this is {0}: save the table as CSV in UTF-8")]
    NoText(&'static str),
    /// No column has this value.
    #[error(
        "{line} has no column for {name}: understood are {understood}, with the unit in brackets \
         where there is one{nearest}"
    )]
    Missing {
        /// The line with the names.
        line: String,
        /// The value.
        name: &'static str,
        /// Names that its column can have.
        understood: String,
        /// The most similar name in the line, in words, or how to separate names; empty if the line
        /// has no other names.
        nearest: String,
    },
    /// Two columns have the same value.
    #[error("{line} has two columns for {name}, {} and {}: leave one out", names[0], names[1])]
    Twice {
        /// The line with the names.
        line: String,
        /// The value.
        name: &'static str,
        /// Names of both columns.
        names: [String; 2],
    },
    /// A number can be read in two ways.
    #[error("{path} = {cell}: {question}")]
    Number {
        /// Line and value.
        path: String,
        /// The number as given.
        cell: String,
        /// What it may be, and how to write it.
        question: String,
    },
    /// A value is not allowed.
    #[error(transparent)]
    Value(#[from] SceneError),
}
