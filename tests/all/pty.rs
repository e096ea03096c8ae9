//! The built program in a pseudo-terminal: it opens, a knob is turned, the
//! verdict changes, and the terminal is restored.

#![cfg(unix)]

use std::io::{Read, Write};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, PtySize, native_pty_system};

/// A long limit, not a speed test: a loaded machine may be slow.
const PATIENCE: Duration = Duration::from_secs(60);

struct Terminal {
    parser: vt100::Parser,
    output: Receiver<Vec<u8>>,
    input: Box<dyn Write + Send>,
    child: Box<dyn Child + Send + Sync>,
    _pair: Box<dyn portable_pty::MasterPty + Send>,
}

impl Terminal {
    fn open(arguments: &[&str]) -> Self {
        Self::open_with(arguments, "")
    }

    /// Opens it with a value of `NO_COLOR`.
    fn open_with(arguments: &[&str], no_color: &str) -> Self {
        let size = PtySize { rows: 24, cols: 80, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).unwrap();
        let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_rubscope"));
        command.args(arguments);
        command.env("TERM", "xterm-256color");
        command.env("NO_COLOR", no_color);
        let child = pair.slave.spawn_command(command).unwrap();
        drop(pair.slave);
        let mut reader = pair.master.try_clone_reader().unwrap();
        let (sender, output) = channel();
        std::thread::spawn(move || {
            let mut buffer = [0; 4096];
            while let Ok(count) = reader.read(&mut buffer) {
                if count == 0 || sender.send(buffer[..count].to_vec()).is_err() {
                    return;
                }
            }
        });
        let input = pair.master.take_writer().unwrap();
        Self { parser: vt100::Parser::default(), output, input, child, _pair: pair.master }
    }

    fn send(&mut self, keys: &str) {
        self.input.write_all(keys.as_bytes()).unwrap();
        self.input.flush().unwrap();
    }

    /// Waits until the screen contains a text.
    fn wait_for(&mut self, text: &str) {
        let began = Instant::now();
        while !self.parser.screen().contents().contains(text) {
            assert!(
                began.elapsed() < PATIENCE,
                "no {text:?} in\n{}",
                self.parser.screen().contents()
            );
            match self.output.recv_timeout(Duration::from_millis(100)) {
                Ok(bytes) => self.parser.process(&bytes),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    panic!("ended without {text:?}:\n{}", self.parser.screen().contents())
                }
            }
        }
    }

    /// Waits for the end; the exit status.
    fn wait(&mut self) -> u32 {
        let began = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(began.elapsed() < PATIENCE, "it does not end");
            // Continue to read: a full pipe would block the program.
            if let Ok(bytes) = self.output.recv_timeout(Duration::from_millis(20)) {
                self.parser.process(&bytes);
            }
        };
        while let Ok(bytes) = self.output.recv_timeout(Duration::from_millis(200)) {
            self.parser.process(&bytes);
        }
        status.exit_code()
    }

    fn is_coloured(&self) -> bool {
        let screen = self.parser.screen();
        let colour = |row, column| screen.cell(row, column).map(vt100::Cell::fgcolor);
        let mut cells = (0..24).flat_map(|row| (0..80).map(move |column| (row, column)));
        cells.any(|(row, column)| colour(row, column) != Some(vt100::Color::Default))
    }

    fn assert_restored(&self) {
        let screen = self.parser.screen();
        assert!(!screen.alternate_screen(), "still on the alternate screen");
        assert!(!screen.hide_cursor(), "the cursor is still hidden");
    }
}

#[test]
fn opens_turns_a_knob_sees_the_verdict_change_and_quits() {
    let mut terminal = Terminal::open(&["--step", "2e-7", "--end", "0.02"]);
    terminal.wait_for(" LOCKED ");
    assert!(terminal.parser.screen().alternate_screen());
    // Nine knobs down is the contact law.
    terminal.send("jjjjjjjjj");
    terminal.wait_for("contact law");
    terminal.send("l");
    terminal.wait_for(" DECAY ");
    terminal.send("h");
    terminal.wait_for(" LOCKED ");
    terminal.send("q");
    assert_eq!(terminal.wait(), 0);
    terminal.assert_restored();
}

#[test]
fn a_termination_signal_restores_the_terminal_and_is_told_in_the_status() {
    let mut terminal = Terminal::open(&["--step", "2e-7", "--end", "0.02"]);
    terminal.wait_for(" LOCKED ");
    let id = terminal.child.process_id().unwrap().to_string();
    let sent = std::process::Command::new("kill").args(["-TERM", &id]).status().unwrap();
    assert!(sent.success());
    assert_eq!(terminal.wait(), 128 + 15);
    terminal.assert_restored();
}

#[test]
fn a_refused_scene_never_takes_the_terminal() {
    let mut terminal = Terminal::open(&["--set", "bladed_disk.blades=0"]);
    assert_eq!(terminal.wait(), 2);
    let text = terminal.parser.screen().contents();
    assert!(text.contains("bladed_disk.blades = 0"), "{text}");
    terminal.assert_restored();
}

#[test]
fn no_color_leaves_the_screen_without_colours_unless_it_is_empty() {
    for (value, coloured) in [("", true), ("1", false)] {
        let mut terminal = Terminal::open_with(&["--end", "1e-3"], value);
        terminal.wait_for(" LOCKED ");
        assert_eq!(terminal.is_coloured(), coloured, "NO_COLOR={value:?}");
        terminal.send("q");
        assert_eq!(terminal.wait(), 0);
    }
}
