//! Writing files: the scene as TOML, the data of the large chart as CSV, the
//! screen as SVG. No file is replaced without a question.

use std::path::PathBuf;

use super::{App, Effect, InputMode, Purpose, Source};
use crate::scene::CheckedScene;
use crate::tui::export;
use crate::tui::files::{FileJob, FileResult};
use crate::tui::scenes::FoundScenes;

/// A file that is being written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Writing {
    /// Its name, as typed.
    pub name: String,
    purpose: Purpose,
    /// Whether no key was pressed since.
    undisturbed: bool,
}

/// The files, and the open scene.
#[derive(Clone, Debug)]
pub struct Files {
    /// Where files are written; the working directory unless set.
    pub directory: PathBuf,
    /// The scene as it was opened; `Backspace` restores its values.
    pub opened: CheckedScene,
    /// Where the scene is from, for the command line that repeats the run.
    pub source: Option<Source>,
    /// The file that is being written.
    pub writing: Option<Writing>,
    /// The scenes of the directory, as they were last read.
    pub found: FoundScenes,
}

impl Files {
    /// With this scene open.
    pub(super) fn of(opened: CheckedScene) -> Self {
        let (directory, found) = (PathBuf::new(), FoundScenes::default());
        Self { directory, opened, source: None, writing: None, found }
    }

    /// The scene as it was opened.
    pub(super) fn opened(&self) -> &CheckedScene {
        &self.opened
    }

    /// Where it is from.
    pub(super) fn source(&self) -> Option<&Source> {
        self.source.as_ref()
    }

    /// Makes another scene the open one; without a source that stays.
    pub(super) fn open(&mut self, scene: CheckedScene, source: Option<Source>) {
        self.opened = scene;
        self.source = source.or(self.source.take());
    }

    /// The open scene as it was.
    pub(super) fn reopen(&mut self, scene: CheckedScene, source: Option<Source>) {
        (self.opened, self.source) = (scene, source);
    }

    /// A key was pressed while a file is being written.
    pub(super) fn disturb(&mut self) {
        if let Some(writing) = &mut self.writing {
            writing.undisturbed = false;
        }
    }
}

impl App {
    /// Has a file written; where one exists, the result is a question.
    pub(super) fn write(&mut self, purpose: Purpose, name: &str, replace: bool) -> Effect {
        let name = name.trim();
        if name.is_empty() {
            self.status = Some("a file name is needed; Esc leaves".into());
            return Effect::None;
        }
        self.dialogue.close();
        if let Some(writing) = &self.files.writing {
            self.status = Some(format!("{name} not written: still writing {}", writing.name));
            return Effect::None;
        }
        let content = match purpose {
            Purpose::Save => Ok(self.scene_to_save().to_toml()),
            Purpose::Export if name.ends_with(".svg") => Ok(export::svg(self)),
            Purpose::Export => self.panel().csv(self),
        };
        match content {
            Ok(content) => {
                self.status = Some(format!("writing {name} ..."));
                self.files.writing =
                    Some(Writing { name: name.into(), purpose, undisturbed: true });
                Effect::Write(FileJob { path: self.files.directory.join(name), content, replace })
            }
            Err(reason) => {
                self.status = Some(format!("nothing exported: {reason}"));
                Effect::None
            }
        }
    }

    /// Tells how the writing of the file went; whether it is written.
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
            // A key that was meant for something else must not be the answer.
            FileResult::Exists => Some(format!("{name} exists and is as it was; save again")),
        };
        result == FileResult::Written
    }

    /// The screen shows this state: from now on a key can be the answer to its
    /// question, and a sweep can go on.
    pub fn drawn(&mut self) {
        self.dialogue.drawn();
        self.sweep_on();
    }
}

#[cfg(test)]
mod tests {
    use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

    use super::*;
    use crate::scene::Scene;
    use crate::tui::{Marker, Theme};

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
        for _ in name.len()..200 {
            press(&mut app, KeyCode::Char('x'));
            assert_eq!(app.status, None);
        }
        press(&mut app, KeyCode::Char('x'));
        assert_eq!(app.status.as_deref(), Some("no room: at most 200 letters"));
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
        // Nor one that came before the screen showed it.
        assert_eq!(press(&mut app, KeyCode::Char('y')), Effect::None);
        assert!(matches!(app.dialogue.mode, InputMode::Replacing(..)));
        app.drawn();
        let Effect::Write(job) = press(&mut app, KeyCode::Char('y')) else { panic!() };
        assert!(job.replace);
        // Here a key comes before the answer: `y` copies, and is no answer.
        press(&mut app, KeyCode::Char('j'));
        assert!(!app.written(FileResult::Exists));
        assert_eq!(app.dialogue.mode, InputMode::Main);
        assert!(matches!(press(&mut app, KeyCode::Char('y')), Effect::Copy(_)));
    }
}
