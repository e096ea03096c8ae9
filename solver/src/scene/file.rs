//! Reads and writes scene files (TOML). Keys that a file does not contain have the documented
//! default (the paper's machine); unknown keys are errors.

use std::fs::File;
use std::io::{Error, ErrorKind, Read};
use std::path::Path;

use toml::{Table, Value as Toml};

use super::builtin::unknown;
use super::error::refuse_if;
use super::units::UnitError;
use super::{Allowed, BUILTIN, Key, Scene, SceneError, Value, keys, modes};

/// Largest accepted scene file \[bytes\]; the built-in ones have a few hundred.
const LARGEST_FILE: u64 = 1 << 20;

impl Scene {
    /// Loads a built-in scene by name, or a `.toml` file, and checks it completely.
    ///
    /// # Errors
    /// The scene or file does not exist, or its content is not allowed.
    pub fn load(name_or_path: &str) -> Result<Self, SceneError> {
        let scene = Self::load_unchecked(name_or_path)?;
        scene.checked().map_err(|error| error.in_file(name_or_path))?;
        Ok(scene)
    }

    /// As [`load`](Self::load), but checks only each key and not the combinations, so that options
    /// can still change the scene before the full check.
    ///
    /// # Errors
    /// The scene or file does not exist, or a key in it is not allowed.
    pub fn load_unchecked(name_or_path: &str) -> Result<Self, SceneError> {
        if let Some(scene) = BUILTIN.iter().find(|scene| scene.name == name_or_path) {
            return Self::from_toml_unchecked(scene.toml);
        }
        let path = Path::new(name_or_path);
        let is_toml = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("toml"));
        if !is_toml && !name_or_path.contains(std::path::MAIN_SEPARATOR) {
            return Err(unknown(name_or_path));
        }
        let refused = |reason: String| SceneError::File { path: name_or_path.to_string(), reason };
        let text = read_text(path, LARGEST_FILE).map_err(|error| refused(error.to_string()))?;
        Self::from_toml_unchecked(&text).map_err(|error| error.in_file(name_or_path))
    }

    /// Reads the text of a scene file and checks it completely.
    ///
    /// # Errors
    /// Names the first error in one line.
    pub fn from_toml(text: &str) -> Result<Self, SceneError> {
        let scene = Self::from_toml_unchecked(text)?;
        scene.checked()?;
        Ok(scene)
    }

    /// As [`from_toml`](Self::from_toml), but checks only each key and not the combinations, so
    /// that options can still change the scene before the full check.
    ///
    /// # Errors
    /// The text is not TOML, a key is unknown, or a value has the wrong type or is out of bounds.
    pub fn from_toml_unchecked(text: &str) -> Result<Self, SceneError> {
        let table: Table = text.parse().map_err(|error: toml::de::Error| {
            let message = error.message().lines().collect::<Vec<_>>().join(" ");
            let message = match message.split_once(" as i128,") {
                Some((start, _)) => format!("{start}: allowed are up to 18 digits"),
                None => message,
            };
            let line = error.span().map_or(1, |span| {
                1 + text.as_bytes().iter().take(span.start).filter(|&&byte| byte == b'\n').count()
            });
            SceneError::Syntax(format!("line {line}: {message}"))
        })?;
        let mut scene = Self::base();
        for (name, value) in &table {
            if name == "schema" {
                refuse_if(value.as_integer() != Some(1), name, one_line(value), "1")?;
            } else if let Toml::Table(inner) = value {
                // Modes are read last: a mode's frequency refers to the mass in the same table.
                let (modes, plain): (Vec<_>, Vec<_>) =
                    inner.iter().partition(|(leaf, _)| *leaf == "modes");
                for (leaf, value) in plain.into_iter().chain(modes) {
                    read(&mut scene, &format!("{name}.{leaf}"), value)?;
                }
                let of_table = |key: &Key| key.path.split_once('.').is_some_and(|of| of.0 == name);
                if !keys::KEYS.iter().any(of_table) {
                    return Err(keys::unknown(name));
                }
            } else {
                read(&mut scene, name, value)?;
            }
        }
        Ok(scene)
    }

    /// Writes the scene as a TOML file that contains every key.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut out = String::from("schema = 1\n");
        let mut table = "";
        let own = self.without_modes();
        for key in keys::KEYS {
            match key.path {
                keys::CASING_MODES => out.push_str(&modes::CASING.blocks(&self.casing.modes)),
                keys::DISK_MODES => out.push_str(&modes::DISK.blocks(&self.bladed_disk.modes)),
                _ => {}
            }
            if matches!(key.allowed, Allowed::Modes(_)) {
                continue;
            }
            let (section, leaf) = key.path.split_once('.').unwrap_or(("", key.path));
            if section != table {
                out.push_str(&format!("\n[{section}]\n"));
                table = section;
            }
            out.push_str(&format!("{leaf} = {}\n", as_toml(&(key.get)(&own))));
        }
        out
    }
}

