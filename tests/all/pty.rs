//! The built program in a pseudo-terminal: it opens, a knob is turned, the
//! verdict changes, and the terminal is restored.

use crate::pty_support::{SHORT, Start, Terminal};

fn is_coloured(terminal: &Terminal) -> bool {
    let screen = terminal.parser.screen();
    let colour = |row, column| screen.cell(row, column).map(vt100::Cell::fgcolor);
    let mut cells = (0..24).flat_map(|row| (0..80).map(move |column| (row, column)));
    cells.any(|(row, column)| colour(row, column) != Some(vt100::Color::Default))
}

#[test]
fn opens_turns_a_knob_sees_the_verdict_change_and_quits() {
    let mut terminal = Start::explorer(&SHORT).locked();
    assert!(terminal.parser.screen().alternate_screen());
    // Five knobs down is the contact law.
    terminal.send("jjjjj");
    terminal.wait_for("▸contact");
    terminal.send("l");
    terminal.wait_for(" DECAY ");
    terminal.send("h");
    terminal.wait_for(" LOCKED ");
    terminal.quit("q");
}

#[test]
fn the_mouse_acts_and_is_given_back() {
    let mut terminal = Start::explorer(&SHORT).locked();
    assert!([1000, 1006].into_iter().all(|mode| terminal.has_mode(mode)));
    // No moves of the pointer.
    assert!([1002, 1003].into_iter().all(|mode| !terminal.has_mode(mode)));
    // A click in the third row, on the damping of the casing.
    terminal.send("\u{1b}[<0;31;3M\u{1b}[<0;31;3m");
    terminal.wait_for("▸ζ_c");
    terminal.send("\u{1b}[<64;31;3M");
    terminal.wait_for("0.055");
    terminal.send("M");
    terminal.wait_for("mouse off");
    assert!([1000, 1006].into_iter().all(|mode| !terminal.has_mode(mode)));
    terminal.send("M");
    terminal.wait_for("mouse on");
    assert!(terminal.has_mode(1000));
    terminal.quit("\u{3}");
}

#[test]
fn a_refused_scene_never_takes_the_terminal() {
    let mut terminal = Start::explorer(&["--set", "bladed_disk.blades=0"]).open();
    assert_eq!(terminal.wait(), 2);
    let text = terminal.text();
    assert!(text.contains("bladed_disk.blades = 0"), "{text}");
}

#[test]
fn no_color_leaves_the_screen_without_colours_unless_it_is_empty() {
    for (value, coloured) in [("", true), ("1", false)] {
        let mut terminal = Start::explorer(&["--end", "1e-3"]).env("NO_COLOR", value).locked();
        assert_eq!(is_coloured(&terminal), coloured, "NO_COLOR={value:?}");
        terminal.quit("q");
    }
}

#[test]
fn a_terminal_of_any_size_is_drawn_as_far_as_is_sensible() {
    for (columns, rows) in [(u16::MAX, u16::MAX), (u16::MAX, 3), (1, 1), (0, 0)] {
        let mut terminal = Start::explorer(&SHORT).size(columns, rows).open();
        match (columns, rows) {
            (0, 0) => terminal.wait_for(" LOCKED "),
            (1, 1) => terminal.wait_for("r"),
            (_, 3) => terminal.wait_for("rubscope needs 40x12; this is 1000x3"),
            _ => terminal.wait_for("The paper's scene, three nodal diameters"),
        }
        terminal.send("q");
        assert_eq!(terminal.wait(), 0, "{columns}x{rows}");
    }
}

