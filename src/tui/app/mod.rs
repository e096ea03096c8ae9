//! The state of the explorer, without a terminal: the screen is a function of
//! this value, and only keys and snapshots change it.

mod command;
mod cursor;
mod files;
mod lesson;
mod map;
mod snapshot;
mod time;
mod turn;
mod update;
mod verdict;

pub use cursor::Cursor;
pub use lesson::LessonProgress;
pub use time::RATES;
pub use update::Effect;
pub use verdict::VerdictText;

use super::appearance::Appearance;
use super::axis::AutoRange;
use super::bindings::Context;
use super::engine::{Moment, Order, Snapshot};
use super::history::BinHistory;
use super::raster::Marker;
use super::theme::Theme;
use super::views::ViewId;
use super::views::map::MapChoice;
use crate::model::Machine;
use crate::scene::{CheckedScene, Scene};

/// A pinned run, drawn behind the next ones.
#[derive(Clone, Debug)]
pub struct Baseline {
    /// Its record.
    pub history: BinHistory,
    /// Its verdict.
    pub words: VerdictText,
}

/// The purpose of a file name that is typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The scene as a TOML file.
    Save,
    /// The large chart's data as CSV, or the screen as SVG.
    Export,
}

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

/// What the keyboard acts on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum InputMode {
    /// Knobs and charts.
    Main,
    /// The value of the selected knob is being typed.
    Typing(String),
    /// The help is open, scrolled down by some lines.
    Help(u16),
    /// A file name is being typed.
    Naming(Purpose, String),
    /// A question: replace the existing file?
    Replacing(Purpose, String),
    /// A lesson is being chosen.
    Lessons(usize),
}

/// How the explorer ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The user quit, or the input ended.
    Done,
    /// A signal ended it.
    Signal(u8),
}

/// Ranges of the charts; they follow the data with hysteresis.
#[derive(Clone, Copy, Debug)]
pub struct Ranges {
    /// `u_c`, `u_s` \[m\].
    pub casing: AutoRange,
    /// `alpha_c`, `alpha_s` \[rad\].
    pub blades: AutoRange,
    /// Gaps \[m\].
    pub gaps: AutoRange,
    /// Whether they follow.
    pub follow: bool,
}

impl Ranges {
    /// Ranges at the start: the clearance and a little more.
    pub fn of(clearance: f64) -> Self {
        Self {
            casing: AutoRange::new(-1.25 * clearance, 1.25 * clearance),
            blades: AutoRange::new(-1e-9, 1e-9),
            gaps: AutoRange::new(-0.2 * clearance, 2.2 * clearance),
            follow: true,
        }
    }
}

/// The explorer.
#[derive(Clone, Debug)]
pub struct App {
    /// The scene with the current values of the knobs.
    pub scene: CheckedScene,
    /// The scene as it was opened; `Backspace` restores its values.
    pub opened: CheckedScene,
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
    /// Whether time passes.
    pub playing: bool,
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
    /// The state of which whole waves are drawn. It changes a few times per
    /// second: a new one in every frame is too much for a slow connection.
    pub throttled: Option<Moment>,
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
    /// Pages back from the current one.
    pub pages_back: i64,
    /// Where the scene is from, for the command line that repeats the run.
    pub source: Option<Source>,
    /// The file that is being written.
    pub writing: Option<Writing>,
    /// The lesson under way.
    pub lesson: Option<LessonProgress>,
    /// Chart ranges.
    pub ranges: Ranges,
    /// Theme and marker.
    pub appearance: Appearance,
    /// Whether the screen has shown the question that is open.
    asked: bool,
    /// The latest verdict of a motion that has been changed since, in one word.
    verdict_before: Option<String>,
    counters: Counters,
    undo: Vec<CheckedScene>,
    redo: Vec<CheckedScene>,
    page: i64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Counters {
    restarts: u64,
    changes: u64,
    steps: u64,
    jumps: u64,
    pulses: u64,
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
        Self {
            opened: scene.clone(),
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
            playing: true,
            rate: time::FIRST_RATE,
            zoom: 0,
            compare: false,
            live: false,
            history: BinHistory::default(),
            map: MapChoice::default(),
            latest: Snapshot::default(),
            throttled: None,
            size: (80, 24),
            comparison_history: BinHistory::default(),
            baseline: None,
            companions_shown: 2,
            cursor: None,
            reading: false,
            pages_back: 0,
            source: None,
            writing: None,
            lesson: None,
            appearance: Appearance { theme, marker },
            asked: true,
            verdict_before: None,
            counters: Counters::default(),
            undo: Vec::new(),
            redo: Vec::new(),
            page: 0,
        }
    }

    /// What the keyboard acts on, as the table of bindings names it.
    pub fn context(&self) -> Context {
        match self.mode {
            InputMode::Main if self.reading => Context::Reading,
            InputMode::Main => Context::Main,
            InputMode::Typing(_) => Context::Typing,
            InputMode::Help(_) => Context::Help,
            InputMode::Naming(..) => Context::Typing,
            InputMode::Replacing(..) => Context::Replacing,
            InputMode::Lessons(_) => Context::Lessons,
        }
    }

    /// The order for the engine.
    pub fn order(&self) -> Order {
        Order {
            scene: self.scene.clone(),
            restarts: self.counters.restarts,
            changes: self.counters.changes,
            steps: self.counters.steps,
            jumps: self.counters.jumps,
            pulses: self.counters.pulses,
            playing: self.playing,
            rate: self.rate(),
            bin_s: self.page_s() / BINS_PER_PAGE,
            compare: self.compare,
            open: ViewId::all().filter(|view| self.is_open(*view)).collect(),
            map: self.map,
            cell: self.map_cell(),
        }
    }

    /// Whether a view can be on the screen.
    pub fn is_open(&self, view: ViewId) -> bool {
        let mut companions = self.companions.iter().take(self.companions_shown);
        view == self.view || (!self.full_screen && companions.any(|other| *other == view))
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
