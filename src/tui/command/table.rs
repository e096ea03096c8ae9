//! The table of commands that have keys: group, keys, command, and the words of help and footer.

use std::sync::LazyLock;

use crossterm::event::KeyCode::{
    BackTab, Backspace, Delete, Down, End, Enter, Esc, Home, Left, PageDown, PageUp, Right, Tab, Up,
};

use strum::{EnumIter, IntoStaticStr};

use super::chord::{Chord, ctrl, key, letter, shift};
use super::{Command, Purpose};
use crate::tui::field::Edit;
use crate::tui::views::id::ViewId;

/// A group of bindings: the heading of the help, and where the keys are valid. The groups up to
/// [`Group::Program`] are those of the main screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, EnumIter, IntoStaticStr)]
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
    /// The arrows move the cursor of a chart; other keys as on the main screen.
    #[strum(serialize = "While a chart is read")]
    Reading,
    /// Typing a value or a name.
    #[strum(serialize = "While typing")]
    Typing,
    /// The editing keys of any text.
    #[strum(serialize = "In every text")]
    Field,
    /// The keys that move in any list.
    #[strum(serialize = "In every list")]
    List,
    /// The unfiltered help.
    #[strum(serialize = "In this help")]
    Help,
    /// Typing a filter into the help.
    #[strum(serialize = "While the help is searched")]
    Filter,
    /// Typing a command.
    #[strum(serialize = "While a command is looked for")]
    Palette,
    /// Answering whether to replace an existing file.
    #[strum(serialize = "Where a file exists")]
    Replacing,
    /// Answering whether to quit with a changed scene.
    #[strum(serialize = "Where the scene is changed")]
    Leaving,
    /// Answering a question of a lesson; other keys as on the main screen.
    #[strum(serialize = "While a lesson asks")]
    Question,
    /// The keys of every dialogue.
    #[strum(serialize = "In every dialogue")]
    Dialogue,
}

impl Group {
    /// Returns whether the keys of the group are those of the main screen.
    pub fn is_main(self) -> bool {
        self <= Self::Program
    }

    /// Returns the groups whose keys are valid in every dialogue of this one's kind, the nearest
    /// first.
    fn behind(self) -> &'static [Self] {
        match self {
            Self::Typing => &[Self::Field, Self::Dialogue],
            Self::Filter | Self::Palette => &[Self::Field, Self::List, Self::Dialogue],
            Self::Help => &[Self::List, Self::Dialogue],
            Self::Replacing | Self::Leaving => &[Self::Dialogue],
            _ => &[],
        }
    }
}

/// One row of the table.
#[derive(Clone, Debug)]
pub struct Binding {
    /// Group that lists the binding and where it is valid.
    pub group: Group,
    /// Keys of the command; the help lists all of them.
    pub keys: &'static [Chord],
    /// Command of the keys.
    pub command: Command,
    /// The command in a few words, for the help, and to be typed after `:`.
    pub what: &'static str,
    /// Keys and word in the footer, such as `↑↓` and `knob`; `None` if it is not shown there.
    pub footer: Option<(&'static str, &'static str)>,
}

macro_rules! bind {
    ($group:ident: [$($key:expr),+], $command:expr, $what:literal) => {
        Binding { group: Group::$group, keys: &[$($key),+], command: $command, what: $what, footer: None }
    };
    ($group:ident: [$($key:expr),+], $command:expr, $what:literal, $short:literal $word:literal) => {
        Binding { group: Group::$group, keys: &[$($key),+], command: $command, what: $what,
                  footer: Some(($short, $word)) }
    };
}

const fn cursor(right: i64, up: i64, coarse: bool) -> Command {
    Command::Cursor { right, up, coarse }
}

const fn turn(up: bool, coarse: bool) -> Command {
    Command::Turn { up, coarse }
}

/// Every binding, in the order of the help. Those in the footer are listed by importance.
pub static BINDINGS: LazyLock<Vec<Binding>> = LazyLock::new(|| {
    // The bindings of views are built once and leaked, to be static like the others.
    let views = ViewId::all().map(|view| Binding {
        group: Group::Views,
        keys: vec![letter(char::from(b'0' + view.digit()))].leak(),
        command: Command::View(view),
        what: format!("view {}: {}", view.digit(), view.what()).leak(),
        footer: None,
    });
    BEFORE_VIEWS.iter().cloned().chain(views).chain(AFTER_VIEWS.iter().cloned()).collect()
});

