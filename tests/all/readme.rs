//! What the README promises of the explorer: its pictures and its first minute.
//! `RUBSCOPE_PICTURES=write cargo test readme` makes the pictures again.

use std::path::PathBuf;

use rubscope::scene::Scene;
use rubscope::tui::{Marker, Theme, export};

use crate::tui_support::Session;

fn open(theme: Theme) -> Session {
    let scene = Scene::builtin("paper-nd3").unwrap();
    Session::open(120, 40, scene, theme, Marker::Braille)
}

/// The screen of the default scene some milliseconds after its start.
fn picture(theme: Theme) -> String {
    let mut session = open(theme);
    for _ in 0..3 {
        session.press("");
    }
    export::svg(&session.app)
}

#[test]
fn the_pictures_are_what_the_screen_shows() {
    for (name, theme) in [("dark", Theme::Dark), ("light", Theme::Light)] {
        let file = format!("assets/pictures/screen-{name}.svg");
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(&file);
        let now = picture(theme);
        if std::env::var("RUBSCOPE_PICTURES").is_ok_and(|value| value == "write") {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, &now).unwrap();
        }
        let kept = std::fs::read_to_string(&path).unwrap();
        assert!(
            kept == now,
            "{file} is not what the screen shows: RUBSCOPE_PICTURES=write cargo test readme makes it again"
        );
    }
}

/// The first line of the screen, and the line of the other verdict below it.
fn header(session: &Session) -> String {
    session.text().lines().take(3).collect::<Vec<_>>().join("\n")
}

#[test]
fn the_first_minute_is_as_it_says() {
    let mut session = open(Theme::Mono);
    let start = header(&session);
    assert!(start.contains("500 rad/s") && start.contains("LOCKED"), "{start}");
    assert!(start.contains("Blades 12 and 19"), "{start}");
    // The speed is the selected knob.
    session.press("\n400\n");
    session.press("");
    assert!(header(&session).contains("ADHESIVE"), "{}", header(&session));
    session.press("ucr");
    session.press("");
    let both = session.text();
    assert_eq!(session.app.scene.operation.speed_rad_s, 500.0);
    assert!(both.contains("LOCKED") && both.contains("unilateral: DECAY"), "{both}");
    session.press("c5");
    session.press("");
    assert_eq!(session.app.view().word(), "map");
    assert!(session.text().contains("5 map"), "{}", session.text());
    session.press("\u{1b}g");
    assert!(session.text().contains("Lessons"), "{}", session.text());
}
