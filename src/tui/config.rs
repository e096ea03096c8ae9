//! The config file, in which the explorer remembers settings between sessions. It is written only
//! if they changed. Without a config directory, nothing is remembered.

use std::io::Write;
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::time::Duration;

use etcetera::{BaseStrategy, choose_base_strategy};
use serde::{Deserialize, Serialize};

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
    #[serde(skip_serializing_if = "Option::is_none")]
    pub theme: Option<ThemeChoice>,
    /// Marker of the curves saved in the file, by a key press or by hand; `None` if there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub marker: Option<Marker>,
    /// Number of small charts next to the large one; `None` for the default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub charts: Option<usize>,
    /// Whether the explorer uses the mouse; `None` counts as true.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mouse: Option<bool>,
    /// Whether the user has pressed a key and so no longer sees the line for new users.
    pub introduced: bool,
    /// Units in which numbers are shown.
    #[serde(skip_serializing_if = "Units::are_usual")]
    pub units: Units,
    /// Steps of the lessons that the user has completed.
    #[serde(skip_serializing_if = "LessonsDone::is_empty")]
    pub steps_done: LessonsDone,
    /// Fields that this version does not know. They are written back unchanged.
    #[serde(flatten)]
    pub others: toml::Table,
}

/// Units for display.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, expecting = "for units a table: units.speed = \"rpm\" or \"rad/s\"")]
pub struct Units {
    /// Unit in which speeds are shown; `None` for rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
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

impl Units {
    fn are_usual(&self) -> bool {
        *self == Self::default()
    }
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
            others: toml::Table::new(),
        }
    }

    fn read(path: &Path) -> Result<Self, String> {
        match path.metadata() {
            // Reading a pipe could block forever.
            Ok(found) if !found.is_file() => return Err("it is not a file".into()),
            Err(_) => return Ok(Self::default()),
            Ok(_) => {}
        }
        let text = file::read_text(path, MOST_BYTES).map_err(|error| error.to_string())?;
        let read: Self = toml::from_str(&text).map_err(|error| error.message().to_string())?;
        Ok(Self { charts: read.charts.map(|count| count.min(MOST_BESIDE)), ..read })
    }

    fn write(&self, path: &Path) -> std::io::Result<()> {
        // TOML needs plain values before tables; converting to a `Table` sorts them.
        let table = toml::Table::try_from(self).map_err(std::io::Error::other)?;
        if let Some(folder) = path.parent() {
            std::fs::DirBuilder::new().recursive(true).mode(0o700).create(folder)?;
        }
        let write = |out: &mut dyn Write| out.write_all(table.to_string().as_bytes());
        if path.symlink_metadata().is_ok() {
            file::replace(path, write).map(drop)
        } else {
            file::create(path, write)
        }
    }
}

/// Overwrites the stored setting only if it changed during this session.
fn keep_if_changed<T: PartialEq>(began: &T, ended: T, kept: &mut T) {
    if ended != *began {
        *kept = ended;
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
    /// Settings of the explorer at the start, to detect changes; `None` before [`Self::prepare`].
    began: Option<Config>,
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
        let read = path.as_deref().map_or_else(|| Ok(Config::default()), Config::read);
        let (config, complaint) = match read {
            Ok(config) => (config, None),
            Err(why) => {
                (Config::default(), Some(clean(&format!("config.toml is not used: {why}"))))
            }
        };
        // A file with an error is not overwritten, so that the user can repair it.
        let path = path.filter(|_| complaint.is_none());
        Self { path, config, complaint, began: None }
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
        self.began = Some(Config::of(app));
    }

    /// Writes the settings that changed during the session. Returns the message if that fails;
    /// `None` if it succeeds, nothing is remembered, or the disk takes longer than `patience`.
    pub fn keep(self, app: &App, patience: Duration) -> Option<String> {
        let path = self.path.clone()?;
        let ended = Config::of(app);
        let (done, wait) = channel();
        let work = move || {
            // Read again, because another explorer may have written the file meanwhile.
            let kept = Config::read(&path).and_then(|config| {
                let changed = self.changed(config.clone(), ended);
                let is_new = changed != config;
                let written = if is_new { changed.write(&path) } else { Ok(()) };
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

    fn changed(&self, mut config: Config, ended: Config) -> Config {
        config.steps_done.join(ended.steps_done);
        config.introduced |= ended.introduced;
        let Some(began) = &self.began else { return config };
        keep_if_changed(&began.theme, ended.theme, &mut config.theme);
        keep_if_changed(&began.marker, ended.marker, &mut config.marker);
        keep_if_changed(&began.charts, ended.charts, &mut config.charts);
        keep_if_changed(&began.mouse, ended.mouse, &mut config.mouse);
        keep_if_changed(&began.units, ended.units, &mut config.units);
        config
    }
}

#[cfg(test)]
mod tests;
