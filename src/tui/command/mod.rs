//! Everything that can be done in the explorer. A key, a click, a word after `:` and a line of
//! `--lines` are commands, and a step of a lesson is a list of them; `update` executes them. The
//! table in `table` gives the keys of a command, its words in help, footer and manual, and the group
//! in which its keys are valid.

pub mod chord;
pub mod table;

use std::path::PathBuf;

use crate::tui::field::Edit;
use crate::tui::files::FileJob;
use crate::tui::theme::Theme;
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::CheckedScene;

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
    /// Open the list of the commands that begin with a word, such as `scene `.
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
    /// Play faster by so many steps, or more slowly.
    Faster(i32),
    /// Shorten the page of time.
    ZoomIn,
    /// Lengthen the page of time.
    ZoomOut,
    /// Show a page of time of at least this length \[s\], or the usual one.
    Page(Option<f64>),
    /// Go on to the next change of contact.
    Jump,
    /// Go to the end of the run.
    GoToEnd,
    /// Go to a simulated time \[s\].
    GoTo(f64),
    /// Make a view the large one.
    View(ViewId),
    /// Make the view so many places after the large one the large one.
    NextView(i64),
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
    /// Compare with the other contact law from now on, or no longer.
    Compare(bool),
    /// Put this view, which would answer a question, behind the others, and slow ones before it.
    Behind(Option<ViewId>),
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
    /// Open a scene, given by its name.
    Scene(String),
    /// Open the scene of a step of a lesson, made from the built-in one of this name.
    LessonScene(String, Box<CheckedScene>),
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
