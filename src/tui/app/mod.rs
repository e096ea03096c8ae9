//! The state of the explorer, without a terminal, and its parts. The screen is a function of this
//! state; only commands and snapshots of the engine change it. `model` has its types; each of the
//! other files has a part of it: what changes the part, and how it is drawn.

mod command_line;
mod dialogue;
pub mod files;
mod glossary;
pub mod help;
pub mod knobs;
pub mod layout;
pub mod lesson;
mod model;
mod mouse;
pub mod palette;
pub mod play;
pub mod reading;
mod run;
mod verdict;
pub mod words;

pub use model::{App, Cursor, InputMode, Parts, Source, Writing};

#[cfg(test)]
pub mod tests {
    use super::App;
    use crate::tui::raster::Marker;
    use crate::tui::theme::Theme;
    use rubscope_solver::scene::Scene;

    /// Creates the paper's scene on a screen of 120 x 40.
    pub fn on_screen() -> App {
        let scene = Scene::builtin("paper-nd3").unwrap().checked().unwrap();
        let mut app = App::new(scene, Theme::Mono, Marker::Braille);
        app.layout.size = (120, 40);
        app
    }
}
