//! A key with its modifiers: from a key event or a sign of the footer, and as text for the help.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// A key with its modifiers. For a letter, Shift is part of the character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chord {
    /// The key without its modifiers; a letter is a capital if Shift is held.
    pub code: KeyCode,
    /// Whether Control is held.
    pub ctrl: bool,
    /// Whether Shift is held, for keys other than characters.
    pub shift: bool,
}

impl Chord {
    /// Builds the chord of a key event: Shift is folded into letters.
    pub fn of(event: &KeyEvent) -> Self {
        let shift = event.modifiers.contains(KeyModifiers::SHIFT);
        let ctrl = event.modifiers.contains(KeyModifiers::CONTROL);
        let code = match event.code {
            // Some terminals report a lower-case letter together with Shift.
            KeyCode::Char(c) if shift && c.is_ascii_lowercase() => {
                KeyCode::Char(c.to_ascii_uppercase())
            }
            code => code,
        };
        let is_char = matches!(code, KeyCode::Char(_) | KeyCode::BackTab);
        Self { code, ctrl, shift: shift && !is_char }
    }
}

/// Creates the chord of a letter.
pub const fn letter(letter: char) -> Chord {
    key(KeyCode::Char(letter))
}

/// Creates the chord of a letter with Control.
pub const fn ctrl(letter: char) -> Chord {
    Chord { code: KeyCode::Char(letter), ctrl: true, shift: false }
}

/// Creates the chord of a key without modifiers.
pub const fn key(code: KeyCode) -> Chord {
    Chord { code, ctrl: false, shift: false }
}

/// Creates the chord of a key with Shift.
pub const fn shift(code: KeyCode) -> Chord {
    Chord { code, ctrl: false, shift: true }
}

/// Creates the key that a character stands for in the footer and in `--lines`: that of an arrow
/// sign, or of the character itself.
impl From<char> for Chord {
    fn from(sign: char) -> Self {
        let code = match sign {
            '←' => KeyCode::Left,
            '→' => KeyCode::Right,
            '↑' => KeyCode::Up,
            '↓' => KeyCode::Down,
            letter => KeyCode::Char(letter),
        };
        key(code)
    }
}

impl std::fmt::Display for Chord {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.ctrl {
            write!(out, "Ctrl-")?;
        }
        if self.shift {
            write!(out, "Shift-")?;
        }
        match self.code {
            KeyCode::Char(' ') => write!(out, "Space"),
            KeyCode::Char(c) if self.ctrl => write!(out, "{}", c.to_ascii_uppercase()),
            KeyCode::Char(c) => write!(out, "{c}"),
            KeyCode::Up => write!(out, "Up"),
            KeyCode::Down => write!(out, "Down"),
            KeyCode::Left => write!(out, "Left"),
            KeyCode::Right => write!(out, "Right"),
            KeyCode::BackTab => write!(out, "Shift-Tab"),
            code => write!(out, "{code:?}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shift_belongs_to_letters_and_stands_beside_arrows() {
        let press = |code, modifiers| Chord::of(&KeyEvent::new(code, modifiers));
        assert_eq!(press(KeyCode::Char('H'), KeyModifiers::SHIFT), letter('H'));
        assert_eq!(press(KeyCode::Char('h'), KeyModifiers::SHIFT), letter('H'));
        assert_eq!(press(KeyCode::Left, KeyModifiers::SHIFT), shift(KeyCode::Left));
        assert_eq!(press(KeyCode::Char('?'), KeyModifiers::SHIFT), letter('?'));
        assert_eq!(press(KeyCode::BackTab, KeyModifiers::SHIFT), key(KeyCode::BackTab));
    }
}
