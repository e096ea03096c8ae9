//! The loop of the drawing thread. Backend, events, engine and host are given
//! to it, so that whole screens can be tested without a terminal.

use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use ratatui::{Terminal, backend::Backend};

use super::app::{App, Exit};
use super::engine::{Engine, Order};
use super::events::ScreenEvent;
use super::files::FileResult;
use super::host::Host;
use super::line::Throttle;
use super::panels::{self, LEAST_HEIGHT, LEAST_WIDTH};
use super::update::Effect;

/// Draw at least this often, to detect a closed terminal by its error.
const HEARTBEAT: Duration = Duration::from_secs(1);
/// Least time between two answers to keys.
const KEY_FRAME: Duration = Duration::from_millis(16);

/// Longest wait of a frame for the forecast of a knob that was turned: most are
/// there sooner, and then one frame shows both.
const ANSWER: Duration = Duration::from_millis(15);

/// Longest wait of quitting for a file that is being written.
const LAST_FILE: Duration = Duration::from_secs(1);

/// Most events before a Ctrl-C that are still answered: more than anybody types ahead of the
/// screen, and answered in a fraction of a second.
const MOST_AHEAD: usize = 1000;

/// The events that have come and are not answered yet.
struct Events<'a> {
    from: &'a Receiver<ScreenEvent>,
    waiting: VecDeque<ScreenEvent>,
}

impl Events<'_> {
    /// Returns the next event that is there. Behind a burst of keys a Ctrl-C is the next one.
    fn next(&mut self) -> Option<ScreenEvent> {
        // Not for ever: more may come as fast as they are taken.
        for event in self.from.try_iter().take(100 * MOST_AHEAD) {
            if event.is_interrupt() && self.waiting.len() > MOST_AHEAD {
                self.waiting.retain(|event| !event.is_input());
            }
            self.waiting.push_back(event);
        }
        self.waiting.pop_front()
    }

    /// Removes the events at the front that are the same as this one; returns how many.
    fn repeats(&mut self, event: &ScreenEvent) -> usize {
        let same = self.waiting.iter().take_while(|other| *other == event).count();
        self.waiting.drain(..same).count()
    }

    /// Returns the next event, and waits for it this long.
    fn within(&mut self, wait: Duration) -> Result<ScreenEvent, RecvTimeoutError> {
        self.next().map_or_else(|| self.from.recv_timeout(wait), Ok)
    }
}

/// Urgency of the next frame.
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
    /// Returns the least time between two frames.
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
    let mut events = Events { from: events, waiting: VecDeque::new() };
    let mut ordered: Option<Order> = None;
    let mut due = Due::Now;
    let mut drawn: Option<Instant> = None;
    let mut again = false;
    let mut answer: Option<Instant> = None;
    let mut throttle = Throttle::new(host.line(), Instant::now(), host.sent());
    loop {
        order(app, engine, &mut ordered);
        let wait = drawn.map_or(Duration::ZERO, |at| due.pause(frame).saturating_sub(at.elapsed()));
        let wait = wait.max(throttle.wait(due == Due::Now, Instant::now()));
        let wait = wait.max(until(answer));
        let mut next = match events.within(wait) {
            Ok(event) => Some(event),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => {
                show(terminal, app, engine, host)?;
                return Ok(Exit::Done);
            }
        };
        while let Some(event) = next {
            if let ScreenEvent::Key(key) = &event
                && app.is_turn(key)
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
            // After many key presses only the last state is computed.
            next = events.next();
        }
        if order(app, engine, &mut ordered) {
            // Not for ever: the next key may come sooner.
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
                // `Terminal::clear` would ask for the cursor and wait for the input thread.
                let size = terminal.size()?;
                terminal.resize(size.into())?;
            }
            show(terminal, app, engine, host)?;
            answer = None;
            let now = Instant::now();
            throttle.spend(host.sent(), due == Due::Now, host.is_slow(), now);
            drawn = Some(now);
            due = Due::Later;
        }
    }
}

fn until(instant: Option<Instant>) -> Duration {
    instant.map_or(Duration::ZERO, |at| at.saturating_duration_since(Instant::now()))
}

/// Gives a new order to the engine; whether it is about another motion.
fn order(app: &App, engine: &mut dyn Engine, ordered: &mut Option<Order>) -> bool {
    let order = app.order();
    let generation = order.generation();
    let other = ordered.as_ref().is_none_or(|before| before.generation() != generation);
    if ordered.as_ref() != Some(&order) {
        engine.order(&order);
        *ordered = Some(order);
    }
    other
}

