//! What the keyboard acts on.

use super::{HelpState, PaletteState};

/// What the keyboard acts on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum InputMode {
    /// Knobs and charts.
    Main,
    /// The value of the selected knob is being typed.
    Typing(String),
    /// The help is open.
    Help(HelpState),
    /// A command is being looked for.
    Palette(PaletteState),
    /// The end of a sweep of the selected knob is being typed.
    Sweeping(String),
    /// A file name is being typed.
    Naming(Purpose, String),
    /// A question: replace the existing file?
    Replacing(Purpose, String),
    /// A lesson is being chosen.
    Lessons(usize),
    /// A scene is being chosen: its place in the list, or the open one.
    Scenes(Option<usize>),
}

/// The purpose of a file name that is typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The scene as a TOML file.
    Save,
    /// The large chart's data as CSV, or the screen as SVG.
    Export,
}