#[test]
fn only_ascii_where_the_terminal_or_the_locale_has_no_more_unless_chosen() {
    let cases = [
        ("xterm", "C.UTF-8", None, false),
        ("linux", "C.UTF-8", None, true),
        ("vt100", "C.UTF-8", None, true),
        ("xterm", "C", None, true),
        ("xterm", "en_US.ISO-8859-1", None, true),
        ("linux", "C", Some("braille"), false),
        ("xterm", "C.UTF-8", Some("ascii"), true),
    ];
    for (term, locale, marker, ascii) in cases {
        let mut arguments = SHORT.to_vec();
        arguments.extend(marker.iter().flat_map(|marker| ["--marker", marker]));
        let start = Start::explorer(&arguments).env("TERM", term).env("LC_ALL", locale);
        let mut terminal = start.open();
        // The last row of the screen: the whole of it is there.
        terminal.wait_for("? help");
        assert_eq!(terminal.text().is_ascii(), ascii, "{term} {locale} {marker:?}");
        terminal.quit("q");
    }
}

#[test]
fn a_pasted_block_lands_in_the_field_that_is_open_or_is_ignored() {
    let folder = tempfile::tempdir().unwrap();
    let mut terminal = Start::explorer(&SHORT).folder(folder.path()).locked();
    assert!(terminal.parser.screen().bracketed_paste());
    terminal.send("\u{1b}[200~echo hello\r\n\u{1b}[201~");
    terminal.wait_for("the pasted text is ignored: no field is open");
    terminal.send("s");
    terminal.wait_for("save the scene as: scene.toml_");
    terminal.send(&"\u{7f}".repeat(10));
    terminal.wait_for("save the scene as: _");
    terminal.send("\u{1b}[200~mi\r\nne\u{7}.toml\n\u{1b}[201~");
    terminal.wait_for("save the scene as: mi ne.toml_");
    terminal.send(&format!("\u{1b}[200~{}\u{1b}[201~", "x".repeat(2000)));
    terminal.wait_for("the pasted text is ignored: it is too long");
    terminal.send("\r");
    terminal.wait_for("written: mi ne.toml");
    terminal.quit("q");
    let names = std::fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().file_name());
    assert_eq!(names.collect::<Vec<_>>(), ["mi ne.toml"]);
}

#[test]
fn a_pipe_a_device_or_a_folder_is_refused_as_a_file_and_the_screen_lives() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe.toml");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    std::os::unix::fs::symlink("/dev/tty", folder.path().join("tty.toml")).unwrap();
    std::fs::create_dir(folder.path().join("folder.toml")).unwrap();
    let mut terminal = Start::explorer(&SHORT).folder(folder.path()).locked();
    for (name, reason) in [
        ("pipe.toml", "cannot write pipe.toml: it is a pipe or a device, not a file"),
        ("tty.toml", "cannot write tty.toml: it is a pipe or a device, not a file"),
        // A name without an ending gets that of a scene.
        ("folder", "cannot write folder.toml: it is a directory"),
    ] {
        terminal.send("s");
        terminal.wait_for("save the scene as: scene.toml_");
        terminal.send(&format!("{}{name}\r", "\u{7f}".repeat(10)));
        terminal.wait_for(reason);
    }
    terminal.send("?");
    terminal.wait_for("select the knob above");
    terminal.quit("\u{3}");
}

#[test]
fn a_file_above_the_limit_of_the_system_is_refused_and_the_screen_lives() {
    let folder = tempfile::tempdir().unwrap();
    let script = "ulimit -f 0; \"$@\"; echo ended with $?";
    let mut terminal = Start::shell(script, &SHORT).folder(folder.path()).locked();
    terminal.send("s\r");
    terminal.wait_for("cannot write scene.toml: ");
    terminal.send("?");
    terminal.wait_for("select the knob above");
    terminal.send("\u{3}");
    terminal.wait_for("ended with 0");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    terminal.assert_restored();
}

#[test]
fn without_a_keyboard_it_says_so_and_leaves_the_terminal_alone() {
    let script = "\"$@\" < /dev/null; echo ended with $?";
    let mut terminal = Start::shell(script, &[]).detached().open();
    terminal.wait_for("ended with 2");
    assert!(terminal.text().contains("rubscope: the explorer needs a keyboard"));
    terminal.assert_restored();
}
