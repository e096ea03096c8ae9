//! Files: the open scene, the scenes that can be opened, the file being written, and the command
//! line that repeats the run on the screen.

use std::path::{Component, Path, PathBuf};

use crate::report::CommandLine;
use crate::tui::app::{App, Source};
use crate::tui::command::Purpose;
use crate::tui::files::{FoundScene, FoundScenes, builtin_scenes};
use rubscope_solver::scene::{CheckedScene, DEFAULT, Scene};

/// A file that is being written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Writing {
    /// File name as typed.
    pub name: String,
    /// What is written to it.
    pub purpose: Purpose,
    /// Whether no key was pressed since the write began.
    pub undisturbed: bool,
}

/// The open scene, and the files of the directory.
#[derive(Clone, Debug)]
pub struct Files {
    /// Directory in which scenes are found and files are written; empty means the working
    /// directory.
    pub directory: PathBuf,
    /// The scene as opened; `Backspace` restores its values.
    pub opened: CheckedScene,
    /// Where the scene came from, for the command line; `None` for the built-in default.
    pub source: Option<Source>,
    /// The write under way; `None` if there is none.
    pub writing: Option<Writing>,
    /// The scene files of the directory, as last read.
    pub found: FoundScenes,
}

impl Files {
    /// Creates the state with `opened` as the open scene and no known source.
    pub fn of(opened: CheckedScene) -> Self {
        let (directory, found) = (PathBuf::new(), FoundScenes::default());
        Self { directory, opened, source: None, writing: None, found }
    }

    /// Makes `scene` the open one. Without a new source the old one is kept.
    pub fn open(&mut self, scene: CheckedScene, source: Option<Source>) {
        self.opened = scene;
        self.source = source.or(self.source.take());
    }

    /// Records that a key was pressed during a write.
    pub fn disturb(&mut self) {
        if let Some(writing) = &mut self.writing {
            writing.undisturbed = false;
        }
    }
}

impl App {
    /// Returns the command line that repeats the run, as one string.
    pub fn command(&self) -> String {
        self.command_line().to_string()
    }

    /// Builds `rubscope run SCENE` with an option for every key that differs from the scene, and
    /// `--at` for every live change.
    pub fn command_line(&self) -> CommandLine {
        // Without a source the scene is the built-in default.
        let default = || Source {
            name: DEFAULT.into(),
            scene: Scene::builtin(DEFAULT).unwrap_or_else(|_| Scene::base()),
        };
        let Source { name, scene: base } = self.files.source.clone().unwrap_or_else(default);
        // Live changes are applied at their own instants, so the command starts from the scene at
        // restart, with the extended end of the run.
        let mut scene = self.run.started.clone().into_scene();
        scene.solver.end_s = self.end_s();
        let start = CommandLine::from_base("run", &name, &base, &scene);
        let live = &self.results().applied;
        let at =
            |line: CommandLine, (t, what): &(f64, _)| line.option("--at", format!("{t:?}:{what}"));
        live.iter().fold(start, at)
    }
}

/// One entry of the list of scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneEntry {
    /// Name or path, as on the command line.
    pub name: String,
    /// The checked scene, or why it cannot be opened.
    pub scene: Result<CheckedScene, String>,
    /// Whether it is a file; otherwise it is built in.
    pub file: bool,
    /// Whether it is the open scene.
    pub open: bool,
}

impl App {
    /// Lists every scene that can be opened: files first, then the built-in ones, then unreadable
    /// files. An open scene from another directory comes before all.
    pub fn scene_entries(&self) -> Vec<SceneEntry> {
        let open = self.files.source.as_ref().map_or(DEFAULT, |source| source.name.as_str());
        let entry = |found: &FoundScene, file, open| {
            let FoundScene { name, scene } = found.clone();
            SceneEntry { name, scene, file, open }
        };
        let builtin = builtin_scenes().iter().map(|one| entry(one, false, one.name == open));
        let path = |name: &String| self.files.directory.join(name);
        let is_open = |name: &String| same_path(&path(name), Path::new(open));
        let files = self.files.found.files.iter().map(|one| entry(one, true, is_open(&one.name)));
        let mut entries: Vec<SceneEntry> = files.chain(builtin).collect();
        // Other programs may keep TOML files here too: those are no scenes, so they go last.
        entries.sort_by_key(|entry| entry.scene.is_err());
        if let Some(source) = &self.files.source
            && !entries.iter().any(|entry| entry.open)
        {
            let read = source.scene.checked().map_err(|error| error.to_string());
            let name = source.name.clone();
            entries.insert(0, SceneEntry { name, scene: read, file: true, open: true });
        }
        entries
    }

    /// Returns the index of the selected scene: `chosen`, or the open one.
    pub fn scene_place(&self, entries: &[SceneEntry], chosen: Option<usize>) -> usize {
        let open = || entries.iter().position(|entry| entry.open).unwrap_or(0);
        chosen.unwrap_or_else(open).min(entries.len().saturating_sub(1))
    }
}

/// Returns whether two paths name the same file, apart from `./`.
fn same_path(one: &Path, other: &Path) -> bool {
    let parts = |path: &Path| -> Vec<std::ffi::OsString> {
        let named = path.components().filter(|part| *part != Component::CurDir);
        named.map(|part| part.as_os_str().to_os_string()).collect()
    };
    parts(one) == parts(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_may_begin_with_a_dot() {
        assert!(same_path(Path::new("./a.toml"), Path::new("a.toml")));
        assert!(!same_path(Path::new("b/a.toml"), Path::new("a.toml")));
    }
}
