//! Everything that can be done in the explorer. A key, a click, a word after `:`, a line of
//! `--lines` and a step of a lesson are commands; `update` executes them. The table in `table` gives
//! the keys of a command, its words in help, footer and manual, and the group in which its keys are
//! valid.

mod chord;
mod table;

use std::path::PathBuf;

use strum::{EnumIter, IntoStaticStr};

use crate::tui::field::Edit;
use crate::tui::files::FileJob;
use crate::tui::theme::Theme;
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::CheckedScene;

pub use chord::Chord;
pub use table::BINDINGS;

/// What will be written to a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The scene as a TOML file.
    Save,
    /// The large chart's data as CSV, or the screen as SVG.
    Export,
}

/// Something that the explorer does.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Quit the explorer.
    Quit,
    /// Close what is open; on the main screen quit, and ask where the scene is changed.
    Leave,
    /// Take every step of the run one by one, or skip again those whose result is known.
    Plain,
    /// Return the terminal to the shell until the job is continued.
    Suspend,
    /// Draw the whole screen again.
    Redraw,
    /// Close what is open.
    Close,
    /// Open the help.
    Help,
    /// Open the help for a search in which every letter is part of the text.
    Search,
    /// Open the list of commands, with this text typed.
    Palette(&'static str),
    /// Select the line above: of a list, of the answers to a question, or of the knobs.
    Above,
    /// Select the line below.
    Below,
    /// Go to the first line of a list.
    First,
    /// Go to the last line of a list.
    Last,
    /// Go back by a page: of a list, or of time.
    PageBack,
    /// Go forward by a page.
    PageForward,
    /// Take the typed text or the selected entry.
    Accept,
    /// Edit the text being typed.
    Edit(Edit),
    /// Replace the existing file.
    Replace,
    /// Show the next page of a scene's note.
    TurnNote,
    /// Turn the selected knob by a fine or a coarse step.
    Turn {
        /// Whether the value grows.
        up: bool,
        /// Whether the step is the coarse one.
        coarse: bool,
    },
    /// Open the prompt for a value of the selected knob.
    Type,
    /// Give the selected knob its value in the opened scene.
    Reset,
    /// Undo the last change of the scene.
    Undo,
    /// Redo it.
    Redo,
    /// Switch between knobs that act on the running motion and knobs that restart it.
    Live,
    /// Select a knob, given by its index in `KNOBS`.
    Select(usize),
    /// Open a group of knobs, given by the index of its first knob.
    Unfold(usize),
    /// Set a knob, given by its index, to a value as typed.
    Set(usize, String),
    /// Set a knob, given by its index, to the value at a fraction of its bar, 0 to 1.
    SetPart(usize, f64),
    /// Pause the motion, or continue it.
    Pause,
    /// Make one time step.
    Step,
    /// Restart the run.
    Restart,
    /// Fire the pulse into the running motion.
    Fire,
    /// Switch whether playback slows down at changes of contact.
    SlowAtEvents,
    /// Play more slowly.
    Slower,
    /// Play faster.
    Faster,
    /// Shorten the page of time.
    ZoomIn,
    /// Lengthen the page of time.
    ZoomOut,
    /// Return to the usual page of time.
    ZoomReset,
    /// Go on to the next change of contact.
    Jump,
    /// Go to the end of the run.
    GoToEnd,
    /// Go to a simulated time \[s\].
    GoTo(f64),
    /// Make a view the large one.
    View(ViewId),
    /// Make the next view the large one.
    NextView,
    /// Make the previous view the large one.
    PreviousView,
    /// Change the number of charts on the screen.
    Charts,
    /// Show one chart over the whole screen, or all again.
    FullScreen,
    /// Switch whether the scales follow the data.
    Autoscale,
    /// Pin the run behind the next ones, or remove the pinned one.
    Pin,
    /// Compare with the other contact law; in the map, use its law.
    OtherLaw,
    /// Switch between the margins of all nodal diameters and those of one.
    Survey,
    /// Survey all nodal diameters over a range of rotor speeds \[rad/s\]; `None` for all speeds.
    /// `doubt` asks about its unit.
    Range { ends: Option<[f64; 2]>, doubt: Option<String> },
    /// Choose the keys on the horizontal and the vertical axis of the map; `None` leaves that axis.
    Axes([Option<&'static str>; 2]),
    /// Give the arrow keys to the cursor of the large chart, or back to the knobs.
    Read,
    /// Move the cursor by steps.
    Cursor {
        /// Steps to the right.
        right: i64,
        /// Steps up.
        up: i64,
        /// Whether the steps are large.
        coarse: bool,
    },
    /// Put the cursor at a position of the large chart, as fractions of its width and height; where
    /// it stands already, open what is there.
    PutCursor([f64; 2]),
    /// Show the gap of a blade, numbered from 1.
    Blade(u32),
    /// Open what the large chart offers at the cursor.
    Open,
    /// Open the run of a map cell.
    OpenRun(Box<CheckedScene>),
    /// Set a knob to the value of a limit.
    JumpTo {
        /// Key of the knob.
        path: &'static str,
        /// Value of the limit.
        value: f64,
        /// Label of the limit.
        to: String,
    },
    /// Do nothing, for this reason.
    Nothing(String),
    /// Open the list of scenes.
    Scenes,
    /// Open a scene, given by its name.
    Scene(String),
    /// Open the list of lessons; in a lesson, show its next step.
    Guide,
    /// Begin a lesson, given by its index in `lessons::all`.
    Lesson(usize),
    /// Show the previous step of the lesson.
    LessonBack,
    /// Leave the lesson.
    LeaveLesson,
    /// Answer the question of a lesson, by the index of the answer.
    Answer(usize),
    /// Ask for the name of a file.
    Ask(Purpose),
    /// Write a file of this kind and name.
    Write(Purpose, String),
    /// Copy the command line that computes what the large view shows.
    Copy,
    /// Use the next marker.
    Marker,
    /// Use the next theme.
    NextTheme,
    /// Use this theme.
    Theme(Theme),
    /// Show speeds in the other unit.
    SpeedUnit,
    /// Switch the mouse on or off.
    Mouse,
}

/// An effect outside the state, which the event loop carries out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Effect {
    /// No effect except a redraw.
    None,
    /// Quit the explorer.
    Quit,
    /// Suspend the job.
    Suspend,
    /// Redraw the whole screen.
    Redraw,
    /// Switch the terminal's mouse reports on or off.
    Mouse(bool),
    /// Put a text on the clipboard of the terminal.
    Copy(String),
    /// Write a file.
    Write(FileJob),
    /// Read the scenes of a directory.
    FindScenes(PathBuf),
}

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
    /// Choosing a lesson.
    #[strum(serialize = "In the list of lessons")]
    Lessons,
    /// Answering a question of a lesson; other keys as on the main screen.
    #[strum(serialize = "While a lesson asks")]
    Question,
    /// Choosing a scene.
    #[strum(serialize = "In the list of scenes")]
    SceneList,
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
            Self::Help | Self::Lessons | Self::SceneList => &[Self::List, Self::Dialogue],
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

/// Returns the group of a command of the table; `None` if it has no key.
pub fn group_of(command: &Command) -> Option<Group> {
    BINDINGS.iter().find(|binding| binding.command == *command).map(|binding| binding.group)
}

/// Lists the keys of a binding as text, such as `Up, k`.
pub fn keys_text(binding: &Binding) -> String {
    binding.keys.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crossterm::event::KeyCode;
    use strum::IntoEnumIterator;
    use table::{ctrl, key};

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
            assert_eq!(lookup(group, key(KeyCode::Esc)), Some(Command::Close));
            assert_eq!(lookup(group, ctrl('z')), Some(Command::Suspend));
        }
    }
}
