//! The one table of key bindings. The handler looks keys up in it; the footer,
//! the help and the manual page are printed from it.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// What a key does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Leave the program.
    Quit,
    /// Stop as a job; the shell comes back.
    Suspend,
    /// Draw the whole screen anew.
    Redraw,
    /// Close what is open.
    Close,
    /// Show or hide the help.
    Help,
    /// The view after this one.
    NextView,
    /// The view before this one.
    PreviousView,
    /// A view by its digit.
    View(u8),
    /// Select the knob above.
    KnobAbove,
    /// Select the knob below.
    KnobBelow,
    /// Turn the selected knob; the sign is the direction.
    Turn {
        /// Up or down.
        up: bool,
        /// In large steps.
        coarse: bool,
    },
    /// Type a value.
    Type,
    /// Back to the scene's value.
    Reset,
    /// Undo a knob.
    Undo,
    /// Redo a knob.
    Redo,
    /// Stop and go.
    Pause,
    /// One step.
    Step,
    /// Begin the run anew.
    Restart,
    /// Fire the pulse into the running motion.
    Fire,
    /// Slower motion.
    Slower,
    /// Faster motion.
    Faster,
    /// A shorter page.
    ZoomIn,
    /// A longer page.
    ZoomOut,
    /// The first page length.
    ZoomReset,
    /// Ranges follow the data, or stand still.
    Autoscale,
    /// One chart only.
    FullScreen,
    /// The next marker.
    Marker,
    /// The next theme.
    Theme,
    /// Knobs begin the run anew, or act on the running motion.
    Live,
    /// Accept what was typed.
    Accept,
    /// Delete the last character.
    Rub,
}

/// Where a binding holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Context {
    /// Charts and knobs.
    Main,
    /// A value is being typed.
    Typing,
    /// The help is open.
    Help,
}

/// A key with its modifiers. Shift is part of a letter, not beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chord {
    /// The key.
    pub code: KeyCode,
    /// With Control.
    pub ctrl: bool,
    /// With Shift, for keys that are no characters.
    pub shift: bool,
}

const fn letter(letter: char) -> Chord {
    Chord { code: KeyCode::Char(letter), ctrl: false, shift: false }
}
const fn ctrl(letter: char) -> Chord {
    Chord { code: KeyCode::Char(letter), ctrl: true, shift: false }
}
const fn key(code: KeyCode) -> Chord {
    Chord { code, ctrl: false, shift: false }
}
const fn shift(code: KeyCode) -> Chord {
    Chord { code, ctrl: false, shift: true }
}

