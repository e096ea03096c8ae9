//! Finding things in the explorer: the last line, lists, prompts and signs, at every size.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use rubscope::tui::events::ScreenEvent;
use rubscope::tui::{Marker, Theme};
use rubscope_solver::scene::Scene;

use crate::tui_support::Session;

const SIZES: [(u16, u16); 4] = [(40, 12), (80, 24), (120, 40), (200, 50)];

fn open(size: (u16, u16), marker: Marker) -> Session {
    let mut scene = Scene::builtin("paper-nd3").unwrap();
    (scene.solver.step_s, scene.solver.end_s) = (1e-6, 5e-3);
    Session::with_stride(size, 1e-3, scene, Theme::Mono, marker)
}

/// The last row of the screen.
fn last(session: &Session) -> String {
    session.rows().pop().unwrap().trim_end().to_string()
}

#[test]
fn the_way_to_help_and_out_is_on_every_screen() {
    for size in SIZES {
        for marker in [Marker::Braille, Marker::Ascii] {
            let mut session = open(size, marker);
            // The map gives the arrows to its cursor, which `q` closes first.
            let shows_both =
                |row: &str| row.ends_with("? help  q quit") || row.ends_with("? help  q close");
            // The view that is large already says so in its place.
            for digit in ('2'..='8').chain(['1']) {
                session.press(&digit.to_string());
                assert!(shows_both(&last(&session)), "{}", last(&session));
            }
            session.press("y");
            let status = last(&session);
            assert!(status.ends_with("? q") || shows_both(&status), "{status}");
            session.press("i");
            assert!(shows_both(&last(&session)), "{}", last(&session));
            session.press("ig");
            assert!(last(&session).ends_with("Ctrl-C quit"), "{}", last(&session));
            session.press("\u{1b}?");
            assert!(last(&session).starts_with("? Esc close"), "{}", last(&session));
            assert!(last(&session).ends_with("Ctrl-C quit"), "{}", last(&session));
        }
    }
}

#[test]
fn every_sign_of_the_pictures_is_found_by_typing_it() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/all/snapshots");
    let pictures = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let texts = pictures.map(|path| std::fs::read_to_string(path).unwrap());
    let mut signs: Vec<char> = texts.flat_map(|text| text.chars().collect::<Vec<_>>()).collect();
    signs.sort_unstable();
    signs.dedup();
    // A curve has any pattern of dots.
    signs.retain(|sign| !sign.is_ascii() && !('\u{2801}'..='\u{28ff}').contains(sign));
    assert!(signs.len() > 30, "{signs:?}");
    let mut session = open((80, 24), Marker::Braille);
    session.press("?");
    for sign in signs.into_iter().chain(['*']) {
        // `press` takes an arrow as the key of the arrow.
        let key = KeyEvent::new(KeyCode::Char(sign), KeyModifiers::NONE);
        session.send([ScreenEvent::Key(key)].into_iter());
        let text = session.text();
        assert!(text.contains(&format!("find: {sign}")) && !text.contains("no match"), "{text}");
        session.press("\u{8}");
    }
}

#[test]
fn every_prompt_edits_as_a_shell_does_and_shows_its_cursor() {
    let ctrl = |session: &mut Session, letter| {
        let key = KeyEvent::new(KeyCode::Char(letter), KeyModifiers::CONTROL);
        session.send([ScreenEvent::Key(key)].into_iter());
    };
    // Each begins with the key that opens the prompt.
    for (open_with, prompt) in
        [("\n", ""), (":", ": "), ("/", "find: "), ("s", "save the scene as: ")]
    {
        for marker in [Marker::Braille, Marker::Ascii] {
            let mut session = open((80, 24), marker);
            session.press(open_with);
            ctrl(&mut session, 'u');
            session.press("4 50x");
            session.press("\u{8}←←⇱⇲←←6⌦");
            assert!(session.text().contains(&format!("{prompt}4 60")), "{}", session.text());
            // The letter under the cursor stands out from those beside it.
            let text = session.text();
            let (row, line) =
                text.lines().enumerate().find(|(_, line)| line.contains("4 60")).unwrap();
            let at =
                line.chars().collect::<Vec<_>>().windows(4).position(|w| w == ['4', ' ', '6', '0']);
            let cell = |x: usize| {
                let buffer = session.terminal.backend().buffer();
                buffer[(u16::try_from(x).unwrap(), u16::try_from(row).unwrap())].modifier
            };
            let at = at.unwrap();
            assert_eq!(cell(at + 3) ^ cell(at + 2), ratatui::style::Modifier::REVERSED);
            session.press("⇲");
            ctrl(&mut session, 'w');
            assert!(session.text().contains(&format!("{prompt}4 _")), "{}", session.text());
            ctrl(&mut session, 'a');
            ctrl(&mut session, 'k');
            assert!(session.text().contains(&format!("{prompt}_")), "{}", session.text());
        }
    }
}

#[test]
fn every_list_pages_and_goes_to_its_ends() {
    for (keys, first, last) in [
        ("o", "paper-nd3", "cannot be read"),
        ("g", "▸lesson The critical", "▸lesson Your own machine"),
        (":", "select the knob above", "▸lesson Your own machine"),
        ("?", "Here", "draw the screen again"),
    ] {
        let mut session = open((80, 24), Marker::Braille);
        session.press(keys);
        session.press("⇱");
        let top = session.text();
        assert!(top.contains(first), "{keys}: {top}");
        session.press("⇲");
        let end = session.text();
        assert!(end != top && (keys == "?" || end.contains(last)), "{keys}: {end}");
        session.press("↓");
        assert_eq!(session.text(), end, "{keys}");
        session.press("⇱");
        assert_eq!(session.text(), top, "{keys}");
        session.press("⇟");
        let page = session.text();
        assert!(page != top, "{keys}");
        session.press("⇞");
        assert_eq!(session.text(), top, "{keys}");
    }
}

#[test]
fn what_was_just_saved_is_found_and_comes_first() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = open((80, 24), Marker::Braille);
    session.app.files.directory = folder.path().into();
    session.press("→:save mine.toml\n");
    session.press(":scene mine");
    session.press("");
    assert!(session.text().contains("scene mine.toml: changed from"), "{}", session.text());
    session.press("\n");
    assert!(session.app.files.source.as_ref().unwrap().name.ends_with("mine.toml"));
    session.press("o");
    let text = session.text();
    assert!(text.find("mine.toml") < text.find("paper-nd3: "), "{text}");
}
