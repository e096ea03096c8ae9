//! Text from outside on the screen: titles and names that would act on a
//! terminal, or break the layout, if they were shown as they are.

use ratatui::buffer::Buffer;
use rubscope::tui::events::ScreenEvent;
use rubscope::tui::{App, Marker, Theme};
use rubscope_solver::scene::Scene;

use crate::tui_support::{Session, key};

/// Escape sequences, a break of a line, text from right to left, characters
/// without a width, wide ones, and letters with many accents.
const HOSTILE: &str =
    "a\u{1b}[2J\u{9b}1m\u{2028}\u{202e}b\u{2066}\u{200d}\u{feff}叶片叶片\u{7}e\u{301}";

/// Letters that a title may have: wide ones, and one with an accent of its own.
const TITLE: &str = "叶片与机匣 e\u{301}";

/// The screen with this title and status after these events.
fn screen(title: &str, status: &str, marker: Marker, events: &[ScreenEvent]) -> (App, Buffer) {
    let mut scene = Scene::base();
    scene.solver.step_s = 1e-6;
    scene.title = title.to_string();
    let mut session = Session::with_stride((160, 30), 1e-4, scene, Theme::Dark, marker);
    session.app.status = Some(status.to_string()).filter(|status| !status.is_empty());
    session.send(events.iter().cloned());
    (session.app, session.terminal.backend().buffer().clone())
}

fn acts(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

/// No cell acts on the terminal or has a text of its own.
fn assert_harmless(buffer: &Buffer) {
    for cell in &buffer.content {
        assert!(!cell.symbol().contains(acts), "{:?}", cell.symbol());
        assert!(cell.symbol().len() < 8 * 160, "{} bytes in a cell", cell.symbol().len());
    }
}

#[test]
fn no_text_can_act_on_the_terminal_or_break_the_layout() {
    let (_, buffer) = screen(TITLE, HOSTILE, Marker::Braille, &[]);
    assert_harmless(&buffer);
    let row: String = buffer.content[..160].iter().map(|cell| cell.symbol()).collect();
    assert!(row.trim_end().ends_with("e\u{301}"), "the end of the title is cut: {row:?}");
    for long in ["叶".repeat(100_000), "e".to_string() + &"\u{301}".repeat(1 << 20)] {
        let (_, buffer) = screen(TITLE, &long, Marker::Braille, &[]);
        assert_harmless(&buffer);
    }
}

#[test]
fn a_refused_value_is_shown_without_acting() {
    // A field takes only letters, but those that act come in ways one may forget.
    let typed = [key('\n'), key('\u{202e}'), key('\u{2028}'), key('x'), key('\n')];
    let (app, buffer) = screen(TITLE, "", Marker::Braille, &typed);
    assert!(app.knobs.refusal.is_some_and(|refusal| !refusal.contains(acts)));
    assert_harmless(&buffer);
}

#[test]
fn every_letter_of_titles_and_names_is_ascii_if_the_marker_is() {
    let typed = [key('s'), ScreenEvent::Pasted("é叶".into())];
    for events in [&[][..], &typed[..], &[key('\n'), ScreenEvent::Pasted("Ω".into())]] {
        let (_, buffer) = screen(TITLE, HOSTILE, Marker::Ascii, events);
        let other = buffer.content.iter().find(|cell| !cell.symbol().is_ascii());
        assert_eq!(other, None);
    }
}

#[test]
fn a_pasted_text_never_acts_as_keys() {
    let paste = ScreenEvent::Pasted("q\ns\u{1b}[Al50\n".into());
    let (app, _) = screen("", "", Marker::Braille, std::slice::from_ref(&paste));
    assert_eq!(app.status.as_deref(), Some("the pasted text is ignored: no field is open"));
    assert_eq!(*app.scene, *app.files.opened);
    // The help and the palette have a field.
    for field in ['?', ':'] {
        let (app, buffer) = screen("", "", Marker::Braille, &[key(field), paste.clone()]);
        assert_eq!((&*app.scene, app.status), (&*app.files.opened, None), "{field}");
        let text: String = buffer.content.iter().map(|cell| cell.symbol()).collect();
        assert!(text.contains("q s[Al50_"), "{text}");
    }
    let typed = [key('\n'), ScreenEvent::Pasted("43\u{7}0\r\n".into()), key('\n')];
    let (app, _) = screen("", "", Marker::Braille, &typed);
    assert_eq!(app.scene.operation.speed_rad_s, 430.0);
    let huge = [key('\n'), ScreenEvent::Pasted("9".repeat(1 << 20)), key('5'), key('\n')];
    let (app, _) = screen("", "", Marker::Braille, &huge);
    assert_eq!(app.scene.operation.speed_rad_s, 5.0);
}
