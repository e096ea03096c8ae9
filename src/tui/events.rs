//! The events that the drawing thread waits for, and the threads that send them: one reads the
//! keyboard, one waits for signals.

use std::sync::mpsc::Sender;
use std::thread;
use std::time::Duration;

use crossterm::event::{Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, MouseEvent};

use super::files::{FileResult, FoundScenes};
use super::ground::Ground;
use super::input::Input;

/// An event for the drawing thread.
#[derive(Clone, Debug, PartialEq)]
pub enum ScreenEvent {
    /// A key was pressed.
    Key(KeyEvent),
    /// The mouse was moved, clicked or scrolled.
    Mouse(MouseEvent),
    /// The terminal has a new size.
    Resize,
    /// The engine has a new snapshot.
    Fresh,
    /// A signal that ends the program has arrived.
    Signal(u8),
    /// SIGTSTP has arrived: suspend the job.
    Suspend,
    /// The job was continued after a stop.
    Continued,
    /// The terminal has reported its background colour.
    Ground(Ground),
    /// Text was pasted.
    Pasted(String),
    /// A file was written, or writing failed.
    Written(FileResult),
    /// The scene files of the directory were read.
    Scenes(FoundScenes),
    /// The input is closed: the terminal is gone.
    InputClosed,
}

impl ScreenEvent {
    /// Returns whether it is Ctrl-C, which quits in every dialogue.
    pub fn is_interrupt(&self) -> bool {
        let interrupt = (KeyCode::Char('c'), KeyModifiers::CONTROL);
        matches!(self, Self::Key(key) if (key.code, key.modifiers) == interrupt)
    }

    /// Returns whether it comes from the keyboard or the mouse.
    pub fn is_input(&self) -> bool {
        matches!(self, Self::Key(_) | Self::Pasted(_) | Self::Mouse(_))
    }
}

/// Starts the thread that reads the keyboard, including the terminal's report of its background.
///
/// # Errors
/// Fails if the system cannot start a thread.
pub fn read_keys(to: Sender<ScreenEvent>) -> std::io::Result<()> {
    let read = move || {
        let mut input = Input::default();
        loop {
            let event = input.next().transpose().and_then(screen_event);
            let ground = input.take_ground().map(ScreenEvent::Ground);
            for event in [ground, event].into_iter().flatten() {
                if event.is_interrupt() {
                    // The drawing thread may be blocked in a write to the terminal; give up its
                    // frame so that it can handle the key.
                    super::terminal::cut_frame();
                }
                let last = event == ScreenEvent::InputClosed;
                if to.send(event).is_err() || last {
                    return;
                }
            }
        }
    };
    thread::Builder::new().name("rubscope-input".into()).spawn(read).map(|_| ())
}

/// Converts a terminal event; `None` if the explorer ignores it.
fn screen_event(event: std::io::Result<Event>) -> Option<ScreenEvent> {
    Some(match event {
        // Some terminals also report key releases. Repeats count as presses.
        Ok(Event::Key(key)) if key.kind != KeyEventKind::Release => ScreenEvent::Key(key),
        Ok(Event::Mouse(mouse)) => ScreenEvent::Mouse(mouse),
        Ok(Event::Resize(..)) => ScreenEvent::Resize,
        Ok(Event::Paste(text)) => ScreenEvent::Pasted(text),
        Ok(_) => return None,
        Err(_) => ScreenEvent::InputClosed,
    })
}

/// Starts the thread that waits for signals. If the drawing thread has not ended the program within
/// `GRACE` after a deadly signal, this thread does.
///
/// # Errors
/// Fails if the system cannot start a thread or watch signals.
pub fn watch_signals(to: Sender<ScreenEvent>) -> std::io::Result<()> {
    use super::{ending, job, terminal};
    use signal_hook::consts::{SIGCONT, SIGTSTP, SIGWINCH};
    let watched = deadly_signals().into_iter().chain([SIGTSTP, SIGCONT, SIGWINCH]);
    let mut signals = signal_hook::iterator::Signals::new(watched)?;
    let watch = move || {
        for signal in signals.forever() {
            match signal {
                SIGTSTP => {
                    job::want_stop(true);
                    // The drawing thread may be blocked in a write to the terminal.
                    terminal::cut_frame();
                    let _ = to.send(ScreenEvent::Suspend);
                }
                SIGCONT => {
                    job::want_stop(false);
                    let _ = to.send(ScreenEvent::Continued);
                }
                SIGWINCH => _ = to.send(ScreenEvent::Resize),
                deadly => {
                    let number = u8::try_from(deadly).unwrap_or(0);
                    ending::end(number);
                    if to.send(ScreenEvent::Signal(number)).is_ok() {
                        thread::sleep(GRACE);
                    }
                    terminal::leave();
                    std::process::exit(128 + deadly);
                }
            }
        }
    };
    thread::Builder::new().name("rubscope-signals".into()).spawn(watch).map(|_| ())
}

/// Lists the signals that end a program by default and can be caught, except those raised by memory
/// or arithmetic faults.
fn deadly_signals() -> Vec<i32> {
    use signal_hook::consts::{
        SIGABRT, SIGALRM, SIGHUP, SIGINT, SIGPROF, SIGQUIT, SIGSYS, SIGTERM, SIGTRAP, SIGUSR1,
        SIGUSR2, SIGVTALRM, SIGXCPU,
    };
    let mut signals = vec![
        SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU,
        SIGABRT, SIGSYS, SIGTRAP,
    ];
    #[cfg(target_os = "linux")]
    {
        use rustix::process::Signal;
        signals.extend([Signal::IO, Signal::POWER, Signal::STKFLT].map(Signal::as_raw));
        // Real-time signals; the C library reserves the first two (32 and 33).
        signals.extend(34..=64);
    }
    signals
}

/// Time for the drawing thread to end after a deadly signal; it may be saving a file.
const GRACE: Duration = super::ending::PATIENCE;
