//! The state of the explorer, without a terminal: what is shown is a function
//! of this value, and only keys and snapshots change it.

mod absorb;
mod command;
mod files;
mod guide;
mod time;
mod turn;
mod update;
mod verdict;

pub use guide::Progress;
pub use time::{RATES, page_length};
pub use update::Effect;
pub use verdict::Words;

use std::sync::Arc;

use super::axis::AutoRange;
use super::bindings::Context;
use super::engine::Wants;
use super::engine::{Ahead, Forecast, Moment, Order, Pace};
use super::history::History;
use super::locked_curve::LockedCurves;
use super::raster::Marker;
use super::skin::Skin;
use super::spectrum::Spectrum;
use super::theme::Theme;
use crate::model::Machine;
use crate::scene::{CheckedScene, keys::CHARTS};
use crate::study::Map;
use crate::study::precision::Precision;

/// The views, in the order of their digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// `u_c`, `u_s`, `alpha_c`, `alpha_s` against time.
    Response,
    /// The gap of every blade.
    Gaps,
    /// Multipliers of the locked motion against speed.
    Locked,
    /// The wave as a point in the frame of the blades, and the rim as a wheel.
    Frame,
    /// How the motion lasts, over speed and pulse.
    Map,
    /// Spectrum of the run, and Campbell lines.
    Spectrum,
    /// Speed against error of every solver.
    Precision,
}

impl View {
    /// All views.
    pub const ALL: [Self; 7] = [
        Self::Response,
        Self::Gaps,
        Self::Locked,
        Self::Frame,
        Self::Map,
        Self::Spectrum,
        Self::Precision,
    ];

    /// The word of the scene file.
    #[must_use]
    pub fn word(self) -> &'static str {
        CHARTS.get(usize::from(self.digit()) - 1).copied().unwrap_or("")
    }

    /// The view a word stands for.
    #[must_use]
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|view| view.word() == word)
    }

    /// The digit that opens it.
    #[must_use]
    pub fn digit(self) -> u8 {
        match self {
            Self::Response => 1,
            Self::Gaps => 2,
            Self::Locked => 3,
            Self::Frame => 4,
            Self::Map => 5,
            Self::Spectrum => 6,
            Self::Precision => 7,
        }
    }
}

/// A run pinned behind the next ones.
#[derive(Clone, Debug)]
pub struct Baseline {
    /// What was recorded of it.
    pub history: History,
    /// Its verdict.
    pub words: Words,
    /// Its forces: sides and multipliers \[N\].
    pub forces: Vec<(u32, f64)>,
}

/// What a file name is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The scene as a TOML file.
    Save,
    /// The large chart's data as CSV, or the screen as SVG.
    Export,
}

