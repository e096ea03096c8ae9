//! Bytes become events, one byte after the other.

use std::collections::VecDeque;
use std::time::Duration;

use crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers};

use super::sequence::{Piece, piece};
use crate::tui::ground::Ground;

/// Ctrl-C as a byte. No sequence and no letter contains it.
const CTRL_C: u8 = 3;
const ESCAPE: u8 = 0x1b;
const PASTE_ENDS: &[u8] = b"\x1b[201~";

/// The letters that begin a report behind Escape: `OSC`, `DCS`, `APC`, `PM`. A report may come in
/// pieces, of which no byte is a key.
const REPORTS: &[u8] = b"]P_^";
/// After so long without a byte the end of a pasted text, or of a report, is lost. Shorter: the
/// rest of what comes over a slow line acts as keys.
const LOST: Duration = Duration::from_secs(2);

/// Bytes of an event that is not complete.
#[derive(Debug, Default)]
pub struct Decoder {
    /// The beginning of a sequence, or of a letter of several bytes.
    begun: Vec<u8>,
    /// The text that is being pasted.
    pasted: Option<Vec<u8>>,
    /// The latest report of the background.
    pub ground: Option<Ground>,
}

impl Decoder {
    /// Takes one byte.
    pub fn take(&mut self, byte: u8, found: &mut VecDeque<Event>) {
        if let Some(text) = &mut self.pasted {
            text.push(byte);
            if let Some(text) = text.strip_suffix(PASTE_ENDS) {
                found.push_back(Event::Paste(String::from_utf8_lossy(text).into_owned()));
                self.pasted = None;
            }
            return;
        }
        if byte == CTRL_C {
            // It must be heard whatever was begun before it.
            self.begun.clear();
        }
        self.begun.push(byte);
        match piece(&self.begun) {
            Piece::Unfinished => return,
            Piece::Paste => self.pasted = Some(Vec::new()),
            Piece::Event(event) => found.push_back(event),
            Piece::Ground(ground) => self.ground = Some(ground),
            Piece::Nothing => {}
        }
        self.begun.clear();
    }

    /// Records that no more bytes come at once: an Escape alone is the key of this name.
    pub fn end(&mut self, found: &mut VecDeque<Event>) {
        if self.begun == [ESCAPE] {
            self.begun.clear();
            found.push_back(Event::Key(KeyCode::Esc.into()));
        }
    }

    /// Records that nothing has come for this long: what was begun swallows no key, and a Ctrl-C
    /// that came last is a key even where the end of a pasted text was lost.
    pub fn pause(&mut self, silent: Duration, found: &mut VecDeque<Event>) {
        self.end(found);
        match *self.begun {
            // Of a user, with Alt.
            [ESCAPE, letter] if REPORTS.contains(&letter) => {
                let key = KeyEvent::new(KeyCode::Char(char::from(letter)), KeyModifiers::ALT);
                found.push_back(Event::Key(key));
                self.begun.clear();
            }
            [ESCAPE, letter, ..] if REPORTS.contains(&letter) && silent < LOST => {}
            _ => self.begun.clear(),
        }
        if self.pasted.take_if(|text| text.last() == Some(&CTRL_C)).is_some() {
            found.push_back(Event::Key(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)));
        }
        if let Some(text) = self.pasted.take_if(|_| silent >= LOST) {
            found.push_back(Event::Paste(String::from_utf8_lossy(&text).into_owned()));
        }
    }

    /// Returns whether more must come.
    pub fn is_unfinished(&self) -> bool {
        !self.begun.is_empty() || self.pasted.is_some()
    }
}

#[cfg(test)]
mod tests {
    use crossterm::event::{MouseButton, MouseEvent, MouseEventKind};
    use proptest::prelude::*;

    use super::*;

    const NONE: KeyModifiers = KeyModifiers::NONE;

    fn key(code: KeyCode, modifiers: KeyModifiers) -> Event {
        Event::Key(KeyEvent::new(code, modifiers))
    }

    fn ctrl_c() -> Event {
        key(KeyCode::Char('c'), KeyModifiers::CONTROL)
    }

    fn mouse(kind: MouseEventKind, column: u16, row: u16, modifiers: KeyModifiers) -> Event {
        Event::Mouse(MouseEvent { kind, column, row, modifiers })
    }

    /// The events of bytes that come in one piece, with nothing after them.
    fn events(bytes: &[u8]) -> Vec<Event> {
        let (mut decoder, mut found) = (Decoder::default(), VecDeque::new());
        bytes.iter().for_each(|byte| decoder.take(*byte, &mut found));
        decoder.end(&mut found);
        found.into()
    }

