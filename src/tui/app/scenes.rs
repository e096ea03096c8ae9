//! The list of scenes: the built-in ones and the files of the directory; the
//! open one is marked, and another can be opened.

use std::path::{Component, Path};

use super::update::Effect;
use super::{App, InputMode, Source};
use crate::scene::{CheckedScene, DEFAULT, Scene};
use crate::tui::scenes::{FoundScene, FoundScenes, builtin_scenes};

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
    /// Every scene that can be opened. One from elsewhere that is open comes first.
    pub fn scene_entries(&self) -> Vec<SceneEntry> {
        let open = self.files.source().map_or(DEFAULT, |source| source.name.as_str());
        let builtin = builtin_scenes().iter().map(|FoundScene { name, scene }| SceneEntry {
            name: name.clone(),
            scene: scene.clone(),
            file: false,
            open: name == open,
        });
        let files = self.files.found.files.iter().map(|FoundScene { name, scene }| {
            let path = self.files.directory.join(name);
            let open = same_path(&path, Path::new(open));
            SceneEntry { name: name.clone(), scene: scene.clone(), file: true, open }
        });
        let mut entries: Vec<SceneEntry> = builtin.chain(files).collect();
        if let Some(source) = &self.files.source
            && !entries.iter().any(|entry| entry.open)
        {
            let read = source.scene.checked().map_err(|error| error.to_string());
            let name = source.name.clone();
            entries.insert(0, SceneEntry { name, scene: read, file: true, open: true });
        }
        entries
    }

    /// The place of the selected scene: the open one, unless another was chosen.
    pub fn scene_place(&self, entries: &[SceneEntry], chosen: Option<usize>) -> usize {
        let open = || entries.iter().position(|entry| entry.open).unwrap_or(0);
        chosen.unwrap_or_else(open).min(entries.len().saturating_sub(1))
    }

    /// Opens the list, and has the files of the directory read.
    pub(super) fn list_scenes(&mut self) -> Effect {
        self.dialogue.open(InputMode::Scenes(None));
        if std::mem::replace(&mut self.files.found.reading, true) {
            // A folder that does not answer is asked once.
            return Effect::None;
        }
        Effect::FindScenes(self.files.directory.clone())
    }

    /// Takes the scenes that were found. The selected one stays selected.
    pub fn scenes_found(&mut self, found: FoundScenes) {
        let chosen = match self.dialogue.mode() {
            InputMode::Scenes(Some(place)) => self.scene_entries().get(*place).cloned(),
            _ => None,
        };
        self.files.found = found;
        if let Some(chosen) = chosen {
            let same = |entry: &SceneEntry| entry.name == chosen.name && entry.file == chosen.file;
            self.dialogue.choose(self.scene_entries().iter().position(same));
        }
    }

    pub(super) fn move_in_scenes(&mut self, by: i64) {
        let InputMode::Scenes(chosen) = *self.dialogue.mode() else { return };
        let entries = self.scene_entries();
        let last = i64::try_from(entries.len()).unwrap_or(1) - 1;
        let place = i64::try_from(self.scene_place(&entries, chosen)).unwrap_or(0);
        let place = usize::try_from((place + by).clamp(0, last)).ok();
        self.dialogue.open(InputMode::Scenes(place));
    }

    /// Opens the chosen scene, if it is one.
    pub(super) fn open_chosen_scene(&mut self) {
        let InputMode::Scenes(chosen) = *self.dialogue.mode() else { return };
        let entries = self.scene_entries();
        let Some(entry) = entries.get(self.scene_place(&entries, chosen)) else { return };
        match &entry.scene {
            Ok(scene) => {
                let path = match entry.file && !entry.open {
                    true => self.files.directory.join(&entry.name).to_string_lossy().into_owned(),
                    false => entry.name.clone(),
                };
                self.dialogue.close();
                self.open_scene(path, scene.clone());
                self.status = Some(format!("opened {}", entry.name));
            }
            Err(_) => self.status = Some(format!("{} cannot be opened", entry.name)),
        }
    }

    /// Makes another scene the open one, with the charts that it names; undo
    /// brings the former back.
    pub fn open_scene(&mut self, name: String, scene: CheckedScene) {
        self.knobs.remember(self.past());
        self.end_lesson();
        let source = Source { name, scene: scene.clone().into_scene() };
        self.files.open(scene.clone(), Some(source));
        self.layout.open(&scene);
        self.map = self.map.anchored(&scene);
        self.reading.stop();
        self.knobs.forget_refusal();
        self.set_scene(scene, false);
    }

    /// The scene to save. Title and note of the opened scene would be false where
    /// knobs were turned: then they say what was changed.
    pub(super) fn scene_to_save(&self) -> Scene {
        let mut scene = self.scene.clone().into_scene();
        let (base, name) = match &self.files.source {
            Some(source) => (&source.scene, source.name.as_str()),
            None => (&*self.files.opened, "the opened scene"),
        };
        let mut changes = self.changes_from(base);
        changes.retain(|(path, _)| !["title", "note"].contains(path));
        if changes.is_empty() {
            return scene;
        }
        let fits = |text: String, most: usize| text.chars().take(most).collect::<String>();
        // Words of the user's own stay.
        if scene.title == base.title {
            scene.title = fits(format!("changed from {name}"), 200);
        }
        if scene.note == base.note {
            let list: Vec<String> =
                changes.iter().map(|(path, value)| format!("{path} = {value}")).collect();
            scene.note = fits(format!("changed from {name}: {}", list.join(", ")), 4000);
        }
        // A name with letters that a title cannot have.
        if scene.checked().is_err() {
            (scene.title, scene.note) = ("changed".into(), String::new());
        }
        scene
    }
}

/// Whether two paths are written for the same file.
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
    use crate::tui::bindings::Action;
    use crate::tui::{Marker, Theme};

    #[test]
    fn a_folder_that_does_not_answer_is_asked_once_and_holds_nothing_up() {
        let mut app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Ascii);
        assert!(matches!(app.act(Action::Scenes), Effect::FindScenes(_)));
        app.act(Action::Close);
        assert_eq!(app.act(Action::Scenes), Effect::None);
        app.act(Action::KnobBelow);
        let chosen = app.scene_entries()[1].name.clone();
        // A file that comes late leaves the selected scene selected.
        let scene = Ok(Scene::base().checked().unwrap());
        let files = vec![FoundScene { name: "late.toml".into(), scene }];
        app.scenes_found(FoundScenes { files, ..FoundScenes::default() });
        assert_eq!(app.scene_entries().last().unwrap().name, "late.toml");
        app.act(Action::Accept);
        assert_eq!(app.files.source.as_ref().unwrap().name, chosen);
        // Now it is asked again.
        assert!(matches!(app.act(Action::Scenes), Effect::FindScenes(_)));
    }

    #[test]
    fn an_open_file_of_another_folder_is_in_the_list() {
        let mut app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Ascii);
        app.files.source = Some(Source { name: "other/mine.toml".into(), scene: Scene::base() });
        let entries = app.scene_entries();
        assert!(entries[0].open && entries[0].name == "other/mine.toml");
        assert_eq!(app.scene_place(&entries, None), 0);
        assert!(same_path(Path::new("./a.toml"), Path::new("a.toml")));
        assert!(!same_path(Path::new("b/a.toml"), Path::new("a.toml")));
    }
}
