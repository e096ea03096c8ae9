//! The pictures of the screen that the README shows are what the screen shows.
//! `RUBSCOPE_PICTURES=write cargo test pictures` makes them again.

use std::path::PathBuf;

use rubscope::scene::Scene;
use rubscope::tui::{Marker, Theme, export};

use crate::tui_screens::Session;

/// The screen of the default scene some milliseconds after its start.
fn picture(theme: Theme) -> String {
    let scene = Scene::builtin("paper-nd3").unwrap();
    let mut session = Session::open(120, 36, scene, theme, Marker::Braille);
    for _ in 0..3 {
        session.press("");
    }
    export::svg(&session.app)
}

#[test]
fn the_pictures_of_the_readme_are_fresh() {
    for (name, theme) in [("dark", Theme::Dark), ("light", Theme::Light)] {
        let file = format!("assets/pictures/screen-{name}.svg");
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(&file);
        let now = picture(theme);
        if std::env::var("RUBSCOPE_PICTURES").is_ok_and(|value| value == "write") {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, &now).unwrap();
        }
        let kept = std::fs::read_to_string(&path).unwrap();
        assert!(kept == now, "{file} is not what the screen shows: make it again");
    }
}
