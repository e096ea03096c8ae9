//! The config file, in which the explorer remembers settings between sessions. It is written only
//! if they changed. Without a config directory, nothing is remembered.

use std::io::Write;
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::time::Duration;

use etcetera::{BaseStrategy, choose_base_strategy};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::app::App;
use super::app::layout::MOST_BESIDE;
use super::files::FILES_NAME;
use super::lessons::LessonsDone;
use super::raster::Marker;
use super::theme::ThemeChoice;
use crate::file;
use crate::sheet::line::clean;

/// Largest file that is read \[bytes\].
const MOST_BYTES: u64 = 64 * 1024;

/// Contents of the config file. A missing field has its default; unknown fields are kept.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Config {
    /// Theme saved in the file, by a key press or by hand; `None` if there is none.
    pub theme: Option<ThemeChoice>,
    /// Marker of the curves saved in the file, by a key press or by hand; `None` if there is none.
    pub marker: Option<Marker>,
    /// Number of small charts next to the large one; `None` for the default.
    pub charts: Option<usize>,
    /// Whether the explorer uses the mouse; `None` counts as true.
    pub mouse: Option<bool>,
    /// Whether the user has pressed a key and so no longer sees the line for new users.
    pub introduced: bool,
    /// Units in which numbers are shown.
    pub units: Units,
    /// Steps of the lessons that the user has completed.
    pub steps_done: LessonsDone,
}

/// Units for display.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, expecting = "for units a table: units.speed = \"rpm\" or \"rad/s\"")]
pub struct Units {
    /// Unit in which speeds are shown; `None` for rad/s.
    pub speed: Option<SpeedUnit>,
}

/// A unit of speeds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum SpeedUnit {
    /// Revolutions per minute.
    #[serde(rename = "rpm")]
    Rpm,
    /// Radians per second.
    #[serde(rename = "rad/s")]
    Radians,
}

impl Config {
    /// Collects the settings of a running explorer.
    fn of(app: &App) -> Self {
        let look = app.appearance;
        let speed = if look.rpm { SpeedUnit::Rpm } else { SpeedUnit::Radians };
        Self {
            // `None` while the theme follows the background of the terminal.
            theme: (!look.follows_ground).then(|| ThemeChoice::of(look.theme)),
            marker: Some(look.marker),
            charts: Some(app.layout.beside),
            mouse: Some(app.mouse.on),
            introduced: !app.dialogue.is_new,
            units: Units { speed: Some(speed) },
            steps_done: app.lessons.done.clone(),
        }
    }

    /// Reads the file: the settings, and all its fields, also those that this version does not know.
    fn read(path: &Path) -> Result<(Self, Table), String> {
        match path.metadata() {
            // Reading a pipe could block forever.
            Ok(found) if !found.is_file() => return Err("it is not a file".into()),
            Err(_) => return Ok(Default::default()),
            Ok(_) => {}
        }
        let text = file::read_text(path, MOST_BYTES).map_err(|error| error.to_string())?;
        let told = |error: toml::de::Error| error.message().to_string();
        let (read, fields): (Self, Table) =
            (toml::from_str(&text).map_err(told)?, toml::from_str(&text).map_err(told)?);
        Ok((Self { charts: read.charts.map(|count| count.min(MOST_BESIDE)), ..read }, fields))
    }

    /// Returns the fields of the file; none for a setting that is not known.
    fn fields(&self) -> Result<Table, String> {
        Table::try_from(self).map_err(|error| error.to_string())
    }
}

/// Writes the fields of the config file, in a folder that is created if needed.
fn write(fields: &Table, path: &Path) -> std::io::Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::DirBuilder::new().recursive(true).mode(0o700).create(folder)?;
    }
    let write = |out: &mut dyn Write| out.write_all(fields.to_string().as_bytes());
    if path.symlink_metadata().is_ok() {
        file::replace(path, write).map(drop)
    } else {
        file::create(path, write)
    }
}

