//! What the terminal sends, as events. `vte` takes the bytes apart. The reader of crossterm keeps a
//! sequence that never ends, so that no Ctrl-C is heard any more, and takes reports of the terminal
//! for keys.

use std::collections::VecDeque;
use std::io::Result;
use std::sync::mpsc::Sender;
use std::thread;
use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use vte::{Params, Parser, Perform};

use super::events::ScreenEvent;
use super::ground::Ground;
use super::terminal::{self, INTERRUPT};

const CTRL_C: u8 = 3;
const ESCAPE: u8 = 0x1b;

/// After so long without a byte, the end of what was begun is lost. Shorter: the rest of a pasted
/// text that comes over a slow line acts as keys.
const LOST: Duration = Duration::from_secs(2);

/// Time for the rest of a sequence that a full buffer has cut.
const REST: Duration = Duration::from_millis(5);

/// Starts the thread that reads the keyboard, including the terminal's report of its background.
///
/// # Errors
/// Fails if the system cannot start a thread.
pub fn read_keys(to: Sender<ScreenEvent>) -> Result<()> {
    let read = move || {
        let mut input = Input::default();
        loop {
            let event = input.next().unwrap_or(ScreenEvent::InputClosed);
            let last = event == ScreenEvent::InputClosed;
            if let ScreenEvent::Key(key) = &event {
                terminal::hear(key);
            }
            if to.send(event).is_err() || last {
                return;
            }
        }
    };
    thread::Builder::new().name("rubscope-input".into()).spawn(read).map(|_| ())
}

/// The bytes of the terminal, taken apart.
#[derive(Default)]
struct Input {
    parser: Parser,
    heard: Heard,
    /// The last byte since a long silence.
    last: Option<u8>,
}

impl Input {
    /// Waits for the next event.
    ///
    /// # Errors
    /// The terminal is closed.
    fn next(&mut self) -> Result<ScreenEvent> {
        loop {
            if let Some(event) = self.heard.events.pop_front() {
                return Ok(event);
            }
            let mut bytes = terminal::read(self.last.map(|_| LOST))?;
            if bytes.len() > 1 && bytes.ends_with(&[ESCAPE]) {
                // The buffer of the system was full: the rest of the sequence follows.
                bytes.extend(terminal::read(Some(REST))?);
            }
            if bytes.is_empty() { self.lose() } else { self.take(&bytes) }
        }
    }

    /// Takes bytes that came together.
    fn take(&mut self, bytes: &[u8]) {
        self.last = bytes.last().copied();
        let mut bytes = bytes;
        // A terminal sends a sequence in one piece: an Escape before a single letter is a key that
        // was pressed before another.
        if let [ESCAPE, letter @ ..] = bytes
            && is_letter(letter)
            && self.heard.pasted.is_none()
        {
            self.escape();
            bytes = letter;
        }
        for byte in bytes {
            if *byte == CTRL_C && self.heard.pasted.is_none() {
                // It must be heard whatever was begun before it.
                self.forget();
            }
            if self.heard.skipped > 0 {
                self.heard.skipped -= 1;
            } else {
                self.parser.advance(&mut self.heard, &[*byte]);
            }
        }
        if self.last == Some(ESCAPE) && self.heard.pasted.is_none() {
            self.escape();
        }
    }

    /// Records that nothing has come for [`LOST`]: what was begun swallows no key, and what there is
    /// of a pasted text is taken, or the Ctrl-C that was pressed behind it.
    fn lose(&mut self) {
        self.forget();
        let last = self.last.take();
        if let Some(text) = self.heard.pasted.take() {
            self.heard.events.push_back(match last {
                Some(CTRL_C) => ScreenEvent::Key(INTERRUPT),
                _ => ScreenEvent::Pasted(text),
            });
        }
    }

    /// Presses the key Escape, which begins no sequence.
    fn escape(&mut self) {
        self.forget();
        self.heard.press(KeyCode::Esc);
    }

    /// Forgets the sequence that was begun.
    fn forget(&mut self) {
        self.parser = Parser::new();
        (self.heard.skipped, self.heard.function) = (0, false);
    }
}

