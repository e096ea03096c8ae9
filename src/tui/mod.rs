//! The explorer: a live screen of one motion. Its state (`app`) knows no terminal; `panels` and
//! `views` draw it; the solver runs in a thread of its own (`worker`). Its tables are in `views`,
//! `knobs`, `lessons` and `command`. Start reading at `app` and `run`.

mod ability;
mod app;
mod appearance;
mod axis;
#[doc(hidden)]
pub mod command;
mod config;
mod encode;
mod ending;
#[doc(hidden)]
pub mod engine;
#[doc(hidden)]
pub mod events;
pub mod export;
mod field;
#[doc(hidden)]
pub mod files;
mod film;
mod ground;
#[doc(hidden)]
pub mod history;
#[doc(hidden)]
pub mod host;
mod input;
mod job;
mod knobs;
#[doc(hidden)]
pub mod lessons;
mod line;
mod lines;
mod options;
mod panels;
mod plot;
mod raster;
mod run;
#[doc(hidden)]
pub mod terminal;
mod text;
mod theme;
#[doc(hidden)]
pub mod trace;
mod tty;
mod update;
mod views;
#[doc(hidden)]
pub mod worker;

use std::fs::File;
use std::io::{IsTerminal, Write};
use std::sync::{Arc, mpsc};

pub use app::{App, Source};
pub use command::Effect;
pub use line::Line;
pub use lines::lines;
pub use options::{Color, ExploreOptions};
pub use raster::Marker;
pub use run::{Exit, run};
pub use theme::{Theme, ThemeChoice};

use crate::sheet::line::clean;
use anyhow::Context;
use rubscope_solver::scene::CheckedScene;

/// Returns whether standard output is a terminal that cannot move the cursor (`TERM=dumb`).
pub fn is_dumb_terminal() -> bool {
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    dumb && std::io::stdout().is_terminal()
}

/// Checks that standard output is a terminal and that a keyboard can be read.
///
/// # Errors
/// The message says which of the two is missing.
pub fn check_terminal() -> Result<(), &'static str> {
    if !std::io::stdout().is_terminal() {
        return Err("the explorer needs a terminal on standard output; without one, use \
                    `rubscope run`, or `rubscope --lines`");
    }
    if !std::io::stdin().is_terminal() && File::open("/dev/tty").is_err() {
        return Err("the explorer needs a keyboard, and standard input is no terminal");
    }
    Ok(())
}

/// Runs the explorer on a checked scene until the user quits; call [`check_terminal`] first.
/// Returns the exit status: 0, or 128 + n after signal n.
///
/// # Errors
/// Fails if threads or signals cannot be set up, or the last file was not written.
pub fn explore(scene: CheckedScene, options: ExploreOptions) -> anyhow::Result<u8> {
    // Otherwise crossterm would drop bold and reverse too if `NO_COLOR` is set. The mono theme has
    // no colours anyway.
    crossterm::style::force_color_output(true);
    terminal::install_panic_hook(&[worker::WORKER_NAME, files::FILES_NAME]);
    let (sender, events) = mpsc::channel();
    events::watch_signals(sender.clone())?;
    let fresh = sender.clone();
    // Sending fails only if the loop has ended; then nobody needs the snapshot.
    let wake: engine::Waker = Arc::new(move || _ = fresh.send(events::ScreenEvent::Fresh));
    let mut worker = worker::Worker::spawn(wake)?;
    let variable = |name: &str| std::env::var(name).unwrap_or_default();
    let mut memory = config::Memory::recall(options.config);
    let choice = options.theme(&memory.config, &variable);
    let ground = ground::Ground::named(&variable("COLORFGBG"));
    let term = variable("TERM");
    let is_plain = ability::is_plain(&term);
    let is_asked = choice.follows_ground() && ground.is_none() && !is_plain && !term.is_empty();
    let theme = choice.theme(ground.unwrap_or_default());
    let mut app =
        App::new(scene, theme, options.marker(&memory.config, ability::only_ascii(&variable)));
    app.appearance.follows_ground = choice.follows_ground();
    app.files.source.clone_from(&options.source);
    app.mouse.on = options.mouse;
    app.appearance.rpm |= options.rpm;
    memory.prepare(&mut app);
    terminal::set_mouse(app.mouse.on)?;
    terminal::set_whole_frames(!is_plain);
    let guard = terminal::Guard;
    let line = options.line(&variable);
    let mut shell = host::Shell { events: sender, unseen: None, line };
    let ended = terminal::open().and_then(|mut screen| {
        input::read_keys(shell.events.clone())?;
        if is_asked {
            // Do not wait for the answer; until it arrives the background is assumed dark.
            terminal::write(ground::QUESTION)?;
        }
        let ended = run(&mut screen, &events, &mut app, &mut worker, &mut shell, options.frame());
        // Dropping it would print an error if the terminal is gone.
        std::mem::forget(screen);
        ended
    });
    drop(guard);
    if let Some(why) = memory.keep(&app, ending::PATIENCE) {
        // Writing fails only if the terminal is gone; then nobody can read it.
        let _ = writeln!(std::io::stderr(), "rubscope: {}", clean(&why));
    }
    match (ending::ended_by(), ended) {
        (Some(signal), _) | (None, Ok(Exit::Signal(signal))) => Ok(128 + signal),
        (None, Ok(Exit::Done)) => match (app.files.writing, shell.unseen) {
            (Some(writing), _) => anyhow::bail!("gave up writing {}: no answer", writing.name),
            (None, Some(reason)) => anyhow::bail!(reason),
            (None, None) => Ok(0),
        },
        (None, Err(error)) if terminal::is_gone(&error) => Ok(128 + run::HANGUP),
        (None, Err(error)) => Err(error).context("cannot use the terminal"),
    }
}
