//! An explorer on a test backend: keys in, text out. The test drives the engine,
//! so that a screen is the same on every machine.

use std::sync::mpsc;
use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::{Terminal, backend::TestBackend};
use rubscope::tui::events::ScreenEvent;
use rubscope::tui::{App, Exit, Marker, Theme, run};
use rubscope_solver::scene::Scene;

use crate::stepwise::{NoHost, Stepwise};

/// An explorer, its screen and its engine.
pub struct Session {
    pub terminal: Terminal<TestBackend>,
    pub app: App,
    pub engine: Stepwise,
}

/// The paper's scene with a coarser step and a shorter run, for speed.
pub fn scene() -> Scene {
    let mut scene = Scene::builtin("paper-nd3").unwrap();
    scene.solver.step_s = 2e-7;
    scene.solver.end_s = 0.02;
    scene
}

/// The key of a letter; arrows stand for the arrow keys.
fn code(letter: char) -> KeyCode {
    match letter {
        '\n' => KeyCode::Enter,
        '\t' => KeyCode::Tab,
        '\u{1b}' => KeyCode::Esc,
        '\u{8}' => KeyCode::Backspace,
        '←' => KeyCode::Left,
        '→' => KeyCode::Right,
        '↑' => KeyCode::Up,
        '↓' => KeyCode::Down,
        '⇟' => KeyCode::PageDown,
        '⇞' => KeyCode::PageUp,
        '⇱' => KeyCode::Home,
        '⇲' => KeyCode::End,
        '⌦' => KeyCode::Delete,
        letter => KeyCode::Char(letter),
    }
}

/// The event of a letter's key.
pub fn key(letter: char) -> ScreenEvent {
    ScreenEvent::Key(KeyEvent::new(code(letter), KeyModifiers::NONE))
}

impl Session {
    /// With 3 ms of motion at each look of the engine.
    pub fn open(width: u16, height: u16, scene: Scene, theme: Theme, marker: Marker) -> Self {
        Self::with_stride((width, height), 3e-3, scene, theme, marker)
    }

    /// The same, with all that the margins search, and checked for tiny changes.
    pub fn searched(width: u16, height: u16, scene: Scene, theme: Theme, marker: Marker) -> Self {
        let mut engine = Stepwise::new(3e-3);
        (engine.extent.searches_changes, engine.checks) = (true, true);
        Self::with_engine((width, height), engine, scene, theme, marker)
    }

    pub fn with_stride(
        size: (u16, u16),
        stride: f64,
        scene: Scene,
        theme: Theme,
        marker: Marker,
    ) -> Self {
        Self::with_engine(size, Stepwise::new(stride), scene, theme, marker)
    }

    pub fn with_engine(
        (width, height): (u16, u16),
        engine: Stepwise,
        scene: Scene,
        theme: Theme,
        marker: Marker,
    ) -> Self {
        let terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        let app = App::new(scene.checked().unwrap(), theme, marker);
        let mut session = Self { terminal, app, engine };
        session.press("");
        session
    }

    /// Presses keys, one a letter; two frames later the screen is looked at.
    pub fn press(&mut self, keys: &str) -> Exit {
        self.send(keys.chars().map(key))
    }

    /// Presses keys one by one; after each, the screen is drawn.
    pub fn press_each(&mut self, keys: &str) {
        for key in keys.chars() {
            self.press(key.encode_utf8(&mut [0; 4]));
        }
        self.press("");
    }

    /// Sends events in one go.
    pub fn send(&mut self, all: impl Iterator<Item = ScreenEvent>) -> Exit {
        let (sender, events) = mpsc::channel();
        all.for_each(|event| sender.send(event).unwrap());
        drop(sender);
        let (app, engine) = (&mut self.app, &mut self.engine);
        run(&mut self.terminal, &events, app, engine, &mut NoHost, Duration::ZERO).unwrap()
    }

    /// Gives the screen another size.
    pub fn resize(&mut self, (width, height): (u16, u16)) {
        self.terminal.backend_mut().resize(width, height);
        self.send(std::iter::once(ScreenEvent::Resize));
    }

    /// The place of the first letter of a text on the screen.
    pub fn find(&self, text: &str) -> (u16, u16) {
        let rows = self.rows();
        let row = rows.iter().position(|row| row.contains(text)).unwrap();
        let column = rows[row][..rows[row].find(text).unwrap()].chars().count();
        (column as u16, row as u16)
    }

    /// Selects the knob of a key, wherever it stands.
    pub fn select(&mut self, path: &str) {
        select(&mut self.app, path);
    }

    /// The rows of the screen, over their whole width.
    pub fn rows(&self) -> Vec<String> {
        let buffer = self.terminal.backend().buffer();
        let row = |row: &[ratatui::buffer::Cell]| row.iter().map(|cell| cell.symbol()).collect();
        buffer.content.chunks(usize::from(buffer.area.width)).map(row).collect()
    }

    /// The rows of the screen without the space at their ends.
    pub fn text(&self) -> String {
        self.rows().iter().map(|row| row.trim_end().to_string() + "\n").collect()
    }
}

/// Selects the knob of a key.
pub fn select(app: &mut App, path: &str) {
    for _ in 0..100 {
        app.knobs.walk(false);
        if app.selected().unwrap().path == path {
            return;
        }
    }
    panic!("{path} is no knob");
}