/// Returns whether bytes are one letter, and not the end of a report.
fn is_letter(bytes: &[u8]) -> bool {
    bytes != b"\\" && std::str::from_utf8(bytes).is_ok_and(|text| text.chars().count() == 1)
}

/// The events of the bytes so far.
#[derive(Default)]
struct Heard {
    events: VecDeque<ScreenEvent>,
    /// The text that is being pasted.
    pasted: Option<String>,
    /// Number of the next bytes that belong to the sequence before them.
    skipped: u8,
    /// Whether the next letter is that of a key, after `ESC O`.
    function: bool,
}

impl Heard {
    fn press(&mut self, code: KeyCode) {
        self.events.push_back(ScreenEvent::Key(code.into()));
    }

    /// Takes a key that sends a letter, or a number and `~`; `held` is one more than the bits of
    /// Shift, Alt and Control.
    fn pressed(&mut self, letter: char, number: u16, held: u16) {
        let code = match (letter, number) {
            ('A', _) => KeyCode::Up,
            ('B', _) => KeyCode::Down,
            ('C', _) => KeyCode::Right,
            ('D', _) => KeyCode::Left,
            ('H', _) | ('~', 1 | 7) => KeyCode::Home,
            ('F', _) | ('~', 4 | 8) => KeyCode::End,
            ('Z', _) => KeyCode::BackTab,
            ('~', 3) => KeyCode::Delete,
            ('~', 5) => KeyCode::PageUp,
            ('~', 6) => KeyCode::PageDown,
            _ => return,
        };
        let held = held.saturating_sub(1);
        let modifiers = modifiers(held & 1 != 0, held & 4 != 0);
        self.events.push_back(ScreenEvent::Key(KeyEvent::new(code, modifiers)));
    }

    /// Takes a button of the mouse that was pressed at a column and a row, counted from 1.
    fn clicked(&mut self, button: u16, column: u16, row: u16) {
        let kind = match button & !0b11100 {
            0 => MouseEventKind::Down(MouseButton::Left),
            2 => MouseEventKind::Down(MouseButton::Right),
            64 => MouseEventKind::ScrollUp,
            65 => MouseEventKind::ScrollDown,
            _ => return,
        };
        let modifiers = modifiers(button & 4 != 0, button & 16 != 0);
        let (column, row) = (column.saturating_sub(1), row.saturating_sub(1));
        self.events.push_back(ScreenEvent::Mouse(MouseEvent { kind, column, row, modifiers }));
    }
}

fn modifiers(shift: bool, control: bool) -> KeyModifiers {
    let mut held = KeyModifiers::NONE;
    held.set(KeyModifiers::SHIFT, shift);
    held.set(KeyModifiers::CONTROL, control);
    held
}

impl Perform for Heard {
    fn print(&mut self, letter: char) {
        match (&mut self.pasted, letter) {
            // Bytes that are no letter.
            (_, char::REPLACEMENT_CHARACTER) => {}
            (Some(text), letter) => text.push(letter),
            (None, letter) if std::mem::take(&mut self.function) => self.pressed(letter, 0, 0),
            (None, '\x7f') => self.press(KeyCode::Backspace),
            (None, letter) => self.press(KeyCode::Char(letter)),
        }
    }

    fn execute(&mut self, byte: u8) {
        match (&mut self.pasted, byte) {
            (Some(text), byte) => text.push(char::from(byte)),
            (None, b'\r' | b'\n') => self.press(KeyCode::Enter),
            (None, b'\t') => self.press(KeyCode::Tab),
            (None, 1..=26) => {
                let letter = KeyCode::Char(char::from(byte - 1 + b'a'));
                let key = KeyEvent::new(letter, KeyModifiers::CONTROL);
                self.events.push_back(ScreenEvent::Key(key));
            }
            _ => {}
        }
    }