/// Bindings listed before those of the views.
const BEFORE_VIEWS: &[Binding] = &[
    bind!(Knobs: [key(Up), letter('k')], Command::Above, "select the knob above", "↑↓" "knob"),
    bind!(Knobs: [key(Down), letter('j')], Command::Below, "select the knob below"),
    bind!(Knobs: [key(Right), letter('l')], turn(true, false), "turn the knob up", "←→" "turn"),
    bind!(Knobs: [key(Left), letter('h')], turn(false, false), "turn the knob down"),
    bind!(Knobs: [shift(Right), letter('L')], turn(true, true), "turn it up in large steps", "HL" "coarse"),
    bind!(Knobs: [shift(Left), letter('H')], turn(false, true), "turn it down in large steps"),
    bind!(Knobs: [key(Enter)], Command::Type, "type a value (20k, 1e-7, 50u)", "Enter" "type"),
    bind!(Time: [letter(' ')], Command::Pause, "pause or continue", "Space" "pause"),
    bind!(Views: [key(Tab)], Command::NextView(1), "next view", "Tab" "view"),
    bind!(Views: [key(BackTab)], Command::NextView(-1), "previous view"),
    bind!(Program: [letter(':'), ctrl('p')], Command::Palette(""), "type a command: t 0.3 ms, blade 7, speed 450, law smooth, scene rub, lesson lock", ":" "commands"),
    bind!(Program: [letter('?')], Command::Help, "this help; type in it to find a key or a word", "?" "help"),
    bind!(Program: [letter('/')], Command::Search, "find a key or a word in this help"),
    bind!(Program: [letter('q')], Command::Leave, "close what is open, or else quit; asks where the scene is changed", "q" "quit"),
    bind!(Program: [ctrl('c')], Command::Quit, "quit"),
    bind!(Time: [letter('r')], Command::Restart, "restart the run", "r" "restart"),
    bind!(Time: [letter('p')], Command::Fire, "fire the pulse into the running motion", "p" "pulse"),
    bind!(Time: [letter('[')], Command::Faster(-1), "slower motion", "[ ]" "slower, faster"),
    bind!(Time: [letter(']')], Command::Faster(1), "faster motion"),
    bind!(Time: [letter('z')], Command::SlowAtEvents, "slow down at changes of contact and speed up between, on or off"),
    bind!(Views: [letter('f')], Command::FullScreen, "one chart over the whole screen, or back", "f" "full"),
    bind!(Look: [letter('M')], Command::Mouse, "mouse on or off; Shift selects text while it is on"),
    bind!(Time: [letter('.')], Command::Step, "one step (pauses)", "." "step"),
    bind!(Knobs: [key(Backspace)], Command::Reset, "back to the scene's value"),
    bind!(Knobs: [letter('u')], Command::Undo, "undo the last turn of a knob", "u" "undo"),
    bind!(Knobs: [ctrl('r')], Command::Redo, "redo it"),
    bind!(Knobs: [letter('x')], Command::Live, "knobs change the running motion (live) or restart it"),
    bind!(Scenes: [letter('g')], Command::Guide, "guide: choose a lesson; in a lesson, its next step", "g" "guide"),
    bind!(Scenes: [letter('B')], Command::LessonBack, "in a lesson: the previous step"),
    bind!(Scenes: [letter('G')], Command::LeaveLesson, "leave the lesson and return to your scene"),
    bind!(Scenes: [letter('o')], Command::Palette("scene "), "open a scene: built-in, or a file in this folder", "o" "scenes"),
    bind!(Time: [letter('A')], Command::Plain, "plain: take every step, or skip again the steps whose result is known"),
    bind!(Time: [letter('n')], Command::Jump, "go to the next change of contact (pauses)"),
    bind!(Time: [letter('E'), key(End)], Command::GoToEnd, "go to the end of the run; to another instant with : t 0.3 ms"),
    bind!(Views: [letter('b')], Command::Pin, "pin this run as a baseline behind the next ones, or unpin it", "b" "pin"),
    bind!(Views: [letter('c')], Command::OtherLaw, "compare with the other contact law; in the map, switch its law", "c" "both laws"),
    bind!(Views: [letter('X')], Command::Palette("across "), "choose the knob of the map's columns"),
    bind!(Views: [letter('Y')], Command::Palette("up "), "choose the knob of the map's rows"),
    bind!(Files: [letter('s')], Command::Ask(Purpose::Save), "save the scene"),
    bind!(Files: [letter('e')], Command::Ask(Purpose::Export), "export the large chart (.csv) or its figure (.svg)"),
    bind!(Files: [letter('y')], Command::Copy, "copy the command line of the large view (OSC 52)"),
    bind!(Views: [letter('D')], Command::Survey, "survey: margins of all nodal diameters, or of n_d alone"),
    bind!(Views: [letter('v')], Command::Charts, "one, two, three or four charts"),
    bind!(Time: [letter('<'), key(PageUp)], Command::PageBack, "a page of time back"),
    bind!(Time: [letter('>'), key(PageDown)], Command::PageForward, "a page of time forward"),
    bind!(Views: [letter('i')], Command::Read, "read the chart: the arrows move a cursor; again: it stays, and they turn knobs", "i" "read"),
];

