//! Files: the open scene, the list of scenes that can be opened, and writing the scene or the large
//! chart. No file is replaced without asking.

use std::path::{Component, Path, PathBuf};

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier};

use super::model::{App, Files, InputMode, Source, Writing};
use crate::sheet::line::clean;
use crate::tui::command::{Effect, Purpose};
use crate::tui::files::{FileResult, FoundScene, FoundScenes, builtin_scenes};
use crate::tui::list::draw_list;
use crate::tui::text::{columns, print, shorten, wrap};
use crate::tui::theme::Role;
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

    /// Returns the index of the selected scene: the chosen one, or the open one.
    pub fn scene_place(&self, entries: &[SceneEntry]) -> usize {
        let open = || entries.iter().position(|entry| entry.open).unwrap_or(0);
        self.dialogue.place.unwrap_or_else(open).min(entries.len().saturating_sub(1))
    }
}

/// Returns whether two paths name the same file, apart from `./`.
fn same_path<'a>(one: &'a Path, other: &'a Path) -> bool {
    let parts = |path: &'a Path| path.components().filter(|part| *part != Component::CurDir);
    parts(one).eq(parts(other))
}

impl App {
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

    /// Applies the list of scenes that were read; the selection stays on the same scene.
    pub fn scenes_found(&mut self, found: FoundScenes) {
        let is_listed = self.dialogue.mode == InputMode::Scenes;
        let chosen = self.dialogue.place.filter(|_| is_listed);
        let chosen = chosen.and_then(|place| self.scene_entries().get(place).cloned());
        self.files.found = found;
        if let Some(chosen) = chosen {
            let same = |entry: &SceneEntry| entry.name == chosen.name && entry.file == chosen.file;
            self.dialogue.place = self.scene_entries().iter().position(same);
        }
    }

    /// Opens a scene of the list. Undo returns to the previous one.
    ///
    /// # Errors
    /// One line that says why the file has no valid scene.
    pub fn open_entry(&mut self, entry: &SceneEntry) -> Result<(), String> {
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

/// Width from which the note is beside the list.
const BESIDE_FROM: u16 = 100;
/// Width of the list beside a note.
const LIST_WIDTH: u16 = 64;
/// Widest scene name.
const NAME_WIDTH: usize = 24;

/// Draws the list of scenes.
pub fn draw_scenes(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    let mark = look.ellipsis();
    let entries = app.scene_entries();
    let place = app.scene_place(&entries);
    let found = &app.files.found;
    let head = match (&found.missing, found.reading) {
        (_, true) => "Scenes: reading the files of this folder".to_string(),
        (Some(missing), false) => format!("Scenes: {missing}"),
        (None, false) => "Scenes: Enter opens one, u returns to the previous one".to_string(),
    };
    let bold = look.style(Role::Text).add_modifier(Modifier::BOLD);
    print(buffer, area, 0, &shorten(&look.spell(&head), usize::from(area.width), mark), bold);
    let area = Rect { y: area.y + 1, height: area.height.saturating_sub(1), ..area };
    let selected = entries.get(place);
    let beside = area.width >= BESIDE_FROM;
    let notes_width = if beside { area.width - LIST_WIDTH - 2 } else { area.width };
    let notes =
        selected.map_or(Vec::new(), |entry| note_lines(app, entry, usize::from(notes_width)));
    let (list, text) = if beside {
        let text = Rect { x: area.x + LIST_WIDTH + 2, width: notes_width, ..area };
        (Rect { width: LIST_WIDTH, ..area }, text)
    } else {
        let wanted = u16::try_from(notes.len() + 1).unwrap_or(u16::MAX);
        let rows = wanted.min(area.height / 2);
        let list = Rect { height: area.height.saturating_sub(rows), ..area };
        (list, Rect { y: list.bottom(), height: rows, ..area })
    };
    draw_entries(app, buffer, list, &entries, place);
    if let Some(entry) = selected {
        draw_note(app, buffer, text, entry, &notes);
    }
}

fn draw_entries(app: &App, buffer: &mut Buffer, area: Rect, entries: &[SceneEntry], place: usize) {
    let look = &app.appearance;
    let mark = look.ellipsis();
    let names = entries.iter().map(|entry| columns(&entry.name));
    let wide = names.max().unwrap_or(0).min(NAME_WIDTH);
    let line = |entry: &SceneEntry| {
        let (title, role) = match &entry.scene {
            Ok(scene) => (scene.title.as_str(), Role::Text),
            Err(_) => ("cannot be read", Role::Trouble),
        };
        let open = if entry.open { '*' } else { ' ' };
        let name = shorten(&look.spell(&entry.name), wide, mark);
        let pad = " ".repeat(wide.saturating_sub(columns(&name)));
        let text = format!("{open} {name}{pad}  {}", look.spell(title));
        (shorten(&text, usize::from(area.width.saturating_sub(1)), mark), role)
    };
    draw_list(look, buffer, area, entries.iter().map(line), place);
}

/// Returns the note of a scene, or why it cannot be opened, as lines.
fn note_lines(app: &App, entry: &SceneEntry, width: usize) -> Vec<(String, Role)> {
    let (text, role) = match &entry.scene {
        Ok(scene) if scene.note.is_empty() => ("It has no note.", Role::Quiet),
        Ok(scene) => (scene.note.as_str(), Role::Text),
        Err(error) => (error.as_str(), Role::Trouble),
    };
    wrap(&app.appearance.spell(text), width).into_iter().map(|line| (line, role)).collect()
}

/// Prints a page of the note below a rule with the scene's name.
fn draw_note(
    app: &App,
    buffer: &mut Buffer,
    area: Rect,
    entry: &SceneEntry,
    lines: &[(String, Role)],
) {
    let look = &app.appearance;
    let (width, mark) = (usize::from(area.width), look.ellipsis());
    let room = usize::from(area.height.saturating_sub(1)).max(1);
    let pages = lines.len().div_ceil(room).max(1);
    let page = app.dialogue.note_page % pages;
    let open = if entry.open { " (open)" } else { "" };
    let more = match pages {
        1 => String::new(),
        _ => format!("  {}/{pages}, Space: more", page + 1),
    };
    let left = width.saturating_sub(columns(open) + columns(&more) + 3);
    let name = shorten(&look.spell(&entry.name), left, mark);
    let dash = look.either("─", "-");
    let head = format!("{dash} {name}{open}{more} ");
    let rule = dash.repeat(width.saturating_sub(columns(&head)));
    print(buffer, area, 0, &format!("{head}{rule}"), look.style(Role::Quiet));
    let shown = lines.iter().skip(page * room);
    for (row, (text, role)) in (1..area.height).zip(shown) {
        print(buffer, area, row, text, look.style(*role));
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
        app.dialogue.asked = true;
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
        app.dialogue.asked = true;
        assert_eq!(press(&mut app, KeyCode::Char('s')), Effect::None);
        assert!(matches!(press(&mut app, KeyCode::Enter), Effect::Write(_)));
        app.written(FileResult::Written);
        assert_eq!(press(&mut app, KeyCode::Char('q')), Effect::Quit);
        press(&mut app, KeyCode::Right);
        press(&mut app, KeyCode::Char('q'));
        app.dialogue.asked = true;
        assert_eq!(press(&mut app, KeyCode::Char('q')), Effect::Quit);
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
        assert_eq!(app.scene_place(&entries), 0);
    }
}
