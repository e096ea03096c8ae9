//! The state of the explorer, without a terminal, and its parts. The screen is a function of this
//! value; only commands and snapshots of the engine change it.

mod command_line;
mod dialogue;
pub mod files;
mod glossary;
pub mod help;
mod knobs;
pub mod layout;
pub mod lesson;
mod mouse;
pub mod palette;
mod play;
mod reading;
mod run;
mod verdict;
pub mod words;

pub use dialogue::InputMode;
pub use help::HelpState;
pub use knobs::Past;
pub use knobs::{panel as knobs_panel, strip};
pub use layout::{LEAST_HEIGHT, LEAST_ROWS, LEAST_WIDTH};
pub use lesson::LessonProgress;
pub use mouse::Parts;
pub use palette::PaletteState;
pub use reading::{Cursor, Reading, STEP, cell_of};

use std::cell::OnceCell;

use dialogue::Dialogue;
use files::Files;
use knobs::Knobs;
use layout::Layout;
use lesson::Lessons;
use mouse::Mouse;
use play::Play;
use run::Run;

use super::appearance::Appearance;
use super::command::Group;
use super::engine::{Moment, Order};
use super::raster::Marker;
use super::theme::Theme;
use super::views::id::ViewId;
use super::views::map::plan::MapChoice;
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

/// How the explorer ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The user quit, or the input ended.
    Done,
    /// The process received this signal.
    Signal(u8),
}

/// The state of the explorer. Each part has its file in `app`: its state, what changes it, and how it
/// is drawn.
#[derive(Clone, Debug)]
pub struct App {
    /// The scene with the current knob values.
    pub scene: CheckedScene,
    /// The machine derived from `scene`.
    pub machine: Machine,
    /// Its lock windows for forward and backward rotation, once asked.
    pub locks: [OnceCell<Option<LockWindow>>; 2],
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
            mouse: Mouse::default(),
            appearance: Appearance { rpm, ..Appearance::new(theme, marker) },
            machine,
            locks: Default::default(),
            scene,
        }
    }

    /// Returns the group of commands that has the keyboard; [`Group::Program`] on the main screen,
    /// where the keys of all its groups are valid.
    pub fn keyboard(&self) -> Group {
        match &self.dialogue.mode {
            InputMode::Main if self.reading.on => Group::Reading,
            InputMode::Main if self.is_asked() => Group::Question,
            InputMode::Main => Group::Program,
            InputMode::Help(help) if help.is_searched() => Group::Filter,
            InputMode::Help(_) => Group::Help,
            InputMode::Palette(_) => Group::Palette,
            InputMode::Typing(_) | InputMode::Naming(..) => Group::Typing,
            InputMode::Replacing(..) => Group::Replacing,
            InputMode::Leaving => Group::Leaving,
            InputMode::Lessons(_) => Group::Lessons,
            InputMode::Scenes(_) => Group::SceneList,
        }
    }

    /// Builds the order for the engine from the current state.
    pub fn order(&self) -> Order {
        Order {
            scene: self.scene.clone(),
            film: self.run.film.clone(),
            number: self.run.number,
            run: self.run.runs,
            pinned: self.run.baseline.as_ref().map(|baseline| baseline.film.clone()),
            compare: self.run.compare,
            moves: self.play.moves.clone(),
            playing: self.play.playing,
            rate: self.rate(),
            slow_at_events: self.play.slow_at_events,
            page: self.page(),
            cursor_s: self.reading.at_s,
            open: ViewId::all().filter(|view| self.is_open(*view)).collect(),
            map: self.map_choice(),
            cell: self.map_cell(),
            range: self.layout.range,
        }
    }

    /// Returns whether the large chart shows both contact laws; then it is the only chart.
    pub fn compares(&self) -> bool {
        self.run.compare && self.is_large(ViewId::Response)
    }

    /// Returns the state at the time shown: that of the cursor, or of the playing motion. Until the
    /// engine has computed it, the state shown before. `None` before the first snapshot.
    pub fn shown(&self) -> Option<&Moment> {
        self.run.latest.moment.as_deref()
    }

    /// As [`Self::shown`], but `None` until the engine has computed the requested time.
    pub fn shown_now(&self) -> Option<&Moment> {
        let step = self.scene.solver.step_s;
        self.shown().filter(|moment| (moment.state.t_s - self.now()).abs() <= step)
    }

    /// Returns the rotor speed at the time shown \[rad/s\]; negative if the rotor turns backward.
    pub fn speed(&self) -> f64 {
        let moment = self.shown();
        moment.map_or(self.scene.operation.speed_rad_s, |moment| moment.speed)
    }

    /// Returns why the motion failed before the time shown; `None` if it did not.
    pub fn failure(&self) -> Option<&String> {
        self.shown()?.failure.as_ref()
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// Creates the paper's scene on a screen of 120 x 40.
    pub fn on_screen() -> App {
        let scene = Scene::builtin("paper-nd3").unwrap().checked().unwrap();
        let mut app = App::new(scene, Theme::Mono, Marker::Braille);
        app.layout.size = (120, 40);
        app
    }
}
