//! The types of the state: the explorer, and its parts.

use std::cell::{OnceCell, RefCell};
use std::path::PathBuf;
use std::sync::Arc;

use ratatui::layout::Rect;

use crate::tui::appearance::Appearance;
use crate::tui::axis::AutoRange;
use crate::tui::command::{Command, Purpose};
use crate::tui::engine::{Answer, Moves, Snapshot};
use crate::tui::field::Field;
use crate::tui::files::FoundScenes;
use crate::tui::film::FilmPlan;
use crate::tui::knobs::KnobRange;
use crate::tui::lessons::LessonsDone;
use crate::tui::raster::Marker;
use crate::tui::theme::Theme;
use crate::tui::views::id::ViewId;
use crate::tui::views::map::plan::MapChoice;
use rubscope_solver::model::{LockWindow, Machine};
use rubscope_solver::scene::{CheckedScene, Scene};

/// Where a scene came from.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Name of a built-in scene, or path of a file.
    pub name: String,
    /// The scene as read when it was opened; the file is not read again.
    pub scene: Scene,
}

/// The state of the explorer. Each part has its file in `app`: what changes it, and how it is drawn.
#[derive(Clone, Debug)]
pub struct App {
    /// The scene with the current knob values.
    pub scene: CheckedScene,
    /// The machine derived from `scene`.
    pub machine: Machine,
    /// Its lock windows for forward and backward rotation, once asked.
    pub locks: [OnceCell<Option<LockWindow>>; 2],
    /// The ranges of the bars drawn so far, by the path of the knob and the bits of its opened value.
    pub ranges: RefCell<std::collections::BTreeMap<(&'static str, u64), Option<KnobRange>>>,
    /// Message in the status line, usually about the last key; `None` shows the keys instead.
    pub status: Option<String>,
    /// The selected knob, and undo.
    pub knobs: Knobs,
    /// Playback, and the page of time.
    pub play: Play,
    /// The run, its results and chart ranges.
    pub run: Run,
    /// Which views are on the screen.
    pub layout: Layout,
    /// The cursor: a time in the run, and a position in the large chart.
    pub reading: Reading,
    /// Axes and contact law of the map.
    pub map: MapChoice,
    /// The open dialogue.
    pub dialogue: Dialogue,
    /// The open scene, the list of scenes, and the write under way.
    pub files: Files,
    /// Progress in the lessons.
    pub lessons: Lessons,
    /// State of the mouse, and the clickable areas of the last frame.
    pub mouse: Mouse,
    /// Theme, marker and units.
    pub appearance: Appearance,
}

impl App {
    /// Creates the explorer's state for a checked scene.
    pub fn new(scene: CheckedScene, theme: Theme, marker: Marker) -> Self {
        let machine = scene.machine();
        let rpm = scene.view.speeds.contains("rpm");
        Self {
            status: None,
            knobs: Knobs::default(),
            play: Play::of(&scene),
            run: Run::of(&scene, &machine),
            layout: Layout::of(&scene),
            reading: Reading::default(),
            map: MapChoice::default().anchored(&scene),
            dialogue: Dialogue::default(),
            files: Files::of(scene.clone()),
            lessons: Lessons::default(),
            mouse: Mouse { on: true, ..Mouse::default() },
            appearance: Appearance { rpm, ..Appearance::new(theme, marker) },
            machine,
            locks: Default::default(),
            ranges: Default::default(),
            scene,
        }
    }
}

/// The selected knob, and the states that undo and redo restore.
#[derive(Clone, Debug, Default)]
pub struct Knobs {
    /// Index in `KNOBS` of the selected knob.
    pub selected: usize,
    /// Why the last value typed or turned was refused; `None` if it was not.
    pub refusal: Option<String>,
    /// Whether knobs act on the running motion instead of restarting it.
    pub live: bool,
    /// Further presses of the same key already waiting; they are applied together.
    pub again: usize,
    /// States that undo restores, the latest last.
    pub(super) undo: Vec<Past>,
    /// States that were undone.
    pub(super) redo: Vec<Past>,
}

/// A state that undo restores.
#[derive(Clone, Debug, PartialEq)]
pub struct Past {
    /// The scene with its knob values.
    pub scene: CheckedScene,
    /// The film of its run.
    pub film: FilmPlan,
    /// Time shown \[s\], and whether the motion played on from there.
    pub at_s: f64,
    pub playing: bool,
    /// The scene as opened.
    pub opened: CheckedScene,
    /// Where it came from; `None` for the built-in default.
    pub source: Option<Source>,
    /// The views, the large one first.
    pub views: Vec<ViewId>,
    /// Settings of playback.
    pub tempo: Tempo,
    /// Whether knobs acted on the running motion.
    pub live: bool,
    /// Whether the scene also ran under the other contact law.
    pub compare: bool,
    /// Progress in the open lesson; `None` if none was open.
    pub lesson: Option<LessonProgress>,
}

/// The state of the playback.
#[derive(Clone, Debug, Default)]
pub struct Play {
    /// Whether the motion plays; otherwise it is paused.
    pub playing: bool,
    /// Its settings.
    pub tempo: Tempo,
    /// Centre of the page \[s\]; `None` if the page follows the motion.
    pub middle_s: Option<f64>,
    /// Moves in time that the engine has yet to make.
    pub moves: Moves,
    /// Start of the run that the last key restarted \[s\]; `None` after any other key.
    pub begun_s: Option<f64>,
    /// Number of the move whose change of contact is to be reported; `None` if there is none.
    pub(super) jump: Option<u64>,
    /// Whether playback stopped because the run ended, not because the user paused it.
    pub(super) stopped_by_end: bool,
    /// Numbers of the film and its page to which the ranges of the charts were last fitted.
    pub fitted: Option<(u64, i64)>,
}

/// Settings of playback that undo restores.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tempo {
    /// Simulated time over wall-clock time, as a place of `round_number`; 0 is real time.
    pub rate: i32,
    /// Zoom steps from the usual page length; positive is shorter.
    pub zoom: i32,
    /// Whether playback slows down at changes of contact and speeds up between them.
    pub slow_at_events: bool,
}

