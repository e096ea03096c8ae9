//! The sequences of xterm, and what other terminals send instead: which key or
//! which move of the mouse each stands for.

use crossterm::event::{
    Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, MouseButton, MouseEvent, MouseEventKind,
};

use crate::tui::ground::Ground;

/// Interpretation of the bytes since the last event.
#[derive(Debug)]
pub enum Piece {
    /// The beginning of a sequence.
    Unfinished,
    /// A complete event.
    Event(Event),
    /// The beginning of a pasted text.
    Paste,
    /// The background of the terminal.
    Ground(Ground),
    /// A sequence that is not known here.
    Nothing,
}

impl From<Option<Event>> for Piece {
    fn from(event: Option<Event>) -> Self {
        event.map_or(Self::Nothing, Self::Event)
    }
}

/// Interprets the bytes since the last event.
pub fn piece(bytes: &[u8]) -> Piece {
    match bytes {
        [] | [0x1b] => Piece::Unfinished,
        [0x1b, 0x1b, ..] => press(KeyCode::Esc),
        [0x1b, b'[', rest @ ..] => control_sequence(rest),
        [0x1b, b'O'] => Piece::Unfinished,
        [0x1b, b']' | b'P' | b'_' | b'^', rest @ ..] => report(rest),
        [0x1b, b'O', last, ..] => lettered(*last).map(|code| key(code, KeyModifiers::NONE)).into(),
        [0x1b, rest @ ..] => match piece(rest) {
            Piece::Event(Event::Key(with)) => {
                Piece::Event(key(with.code, with.modifiers | KeyModifiers::ALT))
            }
            other => other,
        },
        [b'\r' | b'\n', ..] => press(KeyCode::Enter),
        [b'\t', ..] => press(KeyCode::Tab),
        [0x7f, ..] => press(KeyCode::Backspace),
        [0, ..] => with_control(b' '),
        [low @ ..=0x1a, ..] => with_control(low - 1 + b'a'),
        [low @ ..=0x1f, ..] => with_control(low - 0x1c + b'4'),
        letter => match std::str::from_utf8(letter) {
            Ok(text) => text.chars().next().map(typed).into(),
            Err(error) if error.error_len().is_none() => Piece::Unfinished,
            Err(_) => Piece::Nothing,
        },
    }
}

/// Longest report of a terminal that is waited for \[bytes\]; a clipboard may send more, which
/// then are keys. Longer: after a report without end it takes as many keys until one is heard.
const LONGEST: usize = 4096;

/// Interprets what follows `ESC ]` and the like: a report of the terminal, of which only that of the
/// background was asked for.
fn report(bytes: &[u8]) -> Piece {
    match bytes {
        [report @ .., 0x07] | [report @ .., 0x1b, b'\\'] => {
            Ground::reported(report).map_or(Piece::Nothing, Piece::Ground)
        }
        bytes if bytes.len() < LONGEST => Piece::Unfinished,
        _ => Piece::Nothing,
    }
}

fn key(code: KeyCode, modifiers: KeyModifiers) -> Event {
    Event::Key(KeyEvent::new(code, modifiers))
}

fn press(code: KeyCode) -> Piece {
    Piece::Event(key(code, KeyModifiers::NONE))
}

fn with_control(letter: u8) -> Piece {
    Piece::Event(key(KeyCode::Char(char::from(letter)), KeyModifiers::CONTROL))
}

fn typed(letter: char) -> Event {
    let capital = if letter.is_uppercase() { KeyModifiers::SHIFT } else { KeyModifiers::NONE };
    key(KeyCode::Char(letter), capital)
}

/// Returns what follows `ESC [`.
fn control_sequence(bytes: &[u8]) -> Piece {
    match bytes {
        // The console of Linux has F1 to F5 so.
        [] | [b'['] => Piece::Unfinished,
        [b'[', last @ b'A'..=b'E', ..] => press(KeyCode::F(1 + last - b'A')),
        [b'M', button, column, row, ..] => {
            let place = |byte: &u8| u16::from(byte.saturating_sub(32));
            button.checked_sub(32).and_then(|b| mouse(b, place(column), place(row), false)).into()
        }
        [b'M', ..] => Piece::Unfinished,
        [numbers @ .., last @ 0x40..=0x7e] => {
            let Ok(numbers) = std::str::from_utf8(numbers) else { return Piece::Nothing };
            match (numbers, last) {
                ("200", b'~') => Piece::Paste,
                (_, b'M' | b'm') => pointed(numbers, *last == b'm').into(),
                (_, last) => pressed(numbers, *last).into(),
            }
        }
        [.., 0x20..=0x3f] => Piece::Unfinished,
        _ => Piece::Nothing,
    }
}

