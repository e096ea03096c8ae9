//! The built-in scenes: the files under `presets/`, embedded in the binary.

use super::error::visible;
use super::nearest::nearest;
use super::{Scene, SceneError};

/// A scene that is part of the program.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// Name on the command line.
    pub name: &'static str,
    /// Content of its file.
    pub toml: &'static str,
}

macro_rules! builtin {
    ($($name:literal),+ $(,)?) => {
        &[$(Builtin { name: $name, toml: include_str!(concat!("../../presets/", $name, ".toml")) }),+]
    };
}

/// Scene that the program opens by default.
pub const DEFAULT: &str = "paper-nd3";

/// All built-in scenes.
pub const BUILTIN: &[Builtin] = builtin![
    "paper-nd3",
    "paper-nd4",
    "paper-figs-4-6",
    "paper-fig-7",
    "paper-fig-8",
    "adhesive",
    "undamped",
    "rocking",
    "slip",
    "grazing",
    "run-down",
    "coincidence",
    "rub",
    "digs-in",
    "friction-lock",
    "soft-lining",
    "long-tip",
    "oval",
];

/// Returns the error for a name that is no built-in scene; it lists those that are, and names the
/// nearest one.
pub(super) fn unknown(name: &str) -> SceneError {
    let names = || BUILTIN.iter().map(|scene| scene.name);
    let meant = nearest(name, names());
    SceneError::UnknownScene {
        name: visible(name),
        meant: meant.map_or(String::new(), |meant| format!(" (did you mean {meant}?)")),
        allowed: names().collect::<Vec<_>>().join(", "),
    }
}

impl Scene {
    /// Returns the built-in scene with this name.
    ///
    /// # Errors
    /// There is no such scene; the message lists the existing ones.
    pub fn builtin(name: &str) -> Result<Self, SceneError> {
        match BUILTIN.iter().find(|scene| scene.name == name) {
            Some(scene) => Self::from_toml(scene.toml),
            None => Err(unknown(name)),
        }
    }
}