/// The run on the screen, and what is compared with it.
#[derive(Clone, Debug)]
pub struct Run {
    /// The film of the run: the scene at its start, and live changes.
    pub film: FilmPlan,
    /// Number of films in this session; each live change makes a new one.
    pub number: u64,
    /// Number of runs that were begun in this session.
    pub runs: u64,
    /// The latest snapshot, with results of the current film only.
    pub latest: Snapshot,
    /// Whether the scene also runs under the other contact law.
    pub compare: bool,
    /// The pinned run that is drawn behind the current one; `None` if none is pinned.
    pub baseline: Option<Baseline>,
    /// Axis ranges of the charts.
    pub ranges: Ranges,
    /// The latest known verdict, whose scene may be an older one; `None` before the first.
    pub answer: Option<Arc<Answer>>,
}

/// A pinned run, drawn behind later ones.
#[derive(Clone, Debug)]
pub struct Baseline {
    /// Its film.
    pub film: FilmPlan,
    /// Its verdict as displayed.
    pub word: String,
    /// The scene with the knob values at that time.
    pub scene: CheckedScene,
}

/// Axis ranges of the charts; they follow the data with hysteresis.
#[derive(Clone, Copy, Debug)]
pub struct Ranges {
    /// `u_c`, `u_s` \[m\].
    pub casing: AutoRange,
    /// `alpha_c`, `alpha_s` \[rad\].
    pub blades: AutoRange,
    /// Gaps between tips and casing \[m\]; negative in a lining.
    pub gaps: AutoRange,
    /// Casing displacement relative to the tips, in the frame of the blades \[m\].
    pub rim: AutoRange,
    /// Whether the ranges follow the data.
    pub follow: bool,
}

/// Which views are on the screen, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// All views: the large one, then the others in screen order. Only the first `1 + beside` are
    /// shown.
    pub views: Vec<ViewId>,
    /// Whether the user, not the scene, made the first view the large one.
    pub(super) chosen: bool,
    /// Number of charts beside the large one.
    pub beside: usize,
    /// Whether the margins view shows the survey over all nodal diameters.
    pub survey: bool,
    /// Speed range of the survey \[rad/s\]; `None` covers all speeds.
    pub range: Option<[f64; 2]>,
    /// Whether the large chart fills the screen.
    pub full_screen: bool,
    /// Width and height of the screen \[cells\].
    pub size: (u16, u16),
}

