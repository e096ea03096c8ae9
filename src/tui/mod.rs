//! The explorer: a live screen of one motion. The state (`app`) knows no
//! terminal; `panels` and `views` draw it; the solver runs in its own thread
//! (`worker`). Tables: `views`, `knobs`, `lessons`, `bindings`.

mod ability;
mod app;
mod appearance;
mod axis;
mod backend;
#[doc(hidden)]
pub mod bindings;
#[doc(hidden)]
pub mod engine;
#[doc(hidden)]
pub mod events;
mod export;
#[doc(hidden)]
pub mod files;
mod glossary;
#[doc(hidden)]
pub mod history;
mod host;
#[cfg_attr(not(unix), path = "job_other.rs")]
mod job;
mod knobs;
#[doc(hidden)]
pub mod lessons;
mod panels;
mod plot;
mod raster;
mod run;
#[doc(hidden)]
pub mod terminal;
mod text;
mod theme;
#[cfg_attr(not(unix), path = "tty_other.rs")]
mod tty;
mod views;
#[doc(hidden)]
pub mod worker;

use std::fs::File;
use std::io::IsTerminal;
use std::sync::{Arc, mpsc};
use std::time::Duration;

pub use app::{App, Exit, Source};
pub use raster::Marker;
pub use run::run;
pub use theme::Theme;

use strum::{EnumString, VariantNames};

use crate::scene::CheckedScene;

/// When to use colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, EnumString, VariantNames)]
#[strum(serialize_all = "lowercase")]
pub enum Color {
    /// If the terminal supports it and `NO_COLOR` does not forbid it.
    #[default]
    Auto,
    /// Always.
    Always,
    /// Never; bold, reverse and dim stay.
    Never,
}

/// How the explorer looks.
#[derive(Clone, Debug, PartialEq)]
pub struct ExploreOptions {
    /// Most frames a second while the motion plays.
    pub fps: f64,
    /// When to use colour.
    pub color: Color,
    /// How points are drawn; by the terminal and the locale if not given.
    pub marker: Option<Marker>,
    /// Where the scene is from, for the command line that repeats the run.
    pub source: Option<Source>,
}

impl Default for ExploreOptions {
    fn default() -> Self {
        Self { fps: 10.0, color: Color::Auto, marker: None, source: None }
    }
}

impl ExploreOptions {
    fn theme(&self) -> Theme {
        let variable = |name| std::env::var(name).unwrap_or_default();
        let plain = match self.color {
            Color::Always => false,
            Color::Never => true,
            Color::Auto => !variable("NO_COLOR").is_empty() || variable("TERM") == "dumb",
        };
        if plain { Theme::Mono } else { Theme::Dark }
    }

    fn frame(&self) -> Duration {
        let fps = if self.fps.is_finite() { self.fps.clamp(0.1, 60.0) } else { 10.0 };
        Duration::from_secs_f64(1.0 / fps)
    }
}

/// Whether there are a screen and a keyboard.
///
/// # Errors
/// What is missing.
pub fn check_terminal() -> Result<(), &'static str> {
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    if dumb || !std::io::stdout().is_terminal() {
        return Err(
            "the explorer needs a terminal on standard output; without one, use `rubscope run`",
        );
    }
    if !std::io::stdin().is_terminal() && cfg!(unix) && File::open("/dev/tty").is_err() {
        return Err("the explorer needs a keyboard, and standard input is no terminal");
    }
    Ok(())
}

/// Runs the explorer on a checked scene until the user quits, where
/// `check_terminal` found nothing missing. The result is the exit status: 0, or
/// 128 + n after signal n.
///
/// # Errors
/// Threads or signals cannot be set up, or a file was still being written at the
/// end.
pub fn explore(scene: CheckedScene, options: ExploreOptions) -> anyhow::Result<u8> {
    // With `NO_COLOR`, crossterm would drop bold and reverse too; the mono
    // theme has no colours anyway.
    crossterm::style::force_color_output(true);
    terminal::install_panic_hook();
    let (sender, events) = mpsc::channel();
    events::watch_signals(sender.clone())?;
    let fresh = sender.clone();
    // Without a receiver the program is about to end.
    let wake: engine::Waker = Arc::new(move || _ = fresh.send(events::ScreenEvent::Fresh));
    let mut worker = worker::Worker::spawn(wake)?;
    let marker = options.marker.unwrap_or_else(ability::marker);
    let mut app = App::new(scene, options.theme(), marker);
    app.source.clone_from(&options.source);
    let guard = terminal::Guard;
    let ended = terminal::open().and_then(|mut screen| {
        events::read_keys(sender.clone())?;
        let mut shell = terminal::Shell { events: sender };
        let ended = run(&mut screen, &events, &mut app, &mut worker, &mut shell, options.frame());
        // Dropping the screen would write to standard error if the terminal is gone.
        std::mem::forget(screen);
        ended
    });
    drop(guard);
    if app.writing.is_some() {
        files::tidy_up();
    }
    match (terminal::ended_by(), ended) {
        (Some(signal), _) | (None, Ok(Exit::Signal(signal))) => Ok(128 + signal),
        (None, Ok(Exit::Done)) => match app.writing {
            Some(writing) => anyhow::bail!("gave up writing {}: no answer", writing.name),
            None => Ok(0),
        },
        // The terminal was there and is gone: nobody is left to read a message.
        (None, Err(_)) => Ok(128 + run::HANGUP),
    }
}
