//! Files: the open scene, the list of scenes that can be opened, and writing the scene or the large
//! chart. No file is replaced without asking.

use std::path::{Component, Path, PathBuf};

use super::model::{App, Files, InputMode, Source, Writing};
use crate::sheet::line::clean;
use crate::tui::command::{Effect, Purpose};
use crate::tui::files::{FileResult, FoundScene, FoundScenes, builtin_scenes};
use rubscope_solver::scene::keys::differences;
use rubscope_solver::scene::{CheckedScene, DEFAULT, Scene};

impl Files {
    /// Creates the state with `opened` as the open scene and no known source.
    pub fn of(opened: CheckedScene) -> Self {
        let (directory, found) = (PathBuf::new(), FoundScenes::default());
        Self { directory, opened, source: None, saved: None, writing: None, found }
    }

    /// Makes `scene` the open one. Without a new source the old one is kept.
    pub fn open(&mut self, scene: CheckedScene, source: Option<Source>) {
        self.opened = scene;
        self.source = source.or(self.source.take());
    }

    /// Returns whether a scene is neither the one that was opened nor the one that was saved.
    pub fn is_changed(&self, scene: &CheckedScene) -> bool {
        let alike = |kept: &CheckedScene| differences(kept, scene).next().is_none();
        !alike(&self.opened) && !self.saved.as_ref().is_some_and(alike)
    }

    /// Records that a key was pressed during a write.
    pub fn disturb(&mut self) {
        if let Some(writing) = &mut self.writing {
            writing.undisturbed = false;
        }
    }
}

impl App {
    /// Lists every scene that can be opened: files first, then the built-in ones, then unreadable
    /// files. An open scene from another directory comes before all.
    pub fn scene_entries(&self) -> Vec<FoundScene> {
        let found = self.files.found.files.iter().chain(builtin_scenes());
        let mut entries: Vec<FoundScene> = found.cloned().collect();
        // Other programs may keep TOML files here too: those are no scenes, so they go last.
        entries.sort_by_key(|entry| entry.scene.is_err());
        if let Some(source) = &self.files.source
            && !entries.iter().any(|entry| self.is_open_scene(entry))
        {
            let scene = source.scene.checked().map_err(|error| error.to_string());
            entries.insert(0, FoundScene { name: source.name.clone(), scene, file: true });
        }
        entries
    }

    /// Returns whether an entry of the list is the open scene.
    pub fn is_open_scene(&self, entry: &FoundScene) -> bool {
        let open = self.files.source.as_ref().map_or(DEFAULT, |source| source.name.as_str());
        let path = self.files.directory.join(&entry.name);
        // The same file may be named with and without `./`.
        let parts = |path: &Path| -> PathBuf {
            path.components().filter(|part| *part != Component::CurDir).collect()
        };
        entry.name == open || (entry.file && parts(&path) == parts(Path::new(open)))
    }

    /// Asks for the name of the file to write.
    pub fn ask_name(&mut self, purpose: Purpose) {
        let name = match purpose {
            Purpose::Save => "scene.toml".to_string(),
            Purpose::Export => format!("{}.csv", self.view().word()),
        };
        self.dialogue.open(InputMode::Naming(purpose, name.into()));
    }

    /// Handles the result of the write; returns whether the file was written.
    pub fn written(&mut self, result: FileResult) -> bool {
        let Some(Writing { name, purpose, undisturbed }) = self.files.writing.take() else {
            return true;
        };
        if purpose == Purpose::Save && result != FileResult::Written {
            self.files.saved = None;
        }
        self.status = match &result {
            FileResult::Written => Some(format!("written: {name}")),
            FileResult::Failed(reason) => Some(format!("cannot write {name}: {reason}")),
            FileResult::Exists if undisturbed => {
                self.dialogue.ask(InputMode::Replacing(purpose, name));
                None
            }
            // Keys pressed since then were meant for something else and must not answer the
            // question.
            FileResult::Exists => Some(format!("{name} exists and was not replaced; save again")),
        };
        result == FileResult::Written
    }

    /// Requests the scene files of the directory.
    pub fn find_scenes(&mut self) -> Effect {
        if std::mem::replace(&mut self.files.found.reading, true) {
            // A directory that does not respond is read only once at a time.
            return Effect::None;
        }
        Effect::FindScenes(self.files.directory.clone())
    }

