//! Reads and writes files in separate threads, because a pipe without a reader or an unreachable
//! network drive would block the screen. In a directory, only regular files are opened, up to a
//! limit.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::file;
use crate::sheet::line::clean;
use rubscope_solver::scene::{BUILTIN, CheckedScene, Scene};

/// Name of the threads that read and write files, by which the panic hook knows them: their panics
/// neither reset the screen nor are reported.
pub const FILES_NAME: &str = "rubscope-files";

/// A file to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileJob {
    /// Path of the file.
    pub path: PathBuf,
    /// Content of the file.
    pub content: String,
    /// Whether an existing file may be replaced.
    pub replace: bool,
}

/// Outcome of writing a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileResult {
    /// The file was written completely.
    Written,
    /// The file exists already; nothing was written.
    Exists,
    /// Nothing was written, for this reason.
    Failed(String),
}

impl FileJob {
    /// Writes the file, completely or not at all. Replaces regular files only; anything else is not
    /// opened.
    pub fn run(&self) -> FileResult {
        match std::fs::metadata(&self.path) {
            Ok(kind) if kind.is_dir() => return FileResult::Failed("it is a directory".into()),
            Ok(kind) if !kind.is_file() => {
                return FileResult::Failed("it is a pipe or a device, not a file".into());
            }
            Ok(_) if !self.replace => return FileResult::Exists,
            _ => {}
        }
        let write = |out: &mut dyn Write| out.write_all(self.content.as_bytes());
        let written = if self.replace {
            file::replace(&self.path, write).map(|_| ())
        } else {
            file::create(&self.path, write)
        };
        match written {
            Ok(()) => FileResult::Written,
            Err(error) if error.kind() == ErrorKind::AlreadyExists => FileResult::Exists,
            Err(error) => FileResult::Failed(error.to_string()),
        }
    }
}

/// Largest number of scene files of a directory that are read; usually there are some dozens.
const MOST_FILES: usize = 200;
/// Largest number of directory entries that are examined.
const MOST_NAMES: usize = 20_000;

/// A scene in the list of scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundScene {
    /// Name of the built-in scene, or of the file in its directory; the open one has its path, as on
    /// the command line.
    pub name: String,
    /// The checked scene, or the reason in one line why it cannot be opened.
    pub scene: Result<CheckedScene, String>,
    /// Whether it is a file; otherwise it is built in.
    pub file: bool,
}

/// Returns the built-in scenes; they are parsed once.
pub fn builtin_scenes() -> &'static [FoundScene] {
    static READ: OnceLock<Vec<FoundScene>> = OnceLock::new();
    READ.get_or_init(|| {
        let read = |name: &str| Scene::builtin(name).and_then(|scene| scene.checked());
        let scene = |name: &str| read(name).map_err(|error| clean(&error.to_string()));
        let found = |name: &str| FoundScene { name: name.into(), scene: scene(name), file: false };
        BUILTIN.iter().map(|builtin| found(builtin.name)).collect()
    })
}

/// The scenes of a directory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FoundScenes {
    /// The scene files, sorted by name.
    pub files: Vec<FoundScene>,
    /// Remark on scenes that the list omits, or why it is empty; `None` if it is complete.
    pub missing: Option<String>,
    /// Whether the directory is still being read.
    pub reading: bool,
}

impl FoundScenes {
    /// Creates an empty list with the reason why it is empty.
    pub fn failed(reason: String) -> Self {
        Self { missing: Some(reason), ..Self::default() }
    }

    /// Reads the `.toml` files of a directory; the empty path stands for the working directory.
    pub fn of(directory: &Path) -> Self {
        let here = if directory.as_os_str().is_empty() { Path::new(".") } else { directory };
        let entries = match std::fs::read_dir(here) {
            Ok(entries) => entries,
            Err(error) => {
                return Self::failed(clean(&format!("this folder cannot be read: {error}")));
            }
        };
        let names = entries.flatten().take(MOST_NAMES).map(|entry| entry.file_name());
        let is_toml = |name: &String| file::ending(Path::new(name), &["toml"]).is_some();
        // Names that are not UTF-8 cannot be displayed or typed.
        let mut names: Vec<String> =
            names.filter_map(|name| name.into_string().ok()).filter(is_toml).collect();
        names.sort_unstable();
        let more = names.len().saturating_sub(MOST_FILES);
        names.truncate(MOST_FILES);
        let files = names.into_iter().filter_map(|name| load_scene(here, name)).collect();
        let missing = (more > 0).then(|| format!("{more} more files were not read"));
        Self { files, missing, reading: false }
    }
}

