//! Reasons why a scene is rejected, each in one line.

use thiserror::Error;

use super::units::UnitError;

/// Error of a scene or of one of its keys.
#[derive(Debug, Error, Clone, PartialEq)]
#[non_exhaustive]
pub enum SceneError {
    /// The key does not exist.
    #[error("unknown key {key}; allowed: {allowed}")]
    UnknownKey {
        /// Dotted path as given.
        key: String,
        /// Existing keys of the same table.
        allowed: String,
    },
    /// The key has no name.
    #[error("the name of the key before = is missing")]
    NoKey,
    /// The value is not allowed.
    #[error("{key} = {value}: allowed is {allowed}")]
    Refused {
        /// Dotted path.
        key: String,
        /// The value as given.
        value: String,
        /// Allowed values, in words.
        allowed: String,
    },
    /// The value has a unit that is unknown or belongs to another quantity.
    #[error("{key} = {value}: {why}")]
    Unit {
        /// Dotted path.
        key: String,
        /// The value as given.
        value: String,
        /// What is wrong with the unit, and which units are allowed.
        why: UnitError,
    },
    /// The text is not TOML.
    #[error("not a TOML file: {0}")]
    Syntax(String),
    /// The file cannot be read.
    #[error("cannot read scene file {path}: {reason}")]
    File {
        /// The path as given.
        path: String,
        /// Reason given by the operating system.
        reason: String,
    },
    /// The name is neither a built-in scene nor a file.
    #[error("unknown scene {name}{meant}; allowed: a path ending in .toml, or one of {allowed}")]
    UnknownScene {
        /// The name as given.
        name: String,
        /// Question whether the nearest scene was meant; empty if none is near.
        meant: String,
        /// Names of the built-in scenes.
        allowed: String,
    },
    /// An error inside a file.
    #[error("{path}: {error}")]
    InFile {
        /// The path as given.
        path: String,
        /// Error without the file name.
        error: Box<SceneError>,
    },
}

impl SceneError {
    /// Creates the error for a value that is not allowed.
    pub fn refused(
        key: impl Into<String>,
        value: impl ToString,
        allowed: impl Into<String>,
    ) -> Self {
        let value = visible(&value.to_string());
        Self::Refused { key: key.into(), value, allowed: allowed.into() }
    }

    /// Creates the error for a text that is not a number of the right quantity.
    pub fn not_read(
        key: impl Into<String>,
        value: impl ToString,
        why: UnitError,
        allowed: impl Into<String>,
    ) -> Self {
        match why {
            UnitError::NoNumber => Self::refused(key, value, allowed),
            why => Self::Unit { key: key.into(), value: value.to_string(), why },
        }
    }

    /// Returns whether the error refuses the value of this key.
    #[must_use]
    pub fn is_of(&self, path: &str) -> bool {
        matches!(self, Self::Refused { key, .. } if key == path)
    }

    /// Adds the path of the file that is refused.
    pub fn in_file(self, path: &str) -> Self {
        Self::InFile { path: path.to_string(), error: Box::new(self) }
    }
}

/// Returns a text as given, or in quotes if it has no visible letter.
pub(crate) fn visible(text: &str) -> String {
    if text.trim().is_empty() { format!("{text:?}") } else { text.to_string() }
}

/// Rejects the value of a key if `is_wrong`.
///
/// # Errors
/// Returns [`SceneError::Refused`].
pub(crate) fn refuse_if(
    is_wrong: bool,
    key: &str,
    value: impl ToString,
    allowed: &str,
) -> Result<(), SceneError> {
    if is_wrong { Err(SceneError::refused(key, value, allowed)) } else { Ok(()) }
}
