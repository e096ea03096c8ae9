//! The key bindings: key, context, action, and the words of help and footer.

use std::sync::LazyLock;

use crossterm::event::KeyCode::{
    self, BackTab, Backspace, Char, Delete, Down, End, Enter, Esc, Home, Left, PageDown, PageUp,
    Right, Tab, Up,
};

use super::{Action, Binding, Chord, Context};
use crate::tui::field::Edit;
use crate::tui::views::id::ViewId;

pub(super) const fn letter(letter: char) -> Chord {
    Chord { code: Char(letter), ctrl: false, shift: false }
}
pub(super) const fn ctrl(letter: char) -> Chord {
    Chord { code: Char(letter), ctrl: true, shift: false }
}
pub(super) const fn key(code: KeyCode) -> Chord {
    Chord { code, ctrl: false, shift: false }
}
pub(super) const fn shift(code: KeyCode) -> Chord {
    Chord { code, ctrl: false, shift: true }
}

macro_rules! bind {
    ($context:ident: [$($key:expr),+], $action:expr, $what:literal) => {
        Binding { context: Context::$context, keys: &[$($key),+], action: $action, what: $what, footer: None }
    };
    ($context:ident: [$($key:expr),+], $action:expr, $what:literal, $short:literal $word:literal) => {
        Binding { context: Context::$context, keys: &[$($key),+], action: $action, what: $what,
                  footer: Some(($short, $word)) }
    };
}

const fn cursor(right: i64, up: i64, coarse: bool) -> Action {
    Action::Cursor { right, up, coarse }
}

const fn turn(up: bool, coarse: bool) -> Action {
    Action::Turn { up, coarse }
}

/// Every binding, in the order of the help. Those in the footer are listed by importance.
pub static BINDINGS: LazyLock<Vec<Binding>> = LazyLock::new(|| {
    // The bindings of views are built once and leaked, to be static like the others.
    let views = ViewId::all().map(|view| Binding {
        context: Context::Main,
        keys: vec![letter(char::from(b'0' + view.digit()))].leak(),
        action: Action::View(view),
        what: format!("view {}: {}", view.digit(), view.what()).leak(),
        footer: None,
    });
    BEFORE_VIEWS.iter().cloned().chain(views).chain(AFTER_VIEWS.iter().cloned()).collect()
});

/// Bindings listed before those of the views.
const BEFORE_VIEWS: &[Binding] = &[
    bind!(Main: [key(Up), letter('k')], Action::KnobAbove, "select the knob above", "↑↓" "knob"),
    bind!(Main: [key(Down), letter('j')], Action::KnobBelow, "select the knob below"),
    bind!(Main: [key(Right), letter('l')], turn(true, false), "turn the knob up", "←→" "turn"),
    bind!(Main: [key(Left), letter('h')], turn(false, false), "turn the knob down"),
    bind!(Main: [shift(Right), letter('L')], turn(true, true), "turn it up in large steps", "HL" "coarse"),
    bind!(Main: [shift(Left), letter('H')], turn(false, true), "turn it down in large steps"),
    bind!(Main: [key(Enter)], Action::Type, "type a value (20k, 1e-7, 50u)", "Enter" "type"),
    bind!(Main: [letter(' ')], Action::Pause, "pause, or go on", "Space" "pause"),
    bind!(Main: [key(Tab)], Action::NextView, "next view", "Tab" "view"),
    bind!(Main: [key(BackTab)], Action::PreviousView, "previous view"),
    bind!(Main: [letter(':'), ctrl('p')], Action::Palette, "go or do in words: t 0.3 ms, blade 7, speed 450, law smooth, scene rub, lesson lock", ":" "commands"),
    bind!(Main: [letter('?')], Action::Help, "this help; typing in it finds a key or a word", "?" "help"),
    bind!(Main: [letter('/')], Action::Search, "find a key or a word in this help"),
    bind!(Main: [letter('q'), ctrl('c')], Action::Quit, "quit", "q" "quit"),
    bind!(Main: [letter('r')], Action::Restart, "restart the run", "r" "restart"),
    bind!(Main: [letter('p')], Action::Fire, "fire the pulse into the running motion", "p" "pulse"),
    bind!(Main: [letter('[')], Action::Slower, "slower motion", "[ ]" "slower, faster"),
    bind!(Main: [letter(']')], Action::Faster, "faster motion"),
    bind!(Main: [letter('z')], Action::SlowAtEvents, "slower at changes of contact and faster between, or not"),
    bind!(Main: [letter('f')], Action::FullScreen, "one chart over the whole screen, or back", "f" "full"),
    bind!(Main: [letter('M')], Action::Mouse, "mouse on or off; Shift selects text while it is on"),
    bind!(Main: [letter('.')], Action::Step, "one step (pauses)", "." "step"),
    bind!(Main: [key(Backspace)], Action::Reset, "back to the scene's value"),
    bind!(Main: [letter('u')], Action::Undo, "undo the last turn of a knob", "u" "undo"),
    bind!(Main: [ctrl('r')], Action::Redo, "redo it"),
    bind!(Main: [letter('x')], Action::Live, "knobs act on the running motion (live), or restart it"),
    bind!(Main: [letter('g')], Action::Lesson, "guide: choose a lesson; in one, its next step", "g" "guide"),
    bind!(Main: [letter('B')], Action::LessonBack, "in a lesson: the step before"),
    bind!(Main: [letter('G')], Action::LeaveLesson, "leave the lesson; your own scene comes back"),
    bind!(Main: [letter('o')], Action::Scenes, "open a scene: built-in ones, and files of this folder", "o" "scenes"),
    bind!(Main: [letter('n')], Action::Jump, "on to the next change of contact (pauses)"),
    bind!(Main: [letter('E'), key(End)], Action::GoToEnd, "end of the run: go there; to another instant with : t 0.3 ms"),
    bind!(Main: [letter('b')], Action::Pin, "pin this run as a baseline behind the next, or remove it", "b" "pin"),
    bind!(Main: [letter('c')], Action::OtherLaw, "compare with the other contact law; in the map, its law", "c" "both laws"),
    bind!(Main: [letter('X')], Action::MapAxis { up: false }, "choose the knob across the map"),
    bind!(Main: [letter('Y')], Action::MapAxis { up: true }, "choose the knob up the map"),
    bind!(Main: [letter('s')], Action::Save, "save the scene"),
    bind!(Main: [letter('e')], Action::Export, "export the large chart (.csv) or the screen (.svg)"),
    bind!(Main: [letter('y')], Action::Copy, "copy the command line that repeats this run (OSC 52)"),
    bind!(Main: [letter('D')], Action::Survey, "margins of all diameters: the survey, or those of n_d alone"),
    bind!(Main: [letter('v')], Action::Charts, "one, two, three or four charts"),
    bind!(Main: [letter('<'), key(PageUp)], Action::PageBack, "a page of time back"),
    bind!(Main: [letter('>'), key(PageDown)], Action::PageForward, "a page of time forward"),
    bind!(Main: [letter('i')], Action::Read, "read the chart: the arrows move a cursor, or, where it stays, the knobs again", "i" "read"),
];