/// State of the cursor.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Position in the large chart; `None` if there is no cursor.
    pub cursor: Option<Cursor>,
    /// Whether the arrow keys move the cursor instead of turning and selecting knobs.
    pub on: bool,
    /// Time that all panels show \[s\]; `None` follows the playing motion.
    pub at_s: Option<f64>,
}

/// A position in the large chart, as fractions 0 to 1 of its width and height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cursor {
    /// Fraction of the width, from the left.
    pub across: f64,
    /// Fraction of the height, from the bottom.
    pub up: f64,
}

/// The state of the dialogues.
#[derive(Clone, Debug, Default)]
pub struct Dialogue {
    /// What the keyboard acts on.
    pub mode: InputMode,
    /// Index of the selected line of the list, or of the first line of the help; `None` until one is
    /// chosen.
    pub place: Option<usize>,
    /// Whether this is the first start and no key was pressed yet: the footer then says what to
    /// try.
    pub is_new: bool,
    /// Whether no frame has shown the open question yet. Keys typed ahead must not answer it.
    pub unseen: bool,
}

/// What the keyboard acts on: the main screen, or one open dialogue.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum InputMode {
    /// Knobs and charts.
    #[default]
    Main,
    /// Typing a value for the selected knob.
    Typing(Field),
    /// The help, with the words that every entry listed must contain. Without any, the first letter
    /// may be a key of the help, such as `q`.
    Help(Field),
    /// The help, in which every letter goes into the words.
    Search(Field),
    /// The list of commands: the word that all of them begin with, and what is typed behind it.
    Palette(&'static str, Field),
    /// Typing a file name.
    Naming(Purpose, Field),
    /// Asking whether to replace the existing file of this name.
    Replacing(Purpose, String),
    /// Asking whether to quit with a changed scene.
    Leaving,
}

/// The open scene, and the files of the directory.
#[derive(Clone, Debug)]
pub struct Files {
    /// Directory in which scenes are found and files are written; empty means the working
    /// directory.
    pub directory: PathBuf,
    /// The scene as opened; `Backspace` restores its values.
    pub opened: CheckedScene,
    /// Where the scene came from, for the command line; `None` for the built-in default.
    pub source: Option<Source>,
    /// The scene as last saved; `None` if it was not.
    pub saved: Option<CheckedScene>,
    /// The write under way; `None` if there is none.
    pub writing: Option<Writing>,
    /// The scene files of the directory, as last read.
    pub found: FoundScenes,
}

/// A file that is being written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Writing {
    /// File name as typed.
    pub name: String,
    /// What is written to it.
    pub purpose: Purpose,
    /// Whether no key was pressed since the write began.
    pub undisturbed: bool,
}

/// The open lesson, and the steps completed in all lessons.
#[derive(Clone, Debug, Default)]
pub struct Lessons {
    /// Progress in the open lesson; `None` if none is open.
    pub progress: Option<LessonProgress>,
    /// All steps completed so far, in any session.
    pub done: LessonsDone,
}

/// Progress in the current lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct LessonProgress {
    /// Index of the lesson.
    pub lesson: usize,
    /// Index of the current step.
    pub step: usize,
    /// Answer and task of every step.
    pub steps: Vec<StepProgress>,
    /// Index of the answer that Enter gives.
    pub choice: usize,
    /// State before the lesson, restored when it ends.
    pub own: Arc<Past>,
}

/// Progress in one step of a lesson.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepProgress {
    /// Index of the answer given; `None` before that, and without a question.
    pub answer: Option<usize>,
    /// Whether the question is answered and the task done.
    pub done: bool,
}

/// The state of the mouse.
#[derive(Clone, Debug, Default)]
pub struct Mouse {
    /// Whether mouse events are used.
    pub on: bool,
    /// Screen cell at which the wheel turned a knob last, and the index of that knob; `None` before
    /// the first turn.
    pub(super) wheeled: Option<((u16, u16), usize)>,
    /// What can be clicked on the last frame. Where areas overlap, the later one is on top.
    pub(super) drawn: RefCell<Vec<Spot>>,
}

/// Something that is drawn and can be clicked.
#[derive(Clone, Debug)]
pub(super) struct Spot {
    pub(super) area: Rect,
    /// The command of a click. One that needs a position gets that of the click.
    pub(super) command: Command,
    /// The positions that the area covers.
    pub(super) parts: Parts,
}

/// Ranges of fractions, across and up, that an area covers.
pub type Parts = [(f64, f64); 2];
