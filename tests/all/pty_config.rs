//! The explorer in a pseudo-terminal: what it remembers, and how it learns the
//! background of the terminal.

use std::path::{Path, PathBuf};

use super::pty_support::{SHORT, Start};

/// What a terminal with a white background reports: its colour, and what it is.
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
    terminal.quit("q");
    let text = std::fs::read_to_string(file(home.path())).unwrap();
    assert!(text.contains("theme = \"light\"") && text.contains("introduced = true"), "{text}");

    let mut terminal = explorer(home.path(), &[]).open();
    terminal.wait_for("↑↓ knob");
    terminal.send("t");
    terminal.wait_for("theme colour-blind on dark");
    // A signal ends it; what was chosen is remembered all the same.
    terminal.signal("TERM");
    assert_eq!(terminal.wait(), 128 + 15);
    let text = std::fs::read_to_string(file(home.path())).unwrap();
    assert!(text.contains("theme = \"colorblind\""), "{text}");

    let mut terminal = explorer(home.path(), &["--theme", "mono"]).open();
    terminal.wait_for("↑↓ knob");
    terminal.send("t");
    terminal.wait_for("theme dark");
    terminal.quit("q");
}

#[test]
fn without_the_config_file_nothing_is_read_or_written() {
    let home = home();
    let mut terminal = explorer(home.path(), &["--no-config"]).open();
    terminal.wait_for("↑↓ knob");
    terminal.send("t");
    terminal.wait_for("theme light");
    terminal.quit("q");
    assert_eq!(std::fs::read_dir(home.path()).unwrap().count(), 0);

    std::fs::create_dir(home.path().join("rubscope")).unwrap();
    std::fs::write(file(home.path()), "theme = \"pink\"").unwrap();
    let mut terminal = explorer(home.path(), &[]).open();
    terminal.wait_for("config.toml is not used");
    terminal.quit("q");
    assert_eq!(std::fs::read_to_string(file(home.path())).unwrap(), "theme = \"pink\"");
}

#[test]
fn a_config_file_that_cannot_be_written_is_told_once_at_the_end() {
    let home = home();
    std::os::unix::fs::symlink("nowhere", home.path().join("rubscope")).unwrap();
    let mut terminal = explorer(home.path(), &[]).size(200, 24).locked();
    terminal.send("tt");
    terminal.wait_for("theme colour-blind on dark");
    terminal.quit("q");
    let text = terminal.text();
    assert_eq!(text.matches("rubscope: settings are not saved: ").count(), 1, "{text}");
    assert!(text.contains("File exists"), "{text}");
}

/// The shell that started it allows so few open files.
#[test]
fn a_terminal_that_cannot_be_used_is_told_in_one_line() {
    let script = "ulimit -n 6; exec \"$@\"";
    let mut terminal = Start::shell(script, &["--no-config"]).size(120, 24).open();
    assert_eq!(terminal.wait(), 1);
    let text = terminal.text();
    let told: Vec<&str> = text.lines().filter(|line| !line.is_empty()).collect();
    assert!(
        told.len() == 1 && told[0].starts_with("rubscope: cannot use the terminal: "),
        "{text}"
    );
    assert!(told[0].contains("Too many open files"), "{text}");
}

#[test]
fn the_first_screen_does_not_wait_for_the_background_and_its_report_changes_the_theme() {
    let home = home();
    for (report, theme) in [
        (WHITE, "theme colour-blind on dark"),
        ("\u{1b}]11;rgb:1e1e/1e1e/1e1e\u{1b}\\", "theme light"),
        // A terminal that does not answer is taken for a dark one.
        ("", "theme light"),
    ] {
        let mut terminal = explorer(home.path(), &[]).env("COLORFGBG", "").locked();
        assert!(terminal.has_written(b"\x1b]11;?"), "{theme}");
        // The theme after the one that the report has led to; no piece of a report is a key.
        for piece in [report, "t"] {
            terminal.send(piece);
        }
        terminal.wait_for(theme);
        terminal.quit("\u{3}");
        std::fs::remove_file(file(home.path())).unwrap();
    }
    // A theme that only followed the background is not remembered.
    let mut terminal = explorer(home.path(), &[]).env("COLORFGBG", "").typed(WHITE).locked();
    terminal.quit("q");
    let text = std::fs::read_to_string(file(home.path())).unwrap();
    assert!(!text.contains("theme"), "{text}");
}

#[test]
fn a_new_scene_asks_again_after_a_bad_answer() {
    let home = home();
    let mut terminal = Start::command(&["new", "mine.toml", "--rpm"]).folder(home.path()).open();
    for (question, answers) in [
        ("Number of blades: ", &["many", "36"][..]),
        ("Inner radius", &["420 kg", "420mm"]),
        ("Clearance", &["2m", "0.3mm"]),
        ("Nodal diameters: ", &["-5", "5"]),
        ("Frequency of the casing", &["0", "420.3"]),
        ("mode of the casing", &["heavy", "2.9"]),
        ("Frequency of the bladed disk", &["155.9"]),
        ("mode of the bladed disk", &["5.4"]),
        ("Damping ratio of the casing", &["5 kN", "5"]),
        ("Damping ratio of the bladed disk", &[""]),
        ("Speeds of the machine", &["fast", "6000:11000"]),
        ("all the same? yes or no: ", &["perhaps", "yes"]),
    ] {
        for answer in answers {
            terminal.wait_until(question, |screen| {
                screen.contents().trim_end().lines().last().is_some_and(|line| {
                    line.contains(question.trim_end()) && line.trim_end().ends_with(':')
                })
            });
            terminal.send(&format!("{answer}\r"));
        }
    }
    assert_eq!(terminal.wait(), 0);
    let said = terminal.text();
    assert!(said.contains("yes or no: perhaps") && !said.contains("assumed"), "{said}");
    let scene = std::fs::read_to_string(home.path().join("mine.toml")).unwrap();
    assert!(scene.contains("speed_rad_s = 890.117918") && scene.contains("blades = 36"), "{scene}");
}