/// Reads a text file of at most `most` bytes.
///
/// # Errors
/// As [`read_bytes`], or the content is not UTF-8.
pub fn read_text(path: &Path, most: u64) -> std::io::Result<String> {
    String::from_utf8(read_bytes(path, most)?).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        Error::new(ErrorKind::InvalidData, format!("byte {place} is not UTF-8 text"))
    })
}

/// Reads a file of at most `most` bytes.
///
/// # Errors
/// The system reports an error, or the file is larger.
pub fn read_bytes(path: &Path, most: u64) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    // A device or a huge file must not fill the memory.
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let reason = format!("allowed are up to {most} bytes");
        return Err(Error::new(ErrorKind::FileTooLarge, reason));
    }
    Ok(bytes)
}

fn as_toml(value: &Value) -> Toml {
    match value {
        Value::Real(x) => Toml::Float(*x),
        Value::Whole(n) => Toml::Integer(i64::try_from(*n).unwrap_or(i64::MAX)),
        Value::Text(text) => Toml::String(text.clone()),
        Value::Words(words) => Toml::Array(words.iter().cloned().map(Toml::String).collect()),
        Value::Numbers(list) => Toml::Array(list.iter().copied().map(Toml::Float).collect()),
    }
}

fn read(scene: &mut Scene, path: &str, toml: &Toml) -> Result<(), SceneError> {
    let key = keys::find(path)?;
    let refused = || SceneError::refused(path, one_line(toml), key.allowed.to_string());
    let value = match (toml, key.allowed) {
        (Toml::Float(x), Allowed::Real { .. }) => Some(Value::Real(*x)),
        (Toml::Integer(n), Allowed::Real { .. }) => Some(Value::Real(*n as f64)),
        (Toml::Integer(n), Allowed::Whole { .. }) => u64::try_from(*n).ok().map(Value::Whole),
        (Toml::String(text), Allowed::Real { .. }) => match key.parse(text) {
            Err(error @ SceneError::Unit { .. }) => return Err(error),
            read => read.ok(),
        },
        (Toml::String(text), Allowed::OneOf(_) | Allowed::Text { .. }) => {
            Some(Value::Text(text.clone()))
        }
        (Toml::Array(_), Allowed::Modes(_)) => Some(Value::Text(toml.to_string())),
        (Toml::Array(items), Allowed::Numbers { .. }) => {
            let number = |item: &Toml| match item {
                Toml::String(text) => key.quantity().read(text).map_err(|why| match why {
                    UnitError::NoNumber => refused(),
                    why => SceneError::Unit { key: path.into(), value: text.clone(), why },
                }),
                item => item.as_float().or(item.as_integer().map(|n| n as f64)).ok_or_else(refused),
            };
            Some(Value::Numbers(items.iter().map(number).collect::<Result<_, _>>()?))
        }
        (Toml::Array(items), Allowed::SomeOf(_)) => items
            .iter()
            .map(|item| item.as_str().map(String::from))
            .collect::<Option<Vec<_>>>()
            .map(Value::Words),
        _ => None,
    };
    scene.set_value(key, value.ok_or_else(refused)?)
}

/// Formats a value in one line.
pub(super) fn one_line(value: &Toml) -> String {
    match value {
        // With a power of ten instead of many zeros.
        Toml::Float(x) => format!("{x:?}"),
        _ => value.to_string().lines().collect::<Vec<_>>().join(" "),
    }
}
