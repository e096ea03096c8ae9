//! Keys, signals and sizes that come to the explorer: pause and steps, files, and ways to leave.

use rubscope::tui::events::ScreenEvent;
use rubscope::tui::{Exit, Marker, Theme};
use rubscope_solver::scene::Scene;

use crate::tui_support::{Session, key, scene};

#[test]
fn pause_stops_time_and_a_step_is_one_step() {
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
    session.press(" ");
    let before = session.app.now();
    session.press("");
    assert_eq!(session.app.now(), before);
    session.press("...");
    let steps = (session.app.now() - before) / session.app.scene.solver.step_s;
    // Three steps, to the round-off of a time that is a multiple of a step.
    assert!((steps - 3.0).abs() < 1e-6, "{steps}");
}

#[test]
fn signals_and_a_lost_terminal_end_with_their_number() {
    for (event, number) in [(ScreenEvent::Signal(15), 15), (ScreenEvent::InputClosed, 1)] {
        let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
        assert_eq!(session.send([event].into_iter()), Exit::Signal(number));
    }
}

#[test]
fn a_file_is_never_replaced_without_asking() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let name = path.to_str().unwrap().to_string();
    let erase = "\u{8}".repeat(40);
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
    session.press(&format!("s{erase}{name}\n"));
    assert_eq!(Scene::load(&name).unwrap(), scene());
    std::fs::write(&path, "mine").unwrap();
    session.press(&format!("s{erase}{name}\n"));
    assert!(session.text().contains("y replaces it"), "{}", session.text());
    session.press("n");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "mine");
    session.press(&format!("s{erase}{name}\n"));
    session.press("y");
    assert_eq!(Scene::load(&name).unwrap(), scene());
    for (view, file) in [("1", "a.csv"), ("2", "b.csv"), ("3", "c.csv"), ("1", "d.svg")] {
        let path = folder.path().join(file);
        let name = path.to_str().unwrap();
        session.press(view);
        session.press(&format!("e{erase}{name}\n"));
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.len() > 100 && !text.contains("NaN"), "{file}: {text}");
    }
}

#[test]
fn a_storm_of_sizes_between_keys_leaves_one_picture_of_the_last() {
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Dot);
    for (width, height) in [(40, 12), (1, 1), (200, 60), (0, 0), (39, 11), (97, 31)] {
        session.terminal.backend_mut().resize(width, height);
        let storm =
            "\t[]fwf".chars().cycle().take(300).map(key).flat_map(|key| {
                std::iter::repeat_with(|| ScreenEvent::Resize).take(10).chain([key])
            });
        session.send(storm);
        assert_eq!(session.app.layout.size, (width, height));
    }
    assert!(session.text().contains(" LOCKED "), "{}", session.text());
}
