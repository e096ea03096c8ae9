//! The table of key bindings, which the key handler, the footer, the help and the manual page
//! use, and the groups of actions under which the help lists them.

mod table;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use strum::{EnumIter, IntoStaticStr};

use crate::tui::field::Edit;
use crate::tui::views::id::ViewId;

pub use table::BINDINGS;

/// Action of a key.
#[expect(missing_docs, reason = "the table says what each action does")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    Quit,
    Suspend,
    Redraw,
    Close,
    Help,
    Palette,
    NextView,
    PreviousView,
    View(ViewId),
    KnobAbove,
    KnobBelow,
    Turn { up: bool, coarse: bool },
    Type,
    Reset,
    Undo,
    Redo,
    Pause,
    Step,
    Restart,
    Fire,
    SlowAtEvents,
    Slower,
    Faster,
    ZoomIn,
    ZoomOut,
    ZoomReset,
    Autoscale,
    FullScreen,
    Mouse,
    Marker,
    Theme,
    Live,
    Jump,
    GoToEnd,
    Pin,
    OtherLaw,
    Save,
    Export,
    Copy,
    Lesson,
    LeaveLesson,
    LessonBack,
    Answer(usize),
    Scenes,
    Survey,
    SpeedUnit,
    Charts,
    PageBack,
    PageForward,
    Read,
    Cursor { right: i64, up: i64, coarse: bool },
    OpenPlace,
    MapAxis { up: bool },
    Yes,
    Accept,
    Edit(Edit),
    First,
    Last,
    Search,
    TurnNote,
}

/// Context in which a binding holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Context {
    /// Charts and knobs.
    Main,
    /// The arrows move the reading cursor; otherwise as `Main`.
    Reading,
    /// A value is being typed.
    Typing,
    /// The help is open, whole.
    Help,
    /// The help is open and a filter is typed into it.
    Filter,
    /// A command is being looked for.
    Palette,
    /// A question: replace the existing file?
    Replacing,
    /// A lesson is being chosen.
    Lessons,
    /// A lesson waits for an answer; otherwise as `Main`.
    Question,
    /// A scene is being chosen.
    Scenes,
    /// A text is being typed: the keys that edit it.
    Field,
    /// A list is open: the keys that every list has.
    List,
    /// Any dialogue is open: the keys that all of them have.
    Dialogue,
}

/// A key with its modifiers. Shift is part of a letter, not a modifier of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chord {
    /// The key.
    pub code: KeyCode,
    /// Whether Control is held.
    pub ctrl: bool,
    /// Whether Shift is held, for keys that are no characters.
    pub shift: bool,
}

impl Chord {
    /// Returns the bindings of a context.
    pub fn of(event: &KeyEvent) -> Self {
        let shift = event.modifiers.contains(KeyModifiers::SHIFT);
        let ctrl = event.modifiers.contains(KeyModifiers::CONTROL);
        let code = match event.code {
            // Some terminals send the lower case letter together with Shift.
            KeyCode::Char(c) if shift && c.is_ascii_lowercase() => {
                KeyCode::Char(c.to_ascii_uppercase())
            }
            code => code,
        };
        let is_char = matches!(code, KeyCode::Char(_) | KeyCode::BackTab);
        Self { code, ctrl, shift: shift && !is_char }
    }
}

