//! Knobs that act on a running motion, and their place on the screen. What they show is in
//! `tests/screens/knobs.txt`.

use rubscope::tui::{Marker, Theme};

use crate::tui_support::{Session, scene};

#[test]
fn a_damping_acts_on_the_running_motion_and_the_number_of_blades_begins_anew() {
    let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
    let before = session.app.now();
    session.select("casing.damping_ratio");
    session.press("cxL");
    assert!(session.app.now() > before, "the run restarted");
    assert!(session.app.scene.casing.damping_ratio > scene().casing.damping_ratio);
    session.press("u");
    let later = session.app.now();
    assert!(later > before && *session.app.scene == scene(), "undo restarted the run");
    session.select("bladed_disk.blades");
    session.press("l");
    assert_eq!(session.app.scene.bladed_disk.blades, 23);
    assert!(session.app.now() < later && session.text().contains("restarted"));
}

#[test]
fn the_selected_knob_is_in_sight_at_every_size() {
    for (width, height) in [(66, 12), (80, 15), (80, 24), (120, 40), (200, 50)] {
        let mut session = Session::open(width, height, scene(), Theme::Dark, Marker::Braille);
        // Nobody has a hundred knobs: the selection comes back to the first.
        for turn in 0..100 {
            let text = session.text();
            let signs =
                text.split('▸').skip(1).filter(|rest| rest.starts_with(char::is_alphabetic));
            assert_eq!(signs.count(), 1, "{text}");
            if turn > 0 && session.app.knobs.selected == 0 {
                break;
            }
            session.press("j");
        }
        assert_eq!(session.app.knobs.selected, 0);
    }
}