/// Loads a scene file; `None` if it is not a regular file or its path is not UTF-8.
fn load_scene(directory: &Path, name: String) -> Option<FoundScene> {
    let path = directory.join(&name);
    if !std::fs::metadata(&path).is_ok_and(|kind| kind.is_file()) {
        return None;
    }
    let path = path.to_str()?;
    let read = Scene::load(path).and_then(|scene| scene.checked());
    let scene = read.map_err(|error| clean(&error.to_string()));
    Some(FoundScene { name, scene, file: true })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_are_replaced_and_only_if_asked() {
        let folder = tempfile::tempdir().unwrap();
        let job = |name: &str, replace| FileJob {
            path: folder.path().join(name),
            content: "new".into(),
            replace,
        };
        assert_eq!(job("a.toml", false).run(), FileResult::Written);
        std::fs::write(folder.path().join("a.toml"), "old").unwrap();
        assert_eq!(job("a.toml", false).run(), FileResult::Exists);
        assert_eq!(std::fs::read(folder.path().join("a.toml")).unwrap(), b"old");
        assert_eq!(job("a.toml", true).run(), FileResult::Written);
        assert_eq!(std::fs::read(folder.path().join("a.toml")).unwrap(), b"new");
        for replace in [false, true] {
            let FileResult::Failed(reason) = job("", replace).run() else { panic!() };
            assert_eq!(reason, "it is a directory");
            let device = FileJob { path: "/dev/null".into(), ..job("", replace) };
            let FileResult::Failed(reason) = device.run() else { panic!() };
            assert_eq!(reason, "it is a pipe or a device, not a file");
        }
        assert!(matches!(job("none/a.toml", false).run(), FileResult::Failed(_)));
    }

    #[test]
    fn regular_toml_files_are_read_in_order_and_broken_ones_say_why() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &[u8]| std::fs::write(folder.path().join(name), text);
        write("b.toml", b"title = \"B\"").unwrap();
        write("a.toml", b"schema = 2").unwrap();
        write("c.TOML", b"\xff").unwrap();
        write("d.txt", b"title = \"D\"").unwrap();
        write("e.toml", &vec![b'#'; (1 << 20) + 1]).unwrap();
        std::fs::create_dir(folder.path().join("f.toml")).unwrap();
        let found = FoundScenes::of(folder.path());
        let names: Vec<&str> = found.files.iter().map(|file| file.name.as_str()).collect();
        assert_eq!(names, ["a.toml", "b.toml", "c.TOML", "e.toml"]);
        assert_eq!(found.files[1].scene.as_ref().unwrap().title, "B");
        for (place, reason) in [(0, "schema = 2"), (2, "not UTF-8"), (3, "up to 1048576 bytes")] {
            let error = found.files[place].scene.as_ref().unwrap_err();
            assert!(error.contains(reason) && error.lines().count() == 1, "{error}");
        }
        assert_eq!(found.missing, None);
    }

    #[test]
    fn a_pipe_is_not_opened_and_a_folder_of_many_files_has_an_end() {
        let folder = tempfile::tempdir().unwrap();
        for place in 0..MOST_FILES + 3 {
            std::fs::write(folder.path().join(format!("{place:04}.toml")), "").unwrap();
        }
        let pipe = folder.path().join("0000.toml");
        std::fs::remove_file(&pipe).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let found = FoundScenes::of(folder.path());
        assert_eq!(found.files.len(), MOST_FILES - 1);
        assert_eq!(found.missing.as_deref(), Some("3 more files were not read"));
        let none = FoundScenes::of(&folder.path().join("none"));
        assert!(none.missing.unwrap().starts_with("this folder cannot be read"));
    }
}