/// Bindings listed after those of the views.
const AFTER_VIEWS: &[Binding] = &[
    bind!(Time: [letter('+')], Command::ZoomIn, "a shorter page of time"),
    bind!(Time: [letter('-')], Command::ZoomOut, "a longer page of time"),
    bind!(Time: [letter('=')], Command::Page(None), "the default page of time, around NOW"),
    bind!(Views: [letter('a')], Command::Autoscale, "scales follow the data or stay fixed"),
    bind!(Look: [letter('m')], Command::Marker, "next marker (braille, halfblock, dot, ascii)"),
    bind!(Look: [letter('t')], Command::NextTheme, "next theme (dark, light, colour-blind on dark or light, mono)"),
    bind!(Look: [letter('U')], Command::SpeedUnit, "units: speeds in rpm or rad/s"),
    bind!(Program: [ctrl('z')], Command::Suspend, "suspend"),
    bind!(Look: [ctrl('l')], Command::Redraw, "draw the screen again"),
    bind!(Program: [key(Esc)], Command::Close, "close what is open; never quits"),
    bind!(Reading: [key(Left), letter('h')], cursor(-1, 0, false), "cursor to the left", "←→↑↓" "read"),
    bind!(Reading: [key(Right), letter('l')], cursor(1, 0, false), "cursor to the right"),
    bind!(Reading: [key(Up), letter('k')], cursor(0, 1, false), "cursor up"),
    bind!(Reading: [key(Down), letter('j')], cursor(0, -1, false), "cursor down"),
    bind!(Reading: [key(Enter)], Command::Open, "open the run at the cursor (map), jump to a limit or select its knob (margins)", "Enter" "open"),
    bind!(Reading: [shift(Left), letter('H')], cursor(-1, 0, true), "cursor far to the left", "HJKL" "far"),
    bind!(Reading: [shift(Right), letter('L')], cursor(1, 0, true), "cursor far to the right"),
    bind!(Reading: [shift(Up), letter('K')], cursor(0, 1, true), "cursor far up"),
    bind!(Reading: [shift(Down), letter('J')], cursor(0, -1, true), "cursor far down"),
    bind!(Reading: [key(Esc)], Command::Close, "remove the cursor (i keeps it)", "Esc" "knobs"),
    bind!(Typing: [key(Enter)], Command::Accept, "set the value", "Enter" "set"),
    bind!(Typing: [key(Esc)], Command::Close, "keep the old value", "Esc" "cancel"),
    bind!(Help: [letter('?'), letter('q'), key(Esc)], Command::Close, "close the help", "? Esc" "close"),
    bind!(Help: [letter('/')], Command::Search, "search for text that begins with any letter"),
    bind!(Filter: [key(Esc)], Command::Close, "clear the filter", "Esc" "clear"),
    bind!(Palette: [key(Enter)], Command::Accept, "run the command", "Enter" "run"),
    bind!(Palette: [key(Esc)], Command::Close, "close the list", "Esc" "close"),
    bind!(Palette: [key(Tab)], Command::Below, "the line below"),
    bind!(Palette: [key(BackTab)], Command::Above, "the line above"),
    bind!(Replacing: [letter('y')], Command::Accept, "replace the file", "y" "replace"),
    bind!(Replacing: [letter('n'), key(Esc)], Command::Close, "keep the old file", "n" "keep it"),
    bind!(Leaving: [letter('q')], Command::Leave, "quit without saving", "q" "quit"),
    bind!(Leaving: [letter('s')], Command::Ask(Purpose::Save), "save the scene", "s" "save"),
    bind!(Leaving: [letter('n'), key(Esc)], Command::Close, "stay", "Esc" "stay"),
    bind!(Question: [key(Up), letter('k')], Command::Above, "the answer above", "↑↓" "choose"),
    bind!(Question: [key(Down), letter('j')], Command::Below, "the answer below"),
    bind!(Question: [key(Enter)], Command::Accept, "answer", "Enter" "answer"),
    bind!(Question: [letter('a')], Command::Answer(0), "answer a"),
    bind!(Question: [letter('b')], Command::Answer(1), "answer b"),
    bind!(Question: [letter('c')], Command::Answer(2), "answer c"),
    bind!(Question: [letter('B')], Command::LessonBack, "the previous step", "B" "back"),
    bind!(Question: [letter('G')], Command::LeaveLesson, "leave the lesson", "G" "leave"),
    bind!(Field: [key(Left), ctrl('b')], Command::Edit(Edit::Left), "cursor to the left", "←→" "move"),
    bind!(Field: [key(Right), ctrl('f')], Command::Edit(Edit::Right), "cursor to the right"),
    bind!(Field: [key(Home), ctrl('a')], Command::Edit(Edit::Start), "to the start; there, to the first line"),
    bind!(Field: [key(End), ctrl('e')], Command::Edit(Edit::End), "to the end; there, to the last line"),
    bind!(Field: [key(Backspace), ctrl('h')], Command::Edit(Edit::DeleteBefore), "delete the letter before it"),
    bind!(Field: [key(Delete), ctrl('d')], Command::Edit(Edit::DeleteAfter), "delete the letter under it"),
    bind!(Field: [ctrl('w')], Command::Edit(Edit::DeleteWord), "delete the word before it"),
    bind!(Field: [ctrl('u')], Command::Edit(Edit::DeleteToStart), "delete all before it", "Ctrl-U" "clear"),
    bind!(Field: [ctrl('k')], Command::Edit(Edit::DeleteToEnd), "delete all behind it"),
    bind!(List: [key(Up)], Command::Above, "a line up", "↑↓" "choose"),
    bind!(List: [key(Down)], Command::Below, "a line down"),
    bind!(List: [key(PageUp)], Command::PageBack, "a page up"),
    bind!(List: [key(PageDown)], Command::PageForward, "a page down"),
    bind!(List: [key(Home)], Command::First, "the first line"),
    bind!(List: [key(End)], Command::Last, "the last line"),
    bind!(Dialogue: [ctrl('c')], Command::Quit, "quit", "Ctrl-C" "quit"),
    bind!(Dialogue: [ctrl('z')], Command::Suspend, "suspend"),
    bind!(Dialogue: [ctrl('l')], Command::Redraw, "draw the screen again"),
];