/// Buttons, columns and rows, all from 1.
fn pointed(numbers: &str, up: bool) -> Option<Event> {
    // Without the sign the button is counted from 32, as in the oldest form.
    let (numbers, offset) = match numbers.strip_prefix('<') {
        Some(numbers) => (numbers, 0),
        None => (numbers, 32),
    };
    let mut numbers = numbers.split(';');
    let button = numbers.next()?.parse::<u8>().ok()?.checked_sub(offset)?;
    let mut place = || numbers.next()?.parse::<u16>().ok();
    mouse(button, place()?, place()?, up)
}

/// Returns two bits of the button, Shift, Alt, Control, whether it moves, and two bits for the
/// wheel.
fn mouse(bits: u8, column: u16, row: u16, up: bool) -> Option<Event> {
    let button = match bits & 3 {
        0 => Some(MouseButton::Left),
        1 => Some(MouseButton::Middle),
        2 => Some(MouseButton::Right),
        _ => None,
    };
    let kind = match (bits >> 6, bits & 32 != 0, button) {
        (0, true, Some(button)) => MouseEventKind::Drag(button),
        (0 | 1, true, _) => MouseEventKind::Moved,
        (0, _, Some(button)) if up => MouseEventKind::Up(button),
        (0, _, Some(button)) => MouseEventKind::Down(button),
        // The button is not reported.
        (0, _, None) => MouseEventKind::Up(MouseButton::Left),
        (1, ..) => match bits & 3 {
            0 => MouseEventKind::ScrollUp,
            1 => MouseEventKind::ScrollDown,
            2 => MouseEventKind::ScrollLeft,
            _ => MouseEventKind::ScrollRight,
        },
        _ => return None,
    };
    let with = |bit: u8, key| if bits & bit == 0 { KeyModifiers::NONE } else { key };
    let modifiers =
        with(4, KeyModifiers::SHIFT) | with(8, KeyModifiers::ALT) | with(16, KeyModifiers::CONTROL);
    let (column, row) = (column.saturating_sub(1), row.saturating_sub(1));
    Some(Event::Mouse(MouseEvent { kind, column, row, modifiers }))
}

/// Returns a key with its modifiers: `CSI A`, `CSI 1;5 A`, `CSI 5 ~`, `CSI 99;5 u`.
fn pressed(numbers: &str, last: u8) -> Option<Event> {
    let mut numbers = numbers.split(';');
    let which = numbers.next()?.split(':').next()?;
    let mut with = numbers.next().unwrap_or("1").split(':');
    let (mask, kind) = (with.next()?, with.next());
    let code = match last {
        b'~' => numbered(which.parse().ok()?)?,
        b'u' => match char::from_u32(which.parse().ok()?)? {
            '\r' => KeyCode::Enter,
            '\t' => KeyCode::Tab,
            '\u{1b}' => KeyCode::Esc,
            '\u{7f}' => KeyCode::Backspace,
            letter => KeyCode::Char(letter),
        },
        _ if which.is_empty() || which == "1" => lettered(last)?,
        _ => return None,
    };
    let bits = mask.parse::<u8>().ok()?.saturating_sub(1);
    // In the order of their bits.
    let modifiers = [
        KeyModifiers::SHIFT,
        KeyModifiers::ALT,
        KeyModifiers::CONTROL,
        KeyModifiers::SUPER,
        KeyModifiers::HYPER,
        KeyModifiers::META,
    ];
    let mut key = KeyEvent::new(code, KeyModifiers::NONE);
    for (bit, modifier) in modifiers.into_iter().enumerate() {
        key.modifiers.set(modifier, bits & 1 << bit != 0);
    }
    if code == KeyCode::BackTab {
        key.modifiers |= KeyModifiers::SHIFT;
    }
    key.kind = match kind {
        Some("2") => KeyEventKind::Repeat,
        Some("3") => KeyEventKind::Release,
        _ => KeyEventKind::Press,
    };
    Some(Event::Key(key))
}

/// Returns the keys that end in a letter of their own.
fn lettered(last: u8) -> Option<KeyCode> {
    Some(match last {
        b'A' => KeyCode::Up,
        b'B' => KeyCode::Down,
        b'C' => KeyCode::Right,
        b'D' => KeyCode::Left,
        b'H' => KeyCode::Home,
        b'F' => KeyCode::End,
        b'Z' => KeyCode::BackTab,
        b'P'..=b'S' => KeyCode::F(1 + last - b'P'),
        _ => return None,
    })
}

/// Returns the keys that have a number.
fn numbered(number: u8) -> Option<KeyCode> {
    Some(match number {
        1 | 7 => KeyCode::Home,
        2 => KeyCode::Insert,
        3 => KeyCode::Delete,
        4 | 8 => KeyCode::End,
        5 => KeyCode::PageUp,
        6 => KeyCode::PageDown,
        // Gaps in the numbers, as they were on a VT220.
        11..=15 => KeyCode::F(number - 10),
        17..=21 => KeyCode::F(number - 11),
        23..=26 => KeyCode::F(number - 12),
        28..=29 => KeyCode::F(number - 13),
        31..=34 => KeyCode::F(number - 14),
        _ => return None,
    })
}