    #[test]
    fn keys_are_told_by_what_terminals_send_for_them() {
        use KeyCode::*;
        let (shift, ctrl, alt) = (KeyModifiers::SHIFT, KeyModifiers::CONTROL, KeyModifiers::ALT);
        for (bytes, code, modifiers) in [
            ("q", Char('q'), NONE),
            ("Q", Char('Q'), shift),
            ("ζ", Char('ζ'), NONE),
            (" ", Char(' '), NONE),
            ("\r", Enter, NONE),
            ("\n", Enter, NONE),
            ("\t", Tab, NONE),
            ("\x7f", Backspace, NONE),
            ("\0", Char(' '), ctrl),
            ("\x0c", Char('l'), ctrl),
            ("\x1a", Char('z'), ctrl),
            ("\x1c", Char('4'), ctrl),
            ("\x1b", Esc, NONE),
            ("\x1b\x1b", Esc, NONE),
            ("\x1bx", Char('x'), alt),
            ("\x1bX", Char('X'), alt | shift),
            ("\x1bζ", Char('ζ'), alt),
            ("\x1b\r", Enter, alt),
            ("\x1b[A", Up, NONE),
            ("\x1b[B", Down, NONE),
            ("\x1b[C", Right, NONE),
            ("\x1b[D", Left, NONE),
            ("\x1b[H", Home, NONE),
            ("\x1b[F", End, NONE),
            ("\x1b[Z", BackTab, shift),
            ("\x1bOA", Up, NONE),
            ("\x1bOF", End, NONE),
            ("\x1bOQ", F(2), NONE),
            ("\x1b[[C", F(3), NONE),
            ("\x1b[1;2A", Up, shift),
            ("\x1b[1;5D", Left, ctrl),
            ("\x1b[1;3P", F(1), alt),
            ("\x1b[5~", PageUp, NONE),
            ("\x1b[6;5~", PageDown, ctrl),
            ("\x1b[7~", Home, NONE),
            ("\x1b[15~", F(5), NONE),
            ("\x1b[17~", F(6), NONE),
            ("\x1b[24~", F(12), NONE),
            ("\x1b[99;5u", Char('c'), ctrl),
            ("\x1b[27u", Esc, NONE),
        ] {
            assert_eq!(events(bytes.as_bytes()), [key(code, modifiers)], "{bytes:?}");
        }
    }

    #[test]
    fn the_mouse_is_understood_in_every_way_to_write_it() {
        use MouseEventKind::*;
        let (left, right) = (MouseButton::Left, MouseButton::Right);
        for (bytes, expected) in [
            ("\x1b[<0;5;9M", mouse(Down(left), 4, 8, NONE)),
            ("\x1b[<0;5;9m", mouse(Up(left), 4, 8, NONE)),
            ("\x1b[<2;300;200M", mouse(Down(right), 299, 199, NONE)),
            ("\x1b[<32;5;9M", mouse(Drag(left), 4, 8, NONE)),
            ("\x1b[<35;5;9M", mouse(Moved, 4, 8, NONE)),
            ("\x1b[<64;5;9M", mouse(ScrollUp, 4, 8, NONE)),
            ("\x1b[<69;5;9M", mouse(ScrollDown, 4, 8, KeyModifiers::SHIFT)),
            ("\x1b[<80;5;9M", mouse(ScrollUp, 4, 8, KeyModifiers::CONTROL)),
            ("\x1b[96;5;9M", mouse(ScrollUp, 4, 8, NONE)),
            ("\x1b[M %)", mouse(Down(left), 4, 8, NONE)),
            // No terminal has a column 0.
            ("\x1b[<0;0;0M", mouse(Down(left), 0, 0, NONE)),
        ] {
            assert_eq!(events(bytes.as_bytes()), [expected], "{bytes:?}");
        }
    }

    #[test]
    fn a_pasted_text_is_one_event_whatever_is_in_it() {
        let text = "a\r\u{3}\u{1b}[Bζ\u{1b}";
        let pasted = events(format!("j\u{1b}[200~{text}\u{1b}[201~k").as_bytes());
        let plain = |letter| key(KeyCode::Char(letter), NONE);
        assert_eq!(pasted, [plain('j'), Event::Paste(text.into()), plain('k')]);
    }

    #[test]
    fn what_no_key_sends_is_no_key_and_takes_no_other_with_it() {
        for bytes in [
            "\x1b[I",
            "\x1b[O",
            "\x1b[?62;22c",
            "\x1b[9999999999A",
            "\x1b[<0;1M",
            "\x1b[<1;2;3;4x",
            "\x1b[200A",
            "\x1b[;;;~",
            "\x1b[24;80R",
            "\x1bOz",
            "\x1b]4;1;rgb:ffff/0000/0000\x07",
            "\x1b]52;c;cXE=\x1b\\",
            "\x1bP1+r544e=787465726d\x1b\\",
            "\x1b_Gi=31;OK\x1b\\",
            "\x1b^q\x1b\\",
        ] {
            let found = events(format!("{bytes}q").as_bytes());
            assert_eq!(found, [key(KeyCode::Char('q'), NONE)], "{bytes:?}");
        }
        assert_eq!(events(b"\xffq"), [key(KeyCode::Char('q'), NONE)]);
    }