impl Chord {
    /// The chord of a key event.
    #[must_use]
    pub fn of(event: &KeyEvent) -> Self {
        let shift = event.modifiers.contains(KeyModifiers::SHIFT);
        let ctrl = event.modifiers.contains(KeyModifiers::CONTROL);
        let code = match event.code {
            // Some terminals send the letter in lower case with Shift beside it.
            KeyCode::Char(c) if shift && c.is_ascii_lowercase() => {
                KeyCode::Char(c.to_ascii_uppercase())
            }
            code => code,
        };
        let is_char = matches!(code, KeyCode::Char(_) | KeyCode::BackTab);
        Self { code, ctrl, shift: shift && !is_char }
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

/// One line of the table.
#[derive(Debug)]
pub struct Binding {
    /// Where it holds.
    pub context: Context,
    /// The keys.
    pub keys: &'static [Chord],
    /// What they do.
    pub action: Action,
    /// What they do, in a few words.
    pub what: &'static str,
    /// Keys and word of the footer, where it has a place there.
    pub footer: Option<(&'static str, &'static str)>,
}

macro_rules! bind {
    ($context:ident, [$($key:expr),+], $action:expr, $what:literal) => {
        Binding { context: Context::$context, keys: &[$($key),+], action: $action, what: $what, footer: None }
    };
    ($context:ident, [$($key:expr),+], $action:expr, $what:literal, $short:literal $word:literal) => {
        Binding { context: Context::$context, keys: &[$($key),+], action: $action, what: $what,
                  footer: Some(($short, $word)) }
    };
}

const fn turn(up: bool, coarse: bool) -> Action {
    Action::Turn { up, coarse }
}

/// Every binding, in the order of the help; those of the footer come in the
/// order of their importance.
pub const BINDINGS: &[Binding] = &[
    bind!(Main, [key(KeyCode::Up), letter('k')], Action::KnobAbove, "select the knob above", "↑↓" "knob"),
    bind!(Main, [key(KeyCode::Down), letter('j')], Action::KnobBelow, "select the knob below"),
    bind!(Main, [key(KeyCode::Right), letter('l')], turn(true, false), "turn the knob up", "←→" "turn"),
    bind!(Main, [key(KeyCode::Left), letter('h')], turn(false, false), "turn the knob down"),
    bind!(Main, [shift(KeyCode::Right), letter('L')], turn(true, true), "turn it up in large steps", "HL" "coarse"),
    bind!(
        Main,
        [shift(KeyCode::Left), letter('H')],
        turn(false, true),
        "turn it down in large steps"
    ),
    bind!(Main, [key(KeyCode::Enter)], Action::Type, "type a value (20k, 1e-7, 50u)", "Enter" "type"),
    bind!(Main, [letter(' ')], Action::Pause, "pause, or go on", "Space" "pause"),
    bind!(Main, [key(KeyCode::Tab)], Action::NextView, "next view", "Tab" "view"),
    bind!(Main, [key(KeyCode::BackTab)], Action::PreviousView, "previous view"),
    bind!(Main, [letter('?')], Action::Help, "this help", "?" "help"),
    bind!(Main, [letter('q'), ctrl('c')], Action::Quit, "quit", "q" "quit"),
    bind!(Main, [letter('r')], Action::Restart, "begin the run anew", "r" "restart"),
    bind!(Main, [letter('p')], Action::Fire, "fire the pulse into the running motion", "p" "pulse"),
    bind!(Main, [letter('[')], Action::Slower, "slower motion", "[ ]" "slower, faster"),
    bind!(Main, [letter(']')], Action::Faster, "faster motion"),
    bind!(Main, [letter('f')], Action::FullScreen, "one chart over the whole screen, or back", "f" "full"),
    bind!(Main, [letter('.')], Action::Step, "one step (pauses)", "." "step"),
    bind!(Main, [key(KeyCode::Backspace)], Action::Reset, "back to the scene's value"),
    bind!(Main, [letter('u')], Action::Undo, "undo the last turn of a knob", "u" "undo"),
    bind!(Main, [ctrl('r')], Action::Redo, "redo it"),
    bind!(
        Main,
        [letter('x')],
        Action::Live,
        "knobs act on the running motion (live), or begin it anew"
    ),
    bind!(Main, [letter('1')], Action::View(1), "view 1: response"),
    bind!(Main, [letter('2')], Action::View(2), "view 2: gaps"),
    bind!(Main, [letter('3')], Action::View(3), "view 3: locked motion"),
    bind!(Main, [letter('4')], Action::View(4), "view 4: blade frame and wheel"),
    bind!(Main, [letter('5')], Action::View(5), "view 5: map over speed and pulse"),
    bind!(Main, [letter('6')], Action::View(6), "view 6: spectrum and Campbell lines"),
    bind!(Main, [letter('7')], Action::View(7), "view 7: speed against error"),
    bind!(Main, [letter('+')], Action::ZoomIn, "a shorter page of time"),
    bind!(Main, [letter('-')], Action::ZoomOut, "a longer page of time"),
    bind!(Main, [letter('=')], Action::ZoomReset, "the first page of time"),
    bind!(Main, [letter('a')], Action::Autoscale, "scales follow the data, or stand still"),
    bind!(
        Main,
        [letter('m')],
        Action::Marker,
        "next marker (braille, octant, halfblock, dot, ascii)"
    ),
    bind!(Main, [letter('t')], Action::Theme, "next theme (dark, light, colour-blind, mono)"),
    bind!(Main, [ctrl('z')], Action::Suspend, "suspend"),
    bind!(Main, [ctrl('l')], Action::Redraw, "draw the screen anew"),
    bind!(Main, [key(KeyCode::Esc)], Action::Close, "close what is open; never quits"),
    bind!(Typing, [key(KeyCode::Enter)], Action::Accept, "take the value", "Enter" "take"),
    bind!(Typing, [key(KeyCode::Esc)], Action::Close, "leave it as it was", "Esc" "leave"),
    bind!(Typing, [key(KeyCode::Backspace)], Action::Rub, "delete the last character", "Backspace" "delete"),
    bind!(Typing, [ctrl('c')], Action::Quit, "quit", "Ctrl-C" "quit"),
    bind!(Help, [key(KeyCode::Esc), letter('?')], Action::Close, "close the help", "Esc" "close"),
    bind!(Help, [key(KeyCode::Down), letter('j'), letter(' ')], Action::KnobBelow, "scroll down", "↑↓" "scroll"),
    bind!(Help, [key(KeyCode::Up), letter('k')], Action::KnobAbove, "scroll up"),
    bind!(Help, [letter('q'), ctrl('c')], Action::Quit, "quit", "q" "quit"),
    bind!(Help, [letter('t')], Action::Theme, "next theme"),
    bind!(Help, [ctrl('z')], Action::Suspend, "suspend"),
    bind!(Help, [ctrl('l')], Action::Redraw, "draw the screen anew"),
];

/// What a key does in a context.
#[must_use]
pub fn lookup(context: Context, chord: Chord) -> Option<Action> {
    of(context).find(|binding| binding.keys.contains(&chord)).map(|binding| binding.action)
}

/// The bindings of a context.
pub fn of(context: Context) -> impl Iterator<Item = &'static Binding> {
    BINDINGS.iter().filter(move |binding| binding.context == context)
}

/// The keys of a binding as text, such as `Up, k`.
#[must_use]
pub fn keys_text(binding: &Binding) -> String {
    binding.keys.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// The bindings of the explorer as text for the manual page, one a line.
#[must_use]
pub fn manual() -> String {
    of(Context::Main)
        .map(|binding| format!("{:<18} {}\n", keys_text(binding), binding.what))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_is_bound_twice_in_a_context() {
        for (place, binding) in BINDINGS.iter().enumerate() {
            for chord in binding.keys {
                let others = BINDINGS.iter().enumerate().filter(|(other, b)| {
                    *other != place && b.context == binding.context && b.keys.contains(chord)
                });
                assert_eq!(others.count(), 0, "{chord} in {:?}", binding.context);
            }
        }
    }

    #[test]
    fn every_binding_says_what_it_does_and_every_context_can_be_left() {
        for binding in BINDINGS {
            assert!(!binding.what.is_empty() && !binding.keys.is_empty());
        }
        for context in [Context::Main, Context::Typing, Context::Help] {
            let interrupt = Chord { code: KeyCode::Char('c'), ctrl: true, shift: false };
            assert_eq!(lookup(context, interrupt), Some(Action::Quit));
            assert_eq!(lookup(context, key(KeyCode::Esc)), Some(Action::Close));
        }
    }

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
