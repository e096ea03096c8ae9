//! The files: the open scene, the list of those that can be opened, the file that is being
//! written, and the command line that repeats the run on the screen.

use std::path::{Component, Path, PathBuf};

use crate::report::CommandLine;
use crate::tui::app::{App, Purpose, Source};
use crate::tui::files::{FoundScene, FoundScenes, builtin_scenes};
use rubscope_solver::scene::{CheckedScene, DEFAULT, Scene};

/// A file that is being written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Writing {
    /// Its name, as typed.
    pub name: String,
    pub purpose: Purpose,
    /// Whether no key was pressed since.
    pub undisturbed: bool,
}

/// The files, and the open scene.
#[derive(Clone, Debug)]
pub struct Files {
    /// Directory in which files are written; the working directory unless set.
    pub directory: PathBuf,
    /// The scene as it was opened; `Backspace` restores its values.
    pub opened: CheckedScene,
    /// Origin of the scene, for the command line that repeats the run.
    pub source: Option<Source>,
    /// The file that is being written.
    pub writing: Option<Writing>,
    /// The scenes of the directory, as they were last read.
    pub found: FoundScenes,
}

impl Files {
    /// Creates the files with this scene open.
    pub fn of(opened: CheckedScene) -> Self {
        let (directory, found) = (PathBuf::new(), FoundScenes::default());
        Self { directory, opened, source: None, writing: None, found }
    }

    /// Makes another scene the open one; without a source that stays.
    pub fn open(&mut self, scene: CheckedScene, source: Option<Source>) {
        self.opened = scene;
        self.source = source.or(self.source.take());
    }

    /// Records that a key was pressed while a file is being written.
    pub fn disturb(&mut self) {
        if let Some(writing) = &mut self.writing {
            writing.undisturbed = false;
        }
    }
}

impl App {
    /// Returns the command line as text.
    pub fn command(&self) -> String {
        self.command_line().to_string()
    }

    /// Returns `rubscope run SCENE` with every key that differs from the scene.
    pub fn command_line(&self) -> CommandLine {
        // Without a source it is the default scene, which is built in.
        let default = || Source {
            name: DEFAULT.into(),
            scene: Scene::builtin(DEFAULT).unwrap_or_else(|_| Scene::base()),
        };
        let Source { name, scene: base } = self.files.source.clone().unwrap_or_else(default);
        // Live changes come at their instants, after which the forecast is as long
        // as the scene says.
        let mut scene = self.run.started.clone().into_scene();
        scene.solver.end_s = self.end_s();
        let start = CommandLine::from_base("run", &name, &base, &scene);
        let live = &self.results().applied;
        let at =
            |line: CommandLine, (t, what): &(f64, _)| line.option("--at", format!("{t:?}:{what}"));
        live.iter().fold(start, at)
    }
}

/// One line of the list.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneEntry {
    /// Its name on the command line.
    pub name: String,
    /// The scene, or why there is none.
    pub scene: Result<CheckedScene, String>,
    /// Whether it is a file.
    pub file: bool,
    /// Whether it is open.
    pub open: bool,
}

impl App {
    /// Returns every scene that can be opened, those of the user first; one from elsewhere that is
    /// open before all.
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
        // Other programs have such files, too.
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

    /// Returns the place of the selected scene: the open one, unless another was chosen.
    pub fn scene_place(&self, entries: &[SceneEntry], chosen: Option<usize>) -> usize {
        let open = || entries.iter().position(|entry| entry.open).unwrap_or(0);
        chosen.unwrap_or_else(open).min(entries.len().saturating_sub(1))
    }
}

/// Returns whether two paths are written for the same file.
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