/// Iterates over the bindings of a group.
pub fn of(group: Group) -> impl Iterator<Item = &'static Binding> {
    BINDINGS.iter().filter(move |binding| binding.group == group)
}

/// Iterates over the bindings of the main screen.
pub fn main() -> impl Iterator<Item = &'static Binding> {
    BINDINGS.iter().filter(|binding| binding.group.is_main())
}

/// Iterates over the bindings that are valid while `group` has the keyboard, the nearest first.
pub fn valid(group: Group) -> impl Iterator<Item = &'static Binding> {
    let over_main = [Group::Reading, Group::Question].contains(&group) || group.is_main();
    let own = of(group).filter(move |_| !group.is_main());
    let behind = group.behind().iter().copied().flat_map(of);
    own.chain(behind).chain(main().filter(move |_| over_main))
}

/// Returns the command of a key while `group` has the keyboard; `None` if the key has none.
pub fn lookup(group: Group, chord: Chord) -> Option<Command> {
    let found = valid(group).find(|binding| binding.keys.contains(&chord));
    found.map(|binding| binding.command.clone())
}

/// Lists the keys of a binding as text, such as `Up, k`.
pub fn keys_text(binding: &Binding) -> String {
    binding.keys.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use strum::IntoEnumIterator;

    #[test]
    fn no_key_is_bound_twice_in_a_group_or_on_the_main_screen() {
        for group in Group::iter() {
            let keys: Vec<&Chord> = valid(group)
                .filter(|binding| binding.group == group || binding.group.is_main())
                .flat_map(|binding| binding.keys)
                .collect();
            let own = keys.len();
            let distinct = keys.iter().enumerate().filter(|(at, key)| !keys[..*at].contains(key));
            let over_main = [Group::Reading, Group::Question].contains(&group);
            assert!(over_main || distinct.count() == own, "{group:?}");
        }
    }

    #[test]
    fn every_binding_says_what_it_does_and_every_dialogue_can_be_left() {
        for binding in BINDINGS.iter() {
            assert!(!binding.what.is_empty() && !binding.keys.is_empty());
        }
        let parts = [Group::Field, Group::List, Group::Dialogue];
        for group in Group::iter().filter(|group| !parts.contains(group)) {
            assert_eq!(lookup(group, ctrl('c')), Some(Command::Quit));
            assert_eq!(lookup(group, key(Esc)), Some(Command::Close));
            assert_eq!(lookup(group, ctrl('z')), Some(Command::Suspend));
        }
    }
}