/// What the keyboard acts on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Knobs and charts.
    Main,
    /// The value of the selected knob is being typed.
    Typing(String),
    /// The help is open, scrolled down by some lines.
    Help(u16),
    /// A file name is being typed.
    Naming(Purpose, String),
    /// A file exists: may it be replaced?
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
    /// Ranges to begin with: the clearance and a little more.
    #[must_use]
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
    /// The scene as the knobs have it.
    pub scene: CheckedScene,
    /// The scene as it was opened; `Backspace` goes back to its values.
    pub opened: CheckedScene,
    /// Everything derived from `scene`.
    pub machine: Machine,
    /// The selected knob.
    pub knob: usize,
    /// What the keyboard acts on.
    pub mode: Mode,
    /// Where files are written; the working directory unless set.
    pub directory: std::path::PathBuf,
    /// Why the last value of the selected knob was refused.
    pub refusal: Option<String>,
    /// What just happened.
    pub status: Option<String>,
    /// The large chart.
    pub view: View,
    /// The charts beside it.
    pub companions: Vec<View>,
    /// Whether the gaps stand against time.
    pub heat: bool,
    /// Whether the large chart has the whole screen.
    pub full_screen: bool,
    /// Whether time passes.
    pub playing: bool,
    /// Place in `RATES`.
    pub rate: usize,
    /// Page length relative to the usual one, in steps of about two.
    pub zoom: i32,
    /// Whether the other contact law runs beside this one.
    pub compare: bool,
    /// Whether knobs act on the running motion.
    pub live: bool,
    /// What was recorded of the running motion.
    pub history: History,
    /// The latest instant.
    pub moment: Option<Moment>,
    /// The instant that busy pictures show, a few times a second: a whole
    /// wave that moves with every frame would flood a slow line.
    pub slow: Option<Moment>,
    /// What the run comes to.
    pub ahead: Option<Ahead>,
    /// What it comes to under the event solver and unilateral contact.
    pub reference: Option<Forecast>,
    /// Whether a tiny change of the pulse changes the outcome.
    pub sensitive: bool,
    /// Width and height of the screen, in cells.
    pub size: (u16, u16),
    /// What it comes to under the other contact law.
    pub beside: Option<Forecast>,
    /// The locked motion against speed; that of the machine before until the
    /// new one is computed.
    pub locked: Option<Arc<LockedCurves>>,
    /// The spectrum of the run.
    pub spectrum: Option<Arc<Spectrum>>,
    /// The map over speed and pulse.
    pub map: Option<Arc<Map>>,
    /// Speed against error.
    pub precision: Option<Arc<Precision>>,
    /// What was recorded under the other contact law.
    pub beside_history: History,
    /// A run pinned to compare with.
    pub baseline: Option<Baseline>,
    /// How many charts stand beside the large one.
    pub charts_beside: usize,
    /// Place of the reading cursor on the page, 0 to 1.
    pub cursor: Option<f64>,
    /// Pages looked back from the present one.
    pub pages_back: i64,
    /// What the scene was opened by, for the command line that repeats it.
    pub source: Option<String>,
    /// The lesson under way.
    pub lesson: Option<Progress>,
    /// Solver speed.
    pub pace: Pace,
    /// Something broke in the engine.
    pub trouble: Option<String>,
    /// Chart ranges.
    pub ranges: Ranges,
    /// Theme and marker.
    pub skin: Skin,
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
    #[must_use]
    pub fn new(scene: CheckedScene, theme: Theme, marker: Marker) -> Self {
        let mut views: Vec<View> =
            scene.view.charts.iter().filter_map(|word| View::from_word(word)).collect();
        for view in View::ALL {
            if !views.contains(&view) {
                views.push(view);
            }
        }
        let view = views.first().copied().unwrap_or(View::Response);
        let machine = scene.machine();
        Self {
            opened: scene.clone(),
            ranges: Ranges::of(machine.clearance()),
            machine,
            scene,
            knob: 0,
            mode: Mode::Main,
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
            history: History::default(),
            moment: None,
            slow: None,
            ahead: None,
            reference: None,
            sensitive: false,
            size: (80, 24),
            beside: None,
            locked: None,
            spectrum: None,
            map: None,
            precision: None,
            beside_history: History::default(),
            baseline: None,
            charts_beside: 2,
            cursor: None,
            pages_back: 0,
            source: None,
            lesson: None,
            pace: Pace::default(),
            trouble: None,
            skin: Skin { theme, marker },
            counters: Counters::default(),
            undo: Vec::new(),
            redo: Vec::new(),
            page: 0,
        }
    }

    /// What the keyboard acts on, as the table of bindings names it.
    #[must_use]
    pub fn context(&self) -> Context {
        match self.mode {
            Mode::Main => Context::Main,
            Mode::Typing(_) => Context::Typing,
            Mode::Help(_) => Context::Help,
            Mode::Naming(..) => Context::Typing,
            Mode::Replacing(..) => Context::Replacing,
            Mode::Lessons(_) => Context::Lessons,
        }
    }

    /// What the engine shall do.
    #[must_use]
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
            beside: self.compare,
            wants: Wants {
                spectrum: self.is_open(View::Spectrum),
                map: self.is_open(View::Map),
                precision: self.is_open(View::Precision),
            },
        }
    }

    /// Whether a view may be on the screen.
    #[must_use]
    pub fn is_open(&self, view: View) -> bool {
        let beside = self.companions.iter().take(self.charts_beside).any(|other| *other == view);
        view == self.view || (beside && !self.full_screen)
    }

    /// The present rotor speed \[rad/s\].
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.moment.as_ref().map_or(self.scene.operation.speed_rad_s, |moment| moment.speed)
    }
}

/// Bins recorded per page: more than the sub-pixels of a wide screen.
const BINS_PER_PAGE: f64 = 1024.0;
