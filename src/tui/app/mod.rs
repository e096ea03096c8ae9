//! The state of the explorer, without a terminal: the screen is a function of
//! this value, and only keys and snapshots change it.

mod baseline;
mod command;
mod cursor;
mod files;
mod help;
mod lesson;
mod map;
mod margins;
mod mode;
mod mouse;
mod palette;
mod past;
mod ranges;
mod scenes;
mod snapshot;
mod speeds;
mod sweep;
mod time;
mod touching;
mod turn;
mod update;
mod verdict;

pub use baseline::Baseline;
pub use cursor::{Cursor, STEP, cell_of};
pub use help::HelpState;
pub use lesson::LessonProgress;
pub use mode::{InputMode, Purpose};
pub use mouse::Heard;
pub use palette::PaletteState;
pub use ranges::Ranges;
pub use scenes::SceneEntry;
pub use sweep::Sweep;
pub use time::RATES;
pub use update::Effect;
pub use verdict::VerdictText;

use std::cell::RefCell;
use std::sync::Arc;

use mouse::NotedChart;
use past::Past;

use super::appearance::Appearance;
use super::bindings::Context;
use super::engine::{Answer, Moment, Order, Snapshot, generation};
use super::history::BinHistory;
use super::lessons::LessonsDone;
use super::line::Line;
use super::raster::Marker;
use super::scenes::FoundScenes;
use super::theme::Theme;
use super::views::ViewId;
use super::views::map::MapChoice;
use crate::model::Machine;
use crate::scene::{CheckedScene, Scene};

/// Where a scene is from.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Its name or path.
    pub name: String,
    /// The scene as it was read then; its file is never read again.
    pub scene: Scene,
}

/// A file that is being written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Writing {
    /// Its name, as typed.
    pub name: String,
    purpose: Purpose,
    /// Whether no key was pressed since.
    undisturbed: bool,
}

/// How the explorer ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The user quit, or the input ended.
    Done,
    /// A signal ended it.
    Signal(u8),
}

/// The explorer.
#[derive(Clone, Debug)]
pub struct App {
    /// The scene with the current values of the knobs.
    pub scene: CheckedScene,
    /// The scene as it was opened; `Backspace` restores its values.
    pub opened: CheckedScene,
    /// The scene with which the run started; knobs may have acted on it since.
    pub started: CheckedScene,
    /// Everything derived from `scene`.
    pub machine: Machine,
    /// The selected knob.
    pub knob: usize,
    /// What the keyboard acts on.
    pub mode: InputMode,
    /// Where files are written; the working directory unless set.
    pub directory: std::path::PathBuf,
    /// The reason if the last value of the selected knob was refused.
    pub refusal: Option<String>,
    /// The effect of the last key.
    pub status: Option<String>,
    /// The large chart.
    pub view: ViewId,
    /// The other views, in the order of their places next to it.
    pub companions: Vec<ViewId>,
    /// Whether the gaps are drawn against time.
    pub heat: bool,
    /// Whether the large chart has the whole screen.
    pub full_screen: bool,
    /// Whether the screen is for a projector.
    pub presenting: bool,
    /// Whether the mouse acts.
    pub mouse: bool,
    /// Whether time passes.
    pub playing: bool,
    /// Whether it stopped because the run has come to its end.
    stopped_by_end: bool,
    /// Place in `RATES`.
    pub rate: usize,
    /// Page length relative to the usual one, in steps of about two.
    pub zoom: i32,
    /// Whether the other contact law runs too, for comparison.
    pub compare: bool,
    /// Whether knobs act on the running motion.
    pub live: bool,
    /// The record of the running motion.
    pub history: BinHistory,
    /// What the map sweeps, and under which law.
    pub map: MapChoice,
    /// The parts of the latest snapshot that belong to this scene.
    pub latest: Snapshot,
    /// Whether the motion slows down at changes of contact and hurries between.
    pub slow_at_events: bool,
    /// The sweep of a knob that is under way.
    pub sweep: Option<Sweep>,
    /// How much the terminal is sent.
    pub line: Line,
    /// Width and height of the screen, in cells.
    pub size: (u16, u16),
    /// The record under the other contact law.
    pub comparison_history: BinHistory,
    /// A run pinned to compare with.
    pub baseline: Option<Baseline>,
    /// Number of charts next to the large one.
    pub companions_shown: usize,
    /// The reading cursor in the large chart.
    pub cursor: Option<Cursor>,
    /// Whether the arrows move it, not the knobs.
    pub reading: bool,
    /// The instant that it reads, where it was put in a chart over time \[s\].
    read_s: Option<f64>,
    /// Where the motion goes at once \[s\].
    go_to_s: f64,
    /// Pages back from the current one.
    pub pages_back: i64,
    /// Where the scene is from, for the command line that repeats the run.
    pub source: Option<Source>,
    /// The file that is being written.
    pub writing: Option<Writing>,
    /// The lesson under way.
    pub lesson: Option<LessonProgress>,
    /// The steps of the lessons that were done.
    pub lessons_done: LessonsDone,
    /// The scenes of the directory, as they were last read.
    pub found_scenes: FoundScenes,
    /// Page of the note of the selected scene, where it is long.
    pub note_page: usize,
    /// Chart ranges.
    pub ranges: Ranges,
    /// Theme and marker.
    pub appearance: Appearance,
    /// Where the data of the large chart was drawn last, and which part of it.
    chart_places: RefCell<Vec<NotedChart>>,
    /// The knob whose bar the mouse holds.
    grip: Option<mouse::Grip>,
    /// Where it clicked last, if it is still there.
    clicked: Option<(u16, u16)>,
    /// Whether `m` comes to octants.
    pub octants: bool,
    /// Whether the user is new and has pressed no key yet: the last line says
    /// what to try.
    pub is_new: bool,
    /// Whether the screen has shown the question that is open.
    asked: bool,
    /// The latest verdict there is, of this scene or of an older one.
    answer: Option<Arc<Answer>>,
    counters: Counters,
    undo: Vec<Past>,
    redo: Vec<Past>,
    page: i64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Counters {
    restarts: u64,
    changes: u64,
    steps: u64,
    jumps: u64,
    goes: u64,
    pulses: u64,
    /// The latest jump whose result was told.
    met: u64,
    /// How often the end of the run was told.
    ends: u64,
    extensions: u64,
}

impl Counters {
    /// The generation of the order that has these counts.
    fn generation(&self) -> u64 {
        generation(self.restarts, self.changes, self.pulses)
    }
}

impl App {
    /// The explorer on a checked scene.
    pub fn new(scene: CheckedScene, theme: Theme, marker: Marker) -> Self {
        let mut views: Vec<ViewId> =
            scene.view.charts.iter().filter_map(|word| ViewId::from_word(word)).collect();
        for view in ViewId::all() {
            if !views.contains(&view) {
                views.push(view);
            }
        }
        let view = views.first().copied().unwrap_or(ViewId::Response);
        let machine = scene.machine();
        let mut app = Self {
            opened: scene.clone(),
            started: scene.clone(),
            ranges: Ranges::of(machine.clearance()),
            machine,
            scene,
            knob: 0,
            mode: InputMode::Main,
            directory: std::path::PathBuf::new(),
            refusal: None,
            status: None,
            view,
            companions: views.into_iter().skip(1).collect(),
            heat: false,
            full_screen: false,
            presenting: false,
            mouse: true,
            playing: true,
            stopped_by_end: false,
            rate: time::FIRST_RATE,
            zoom: 0,
            compare: false,
            live: false,
            history: BinHistory::default(),
            map: MapChoice::default(),
            latest: Snapshot::default(),
            slow_at_events: true,
            sweep: None,
            line: Line::Auto,
            size: (80, 24),
            comparison_history: BinHistory::default(),
            baseline: None,
            companions_shown: 2,
            cursor: None,
            read_s: None,
            go_to_s: 0.0,
            reading: false,
            pages_back: 0,
            source: None,
            writing: None,
            lesson: None,
            lessons_done: LessonsDone::default(),
            found_scenes: FoundScenes::default(),
            note_page: 0,
            appearance: Appearance { theme, marker, wide: false },
            chart_places: RefCell::default(),
            grip: None,
            clicked: None,
            octants: false,
            is_new: false,
            asked: true,
            answer: None,
            counters: Counters::default(),
            undo: Vec::new(),
            redo: Vec::new(),
            page: 0,
        };
        app.go_to_s = app.begin_s();
        app
    }