/// Returns whether a directory may be created: not in a home directory that does not exist.
fn is_at_home(folder: &Path, home: &Path) -> bool {
    home.is_dir() || !folder.starts_with(home)
}

/// The config file during a session.
#[derive(Debug)]
pub struct Memory {
    /// Path of the file; `None` if nothing is remembered: the user does not want it, there is no
    /// config directory, or the file has an error.
    path: Option<PathBuf>,
    /// Contents at the start of the session.
    pub config: Config,
    /// Message on why the file was not used; `None` if it was read or does not exist.
    pub complaint: Option<String>,
    /// Fields of the settings at the start, to detect changes; none before [`Self::prepare`].
    began: Table,
}

impl Memory {
    /// Reads the config file if `wanted`; otherwise the defaults apply.
    pub fn recall(wanted: bool) -> Self {
        if !wanted {
            return Self::at(None);
        }
        let folder = choose_base_strategy().ok().and_then(|places| {
            let folder = places.config_dir();
            is_at_home(&folder, places.home_dir()).then_some(folder)
        });
        let mut memory = Self::at(folder.as_ref().map(|at| at.join("rubscope/config.toml")));
        let is_folder = |folder: &PathBuf| folder.is_dir() || !folder.exists();
        if memory.complaint.is_none() && !folder.as_ref().is_some_and(is_folder) {
            let place = folder.map_or("no home folder".into(), |folder| {
                format!("{} is not a folder", folder.display())
            });
            memory.complaint = Some(clean(&format!("settings are not saved: {place}")));
        }
        memory
    }

    fn at(path: Option<PathBuf>) -> Self {
        let read = path.as_deref().map_or_else(|| Ok(Default::default()), Config::read);
        let (config, complaint) = match read {
            Ok((config, _)) => (config, None),
            Err(why) => {
                (Config::default(), Some(clean(&format!("config.toml is not used: {why}"))))
            }
        };
        // A file with an error is not overwritten, so that the user can repair it.
        let path = path.filter(|_| complaint.is_none());
        Self { path, config, complaint, began: Table::new() }
    }

    /// Applies the stored settings to the explorer, and notes the state from which changes count.
    pub fn prepare(&mut self, app: &mut App) {
        if let Some(charts) = self.config.charts {
            app.layout.beside = charts;
        }
        app.lessons.done.clone_from(&self.config.steps_done);
        app.appearance.rpm |= self.config.units.speed == Some(SpeedUnit::Rpm);
        app.mouse.on &= self.config.mouse.unwrap_or(true);
        app.dialogue.is_new = self.path.is_some() && !self.config.introduced;
        app.status.clone_from(&self.complaint);
        self.began = Config::of(app).fields().unwrap_or_default();
    }

    /// Writes the settings that changed during the session. Returns the message if that fails;
    /// `None` if it succeeds, nothing is remembered, or the disk takes longer than `patience`.
    pub fn keep(self, app: &App, patience: Duration) -> Option<String> {
        let path = self.path.clone()?;
        let mut ended = Config::of(app);
        let (done, wait) = channel();
        let work = move || {
            // Read again, because another explorer may have written the file meanwhile.
            let kept = Config::read(&path).and_then(|(config, before)| {
                ended.steps_done.join(config.steps_done);
                let mut fields = before.clone();
                let is_new = |(key, value): &(String, _)| self.began.get(key) != Some(value);
                fields.extend(ended.fields()?.into_iter().filter(is_new));
                let written = if fields == before { Ok(()) } else { write(&fields, &path) };
                written.map_err(|error| error.to_string())
            });
            let failed =
                |why| format!("settings are not saved: cannot write {}: {why}", path.display());
            // Sending fails if `keep` has given up.
            let _ = done.send(kept.err().map(failed));
        };
        std::thread::Builder::new().name(FILES_NAME.into()).spawn(work).ok()?;
        wait.recv_timeout(patience).ok()?
    }
}

#[cfg(test)]
mod tests;
