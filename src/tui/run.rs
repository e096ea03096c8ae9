//! The loop of the drawing thread. Backend, events, engine and host are given
//! to it, so that whole screens can be tested without a terminal.

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use ratatui::{Terminal, backend::Backend};

use super::app::{App, Effect, Exit};
use super::engine::{Engine, Order};
use super::events::Event;
use super::panels;
use super::terminal::Host;

/// Draw at least this often: a terminal that is gone shows as an error.
const HEARTBEAT: Duration = Duration::from_secs(1);
/// Keys are answered at once, but not more often than this.
const KEY_FRAME: Duration = Duration::from_millis(16);

/// How soon the screen must be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Due {
    /// Nothing has changed.
    Later,
    /// New motion: at the frame rate.
    Frame,
    /// A key or another size: at once.
    Now,
}

/// Runs the explorer until it is left. Draws only when something changed.
///
/// # Errors
/// The terminal cannot be written to.
pub fn run<B: Backend>(
    terminal: &mut Terminal<B>,
    events: &Receiver<Event>,
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
        let pause = match due {
            Due::Later => HEARTBEAT,
            Due::Frame => frame,
            Due::Now => KEY_FRAME,
        };
        let wait = drawn.map_or(Duration::ZERO, |at| pause.saturating_sub(at.elapsed()));
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
                Heard::Exit(exit) => return Ok(exit),
                Heard::Draw(soon) => due = due.max(soon),
                Heard::Anew => {
                    // `Terminal::clear` would ask for the cursor and wait for the input thread.
                    let size = terminal.size()?;
                    terminal.resize(size.into())?;
                    due = Due::Now;
                }
            }
            // The last of twenty turns is computed, not all of them.
            next = events.try_recv().ok();
        }
        order(app, engine, &mut ordered);
        let pause = if due == Due::Now {
            KEY_FRAME
        } else if due == Due::Frame {
            frame
        } else {
            HEARTBEAT
        };
        if drawn.is_none_or(|at| at.elapsed() >= pause) {
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

/// What an event asks of the loop.
enum Heard {
    Exit(Exit),
    Draw(Due),
    Anew,
}

fn handle(event: &Event, app: &mut App, host: &mut dyn Host) -> Heard {
    match event {
        Event::Key(key) => match app.key(key) {
            Effect::None => Heard::Draw(Due::Now),
            Effect::Quit => Heard::Exit(Exit::Done),
            Effect::Suspend => resumed(host.suspend()),
            Effect::Redraw => Heard::Anew,
            Effect::Copy(text) => {
                // A terminal that cannot take it still shows it.
                let _ = host.copy(&text);
                Heard::Draw(Due::Now)
            }
        },
        Event::Resize => Heard::Draw(Due::Now),
        Event::Fresh => Heard::Draw(Due::Frame),
        Event::Signal(number) => Heard::Exit(Exit::Signal(*number)),
        Event::Suspend => resumed(host.suspend()),
        Event::Continued => resumed(host.resume()),
        Event::InputClosed => Heard::Exit(Exit::Signal(HANGUP)),
    }
}

fn resumed(result: std::io::Result<()>) -> Heard {
    if result.is_ok() { Heard::Anew } else { Heard::Exit(Exit::Signal(HANGUP)) }
}

/// SIGHUP: the terminal is gone.
pub(super) const HANGUP: u8 = 1;
