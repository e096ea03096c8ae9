//! The loop of the drawing thread. Backend, events, engine and host are given
//! to it, so that whole screens can be tested without a terminal.

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use ratatui::{Terminal, backend::Backend};

use super::app::{App, Effect, Exit};
use super::engine::{Engine, Order};
use super::events::ScreenEvent;
use super::panels;
use super::terminal::Host;

/// Draw at least this often, to detect a closed terminal by its error.
const HEARTBEAT: Duration = Duration::from_secs(1);
/// Least time between two answers to keys.
const KEY_FRAME: Duration = Duration::from_millis(16);

/// When the screen must be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Due {
    /// Nothing has changed.
    Later,
    /// New motion: at the frame rate.
    Frame,
    /// A key or another size: at once.
    Now,
}

impl Due {
    /// Least time between two frames.
    fn pause(self, frame: Duration) -> Duration {
        match self {
            Self::Later => HEARTBEAT,
            Self::Frame => frame,
            Self::Now => KEY_FRAME,
        }
    }
}

/// Runs the explorer until the user quits. Draws only when something changed.
///
/// # Errors
/// The terminal cannot be written to.
pub fn run<B: Backend>(
    terminal: &mut Terminal<B>,
    events: &Receiver<ScreenEvent>,
    app: &mut App,
    engine: &mut dyn Engine,
    host: &mut dyn Host,
    frame: Duration,
) -> Result<Exit, B::Error> {
    let mut ordered: Option<Order> = None;
    let mut due = Due::Now;
    let mut drawn: Option<Instant> = None;
    loop {
        order(app, engine, &mut ordered);
        let wait = drawn.map_or(Duration::ZERO, |at| due.pause(frame).saturating_sub(at.elapsed()));
        let mut next = match events.recv_timeout(wait) {
            Ok(event) => Some(event),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => {
                show(terminal, app, engine)?;
                return Ok(Exit::Done);
            }
        };
        while let Some(event) = next {
            match handle(&event, app, host) {
                Reaction::Exit(exit) => return Ok(exit),
                Reaction::Draw(soon) => due = due.max(soon),
                Reaction::Redraw => {
                    // `Terminal::clear` would ask for the cursor and wait for the input thread.
                    let size = terminal.size()?;
                    terminal.resize(size.into())?;
                    due = Due::Now;
                }
            }
            // After many key presses only the last state is computed.
            next = events.try_recv().ok();
        }
        order(app, engine, &mut ordered);
        if drawn.is_none_or(|at| at.elapsed() >= due.pause(frame)) {
            show(terminal, app, engine)?;
            drawn = Some(Instant::now());
            due = Due::Later;
        }
    }
}

fn order(app: &App, engine: &mut dyn Engine, ordered: &mut Option<Order>) {
    let order = app.order();
    if ordered.as_ref() != Some(&order) {
        engine.order(&order);
        *ordered = Some(order);
    }
}

fn show<B: Backend>(
    terminal: &mut Terminal<B>,
    app: &mut App,
    engine: &mut dyn Engine,
) -> Result<(), B::Error> {
    if let Some(snapshot) = engine.take() {
        app.apply_snapshot(snapshot);
    }
    let size = terminal.size()?;
    app.size = (size.width, size.height);
    terminal.draw(|frame| panels::draw(frame, app)).map(|_| ())
}

/// What the loop must do for an event.
enum Reaction {
    Exit(Exit),
    Draw(Due),
    Redraw,
}

fn handle(event: &ScreenEvent, app: &mut App, host: &mut dyn Host) -> Reaction {
    match event {
        ScreenEvent::Key(key) => match app.key(key) {
            Effect::None => Reaction::Draw(Due::Now),
            Effect::Quit => Reaction::Exit(Exit::Done),
            Effect::Suspend => resumed(host.suspend()),
            Effect::Redraw => Reaction::Redraw,
            Effect::Copy(text) => {
                // The status line also shows it, in case the terminal refuses it.
                let _ = host.copy(&text);
                Reaction::Draw(Due::Now)
            }
        },
        ScreenEvent::Resize => Reaction::Draw(Due::Now),
        ScreenEvent::Fresh => Reaction::Draw(Due::Frame),
        ScreenEvent::Signal(number) => Reaction::Exit(Exit::Signal(*number)),
        ScreenEvent::Suspend => resumed(host.suspend()),
        ScreenEvent::Continued => resumed(host.resume()),
        ScreenEvent::InputClosed => Reaction::Exit(Exit::Signal(HANGUP)),
    }
}

fn resumed(result: std::io::Result<()>) -> Reaction {
    if result.is_ok() { Reaction::Redraw } else { Reaction::Exit(Exit::Signal(HANGUP)) }
}

/// SIGHUP: the terminal is closed.
pub(super) const HANGUP: u8 = 1;