    #[test]
    fn ctrl_c_is_heard_after_everything_that_is_unfinished() {
        for begun in ["", "\x1b", "\x1b[", "\x1b[<0;1", "\x1b[M ", "\x1bO", "\x1b[[", "\x1b[1;"] {
            let found = events(format!("{begun}\u{3}").as_bytes());
            assert_eq!(found.last(), Some(&ctrl_c()), "{begun:?}");
        }
        assert_eq!(events(b"\xc3\x03"), [ctrl_c()]);
    }

    #[test]
    fn in_a_pasted_text_without_end_ctrl_c_is_heard_when_nothing_follows_it() {
        let (mut decoder, mut found) = (Decoder::default(), VecDeque::new());
        let mut take = |bytes: &[u8], decoder: &mut Decoder| {
            bytes.iter().for_each(|byte| decoder.take(*byte, &mut found));
            decoder.end(&mut found);
            let before = found.len();
            decoder.pause(Duration::ZERO, &mut found);
            (before, found.drain(..).collect::<Vec<_>>())
        };
        // A text that comes slowly stays one text.
        assert_eq!(take(b"\x1b[200~ab", &mut decoder), (0, vec![]));
        assert_eq!(take(b"\x03c", &mut decoder), (0, vec![]));
        assert_eq!(take(b"\x1b[201~", &mut decoder), (1, vec![Event::Paste("ab\u{3}c".into())]));
        assert_eq!(take(b"\x1b[200~abc\x03", &mut decoder), (0, vec![ctrl_c()]));
        assert_eq!(take(b"q", &mut decoder), (1, vec![key(KeyCode::Char('q'), NONE)]));
    }

    #[test]
    fn what_was_begun_before_a_pause_takes_no_key_with_it() {
        let (mut decoder, mut found) = (Decoder::default(), VecDeque::new());
        let mut take = |bytes: &[u8], silent, decoder: &mut Decoder| {
            bytes.iter().for_each(|byte| decoder.take(*byte, &mut found));
            decoder.pause(silent, &mut found);
            found.drain(..).collect::<Vec<_>>()
        };
        let (moment, q) = (LOST / 20, [key(KeyCode::Char('q'), NONE)]);
        for begun in ["\x1b[<0;1", "\x1b[", "\x1bO", "\x1b[M ", "\x1b[[", "\x1b[1;"] {
            assert_eq!(take(begun.as_bytes(), moment, &mut decoder), [], "{begun:?}");
            assert!(!decoder.is_unfinished());
            assert_eq!(take(b"q", moment, &mut decoder), q, "{begun:?}");
        }
        // A report that comes in pieces is none of the user's keys.
        for piece in ["\x1b]11;rg", "b:ffff/f", "fff/ffff"] {
            assert_eq!(take(piece.as_bytes(), moment, &mut decoder), [], "{piece:?}");
            assert!(decoder.is_unfinished() && decoder.ground.is_none());
        }
        assert_eq!(take(b"\x1b\\q", moment, &mut decoder), q);
        assert_eq!(decoder.ground.take(), Some(Ground::Light));
        assert_eq!(take(b"\x1b]11;rgb:0/0/0\x07q", moment, &mut decoder), q);
        assert_eq!(decoder.ground.take(), Some(Ground::Dark));
        assert_eq!(take(b"\x1b]11;rgb:0/0", LOST, &mut decoder), []);
        assert_eq!(take(b"q", moment, &mut decoder), q);
        let alt = [key(KeyCode::Char(']'), KeyModifiers::ALT)];
        assert_eq!(take(b"\x1b]", moment, &mut decoder), alt);
        assert_eq!(decoder.ground, None);
        assert_eq!(take(b"\xc3", moment, &mut decoder), []);
        assert_eq!(take(b"q", moment, &mut decoder), q);
        // A pasted text has more time; what there is of it is not lost.
        assert_eq!(take(b"\x1b[200~ab", moment, &mut decoder), []);
        assert!(decoder.is_unfinished());
        assert_eq!(take(b"c", LOST, &mut decoder), [Event::Paste("abc".into())]);
        assert_eq!(take(b"q", moment, &mut decoder), q);
    }

    proptest! {
        #[test]
        fn any_bytes_are_taken_and_ctrl_c_after_them_is_heard(
            bytes in proptest::collection::vec(
                prop_oneof![any::<u8>(), proptest::sample::select(&b"\x1b[<;0129~MmO?u"[..])],
                0..60,
            )
        ) {
            let (mut decoder, mut found) = (Decoder::default(), VecDeque::new());
            bytes.iter().chain(b"\x03").for_each(|byte| decoder.take(*byte, &mut found));
            decoder.end(&mut found);
            decoder.pause(Duration::ZERO, &mut found);
            prop_assert_eq!(found.back(), Some(&ctrl_c()));
            prop_assert!(!decoder.is_unfinished());
        }
    }
}
