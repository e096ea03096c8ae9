//! The reasons why a scene is refused, each in one line.

use thiserror::Error;

use super::units::UnitError;

/// Why a scene, or a key of one, was refused.
#[derive(Debug, Error, Clone, PartialEq)]
#[non_exhaustive]
pub enum SceneError {
    /// A key that does not exist.
    #[error("unknown key {key}; allowed: {allowed}")]
    UnknownKey {
        /// Dotted path as given.
        key: String,
        /// The keys of its table.
        allowed: String,
    },
    /// A value that is not allowed.
    #[error("{key} = {value}: allowed is {allowed}")]
    Refused {
        /// Dotted path.
        key: String,
        /// The value as given.
        value: String,
        /// What would be accepted.
        allowed: String,
    },
    /// A number of another quantity, or of no unit.
    #[error("{key} = {value}: {why}")]
    Unit {
        /// Dotted path.
        key: String,
        /// The value as given.
        value: String,
        /// What it is, and which units are allowed.
        why: UnitError,
    },
    /// Text that is not TOML.
    #[error("not a TOML file: {0}")]
    Syntax(String),
    /// A file that cannot be read.
    #[error("cannot read scene file {path}: {reason}")]
    File {
        /// The path as given.
        path: String,
        /// The system's reason.
        reason: String,
    },
    /// A built-in scene of an earlier version.
    #[error("scene {name} is gone: {instead}")]
    GoneScene {
        /// The name as given.
        name: String,
        /// What has its motion or its numbers now.
        instead: &'static str,
    },
    /// Neither a built-in scene nor a file.
    #[error("unknown scene {name}; allowed: a path ending in .toml, or one of {allowed}")]
    UnknownScene {
        /// The name as given.
        name: String,
        /// Names of the built-in scenes.
        allowed: String,
    },
    /// An error in a file, with the name of the file.
    #[error("{path}: {error}")]
    InFile {
        /// The path as given.
        path: String,
        /// The error.
        error: Box<SceneError>,
    },
}

impl SceneError {
    /// A refusal of `value` for `key`.
    pub fn refused(
        key: impl Into<String>,
        value: impl ToString,
        allowed: impl Into<String>,
    ) -> Self {
        Self::Refused { key: key.into(), value: value.to_string(), allowed: allowed.into() }
    }
}

/// Refuses `value` for `key` where it is wrong.
///
/// # Errors
/// The refusal.
pub(super) fn refuse_if(
    is_wrong: bool,
    key: &str,
    value: impl ToString,
    allowed: &str,
) -> Result<(), SceneError> {
    if is_wrong { Err(SceneError::refused(key, value, allowed)) } else { Ok(()) }
}