/// Takes the latest snapshot. A verdict is drawn as soon as it is known: while a key
/// is held, the next one comes before the next frame.
fn look(app: &mut App, engine: &mut dyn Engine) -> Due {
    let known = app.verdict().is_some();
    if let Some(snapshot) = engine.take() {
        app.apply_snapshot(snapshot);
    }
    if !known && app.verdict().is_some() { Due::Now } else { Due::Frame }
}

fn show<B: Backend>(
    terminal: &mut Terminal<B>,
    app: &mut App,
    engine: &mut dyn Engine,
    host: &mut dyn Host,
) -> Result<(), B::Error> {
    look(app, engine);
    let size = terminal.size()?;
    app.layout.size = (size.width, size.height);
    terminal.draw(|frame| panels::draw(frame, app))?;
    engine.drawn();
    // A screen that is too small shows only that it is.
    if size.width >= LEAST_WIDTH && size.height >= LEAST_HEIGHT {
        app.drawn();
        host.unseen(None);
    }
    Ok(())
}

/// Reaction of the loop to an event.
enum Reaction {
    Exit(Exit),
    /// Exit, as soon as the file that is being written is complete.
    Quit,
    Draw(Due),
    Redraw,
    /// Take what the engine has.
    Look,
}

fn handle(event: ScreenEvent, app: &mut App, host: &mut dyn Host) -> Reaction {
    match event {
        ScreenEvent::Key(key) => {
            let effect = app.key(&key);
            take(effect, app, host)
        }
        ScreenEvent::Mouse(event) => match app.mouse(&event) {
            None => Reaction::Draw(Due::Later),
            Some(effect) => take(effect, app, host),
        },
        ScreenEvent::Resize => Reaction::Draw(Due::Now),
        ScreenEvent::Ground(ground) => {
            app.appearance.use_ground(ground);
            Reaction::Draw(Due::Now)
        }
        ScreenEvent::Pasted(text) => {
            app.paste(&text);
            Reaction::Draw(Due::Now)
        }
        ScreenEvent::Written(result) => {
            written(result, app, host);
            Reaction::Draw(Due::Now)
        }
        ScreenEvent::Scenes(found) => {
            app.scenes_found(found);
            Reaction::Draw(Due::Now)
        }
        ScreenEvent::Fresh => Reaction::Look,
        ScreenEvent::Signal(number) => Reaction::Exit(Exit::Signal(number)),
        ScreenEvent::Suspend => suspended(app, host.suspend(false)),
        ScreenEvent::Continued => resumed(host.resume()),
        ScreenEvent::InputClosed => Reaction::Exit(Exit::Signal(HANGUP)),
    }
}

/// Returns what follows from a key or a click.
fn take(effect: Effect, app: &mut App, host: &mut dyn Host) -> Reaction {
    match effect {
        Effect::None => Reaction::Draw(Due::Now),
        Effect::Quit => Reaction::Quit,
        Effect::Suspend => suspended(app, host.suspend(true)),
        Effect::Redraw => Reaction::Redraw,
        Effect::Mouse(on) => {
            host.mouse(on);
            Reaction::Draw(Due::Now)
        }
        Effect::Copy(text) => {
            // The status line also shows it, in case the terminal refuses it.
            let _ = host.copy(&text);
            Reaction::Draw(Due::Now)
        }
        Effect::Write(job) => {
            if let Some(result) = host.write(job) {
                written(result, app, host);
            }
            Reaction::Draw(Due::Now)
        }
        Effect::FindScenes(directory) => {
            if let Some(found) = host.find_scenes(directory) {
                app.scenes_found(found);
            }
            Reaction::Draw(Due::Now)
        }
    }
}

/// Takes how the writing of a file went. Until a screen shows it, it is for the end of
/// the program to say.
fn written(result: FileResult, app: &mut App, host: &mut dyn Host) {
    let name = app.files.writing.as_ref().map_or("the file", |writing| &writing.name);
    match &result {
        FileResult::Written => {}
        FileResult::Exists => host.unseen(Some(format!("cannot write {name}: it exists"))),
        FileResult::Failed(reason) => host.unseen(Some(format!("cannot write {name}: {reason}"))),
    }
    app.written(result);
}

/// Waits a moment for the file that is being written.
fn last_file(events: &mut Events, app: &mut App, host: &mut dyn Host) -> Exit {
    let began = Instant::now();
    while app.files.writing.is_some() {
        match events.within(LAST_FILE.saturating_sub(began.elapsed())) {
            // The keys after the one that quits are for nobody.
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

/// SIGHUP: the terminal is closed.
pub(super) const HANGUP: u8 = 1;