    fn csi_dispatch(&mut self, numbers: &Params, sign: &[u8], _: bool, last: char) {
        let mut numbers = numbers.iter().map(|number| number.first().copied().unwrap_or(0));
        let [first, second, third] = [(); 3].map(|()| numbers.next().unwrap_or(0));
        match (sign, last, first) {
            (b"", '~', 200) => self.pasted = Some(String::new()),
            (b"", '~', 201) => {
                self.events.extend(self.pasted.take().map(ScreenEvent::Pasted));
            }
            _ if self.pasted.is_some() => {}
            (b"<", 'M', button) => self.clicked(button, second, third),
            // The oldest report of the mouse has three bytes more, F1 to F5 of the console of Linux
            // one letter.
            (b"", 'M', 0) => self.skipped = 3,
            (b"", '[', _) => self.skipped = 1,
            (b"", letter, number) => self.pressed(letter, number, second),
            _ => {}
        }
    }

    fn esc_dispatch(&mut self, sign: &[u8], _: bool, last: u8) {
        match (&self.pasted, sign, last) {
            (None, [], b'O') => self.function = true,
            // The end of a report.
            (None, [], b'\\') => {}
            (None, [], letter) => {
                self.press(KeyCode::Esc);
                self.press(KeyCode::Char(char::from(letter)));
            }
            _ => {}
        }
    }

    fn osc_dispatch(&mut self, report: &[&[u8]], _: bool) {
        if let [b"11", colour] = report {
            self.events.extend(Ground::reported(colour).map(ScreenEvent::Ground));
        }
    }
}

#[cfg(test)]
mod tests {
    use fastrand::Rng;

    use super::*;

    const NONE: KeyModifiers = KeyModifiers::NONE;
    const Q: ScreenEvent = ScreenEvent::Key(KeyEvent::new(KeyCode::Char('q'), NONE));

    fn key(code: KeyCode, modifiers: KeyModifiers) -> ScreenEvent {
        ScreenEvent::Key(KeyEvent::new(code, modifiers))
    }

    /// The events of bytes that come in pieces, and of a long silence behind them.
    fn heard(pieces: &[&[u8]]) -> Vec<ScreenEvent> {
        let mut input = Input::default();
        pieces.iter().for_each(|piece| input.take(piece));
        input.lose();
        input.heard.events.into()
    }

    #[test]
    fn keys_are_told_by_what_terminals_send_for_them() {
        use KeyCode::*;
        let (shift, control) = (KeyModifiers::SHIFT, KeyModifiers::CONTROL);
        for (bytes, code, modifiers) in [
            ("Q", Char('Q'), NONE),
            ("ζ", Char('ζ'), NONE),
            (" ", Char(' '), NONE),
            ("\r", Enter, NONE),
            ("\n", Enter, NONE),
            ("\t", Tab, NONE),
            ("\x7f", Backspace, NONE),
            ("\x0c", Char('l'), control),
            ("\x1a", Char('z'), control),
            ("\x1b", Esc, NONE),
            ("\x1b[A", Up, NONE),
            ("\x1b[B", Down, NONE),
            ("\x1b[C", Right, NONE),
            ("\x1b[D", Left, NONE),
            ("\x1b[H", Home, NONE),
            ("\x1b[F", End, NONE),
            ("\x1b[Z", BackTab, NONE),
            ("\x1bOA", Up, NONE),
            ("\x1bOF", End, NONE),
            ("\x1b[1;2A", Up, shift),
            ("\x1b[1;5D", Left, control),
            ("\x1b[3~", Delete, NONE),
            ("\x1b[5~", PageUp, NONE),
            ("\x1b[6;5~", PageDown, control),
            ("\x1b[7~", Home, NONE),
        ] {
            assert_eq!(heard(&[bytes.as_bytes()]), [key(code, modifiers)], "{bytes:?}");
        }
        for letter in ["q", "ζ", " ", "[", "O", "]"] {
            let both = [key(Esc, NONE), key(Char(letter.chars().next().unwrap()), NONE)];
            assert_eq!(heard(&[format!("\x1b{letter}").as_bytes()]), both);
        }
        assert_eq!(heard(&[b"\x1bq\x1b"]), [key(Esc, NONE), Q, key(Esc, NONE)]);
    }

