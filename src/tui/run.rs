//! The event loop of the drawing thread. It receives backend, events, engine and host as arguments,
//! so that tests can draw whole screens without a terminal.

use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use ratatui::{Terminal, backend::Backend};

use super::app::App;
use super::app::layout::{LEAST_HEIGHT, LEAST_WIDTH};
use super::command::chord::Chord;
use super::command::table::lookup;
use super::command::{Command, Effect};
use super::engine::{Engine, Order};
use super::events::ScreenEvent;
use super::files::FileResult;
use super::host::Host;
use super::line::Throttle;
use super::{panels, terminal};

/// How the explorer ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The user quit, or the input ended.
    Done,
    /// The process received this signal.
    Signal(u8),
}

/// Longest time between two frames. Only by drawing does the program notice that the terminal is
/// gone.
const HEARTBEAT: Duration = Duration::from_secs(1);
/// Shortest time between two frames that answer keys.
const KEY_FRAME: Duration = Duration::from_millis(16);

/// Longest delay of a frame after a knob was turned. Most forecasts arrive within it, so that one
/// frame shows both the knob and its verdict.
const ANSWER: Duration = Duration::from_millis(15);

/// Longest time that quitting waits for a file to be written.
const LAST_FILE: Duration = Duration::from_secs(1);

/// Number of waiting events above which a Ctrl-C discards the input before it. Nobody types that
/// far ahead, and fewer are handled within a fraction of a second.
const MOST_AHEAD: usize = 1000;

/// Queue of the events that have arrived but are not handled yet.
struct Events<'a> {
    from: &'a Receiver<ScreenEvent>,
    waiting: VecDeque<ScreenEvent>,
}

impl Events<'_> {
    /// Returns the next event without waiting; `None` if none has arrived. A Ctrl-C behind more
    /// than [`MOST_AHEAD`] events discards the input before it.
    fn next(&mut self) -> Option<ScreenEvent> {
        // Bounded, because events may arrive as fast as they are received.
        for event in self.from.try_iter().take(100 * MOST_AHEAD) {
            if event.is_interrupt() && self.waiting.len() > MOST_AHEAD {
                self.waiting.retain(|event| !event.is_input());
            }
            self.waiting.push_back(event);
        }
        self.waiting.pop_front()
    }

    /// Removes the events at the front that equal `event`; returns their number.
    fn repeats(&mut self, event: &ScreenEvent) -> usize {
        let same = self.waiting.iter().take_while(|other| *other == event).count();
        self.waiting.drain(..same).count()
    }

    /// Returns the next event; waits up to `wait` for one.
    fn within(&mut self, wait: Duration) -> Result<ScreenEvent, RecvTimeoutError> {
        self.next().map_or_else(|| self.from.recv_timeout(wait), Ok)
    }
}

/// Urgency of the next frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Due {
    /// Nothing has changed: draw at the heartbeat.
    Later,
    /// The motion has advanced: draw at the frame rate.
    Frame,
    /// A key was pressed or the screen has a new size: draw at once.
    Now,
}

impl Due {
    /// Returns the shortest time between the last frame and the next one; `frame` is that between
    /// two frames of the playing motion.
    fn pause(self, frame: Duration) -> Duration {
        match self {
            Self::Later => HEARTBEAT,
            Self::Frame => frame,
            Self::Now => KEY_FRAME,
        }
    }
}

