//! What must stand on the screen after some keys, as a table: `tests/screens/*.txt`.
//!
//! | line | it does |
//! |---|---|
//! | `@ 80x24 SCENE WORDS` | opens the explorer; words: `mono`, `ascii`, `checked`, `searched`, `stride=SECONDS`, `KEY=VALUE` |
//! | `> KEYS` | presses them in one go; a line without keys lets two frames pass |
//! | `>> KEYS` | presses them one by one |
//! | `= 120x40` | gives the screen another size |
//! | `* KEY` | selects the knob of a key |
//! | `^ WORDS`, `v WORDS` | clicks on them; turns the wheel down over them |
//! | `~ KEY VALUE` | asserts a value of the scene |
//! | `1: WORDS` | stand in this row, from 0 |
//! | `! WORDS` | stand nowhere |
//! | any other | stands on the screen, wherever its lines break |
//!
//! Nowhere is a number none, and in ASCII all is ASCII.
//!
//! Keys are letters and `⏎ ⎋ ⌫ ⇥ ␣ ← → ↑ ↓`; the scene `short` is paper-nd3 with a coarse step and
//! an early end. To add a case, write its `@` and its keys and run `cargo test screens`: a case
//! without words shows its screen.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use rubscope::tui::{Marker, Theme};
use rubscope_solver::scene::{Scene, keys};

use crate::stepwise::Stepwise;
use crate::tui_support::{Session, scene};

files! { "screens": headers help knobs maps margins odd odd_laws odd_speeds odd_starts time views }

fn size(text: &str) -> (u16, u16) {
    let (width, height) = text.split_once('x').unwrap();
    (width.parse().unwrap(), height.parse().unwrap())
}

/// Opens the explorer of a line behind `@`.
fn open(line: &str) -> Session {
    let mut words = line.split_whitespace();
    let size = size(words.next().unwrap());
    let mut opened = match words.next().unwrap() {
        "short" => scene(),
        name => Scene::builtin(name).unwrap(),
    };
    let (mut theme, mut marker, mut engine) = (Theme::Dark, Marker::Braille, Stepwise::new(3e-3));
    for word in words {
        match word.split_once('=') {
            None if word == "ascii" => marker = Marker::Ascii,
            None if word == "mono" => theme = Theme::Mono,
            None if word == "checked" => engine.checks = true,
            None if word == "searched" => engine.extent.searches_changes = true,
            None => panic!("{word}: allowed is ascii, mono, checked or searched"),
            Some(("stride", seconds)) => engine.stride = seconds.parse().unwrap(),
            Some((key, value)) => opened.set(key, value).unwrap(),
        }
    }
    Session::with_engine(size, engine, opened, theme, marker)
}

/// The keys of a line: signs for those that have no letter.
fn keys_of(text: &str) -> String {
    let signs = [('⏎', '\n'), ('⎋', '\u{1b}'), ('⌫', '\u{8}'), ('⇥', '\t'), ('␣', ' ')];
    let key = |c| signs.iter().find(|(sign, _)| *sign == c).map_or(c, |(_, key)| *key);
    text.chars().map(key).collect()
}

fn mouse(session: &mut Session, kind: MouseEventKind, words: &str) {
    let (column, row) = session.find(words);
    session.app.mouse(&MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE });
    session.press("");
}

/// Whether words stand on the screen, as they are or over the end of a line.
fn stands(session: &Session, words: &str) -> bool {
    let text = session.text();
    let joined = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    text.contains(words) || joined(&text).contains(&joined(words))
}

/// Does what a line says; whether all is so on the screen then. A number is none nowhere, and a
/// screen in ASCII is in ASCII.
fn follow(session: &mut Session, line: &str) -> bool {
    let (sign, rest) = line.split_once(' ').unwrap_or((line, ""));
    match sign {
        ">" => _ = session.press(&keys_of(rest)),
        ">>" => {
            let press = |key: char| {
                session.press(key.encode_utf8(&mut [0; 4]));
                is_sound(session)
            };
            return keys_of(rest).chars().all(press);
        }
        "=" => session.resize(size(rest)),
        "*" => {
            session.select(rest);
            session.press("");
        }
        "^" => mouse(session, MouseEventKind::Down(MouseButton::Left), rest),
        "v" => mouse(session, MouseEventKind::ScrollDown, rest),
        "~" => {
            let (key, value) = rest.split_once(' ').unwrap();
            let held = (keys::find(key).unwrap().get)(&session.app.scene).to_string();
            if held.trim_matches('"') != value {
                println!("{key} is {held}");
                return false;
            }
        }
        "!" => return !stands(session, rest),
        _ => {
            let row = sign.strip_suffix(':').and_then(|row| row.parse::<usize>().ok());
            return match row {
                Some(row) => session.rows()[row].contains(rest),
                None => stands(session, line),
            };
        }
    }
    is_sound(session)
}

fn is_sound(session: &Session) -> bool {
    let text = session.text();
    !text.contains("NaN") && (session.app.appearance.marker != Marker::Ascii || text.is_ascii())
}

/// Every case of a file.
fn holds(name: &str) {
    let text = std::fs::read_to_string(crate::table("screens", name)).unwrap();
    let lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with("##"));
    let lines: Vec<&str> = lines.collect();
    let cases: Vec<&[&str]> = lines.chunk_by(|_, next| !next.starts_with("@ ")).collect();
    let wrong: Vec<String> = std::thread::scope(|scope| {
        let half = cases.len().div_ceil(2);
        let all = cases.chunks(half).map(|cases| {
            scope.spawn(|| cases.iter().filter_map(|case| wrong(case)).collect::<Vec<_>>())
        });
        let all: Vec<_> = all.collect();
        all.into_iter().flat_map(|cases| cases.join().unwrap()).collect()
    });
    assert!(wrong.is_empty(), "{name}: {}", wrong.join("\n"));
}

/// The first line of a case that is not so, with the screen.
fn wrong(case: &[&str]) -> Option<String> {
    let mut session = open(case[0].strip_prefix("@ ").unwrap());
    let line = case[1..].iter().find(|line| !follow(&mut session, line));
    let asserts =
        |line: &&&str| ![">", ">>", "=", "*", "^", "v"].contains(&line.split(' ').next().unwrap());
    let line = if case[1..].iter().any(|line| asserts(&line)) { *line? } else { "no words" };
    Some(format!("{}: {line}\n{}", case[0], session.text()))
}