    #[test]
    fn clicks_and_the_wheel_are_understood() {
        use MouseEventKind::*;
        let mouse = |kind, column, row, modifiers| {
            vec![ScreenEvent::Mouse(MouseEvent { kind, column, row, modifiers })]
        };
        let (left, right) = (Down(MouseButton::Left), Down(MouseButton::Right));
        for (bytes, expected) in [
            ("\x1b[<0;5;9M", mouse(left, 4, 8, NONE)),
            ("\x1b[<2;300;200M", mouse(right, 299, 199, NONE)),
            ("\x1b[<64;5;9M", mouse(ScrollUp, 4, 8, NONE)),
            ("\x1b[<69;5;9M", mouse(ScrollDown, 4, 8, KeyModifiers::SHIFT)),
            ("\x1b[<80;5;9M", mouse(ScrollUp, 4, 8, KeyModifiers::CONTROL)),
            // No terminal has a column 0.
            ("\x1b[<0;0;0M", mouse(left, 0, 0, NONE)),
            ("\x1b[<0;5;9m", vec![]),
            ("\x1b[<32;5;9M", vec![]),
        ] {
            assert_eq!(heard(&[bytes.as_bytes()]), expected, "{bytes:?}");
        }
    }

    #[test]
    fn a_pasted_text_is_one_event_and_comes_as_slowly_as_it_likes() {
        let pasted = |text: &str| ScreenEvent::Pasted(text.into());
        let pieces: [&[u8]; 4] = [b"q\x1b[200~a\r\x03", b"\x1b", b"[B\xce", b"\xb6\x1b[201~q"];
        assert_eq!(heard(&pieces), [Q, pasted("a\r\u{3}ζ"), Q]);
        assert_eq!(heard(&[b"\x1b[200~abc"]), [pasted("abc")]);
        assert_eq!(heard(&[b"\x1b[200~abc\x03"]), [ScreenEvent::Key(INTERRUPT)]);
    }

    #[test]
    fn what_no_key_sends_is_no_key_and_takes_no_other_with_it() {
        for bytes in [
            "\x1b[I",
            "\x1b[O",
            "\x1b[?62;22c",
            "\x1b[9999999999~",
            "\x1b[<1;2;3;4x",
            "\x1b[;;;~",
            "\x1b[24;80R",
            "\x1b[99;5u",
            "\x1bOz",
            "\x1b[[A",
            "\x1b[M %)",
            "\x1b]4;1;rgb:ffff/0000/0000\x07",
            "\x1b]52;c;cXE=\x1b\\",
            "\x1bP1+r544e=787465726d\x1b\\",
            "\x1b_Gi=31;OK\x1b\\",
            "\x1b^q\x1b\\",
        ] {
            assert_eq!(heard(&[bytes.as_bytes(), b"q"]), [Q], "{bytes:?}");
        }
        assert_eq!(heard(&[b"\xffq"]), [Q]);
        let ground = ScreenEvent::Ground(Ground::Light);
        assert_eq!(heard(&[b"\x1b]11;rg", b"b:ff/ff/ff", b"\x1b\\", b"q"]), [ground, Q]);
    }

    #[test]
    fn what_was_begun_before_a_silence_takes_no_key_with_it() {
        for begun in ["\x1b[<0;1", "\x1b[1;", "\x1b[M ", "\x1b[[", "\x1b]11;rgb:", "q\x1bO"] {
            let mut input = Input::default();
            input.take(begun.as_bytes());
            input.lose();
            input.take(b"q");
            assert_eq!(input.heard.events.pop_back(), Some(Q), "{begun:?}");
        }
    }

    #[test]
    fn any_bytes_are_taken_and_ctrl_c_after_them_is_heard() {
        for case in 0..256 {
            let rng = &mut Rng::with_seed(case);
            let signs = b"\x1b[<;0129~MO?]P_";
            let byte = |rng: &mut Rng| {
                if rng.bool() { rng.u8(..) } else { signs[rng.usize(..signs.len())] }
            };
            let bytes: Vec<u8> = (0..rng.usize(0..60)).map(|_| byte(rng)).collect();
            let last = heard(&[&bytes, b"\x03"]).pop();
            assert_eq!(last, Some(ScreenEvent::Key(INTERRUPT)), "{bytes:?}");
        }
    }
}
