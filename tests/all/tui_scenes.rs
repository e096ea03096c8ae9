//! The list of scenes on the screen, and what a saved scene says about itself.

use rubscope::tui::{App, Marker, Source, Theme};
use rubscope_solver::scene::{BUILTIN, Scene};

use super::tui_support::{Session, scene};

/// A folder with a scene that can be opened and one that cannot.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut mine = scene();
    (mine.title, mine.note) = ("My own blades".into(), "What I look for.".into());
    mine.operation.speed_rad_s = 430.0;
    std::fs::write(folder.path().join("mine.toml"), mine.to_toml()).unwrap();
    std::fs::write(folder.path().join("broken.toml"), "[casing]\ncolour = 1").unwrap();
    folder
}

fn open(width: u16, height: u16, folder: &tempfile::TempDir, marker: Marker) -> Session {
    let mut session = Session::searched(width, height, scene(), Theme::Mono, marker);
    session.app.files.directory = folder.path().to_path_buf();
    session.press("o");
    session
}

#[test]
fn the_list_shows_built_in_scenes_and_files_with_the_note_of_the_open_one() {
    let folder = folder();
    for (width, height) in [(120, 40), (80, 24)] {
        let session = open(width, height, &folder, Marker::Braille);
        let text = session.text();
        // A low screen has the part of the list around the chosen one.
        for builtin in BUILTIN.iter().filter(|_| height == 40) {
            assert!(text.contains(builtin.name), "{text}");
        }
        // Own scenes come first.
        assert!(text.find("mine.toml: My own blades") < text.find("paper-nd3: "), "{text}");
        assert!(text.contains("mine.toml"), "{text}");
        let open = text.lines().find(|line| line.contains("▸scene paper-nd3: ")).unwrap();
        assert!(open.trim_end().ends_with("open"), "{text}");
        // Its note, which no other part of the screen shows.
        assert!(text.contains("The algorithm of the paper"), "{text}");
        insta::assert_snapshot!(format!("scenes_{width}x{height}"), text);
    }
    let small = open(40, 12, &folder, Marker::Ascii).text();
    assert!(small.is_ascii() && small.contains(">scene paper-nd3"), "{small}");
    assert!(small.contains("The algorithm of the paper"), "{small}");
}

#[test]
fn a_broken_file_says_why_and_is_not_opened() {
    let folder = folder();
    let mut session = open(100, 30, &folder, Marker::Braille);
    // What is no scene comes last.
    session.press(&"↓".repeat(BUILTIN.len()));
    let text = session.text();
    assert!(text.contains("unknown key casing.colour"), "{text}");
    session.press("\n");
    assert!(session.text().contains("broken.toml cannot be opened"), "{}", session.text());
    session.press("\u{1b}");
    assert_eq!(*session.app.scene, scene());
}

#[test]
fn a_scene_is_opened_with_its_charts_and_undo_brings_the_former_back() {
    let folder = folder();
    let mut session = open(120, 40, &folder, Marker::Braille);
    let before = session.app.clone();
    session.press("↑\n");
    assert_eq!(session.app.scene.title, "My own blades");
    // Now it is the scene whose values Backspace means, and the one marked.
    session.press("\n300\n\u{8}");
    assert_eq!(session.app.scene.operation.speed_rad_s, 430.0);
    session.press("o");
    let text = session.text();
    let open = text.lines().find(|line| line.contains("▸scene mine.toml: ")).unwrap();
    assert!(open.trim_end().ends_with("open"), "{text}");
    session.press("\u{1b}uuu");
    let same = |app: &App| app.scene == before.scene && app.files.opened == before.files.opened;
    assert!(same(&session.app) && session.app.files.source == before.files.source);
    // A built-in one begins with its own charts.
    let rocking = BUILTIN.iter().position(|scene| scene.name == "rocking").unwrap();
    session.press(&format!("o{}\n", "↓".repeat(rocking)));
    assert_eq!(session.app.view().word(), Scene::builtin("rocking").unwrap().view.charts[0]);
    let command = session.app.command_line().to_string();
    assert!(command.starts_with("rubscope run rocking"), "{command}");
}

#[test]
fn a_scene_opened_in_a_lesson_ends_the_lesson() {
    let folder = folder();
    let mut session = Session::open(120, 40, scene(), Theme::Mono, Marker::Braille);
    session.app.files.directory = folder.path().to_path_buf();
    session.press("g\no");
    session.press("↓\n");
    assert!(session.app.lessons.progress.is_none());
    session.press("u");
    assert!(session.app.lessons.progress.is_some() && session.app.is_asked());
}

/// What is in the file after the scene is saved.
fn saved(session: &mut Session, folder: &tempfile::TempDir) -> Scene {
    let path = folder.path().join("saved.toml");
    let _ = std::fs::remove_file(&path);
    session.press(&format!("s{}{}\n", "\u{8}".repeat(40), path.to_str().unwrap()));
    Scene::load(path.to_str().unwrap()).unwrap()
}

#[test]
fn a_saved_scene_keeps_no_note_that_its_values_made_false() {
    let folder = tempfile::tempdir().unwrap();
    let paper = Scene::builtin("paper-nd3").unwrap();
    let mut session = Session::open(80, 24, paper.clone(), Theme::Mono, Marker::Braille);
    session.app.files.source = Some(Source { name: "paper-nd3".into(), scene: paper.clone() });
    assert_eq!(saved(&mut session, &folder), paper);
    session.press("\n430\n");
    let changed = saved(&mut session, &folder);
    assert_eq!(changed.title, "changed from paper-nd3");
    assert_eq!(changed.note, "changed from paper-nd3: operation.speed_rad_s = 430.0");
    assert_eq!(changed.operation.speed_rad_s, 430.0);
    session.press("u");
    assert_eq!(saved(&mut session, &folder), paper);
    // Words that the user gave stay.
    let mut named = paper.clone();
    (named.title, named.operation.speed_rad_s) = ("mine".into(), 430.0);
    let mut session = Session::open(80, 24, named, Theme::Mono, Marker::Braille);
    session.app.files.source = Some(Source { name: "paper-nd3".into(), scene: paper });
    let kept = saved(&mut session, &folder);
    assert_eq!(kept.title, "mine");
    assert!(kept.note.starts_with("changed from paper-nd3"), "{}", kept.note);
}
