//! While a command is at work, a line on its terminal moves, and Ctrl-C ends it. Nothing of
//! it goes into a pipe.

use std::path::Path;

use crate::pty_support::{Start, Terminal};

/// In any build these take many seconds.
const LONG: [&str; 5] = [
    "map undamped --solver event --model rigid --end 1e6 --speed 300:500:2 --pulse 1e4:2e4:2",
    "run undamped --solver event --model rigid --end 1e6",
    "precision undamped --repeat 1000 --set solver.end_s=20",
    "figures --out .",
    "map --speed 300:500:3000 --pulse 1e4:1e6:3000 --out m.csv",
];

fn is_seen(screen: &vt100::Screen) -> bool {
    screen.contents().contains(|c: char| ('\u{2801}'..='\u{28ff}').contains(&c))
}

fn start(command: &str, folder: &Path) -> Terminal {
    let words: Vec<&str> = command.split(' ').collect();
    Start::command(&words).folder(folder).size(120, 40).open()
}

#[test]
fn what_takes_long_shows_that_it_is_alive() {
    for command in LONG {
        let folder = tempfile::tempdir().unwrap();
        let mut terminal = start(command, folder.path());
        assert!(!terminal.ends_before(is_seen), "{command} showed nothing");
        terminal.send("\u{3}");
        let status = terminal.ended();
        assert!(status.signal().is_some() || status.exit_code() == 130, "{command}: {status:?}");
    }
}

#[test]
fn nothing_of_the_line_stays_or_goes_into_a_pipe() {
    let command = "precision rub --end 0.2 --finest 1e-6 --repeat 1";
    let folder = tempfile::tempdir().unwrap();
    let mut terminal = start(command, folder.path());
    assert_eq!(terminal.wait(), 0);
    assert!(!is_seen(terminal.parser.screen()), "{}", terminal.text());
    let words = command.split(' ');
    let output = crate::cli_support::program().args(words).output().unwrap();
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
}