    /// Opens a scene of the list. Undo returns to the previous one.
    ///
    /// # Errors
    /// One line that says why the file has no valid scene.
    pub fn open_entry(&mut self, entry: &FoundScene) -> Result<(), String> {
        let name = clean(&entry.name);
        let refused = |why: &String| format!("{name} cannot be opened: {why}");
        let scene = entry.scene.as_ref().map_err(refused)?;
        let path = match entry.file && !self.is_open_scene(entry) {
            true => self.files.directory.join(&entry.name).to_string_lossy().into_owned(),
            false => entry.name.clone(),
        };
        let back =
            if self.files.is_changed(&self.scene) { "; u goes back to the changes" } else { "" };
        self.dialogue.close();
        self.open_scene(path, scene.clone());
        self.status = Some(format!("opened {name}{back}"));
        Ok(())
    }

    /// Makes another scene the open one and shows the charts that it names. Undo returns to the
    /// previous one.
    pub fn open_scene(&mut self, name: String, scene: CheckedScene) {
        self.knobs.remember(self.past());
        self.end_lesson();
        let source = Source { name, scene: scene.clone().into_scene() };
        self.files.open(scene.clone(), Some(source));
        self.layout.open(&scene);
        self.appearance.rpm |= scene.view.speeds.contains("rpm");
        self.map = self.map.anchored(&scene);
        self.stop_reading();
        self.play.open(&scene);
        self.knobs.refusal = None;
        self.set_scene(scene, false);
    }

    /// Opens the scene of a step of a lesson, which is made from the built-in scene `name`.
    pub fn open_lesson_scene(&mut self, name: String, scene: CheckedScene) {
        let source = Scene::builtin(&name).ok().map(|scene| Source { name, scene });
        self.files.open(scene.clone(), source);
        self.knobs.refusal = None;
        if scene != self.scene {
            self.set_scene(scene, false);
        }
    }