    /// What the keyboard acts on, as the table of bindings names it.
    pub fn context(&self) -> Context {
        match self.mode {
            InputMode::Main if self.reading => Context::Reading,
            InputMode::Main if self.is_asked() => Context::Question,
            InputMode::Main => Context::Main,
            InputMode::Typing(_) | InputMode::Sweeping(_) => Context::Typing,
            InputMode::Help(ref help) if help.filter.is_empty() => Context::Help,
            InputMode::Help(_) => Context::Filter,
            InputMode::Palette(_) => Context::Palette,
            InputMode::Naming(..) => Context::Typing,
            InputMode::Replacing(..) => Context::Replacing,
            InputMode::Lessons(_) => Context::Lessons,
            InputMode::Scenes(_) => Context::Scenes,
        }
    }

    /// The order for the engine.
    pub fn order(&self) -> Order {
        Order {
            scene: self.scene.clone(),
            restarts: self.counters.restarts,
            changes: self.counters.changes,
            steps: self.counters.steps,
            goes: self.counters.goes,
            go_to_s: self.go_to_s,
            jumps: self.counters.jumps,
            pulses: self.counters.pulses,
            playing: self.playing,
            extensions: self.counters.extensions,
            rate: self.rate(),
            bin_s: self.page_s() / BINS_PER_PAGE,
            page: self.page(),
            compare: self.compare,
            slow_at_events: self.slow_at_events,
            cursor_s: self.cursor_time(),
            open: ViewId::all().filter(|view| self.is_open(*view)).collect(),
            map: self.map,
            cell: self.map_cell(),
        }
    }

    /// Whether a view can be on the screen.
    pub fn is_open(&self, view: ViewId) -> bool {
        let mut companions = self.companions.iter().take(self.companions_shown);
        view == self.view || (!self.is_alone() && companions.any(|other| *other == view))
    }

    /// Whether the large chart compares both contact laws, over the whole height.
    pub fn compares(&self) -> bool {
        self.compare && self.view == ViewId::Response
    }

    /// Whether only the large chart is on the screen.
    pub fn is_alone(&self) -> bool {
        self.full_screen || self.presenting || self.compares()
    }

    /// The instant that every panel shows: that under the reading cursor, or now.
    pub fn shown(&self) -> Option<&Moment> {
        let reading = self.latest.results.reading.as_deref();
        let reading = reading.filter(|_| self.cursor_time().is_some());
        reading.or(self.latest.moment.as_ref())
    }

    /// The current rotor speed \[rad/s\].
    pub fn speed(&self) -> f64 {
        let moment = self.latest.moment.as_ref();
        moment.map_or(self.scene.operation.speed_rad_s, |moment| moment.speed)
    }

    /// Why the motion stopped.
    pub fn failure(&self) -> Option<&String> {
        self.latest.moment.as_ref()?.failure.as_ref()
    }
}

/// Bins recorded per page: more than the sub-pixels of a wide screen.
const BINS_PER_PAGE: f64 = 1024.0;