/// Runs the explorer until the user quits. Frames are drawn only when something has changed, and at
/// the heartbeat.
///
/// # Errors
/// Fails if the terminal cannot be written to.
pub fn run<B: Backend>(
    screen: &mut Terminal<B>,
    events: &Receiver<ScreenEvent>,
    app: &mut App,
    engine: &mut dyn Engine,
    host: &mut dyn Host,
    frame: Duration,
) -> Result<Exit, B::Error> {
    let mut events = Events { from: events, waiting: VecDeque::new() };
    let mut ordered: Option<Order> = None;
    let mut due = Due::Now;
    let mut drawn: Option<Instant> = None;
    let mut again = false;
    let mut answer: Option<Instant> = None;
    // What is computed depends on what is shown.
    app.layout.size = screen.size()?.into();
    let mut throttle = Throttle::new(host.line(), Instant::now(), terminal::sent());
    loop {
        order(app, engine, &mut ordered);
        let wait = drawn.map_or(Duration::ZERO, |at| due.pause(frame).saturating_sub(at.elapsed()));
        let wait = wait.max(throttle.wait(due == Due::Now, Instant::now()));
        let wait = wait.max(until(answer));
        let mut next = match events.within(wait) {
            Ok(event) => Some(event),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => {
                show(screen, app, engine, host)?;
                return Ok(Exit::Done);
            }
        };
        while let Some(event) = next {
            if let ScreenEvent::Key(key) = &event
                && let Some(Command::Turn { .. }) = lookup(app.keyboard(), Chord::of(key))
            {
                app.knobs.again = events.repeats(&event);
            }
            match handle(event, app, host) {
                Reaction::Exit(exit) => return Ok(exit),
                Reaction::Quit => return Ok(last_file(&mut events, app, host)),
                Reaction::Draw(soon) => due = due.max(soon),
                Reaction::Look => due = due.max(look(app, engine)),
                Reaction::Redraw => (again, due) = (true, Due::Now),
            }
            // Handle all waiting keys before the next order: only the final state is computed.
            next = events.next();
        }
        if order(app, engine, &mut ordered) {
            // Keep an earlier deadline: a held key must not delay the frame for ever.
            answer = answer.or(Some(Instant::now() + ANSWER));
        }
        if app.verdict().is_some() {
            answer = None;
        }
        let free = throttle.wait(due == Due::Now, Instant::now()).is_zero();
        if free
            && until(answer).is_zero()
            && drawn.is_none_or(|at| at.elapsed() >= due.pause(frame))
        {
            if std::mem::take(&mut again) {
                // `Terminal::clear` would ask for the cursor position, and its answer would wait
                // for the input thread.
                let size = screen.size()?;
                screen.resize(size.into())?;
            }
            show(screen, app, engine, host)?;
            answer = None;
            let now = Instant::now();
            throttle.spend(terminal::sent(), due == Due::Now, terminal::is_slow(), now);
            drawn = Some(now);
            again = terminal::take_torn();
            due = if again { Due::Now } else { Due::Later };
        }
    }
}

fn until(instant: Option<Instant>) -> Duration {
    instant.map_or(Duration::ZERO, |at| at.saturating_duration_since(Instant::now()))
}

/// Sends the order to the engine if it has changed; returns whether its film is new.
fn order(app: &App, engine: &mut dyn Engine, ordered: &mut Option<Order>) -> bool {
    let order = app.order();
    let other = ordered.as_ref().is_none_or(|before| before.number != order.number);
    if ordered.as_ref() != Some(&order) {
        engine.order(&order);
        *ordered = Some(order);
    }
    other
}

/// Applies the latest snapshot. A new verdict is drawn at once, because while a key is held the
/// next turn of the knob would replace it before the next regular frame.
fn look(app: &mut App, engine: &mut dyn Engine) -> Due {
    let known = app.verdict().is_some();
    if let Some(snapshot) = engine.take() {
        app.apply_snapshot(snapshot);
    }
    if !known && app.verdict().is_some() { Due::Now } else { Due::Frame }
}

fn show<B: Backend>(
    screen: &mut Terminal<B>,
    app: &mut App,
    engine: &mut dyn Engine,
    host: &mut dyn Host,
) -> Result<(), B::Error> {
    look(app, engine);
    let size = screen.size()?;
    app.layout.size = (size.width, size.height);
    terminal::set_typing(lookup(app.keyboard(), Chord::from('q')).is_none());
    screen.draw(|frame| panels::draw(frame, app))?;
    engine.drawn();
    // A screen that is too small shows only a note about its size, and no message.
    if size.width >= LEAST_WIDTH && size.height >= LEAST_HEIGHT {
        // Keys may now answer an open question.
        app.dialogue.unseen = false;
        host.unseen(None);
    }
    Ok(())
}

