//! The screen for a projector, and two contact laws compared over the whole height.

use rubscope::tui::{Marker, Theme};

use crate::tui_support::{Session, scene};

#[test]
fn the_screen_for_a_projector_has_one_chart_large_letters_and_the_knob() {
    for (name, marker, width, height) in [
        ("projector_80x24", Marker::Braille, 80, 24),
        ("projector_120x40", Marker::Braille, 120, 40),
        ("projector_ascii_80x24", Marker::Ascii, 80, 24),
    ] {
        let mut session = Session::open(width, height, scene(), Theme::Mono, marker);
        session.press("P ");
        let text = session.text();
        assert!(marker != Marker::Ascii || text.is_ascii(), "{text}");
        assert!(!text.contains("2 gaps") && !text.contains("pulse F"), "{text}");
        insta::assert_snapshot!(name, text);
    }
}

#[test]
fn a_projector_shows_one_chart_also_where_the_whole_screen_had_two() {
    let mut session = Session::open(120, 60, scene(), Theme::Mono, Marker::Braille);
    session.press("1f");
    assert!(session.text().contains("response, blades"), "{}", session.text());
    session.press("P");
    let text = session.text();
    assert!(text.contains("1 response") && !text.contains("response, blades"), "{text}");
}

#[test]
fn where_there_is_no_room_for_a_projector_the_usual_screen_stays() {
    let mut session = Session::open(40, 12, scene(), Theme::Dark, Marker::Braille);
    session.press("P");
    let text = session.text();
    assert!(text.contains(" LOCKED ") && text.contains("4 wheel"), "{text}");
}

#[test]
fn a_projector_shows_values_being_typed_refusals_lists_and_ends_with_escape() {
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
    session.press("P\n43");
    assert!(session.text().contains("speed Ω = 43_"), "{}", session.text());
    session.press("x\n");
    assert!(
        session.text().contains("speed Ω: 43x cannot be read: no unit x;"),
        "{}",
        session.text()
    );
    session.press("\u{1b}");
    session.press("?");
    assert!(session.text().contains("Type to find"), "{}", session.text());
    session.press("\u{1b}");
    assert!(session.app.appearance.wide);
    session.press("\u{1b}");
    assert!(
        !session.app.appearance.wide && session.text().contains("1 response"),
        "{}",
        session.text()
    );
}

#[test]
fn a_lesson_keeps_the_screen_on_which_it_begins() {
    for keys in ["g\n", ":polygon\n"] {
        for wide in ["", "P"] {
            let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
            session.press(wide);
            session.press(keys);
            assert!(session.app.lessons.progress.is_some(), "{keys:?}");
            assert_eq!(session.app.appearance.wide, !wide.is_empty(), "{keys:?}");
            assert!(session.text().contains("Lesson "), "{}", session.text());
        }
    }
    // The list alone changes nothing.
    let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
    session.press("Pg\u{1b}");
    assert!(session.app.appearance.wide);
}

/// Rows of the screen that a chart's upright axis goes through, by its column.
fn axis_rows(session: &Session, column: usize) -> usize {
    let is_axis = |sign: char| "│┤".contains(sign);
    session.text().lines().filter(|line| line.chars().nth(column).is_some_and(is_axis)).count()
}

#[test]
fn two_laws_have_the_whole_height_and_the_same_axes() {
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
    session.press("c");
    session.press("");
    let text = session.text();
    assert!(text.contains("bilateral: LOCKED") && text.contains("unilateral: DECAY"), "{text}");
    assert!(!text.contains("2 gaps") && !text.contains("pulse F"), "{text}");
    insta::assert_snapshot!("laws_80x24", text);
    let column = text.lines().find(|line| line.contains("0┤")).unwrap();
    let column = column.chars().position(|sign| sign == '┤').unwrap();
    assert!(axis_rows(&session, column) >= 14, "{text}");
    let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
    session.press("c");
    session.press("");
    let text = session.text();
    assert!(text.contains("pulse F") && !text.contains("2 gaps"), "{text}");
    insta::assert_snapshot!("laws_120x40", text);
    let row = text.lines().find(|line| line.contains("bilateral: LOCKED")).unwrap();
    assert!(row.contains("unilateral: DECAY"), "{text}");
}
