//! The built program in a pseudo-terminal whose user sends more than is read at
//! once, or sequences without an end: one Ctrl-C is heard all the same.

use crate::pty_support::{SHORT, Start, Terminal};

/// Keys that open each mode, and what is seen then.
const MODES: [(&str, &str); 8] = [
    ("", "? help"),
    ("\r12", "12_"),
    (":", "or any words"),
    ("?", "Type to find"),
    ("g", "Enter begins one"),
    ("g\r", "lower"),
    ("s", "save the scene as"),
    ("i", "Esc knobs"),
];

/// A letter, an arrow, a click of the middle button and a pasted text.
const UNIT: &str = "j\u{1b}[B\u{1b}[<1;10;10M\u{1b}[200~ab\u{1b}[201~";

fn opened(keys: &str, seen: &str) -> Terminal {
    let mut terminal = Start::explorer(&SHORT).locked();
    terminal.send(keys);
    terminal.wait_for(seen);
    terminal
}

fn ends(mut terminal: Terminal, what: &str) {
    terminal.send("\u{3}");
    ended(terminal, what);
}

fn ended(mut terminal: Terminal, what: &str) {
    assert_eq!(terminal.wait(), 0, "{what}");
}

/// More than the program reads at once, and more than a terminal and a pipe hold.
fn bursts_of_any_size_in_every_mode() {
    for (place, (keys, seen)) in MODES.into_iter().enumerate() {
        let sizes = [70_000, 1_000, 4_200, 20_000];
        for size in if place == 0 { &sizes[..] } else { &sizes[..1] } {
            let mut terminal = opened(keys, seen);
            terminal.send(&UNIT.repeat(size / UNIT.len()));
            ends(terminal, &format!("{keys:?}, {size} bytes"));
        }
    }
}

#[test]
fn one_ctrl_c_is_heard_after_bursts_and_sequences_without_an_end_in_every_mode() {
    let long = format!("\u{1b}[200~{}", "abc".repeat(20_000));
    let begun = [&long, "\u{1b}[200~abc", "\u{1b}[<0;1", "\u{1b}]11;rgb:", "\u{1b}O"];
    // Each waits for the end of its sequence before it gives it up: all wait at once.
    let mut waiting = Vec::new();
    for (place, (keys, seen)) in MODES.into_iter().enumerate() {
        for begun in if place == 0 { &begun[..] } else { &begun[1..2] } {
            let mut terminal = opened(keys, seen);
            terminal.send(begun);
            terminal.send("\u{3}");
            waiting.push((terminal, format!("{keys:?} {begun:.20?}")));
        }
    }
    bursts_of_any_size_in_every_mode();
    for (terminal, what) in waiting {
        ended(terminal, &what);
    }
}

/// All that was sent before a Ctrl-C would take far more of the processor.
#[cfg(target_os = "linux")]
#[test]
fn one_ctrl_c_does_not_wait_until_a_burst_before_it_is_answered() {
    for burst in ["8".to_string() + &"5".repeat(40_000), "hl".repeat(100_000)] {
        let mut terminal = opened("", "? help");
        let before = terminal.processor_s();
        terminal.send(&(burst.clone() + "\u{3}"));
        let took = terminal.last_processor_s() - before;
        assert_eq!(terminal.wait(), 0);
        assert!(took < 3.0, "{took} s for {} bytes", burst.len());
    }
}

/// The size comes by a signal, not with the keys.
#[test]
fn another_size_of_the_terminal_is_drawn() {
    let mut terminal = opened("", "? help");
    terminal.resize(100, 30);
    terminal.wait_until("a screen of 30 rows", |screen| {
        screen.rows(0, 100).nth(29).is_some_and(|row| row.contains("? help"))
    });
    ends(terminal, "another size");
}

/// The reason why a file was not written outlives the screen.
#[test]
fn one_ctrl_c_behind_the_name_of_a_file_that_cannot_be_written_ends() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ex.toml"), "old").unwrap();
    for (name, reason) in [
        ("ex.toml", "rubscope: cannot write ex.toml: it exists"),
        ("nodir/ex.toml", "rubscope: cannot write nodir/ex.toml: No such file or directory"),
    ] {
        let mut terminal = Start::explorer(&SHORT).folder(folder.path()).locked();
        terminal.send(&format!("s{}{name}\r\u{3}", "\u{7f}".repeat(12)));
        assert_eq!(terminal.wait(), 1, "{name}");
        assert!(terminal.text().contains(reason), "{}", terminal.text());
    }
    assert_eq!(std::fs::read(folder.path().join("ex.toml")).unwrap(), b"old");
}
