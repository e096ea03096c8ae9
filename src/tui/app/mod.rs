//! The state of the explorer, without a terminal: the screen is a function of
//! this value, and only keys and snapshots change it.

mod dialogue;
mod files;
mod knobs;
mod layout;
mod lesson;
mod map;
mod mouse;
mod play;
mod reading;
mod run;
mod verdict;

pub use dialogue::{HelpState, InputMode, PaletteState, Purpose};
pub use files::{SceneEntry, Writing};
pub use knobs::Past;
pub use lesson::{LessonProgress, StepProgress};
pub use mouse::Target;
pub use reading::{Cursor, Reading, STEP, cell_of};

use dialogue::Dialogue;
use files::Files;
use knobs::Knobs;
use layout::Layout;
use lesson::Lessons;
use mouse::Mouse;
use play::Play;
use run::Run;

use super::appearance::Appearance;
use super::bindings::Context;
use super::engine::{Moment, Order};
use super::raster::Marker;
use super::theme::Theme;
use super::views::id::ViewId;
use super::views::map::plan::MapChoice;
use rubscope_solver::model::Machine;
use rubscope_solver::scene::{CheckedScene, Scene};

/// Origin of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Its name or path.
    pub name: String,
    /// The scene as it was read then; its file is never read again.
    pub scene: Scene,
}

/// End of the explorer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The user quit, or the input ended.
    Done,
    /// A signal ended it.
    Signal(u8),
}

/// The explorer: what every part reads, and the parts. Each part has a file with its state and
/// what can be asked of it; what keys do with it is in `update`.
#[derive(Clone, Debug)]
pub struct App {
    /// The scene with the current values of the knobs.
    pub scene: CheckedScene,
    /// Everything derived from `scene`.
    pub machine: Machine,
    /// The effect of the last key.
    pub status: Option<String>,
    /// The knobs, and what can be undone.
    pub knobs: Knobs,
    /// Playing, and the page of time.
    pub play: Play,
    /// The run, and its forecasts.
    pub run: Run,
    /// The charts on the screen.
    pub layout: Layout,
    /// The cursor: instant that is shown, and place that is read in the large chart.
    pub reading: Reading,
    /// Axes and contact law of the map.
    pub map: MapChoice,
    /// The open dialogue, if one is.
    pub dialogue: Dialogue,
    /// The files, and the open scene.
    pub files: Files,
    /// The lessons.
    pub lessons: Lessons,
    /// The mouse.
    pub mouse: Mouse,
    /// Theme and marker.
    pub appearance: Appearance,
}

impl App {
    /// Creates the explorer on a checked scene.
    pub fn new(scene: CheckedScene, theme: Theme, marker: Marker) -> Self {
        let machine = scene.machine();
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
            appearance: Appearance::new(theme, marker),
            machine,
            scene,
        }
    }

    /// Returns what the keyboard acts on, as the table of bindings names it.
    pub fn context(&self) -> Context {
        match self.dialogue.mode {
            InputMode::Main if self.reading.on => Context::Reading,
            InputMode::Main if self.is_asked() => Context::Question,
            InputMode::Main => Context::Main,
            InputMode::Typing(_) => Context::Typing,
            InputMode::Help(ref help) if help.filter.text().is_empty() && !help.searches => {
                Context::Help
            }
            InputMode::Help(_) => Context::Filter,
            InputMode::Palette(_) => Context::Palette,
            InputMode::Naming(..) => Context::Typing,
            InputMode::Replacing(..) => Context::Replacing,
            InputMode::Lessons(_) => Context::Lessons,
            InputMode::Scenes(_) => Context::Scenes,
        }
    }

    /// Returns the order for the engine.
    pub fn order(&self) -> Order {
        Order {
            scene: self.scene.clone(),
            restarts: self.run.restarts,
            changes: self.run.changes,
            steps: self.play.steps,
            goes: self.play.goes,
            go_to_s: self.play.go_to_s,
            jumps: self.play.jumps,
            pulses: self.run.pulses,
            playing: self.play.playing,
            extensions: self.play.extensions,
            rate: self.rate(),
            bin_s: self.page_s() / BINS_PER_PAGE,
            page: self.page(),
            compare: self.run.compare,
            slow_at_events: self.play.slow_at_events,
            cursor_s: self.reading.at_s,
            open: ViewId::all().filter(|view| self.is_open(*view)).collect(),
            map: self.map_choice(),
            cell: self.map_cell(),
            range: self.layout.range,
        }
    }

    /// Returns whether the large chart compares both contact laws, over the whole height.
    pub fn compares(&self) -> bool {
        self.run.compare && self.is_large(ViewId::Response)
    }

    /// Returns the motion that every panel shows: at the cursor, or as it plays.
    pub fn shown(&self) -> Option<&Moment> {
        let reading = self.results().reading.as_deref();
        let reading = reading.filter(|_| self.reading.at_s.is_some());
        reading.or(self.moment())
    }

    /// Same as [`Self::shown`], once it is computed for the instant that is asked for.
    pub fn shown_now(&self) -> Option<&Moment> {
        let step = self.scene.solver.step_s;
        self.shown().filter(|moment| (moment.state.t_s - self.now()).abs() <= step)
    }

    /// Returns the rotor speed at the instant that is shown \[rad/s\].
    pub fn speed(&self) -> f64 {
        let moment = self.shown();
        moment.map_or(self.scene.operation.speed_rad_s, |moment| moment.speed)
    }

    /// Returns why the motion stopped.
    pub fn failure(&self) -> Option<&String> {
        self.moment()?.failure.as_ref()
    }
}

/// Bins recorded per page: more than the sub-pixels of a wide screen.
const BINS_PER_PAGE: f64 = 1024.0;

#[cfg(test)]
pub mod tests {
    use super::*;

    /// Returns the paper's scene on a screen of 120 x 40, for the tests of the parts.
    pub fn on_screen() -> App {
        let scene = Scene::builtin("paper-nd3").unwrap().checked().unwrap();
        let mut app = App::new(scene, Theme::Mono, Marker::Braille);
        app.layout.size = (120, 40);
        app
    }
}
