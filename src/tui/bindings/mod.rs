//! The table of key bindings, used by the key handler, the footer, the help and the manual page,
//! and the groups of actions in the help.

mod table;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use strum::{EnumIter, IntoStaticStr};

use crate::tui::field::Edit;
use crate::tui::views::id::ViewId;

pub use table::BINDINGS;

/// What a key can do.
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

/// Where a binding is valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Context {
    /// The charts and the knobs.
    Main,
    /// Reading a chart: the arrows move the cursor; other keys as in `Main`.
    Reading,
    /// Typing a value.
    Typing,
    /// The unfiltered help.
    Help,
    /// Typing a filter into the help.
    Filter,
    /// Typing a command in the palette.
    Palette,
    /// Answering whether to replace an existing file.
    Replacing,
    /// Choosing a lesson.
    Lessons,
    /// Answering a question of a lesson; other keys as in `Main`.
    Question,
    /// Choosing a scene.
    Scenes,
    /// Any text field: the editing keys.
    Field,
    /// Any list: the keys that move in it.
    List,
    /// Any dialogue: the keys common to all.
    Dialogue,
}

/// A key with its modifiers. For a letter, Shift is part of the character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chord {
    /// The key.
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

/// The key that a character stands for in the footer and in scripts: an arrow sign, or the letter.
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

/// One row of the table.
#[derive(Clone, Debug)]
pub struct Binding {
    /// Context in which the binding is valid.
    pub context: Context,
    /// The keys.
    pub keys: &'static [Chord],
    /// What the keys do.
    pub action: Action,
    /// The action in a few words, for the help.
    pub what: &'static str,
    /// Keys and word in the footer, if the binding appears there.
    pub footer: Option<(&'static str, &'static str)>,
}

impl Context {
    /// Returns the contexts to search for a key that this one does not bind, the nearest first.
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

/// Returns the action of a key in a context.
pub fn lookup(context: Context, chord: Chord) -> Option<Action> {
    let found = with_behind(context).find(|binding| binding.keys.contains(&chord));
    found.map(|binding| binding.action)
}

/// Iterates over the bindings of a context, then those of the contexts behind it.
pub fn with_behind(context: Context) -> impl Iterator<Item = &'static Binding> {
    of(context).chain(context.behind().iter().copied().flat_map(of))
}

/// Iterates over the bindings of a context.
pub fn of(context: Context) -> impl Iterator<Item = &'static Binding> {
    BINDINGS.iter().filter(move |binding| binding.context == context)
}

/// Lists the keys of a binding, as in `Up, k`.
pub fn keys_text(binding: &Binding) -> String {
    binding.keys.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// Groups of actions, in the order of the help.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumIter, IntoStaticStr)]
pub enum Group {
    /// Select and turn knobs.
    Knobs,
    /// Play the motion and choose the part shown.
    Time,
    /// Choose and read charts.
    #[strum(serialize = "Views and charts")]
    Views,
    /// Open scenes and lessons.
    #[strum(serialize = "Scenes and lessons")]
    Scenes,
    /// Write and copy files.
    Files,
    /// Colours, marker and units.
    Look,
    /// Control the program itself.
    Program,
}

impl Action {
    /// Returns the help group of an action.
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
            // Actions of dialogues have their own headings in the help.
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
