//! Files: writing the scene, the data of the large chart or the screen, and opening a scene from
//! the list. No file is replaced without asking.

use crate::report::line::clean;
use crate::tui::app::{App, InputMode, SceneEntry, Source, Writing};
use crate::tui::command::{Effect, Purpose};
use crate::tui::export;
use crate::tui::files::{FileJob, FileResult, FoundScenes};
use rubscope_solver::scene::keys::{differences, is_plain};
use rubscope_solver::scene::{CheckedScene, Scene};

impl App {
    /// Asks for the name of the file to write.
    pub(super) fn ask_name(&mut self, purpose: Purpose) {
        let name = match purpose {
            Purpose::Save => "scene.toml".to_string(),
            Purpose::Export => format!("{}.csv", self.view().word()),
        };
        self.dialogue.open(InputMode::Naming(purpose, name.into()));
    }

    /// Replaces the file of the open question. A key typed before the question was drawn does not
    /// answer it.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub(super) fn replace_file(&mut self) -> Result<Effect, String> {
        match self.dialogue.mode.clone() {
            InputMode::Replacing(purpose, name) if self.dialogue.asked => {
                self.write(purpose, &name, true)
            }
            _ => Ok(Effect::None),
        }
    }

    /// Starts writing a file. If it exists and `replace` is false, the result will ask the user.
    ///
    /// # Errors
    /// One line that says why nothing is written: the name, another file being written, or no data.
    pub(super) fn write(
        &mut self,
        purpose: Purpose,
        name: &str,
        replace: bool,
    ) -> Result<Effect, String> {
        let name = name.trim();
        if name.is_empty() {
            return Err("a file name is needed; Esc leaves".into());
        }
        if !name.chars().all(is_plain) {
            return Err("a file name of letters that can be seen is needed".into());
        }
        self.dialogue.close();
        if let Some(writing) = &self.files.writing {
            return Err(format!("{name} not written: still writing {}", writing.name));
        }
        let content = match purpose {
            Purpose::Save => Ok(self.scene_to_save().to_toml()),
            Purpose::Export if name.ends_with(".svg") => Ok(export::svg(self)),
            Purpose::Export => self.panel().csv(self),
        };
        let content = content.map_err(|reason| format!("nothing exported: {reason}"))?;
        self.status = Some(format!("writing {name} ..."));
        self.files.writing = Some(Writing { name: name.into(), purpose, undisturbed: true });
        Ok(Effect::Write(FileJob { path: self.files.directory.join(name), content, replace }))
    }

    /// Handles the result of the write; returns whether the file was written.
    pub fn written(&mut self, result: FileResult) -> bool {
        let Some(Writing { name, purpose, undisturbed }) = self.files.writing.take() else {
            return true;
        };
        self.status = match &result {
            FileResult::Written => Some(format!("written: {name}")),
            FileResult::Failed(reason) => Some(format!("cannot write {name}: {reason}")),
            FileResult::Exists if undisturbed => {
                self.dialogue.ask(InputMode::Replacing(purpose, name));
                None
            }
            // Keys pressed since then were meant for something else and must not answer the
            // question.
            FileResult::Exists => Some(format!("{name} exists and is as it was; save again")),
        };
        result == FileResult::Written
    }

    /// Records that a frame has shown the current state, so that keys may now answer an open
    /// question.
    pub fn drawn(&mut self) {
        self.dialogue.asked = true;
    }

    /// Returns the command line for the clipboard, and shows it in the status line: whether the
    /// terminal takes it is not known.
    pub(super) fn copied(&mut self) -> String {
        let command = self.command();
        self.status = Some(format!("sent to the terminal to copy: {command}"));
        command
    }

    /// Requests the scene files of the directory.
    pub(super) fn find_scenes(&mut self) -> Effect {
        if std::mem::replace(&mut self.files.found.reading, true) {
            // A directory that does not respond is read only once at a time.
            return Effect::None;
        }
        Effect::FindScenes(self.files.directory.clone())
    }

    /// Applies the list of scenes that were read; the selection stays on the same scene.
    pub fn scenes_found(&mut self, found: FoundScenes) {
        let chosen = match &self.dialogue.mode {
            InputMode::Scenes(Some(place)) => self.scene_entries().get(*place).cloned(),
            _ => None,
        };
        self.files.found = found;
        if let Some(chosen) = chosen {
            let same = |entry: &SceneEntry| entry.name == chosen.name && entry.file == chosen.file;
            self.dialogue.mode = InputMode::Scenes(self.scene_entries().iter().position(same));
        }
    }

    /// Opens the scene of this name, if the list has it.
    ///
    /// # Errors
    /// As [`Self::open_entry`].
    pub(super) fn open_named(&mut self, name: &str) -> Result<(), String> {
        let entries = self.scene_entries();
        let entry = entries.iter().find(|entry| entry.name == name);
        entry.map_or(Ok(()), |entry| self.open_entry(entry))
    }

    /// Opens a scene of the list. Undo returns to the previous one.
    ///
    /// # Errors
    /// One line that says why the file has no valid scene.
    pub(super) fn open_entry(&mut self, entry: &SceneEntry) -> Result<(), String> {
        let name = clean(&entry.name);
        let refused = |why: &String| format!("{name} cannot be opened: {why}");
        let scene = entry.scene.as_ref().map_err(refused)?;
        let path = match entry.file && !entry.open {
            true => self.files.directory.join(&entry.name).to_string_lossy().into_owned(),
            false => entry.name.clone(),
        };
        self.dialogue.close();
        self.open_scene(path, scene.clone());
        self.status = Some(format!("opened {name}"));
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
        self.map = self.map.anchored(&scene);
        self.stop_reading();
        self.play.open(&scene);
        self.knobs.refusal = None;
        self.set_scene(scene, false);
    }

    /// Returns the scene to save. If knobs were turned, the title and note of the opened scene no
    /// longer apply and are replaced by a list of the changes.
    pub(super) fn scene_to_save(&self) -> Scene {
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
        assert_eq!(app.status.as_deref(), Some("no room: at most 1000 letters"));
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
        app.drawn();
        let Effect::Write(job) = press(&mut app, KeyCode::Char('y')) else { panic!() };
        assert!(job.replace);
        // A key pressed before the result arrives suppresses the question: `y` copies instead.
        press(&mut app, KeyCode::Char('j'));
        assert!(!app.written(FileResult::Exists));
        assert_eq!(app.dialogue.mode, InputMode::Main);
        assert!(matches!(press(&mut app, KeyCode::Char('y')), Effect::Copy(_)));
    }

    #[test]
    fn the_command_names_what_differs_and_nothing_else() {
        let mut scene = Scene::builtin("paper-nd3").unwrap();
        let app = App::new(scene.checked().unwrap(), Theme::Dark, Marker::Braille);
        assert_eq!(app.command(), "rubscope run paper-nd3");
        scene.set("operation.speed_rad_s", "-430").unwrap();
        scene.set("solver.contact", "unilateral").unwrap();
        scene.set("title", "it's mine").unwrap();
        let app = App::new(scene.checked().unwrap(), Theme::Dark, Marker::Braille);
        assert_eq!(
            app.command(),
            "rubscope run paper-nd3 --set 'title=it'\\''s mine' \
             --set operation.speed_rad_s=-430.0 --set solver.contact=unilateral"
        );
    }

    #[test]
    fn a_folder_that_does_not_answer_is_asked_once_and_holds_nothing_up() {
        let mut app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Ascii);
        assert!(matches!(app.act(Command::Scenes), Effect::FindScenes(_)));
        app.act(Command::Close);
        assert_eq!(app.act(Command::Scenes), Effect::None);
        app.act(Command::Below);
        let chosen = app.scene_entries()[1].name.clone();
        // A file that arrives late does not move the selection.
        let scene = Ok(Scene::base().checked().unwrap());
        let files = vec![FoundScene { name: "late.toml".into(), scene }];
        app.scenes_found(FoundScenes { files, ..FoundScenes::default() });
        // Files come before built-in scenes.
        assert_eq!(app.scene_entries()[0].name, "late.toml");
        app.act(Command::Accept);
        assert_eq!(app.files.source.as_ref().unwrap().name, chosen);
        // The directory is read again.
        assert!(matches!(app.act(Command::Scenes), Effect::FindScenes(_)));
    }

    #[test]
    fn an_open_file_of_another_folder_is_in_the_list() {
        let mut app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Ascii);
        app.files.source = Some(Source { name: "other/mine.toml".into(), scene: Scene::base() });
        let entries = app.scene_entries();
        assert!(entries[0].open && entries[0].name == "other/mine.toml");
        assert_eq!(app.scene_place(&entries, None), 0);
    }
}
