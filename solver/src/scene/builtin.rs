//! The built-in scenes: the files under `presets/`, embedded in the binary.

use super::{Scene, SceneError};

/// A scene that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// Its name on the command line.
    pub name: &'static str,
    /// Its file.
    pub toml: &'static str,
}

macro_rules! builtin {
    ($($name:literal),+ $(,)?) => {
        &[$(Builtin { name: $name, toml: include_str!(concat!("../../presets/", $name, ".toml")) }),+]
    };
}

/// The scene the program opens when none is named.
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

impl Scene {
    /// Returns the built-in scene of this name.
    ///
    /// # Errors
    /// No such scene; the message lists the existing ones.
    pub fn builtin(name: &str) -> Result<Self, SceneError> {
        match BUILTIN.iter().find(|scene| scene.name == name) {
            Some(scene) => Self::from_toml(scene.toml),
            None => Err(SceneError::UnknownScene {
                name: name.to_string(),
                allowed: BUILTIN.iter().map(|scene| scene.name).collect::<Vec<_>>().join(", "),
            }),
        }
    }
}
