//! The explorer in a pseudo-terminal: what it remembers, and how it learns the
//! background of the terminal.

use std::path::{Path, PathBuf};

use super::pty_support::{SHORT, Start};

/// What a terminal with a white background answers: its colour, and what it is.
const WHITE: &str = "\u{1b}]11;rgb:ffff/ffff/ffff\u{7}\u{1b}[?62;22c";

fn explorer(home: &Path, more: &[&str]) -> Start {
    let arguments = [&SHORT[..], more].concat();
    Start::explorer(&arguments).env("XDG_CONFIG_HOME", home.to_str().unwrap())
}

/// A home in memory where there is one: a busy disk takes longer than the program waits.
fn home() -> tempfile::TempDir {
    tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap()
}

fn file(home: &Path) -> PathBuf {
    home.join("rubscope/config.toml")
}

#[test]
fn what_was_seen_and_chosen_is_remembered() {
    let home = home();
    let mut terminal = explorer(home.path(), &[]).open();
    terminal.wait_for("new here?");
    terminal.send("t");
    terminal.wait_for("theme light");
    terminal.send("q");
    assert_eq!(terminal.wait(), 0);
    let text = std::fs::read_to_string(file(home.path())).unwrap();
    assert!(text.contains("theme = \"light\"") && text.contains("introduced = true"), "{text}");

    let mut terminal = explorer(home.path(), &[]).open();
    terminal.wait_for("↑↓ knob");
    terminal.send("t");
    terminal.wait_for("theme colour-blind on dark");
    // A signal ends it; what was chosen is remembered all the same.
    terminal.signal("TERM");
    assert_eq!(terminal.wait(), 128 + 15);
    terminal.assert_restored();
    let text = std::fs::read_to_string(file(home.path())).unwrap();
    assert!(text.contains("theme = \"colorblind\""), "{text}");

    let mut terminal = explorer(home.path(), &["--theme", "mono"]).open();
    terminal.wait_for("↑↓ knob");
    terminal.send("t");
    terminal.wait_for("theme dark");
    terminal.send("q");
    assert_eq!(terminal.wait(), 0);
}

#[test]
fn without_the_config_file_nothing_is_read_or_written() {
    let home = home();
    let mut terminal = explorer(home.path(), &["--no-config"]).open();
    terminal.wait_for("↑↓ knob");
    terminal.send("t");
    terminal.wait_for("theme light");
    terminal.send("q");
    assert_eq!(terminal.wait(), 0);
    assert_eq!(std::fs::read_dir(home.path()).unwrap().count(), 0);

    std::fs::create_dir(home.path().join("rubscope")).unwrap();
    std::fs::write(file(home.path()), "theme = \"pink\"").unwrap();
    let mut terminal = explorer(home.path(), &[]).open();
    terminal.wait_for("config.toml is not used");
    terminal.send("q");
    assert_eq!(terminal.wait(), 0);
    assert_eq!(std::fs::read_to_string(file(home.path())).unwrap(), "theme = \"pink\"");
}

#[test]
fn a_terminal_that_answers_has_the_theme_for_its_background() {
    let home = home();
    let mut terminal = explorer(home.path(), &[]).env("COLORFGBG", "").typed(WHITE).open();
    terminal.wait_for("LOCKED");
    terminal.send("t");
    // The one after the light one.
    terminal.wait_for("theme colour-blind on dark");
    terminal.send("q");
    assert_eq!(terminal.wait(), 0);
    terminal.assert_restored();
}

#[test]
fn an_answer_that_comes_too_late_is_no_key_and_is_not_asked_for_again() {
    let home = home();
    let mut terminal = explorer(home.path(), &[]).env("COLORFGBG", "").open();
    terminal.wait_for("LOCKED");
    let late = "\u{1b}]11;rgb:eeee/eeee/eeee\u{1b}\\\u{1b}[?62;22c";
    terminal.send(&format!("{late}t"));
    terminal.wait_for("theme light");
    assert!(!terminal.text().contains("export as"), "{}", terminal.text());
    terminal.send("q");
    assert_eq!(terminal.wait(), 0);
    let text = std::fs::read_to_string(file(home.path())).unwrap();
    assert!(text.contains("silent_terminals = [\"xterm-256color\"]"), "{text}");
    std::fs::write(file(home.path()), text.replace("theme", "former")).unwrap();

    // The answer is there before the question, but there is no question.
    let mut terminal = explorer(home.path(), &[]).env("COLORFGBG", "").typed(WHITE).open();
    terminal.wait_for("LOCKED");
    assert!(!terminal.text().contains("]11;?"));
    terminal.send("\u{1b}\u{1b}t");
    terminal.wait_for("theme light");
    drop(terminal);
}
