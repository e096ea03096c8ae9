use super::*;
use crate::tui::Theme;
use crate::tui::command::Command;
use crate::tui::lessons;
use rubscope_solver::scene::Scene;

fn app() -> App {
    App::new(Scene::base().checked().unwrap(), Theme::Dark, Marker::Braille)
}

/// Starts on this file, does this, and ends.
fn session(path: &Path, does: impl FnOnce(&mut App)) -> App {
    let mut memory = Memory::at(Some(path.into()));
    let mut app = app();
    memory.prepare(&mut app);
    let state = app.clone();
    does(&mut app);
    memory.keep(&app, Duration::MAX);
    state
}

fn read(path: &Path) -> Config {
    Config::read(path).unwrap().0
}

#[test]
fn the_unit_of_speeds_is_remembered_and_can_be_written_by_hand() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("config.toml");
    std::fs::write(&path, "[units]\nspeed = \"rpm\"\n").unwrap();
    let first = session(&path, |app| _ = app.act(Command::SpeedUnit));
    assert!(first.appearance.rpm);
    assert_eq!(read(&path).units.speed, Some(SpeedUnit::Radians));
    assert!(!session(&path, |_| {}).appearance.rpm);
    std::fs::write(&path, "[units]\nspeed = \"knots\"\n").unwrap();
    assert!(
        Memory::at(Some(path.clone())).complaint.unwrap().starts_with("config.toml is not used")
    );
    std::fs::write(&path, "units = \"rpm\"\n").unwrap();
    let complaint = Memory::at(Some(path)).complaint.unwrap();
    assert!(complaint.contains("expected for units a table: units.speed = \"rpm\""), "{complaint}");
    assert_eq!(complaint.lines().count(), 1);
}

#[test]
fn a_file_is_written_only_if_something_changed_and_keeps_what_is_not_known() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("config.toml");
    let text = "later = 3\nintroduced=true\ncharts = 99\n[lessons]\ndone = [\"lock\"]\n";
    std::fs::write(&path, text).unwrap();
    assert_eq!(session(&path, |_| {}).layout.beside, MOST_BESIDE);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    session(&path, |app| _ = app.act(Command::NextTheme));
    let text = std::fs::read_to_string(&path).unwrap();
    for kept in ["later = 3", "[lessons]", "done = [\"lock\"]", "theme = \"light\""] {
        assert!(text.contains(kept), "{text}");
    }
}

#[test]
fn a_file_that_cannot_be_used_is_named_and_left_alone() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("config.toml");
    let long = "#".repeat(70_000);
    for text in ["theme = \"pink\"", "charts = -1", "\u{1b}[2J", "[[", &long, "mouse = \u{1b}"] {
        std::fs::write(&path, text).unwrap();
        let started = session(&path, |app| _ = app.act(Command::NextTheme));
        let status = started.status.unwrap();
        assert!(status.starts_with("config.toml is not used: "), "{status}");
        assert!(!status.contains(['\n', '\u{1b}']) && !started.dialogue.is_new, "{status}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    }
    std::fs::write(&path, [0xff, 0xfe]).unwrap();
    assert!(session(&path, |_| {}).status.is_some());
    std::fs::remove_file(&path).unwrap();
    std::fs::create_dir(&path).unwrap();
    assert!(session(&path, |_| {}).status.is_some());
}

#[test]
fn without_a_folder_nothing_is_remembered_and_nothing_is_said() {
    let started = session(Path::new("/dev/null/rubscope/config.toml"), |app| {
        app.act(Command::NextTheme);
    });
    assert_eq!(started.status, None);
    let memory = Memory::at(None);
    assert_eq!((memory.complaint, memory.path), (None, None));
}

#[test]
fn a_home_that_does_not_exist_is_not_made() {
    let home = tempfile::tempdir().unwrap();
    let none = home.path().join("none");
    assert!(is_at_home(&home.path().join(".config"), home.path()));
    assert!(!is_at_home(&none.join(".config"), &none));
    // A folder that the user names is.
    assert!(is_at_home(&home.path().join("xdg"), &none));
}

#[test]
fn the_steps_that_were_done_are_there_at_the_next_start_with_those_of_another_explorer() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("config.toml");
    let (lock, slip) = (&lessons::all()[1], &lessons::all()[5]);
    session(&path, |app| {
        app.lessons.done.add(lock, 0);
        session(&path, |other| other.lessons.done.add(slip, 2));
    });
    let next = session(&path, |_| {});
    assert!(next.lessons.done.has(lock, 0) && next.lessons.done.has(slip, 2));
    // Without a file there are none.
    let mut app = app();
    Memory::at(None).prepare(&mut app);
    assert!(app.lessons.done.is_empty());
}