/// What the loop does after an event.
enum Reaction {
    Exit(Exit),
    /// Exit once the file being written is complete.
    Quit,
    Draw(Due),
    Redraw,
    /// Apply the latest snapshot of the engine.
    Look,
}

fn handle(event: ScreenEvent, app: &mut App, host: &mut dyn Host) -> Reaction {
    match event {
        ScreenEvent::Key(key) => {
            let effect = app.key(&key);
            return take(effect, app, host);
        }
        ScreenEvent::Mouse(event) => {
            let effect = app.mouse(&event);
            return effect.map_or(Reaction::Draw(Due::Later), |effect| take(effect, app, host));
        }
        ScreenEvent::Fresh => return Reaction::Look,
        ScreenEvent::Signal(number) => return Reaction::Exit(Exit::Signal(number)),
        ScreenEvent::InputClosed => return Reaction::Exit(Exit::Signal(HANGUP)),
        ScreenEvent::Suspend => return suspended(app, host.suspend(false)),
        ScreenEvent::Continued => return resumed(host.resume()),
        ScreenEvent::Resize => {}
        ScreenEvent::Ground(ground) => app.appearance.use_ground(ground),
        ScreenEvent::Pasted(text) => app.paste(&text),
        ScreenEvent::Written(result) => written(result, app, host),
        ScreenEvent::Scenes(found) => app.scenes_found(found),
    }
    Reaction::Draw(Due::Now)
}

/// Carries out the effect of a key or a click on the host.
fn take(effect: Effect, app: &mut App, host: &mut dyn Host) -> Reaction {
    let answer = match effect {
        Effect::Quit => return Reaction::Quit,
        Effect::Suspend => return suspended(app, host.suspend(true)),
        Effect::Redraw => return Reaction::Redraw,
        Effect::None => None,
        Effect::Mouse(on) => {
            // If the terminal is gone, the next frame fails and ends the program.
            let _ = terminal::set_mouse(on);
            None
        }
        Effect::Copy(text) => {
            // If the terminal refuses OSC 52, the text can still be copied from the status line.
            let _ = host.copy(&text);
            None
        }
        Effect::Write(job) => host.write(job),
        Effect::FindScenes(directory) => host.find_scenes(directory),
    };
    answer.map_or(Reaction::Draw(Due::Now), |answer| handle(answer, app, host))
}

/// Handles the result of a write. If no frame shows an error, it is printed on exit.
fn written(result: FileResult, app: &mut App, host: &mut dyn Host) {
    let name = app.files.writing.as_ref().map_or("the file", |writing| &writing.name);
    match &result {
        FileResult::Written => {}
        FileResult::Exists => host.unseen(Some(format!("cannot write {name}: it exists"))),
        FileResult::Failed(reason) => host.unseen(Some(format!("cannot write {name}: {reason}"))),
    }
    app.written(result);
}

/// Waits up to [`LAST_FILE`] for the file being written.
fn last_file(events: &mut Events, app: &mut App, host: &mut dyn Host) -> Exit {
    let began = Instant::now();
    while app.files.writing.is_some() {
        match events.within(LAST_FILE.saturating_sub(began.elapsed())) {
            // Input after the quit key is ignored.
            Ok(event) if event.is_input() => {}
            Ok(other) => {
                if let Reaction::Exit(exit) = handle(other, app, host) {
                    return exit;
                }
            }
            Err(_) => break,
        }
    }
    Exit::Done
}

fn suspended(app: &mut App, result: std::io::Result<bool>) -> Reaction {
    if let Ok(false) = result {
        app.status = Some("not suspended: there is no shell to continue it".into());
    }
    resumed(result.map(|_| ()))
}

fn resumed(result: std::io::Result<()>) -> Reaction {
    if result.is_ok() { Reaction::Redraw } else { Reaction::Exit(Exit::Signal(HANGUP)) }
}

/// Signal number of SIGHUP: the terminal was closed.
pub(super) const HANGUP: u8 = 1;