/// The key that a sign stands for, in the last line and in scripts: an arrow, or the letter.
impl From<char> for Chord {
    fn from(sign: char) -> Self {
        let code = match sign {
            '←' => KeyCode::Left,
            '→' => KeyCode::Right,
            '↑' => KeyCode::Up,
            '↓' => KeyCode::Down,
            letter => KeyCode::Char(letter),
        };
        Self { code, ctrl: false, shift: false }
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
#[derive(Clone, Debug)]
pub struct Binding {
    /// Context in which it holds.
    pub context: Context,
    /// The keys.
    pub keys: &'static [Chord],
    /// Action of the keys.
    pub action: Action,
    /// Description of the action in a few words.
    pub what: &'static str,
    /// Keys and word of the footer, if it is shown there.
    pub footer: Option<(&'static str, &'static str)>,
}

impl Context {
    /// Returns the contexts that have the keys which this one has not, the nearest first.
    pub fn behind(self) -> &'static [Self] {
        match self {
            Self::Main | Self::Dialogue => &[],
            Self::Reading | Self::Question => &[Self::Main],
            Self::Typing => &[Self::Field, Self::Dialogue],
            Self::Filter | Self::Palette => &[Self::Field, Self::List, Self::Dialogue],
            Self::Help | Self::Lessons | Self::Scenes => &[Self::List, Self::Dialogue],
            Self::Field | Self::List | Self::Replacing => &[Self::Dialogue],
        }
    }
}

/// Returns what a key does in a context.
pub fn lookup(context: Context, chord: Chord) -> Option<Action> {
    let found = with_behind(context).find(|binding| binding.keys.contains(&chord));
    found.map(|binding| binding.action)
}

/// Returns the bindings of a context, and those behind it.
pub fn with_behind(context: Context) -> impl Iterator<Item = &'static Binding> {
    of(context).chain(context.behind().iter().copied().flat_map(of))
}

/// Creates the bindings of a context.
pub fn of(context: Context) -> impl Iterator<Item = &'static Binding> {
    BINDINGS.iter().filter(move |binding| binding.context == context)
}

/// Returns the keys of a binding as text, such as `Up, k`.
pub fn keys_text(binding: &Binding) -> String {
    binding.keys.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// Group of actions, in the order of the help.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumIter, IntoStaticStr)]
pub enum Group {
    /// Selecting and turning knobs.
    Knobs,
    /// Playing the motion, and choosing the part that is shown.
    Time,
    /// Choosing charts and reading them.
    #[strum(serialize = "Views and charts")]
    Views,
    /// Opening scenes and lessons.
    #[strum(serialize = "Scenes and lessons")]
    Scenes,
    /// Writing and copying.
    Files,
    /// Colours, marker and units.
    Look,
    /// The program itself.
    Program,
}

impl Action {
    /// Returns the group of an action.
    pub fn group(self) -> Group {
        match self {
            Self::KnobAbove
            | Self::KnobBelow
            | Self::Turn { .. }
            | Self::Type
            | Self::Reset
            | Self::Undo
            | Self::Redo
            | Self::Live => Group::Knobs,
            Self::Pause
            | Self::Step
            | Self::Restart
            | Self::Fire
            | Self::SlowAtEvents
            | Self::Slower
            | Self::Faster
            | Self::Jump
            | Self::GoToEnd
            | Self::PageBack
            | Self::PageForward
            | Self::ZoomIn
            | Self::ZoomOut
            | Self::ZoomReset => Group::Time,
            Self::NextView
            | Self::PreviousView
            | Self::View(_)
            | Self::Survey
            | Self::Charts
            | Self::FullScreen
            | Self::Autoscale
            | Self::Pin
            | Self::OtherLaw
            | Self::MapAxis { .. }
            | Self::Read => Group::Views,
            Self::Lesson | Self::LeaveLesson | Self::LessonBack | Self::Scenes => Group::Scenes,
            Self::Save | Self::Export | Self::Copy => Group::Files,
            Self::Marker | Self::Theme | Self::SpeedUnit | Self::Mouse | Self::Redraw => {
                Group::Look
            }
            // Those of dialogues, too, of which the help has other headings.
            _ => Group::Program,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use table::{key, letter, shift};

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
        for binding in BINDINGS.iter() {
            assert!(!binding.what.is_empty() && !binding.keys.is_empty());
        }
        for context in [
            Context::Main,
            Context::Reading,
            Context::Typing,
            Context::Help,
            Context::Filter,
            Context::Palette,
            Context::Replacing,
            Context::Lessons,
            Context::Question,
            Context::Scenes,
        ] {
            let interrupt = Chord { code: KeyCode::Char('c'), ctrl: true, shift: false };
            assert_eq!(lookup(context, interrupt), Some(Action::Quit));
            assert_eq!(lookup(context, key(KeyCode::Esc)), Some(Action::Close));
            assert_eq!(lookup(context, table::ctrl('z')), Some(Action::Suspend));
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