    /// Returns the scene to save. If knobs were turned, the title and note of the opened scene no
    /// longer apply and are replaced by a list of the changes.
    pub fn scene_to_save(&self) -> Scene {
        let mut scene = self.scene.clone().into_scene();
        let (base, name) = match &self.files.source {
            Some(source) => (&source.scene, source.name.as_str()),
            None => (&*self.files.opened, "the opened scene"),
        };
        let mut changes: Vec<_> = differences(base, &self.scene).collect();
        changes.retain(|(path, _)| !["title", "note"].contains(path));
        if changes.is_empty() {
            return scene;
        }
        let fits = |text: String, most: usize| text.chars().take(most).collect::<String>();
        // A title or note given by the user is kept.
        if scene.title == base.title {
            scene.title = fits(format!("changed from {name}"), 200);
        }
        if scene.note == base.note {
            let list: Vec<String> =
                changes.iter().map(|(path, value)| format!("{path} = {value}")).collect();
            scene.note = fits(format!("changed from {name}: {}", list.join(", ")), 4000);
        }
        // The name has characters that are not allowed in a title.
        if scene.checked().is_err() {
            (scene.title, scene.note) = ("changed".into(), String::new());
        }
        scene
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::command::Command;
    use crate::tui::files::FoundScene;
    use crate::tui::{Marker, Theme};
    use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

    fn press(app: &mut App, code: KeyCode) -> Effect {
        app.key(&KeyEvent::new(code, KeyModifiers::NONE))
    }

    fn app() -> App {
        App::new(Scene::base().checked().unwrap(), Theme::Dark, Marker::Braille)
    }

    #[test]
    fn a_file_that_takes_long_leaves_the_keys_alone_and_a_second_one_waits() {
        let mut app = app();
        press(&mut app, KeyCode::Char('s'));
        assert!(matches!(press(&mut app, KeyCode::Enter), Effect::Write(_)));
        assert_eq!(app.status.as_deref(), Some("writing scene.toml ..."));
        press(&mut app, KeyCode::Char('s'));
        assert_eq!(press(&mut app, KeyCode::Enter), Effect::None);
        let refused = "scene.toml not written: still writing scene.toml";
        assert_eq!(app.status.as_deref(), Some(refused));
        assert!(app.written(FileResult::Written) && app.files.writing.is_none());
        assert_eq!(app.status.as_deref(), Some("written: scene.toml"));
    }

    #[test]
    fn a_name_without_an_end_says_where_its_end_is() {
        let mut app = app();
        press(&mut app, KeyCode::Char('s'));
        let InputMode::Naming(_, name) = &app.dialogue.mode else { panic!() };
        for _ in name.text().len()..1000 {
            press(&mut app, KeyCode::Char('x'));
            assert_eq!(app.status, None);
        }
        press(&mut app, KeyCode::Char('x'));
        assert_eq!(app.status.as_deref(), Some("no room: at most 1000 characters"));
        press(&mut app, KeyCode::Backspace);
        assert_eq!(app.status, None);
    }

    #[test]
    fn the_question_whether_to_replace_takes_no_key_that_was_pressed_before_it() {
        let mut app = app();
        press(&mut app, KeyCode::Char('s'));
        press(&mut app, KeyCode::Enter);
        assert!(!app.written(FileResult::Exists));
        assert!(matches!(app.dialogue.mode, InputMode::Replacing(..)));
        // Nor does a key pressed before the question was drawn.
        assert_eq!(press(&mut app, KeyCode::Char('y')), Effect::None);
        assert!(matches!(app.dialogue.mode, InputMode::Replacing(..)));
        app.dialogue.unseen = false;
        let Effect::Write(job) = press(&mut app, KeyCode::Char('y')) else { panic!() };
        assert!(job.replace);
        // A key pressed before the result arrives suppresses the question: `y` copies instead.
        press(&mut app, KeyCode::Char('j'));
        assert!(!app.written(FileResult::Exists));
        assert_eq!(app.dialogue.mode, InputMode::Main);
        assert!(matches!(press(&mut app, KeyCode::Char('y')), Effect::Copy(_)));
    }

    #[test]
    fn quitting_asks_where_the_scene_is_changed_and_closes_one_level_before() {
        let mut app = app();
        press(&mut app, KeyCode::Right);
        press(&mut app, KeyCode::Char('f'));
        press(&mut app, KeyCode::Char('q'));
        assert!(!app.layout.full_screen && app.dialogue.is_closed());
        assert_eq!(press(&mut app, KeyCode::Char('q')), Effect::None);
        // Until the question is drawn, no key answers it.
        assert_eq!(press(&mut app, KeyCode::Char('q')), Effect::None);
        app.dialogue.unseen = false;
        assert_eq!(press(&mut app, KeyCode::Char('s')), Effect::None);
        assert!(matches!(press(&mut app, KeyCode::Enter), Effect::Write(_)));
        app.written(FileResult::Written);
        assert_eq!(press(&mut app, KeyCode::Char('q')), Effect::Quit);
        press(&mut app, KeyCode::Right);
        press(&mut app, KeyCode::Char('q'));
        app.dialogue.unseen = false;
        assert_eq!(press(&mut app, KeyCode::Char('q')), Effect::Quit);
    }

    #[test]
    fn a_folder_that_does_not_answer_is_asked_once_and_holds_nothing_up() {
        let mut app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Ascii);
        assert!(matches!(app.act(Command::Palette("scene ")), Effect::FindScenes(_)));
        app.act(Command::Close);
        assert_eq!(app.act(Command::Palette("scene ")), Effect::None);
        app.act(Command::Below);
        let chosen = app.scene_entries()[1].name.clone();
        // A file that arrives late does not move the selection.
        let scene = Ok(Scene::base().checked().unwrap());
        let files = vec![FoundScene { name: "late.toml".into(), scene, file: true }];
        app.scenes_found(FoundScenes { files, ..FoundScenes::default() });
        // Files come before built-in scenes.
        assert_eq!(app.scene_entries()[0].name, "late.toml");
        app.act(Command::Accept);
        assert_eq!(app.files.source.as_ref().unwrap().name, chosen);
        // The directory is read again.
        assert!(matches!(app.act(Command::Palette("scene ")), Effect::FindScenes(_)));
    }

    #[test]
    fn an_open_file_of_another_folder_is_in_the_list() {
        let mut app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Ascii);
        app.files.source = Some(Source { name: "other/mine.toml".into(), scene: Scene::base() });
        let entries = app.scene_entries();
        assert!(app.is_open_scene(&entries[0]) && entries[0].name == "other/mine.toml");
    }
}