/// Bindings listed after those of the views.
const AFTER_VIEWS: &[Binding] = &[
    bind!(Main: [letter('+')], Action::ZoomIn, "a shorter page of time"),
    bind!(Main: [letter('-')], Action::ZoomOut, "a longer page of time"),
    bind!(Main: [letter('=')], Action::ZoomReset, "the usual page of time, where NOW is"),
    bind!(Main: [letter('a')], Action::Autoscale, "scales follow the data, or stay fixed"),
    bind!(Main: [letter('m')], Action::Marker, "next marker (braille, halfblock, dot, ascii)"),
    bind!(Main: [letter('t')], Action::Theme, "next theme (dark, light, colour-blind on dark or light, mono)"),
    bind!(Main: [letter('U')], Action::SpeedUnit, "units: speeds in rpm, or in rad/s"),
    bind!(Main: [ctrl('z')], Action::Suspend, "suspend"),
    bind!(Main: [ctrl('l')], Action::Redraw, "draw the screen again"),
    bind!(Main: [key(Esc)], Action::Close, "close what is open; never quits"),
    bind!(Reading: [key(Left), letter('h')], cursor(-1, 0, false), "cursor to the left", "←→↑↓" "read"),
    bind!(Reading: [key(Right), letter('l')], cursor(1, 0, false), "cursor to the right"),
    bind!(Reading: [key(Up), letter('k')], cursor(0, 1, false), "cursor up"),
    bind!(Reading: [key(Down), letter('j')], cursor(0, -1, false), "cursor down"),
    bind!(Reading: [key(Enter)], Action::OpenPlace, "open the run at the cursor (map), jump to a limit or select its knob (margins)", "Enter" "open"),
    bind!(Reading: [shift(Left), letter('H')], cursor(-1, 0, true), "cursor far to the left", "HJKL" "far"),
    bind!(Reading: [shift(Right), letter('L')], cursor(1, 0, true), "cursor far to the right"),
    bind!(Reading: [shift(Up), letter('K')], cursor(0, 1, true), "cursor far up"),
    bind!(Reading: [shift(Down), letter('J')], cursor(0, -1, true), "cursor far down"),
    bind!(Reading: [key(Esc)], Action::Close, "no cursor: the motion where it is; i leaves it", "Esc" "knobs"),
    bind!(Typing: [key(Enter)], Action::Accept, "take the value", "Enter" "take"),
    bind!(Typing: [key(Esc)], Action::Close, "leave it as it was", "Esc" "leave"),
    bind!(Help: [letter('?'), key(Esc)], Action::Close, "close the help", "? Esc" "close"),
    bind!(Help: [letter('/')], Action::Search, "type what to find, whatever its first letter"),
    bind!(Help: [letter('q')], Action::Quit, "quit", "q" "quit"),
    bind!(Filter: [key(Esc)], Action::Close, "clear the filter", "Esc" "clear"),
    bind!(Palette: [key(Enter)], Action::Accept, "do it", "Enter" "do it"),
    bind!(Palette: [key(Esc)], Action::Close, "leave", "Esc" "leave"),
    bind!(Palette: [key(Tab)], Action::KnobBelow, "the line below"),
    bind!(Palette: [key(BackTab)], Action::KnobAbove, "the line above"),
    bind!(Replacing: [letter('y')], Action::Yes, "replace the file", "y" "replace"),
    bind!(Replacing: [letter('n'), key(Esc)], Action::Close, "leave it as it is", "n" "leave it"),
    bind!(Lessons: [letter('k')], Action::KnobAbove, "the lesson above"),
    bind!(Lessons: [letter('j')], Action::KnobBelow, "the lesson below"),
    bind!(Lessons: [key(Enter), letter('g')], Action::Accept, "begin the lesson", "Enter" "begin"),
    bind!(Lessons: [letter('/')], Action::Search, "find a lesson by its words", "/" "find"),
    bind!(Lessons: [key(Esc)], Action::Close, "close the list", "Esc" "close"),
    bind!(Lessons: [letter('q')], Action::Quit, "quit", "q" "quit"),
    bind!(Question: [key(Up), letter('k')], Action::KnobAbove, "the answer above", "↑↓" "choose"),
    bind!(Question: [key(Down), letter('j')], Action::KnobBelow, "the answer below"),
    bind!(Question: [key(Enter)], Action::Accept, "answer", "Enter" "answer"),
    bind!(Question: [letter('B')], Action::LessonBack, "the step before", "B" "back"),
    bind!(Question: [letter('G')], Action::LeaveLesson, "leave the lesson", "G" "leave"),
    bind!(Scenes: [letter('k')], Action::KnobAbove, "the scene above"),
    bind!(Scenes: [letter('j')], Action::KnobBelow, "the scene below"),
    bind!(Scenes: [key(Enter)], Action::Accept, "open the scene", "Enter" "open"),
    bind!(Scenes: [letter('/')], Action::Search, "find a scene by its words", "/" "find"),
    bind!(Scenes: [letter(' ')], Action::TurnNote, "the rest of a long note"),
    bind!(Scenes: [key(Esc), letter('o')], Action::Close, "close the list", "Esc" "close"),
    bind!(Scenes: [letter('q')], Action::Quit, "quit", "q" "quit"),
    bind!(Field: [key(Left), ctrl('b')], Action::Edit(Edit::Left), "cursor to the left", "←→" "move"),
    bind!(Field: [key(Right), ctrl('f')], Action::Edit(Edit::Right), "cursor to the right"),
    bind!(Field: [key(Home), ctrl('a')], Action::Edit(Edit::Start), "to the start; there, to the first line"),
    bind!(Field: [key(End), ctrl('e')], Action::Edit(Edit::End), "to the end; there, to the last line"),
    bind!(Field: [key(Backspace), ctrl('h')], Action::Edit(Edit::DeleteBefore), "delete the letter before it"),
    bind!(Field: [key(Delete), ctrl('d')], Action::Edit(Edit::DeleteAfter), "delete the letter under it"),
    bind!(Field: [ctrl('w')], Action::Edit(Edit::DeleteWord), "delete the word before it"),
    bind!(Field: [ctrl('u')], Action::Edit(Edit::DeleteToStart), "delete all before it", "Ctrl-U" "clear"),
    bind!(Field: [ctrl('k')], Action::Edit(Edit::DeleteToEnd), "delete all behind it"),
    bind!(List: [key(Up)], Action::KnobAbove, "a line up", "↑↓" "choose"),
    bind!(List: [key(Down)], Action::KnobBelow, "a line down"),
    bind!(List: [key(PageUp)], Action::PageBack, "a page up"),
    bind!(List: [key(PageDown)], Action::PageForward, "a page down"),
    bind!(List: [key(Home)], Action::First, "the first line"),
    bind!(List: [key(End)], Action::Last, "the last line"),
    bind!(Dialogue: [ctrl('c')], Action::Quit, "quit", "Ctrl-C" "quit"),
    bind!(Dialogue: [ctrl('z')], Action::Suspend, "suspend"),
    bind!(Dialogue: [ctrl('l')], Action::Redraw, "draw the screen again"),
];
