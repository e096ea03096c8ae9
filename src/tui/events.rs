//! The events that the drawing thread waits for, and the threads that send
//! them: one reads keys, one waits for signals.

use std::sync::mpsc::Sender;
use std::thread;

use crossterm::event::{self, KeyEvent, KeyEventKind};

/// Something that happened.
#[derive(Clone, Debug, PartialEq)]
pub enum ScreenEvent {
    /// A key was pressed.
    Key(KeyEvent),
    /// The terminal has a new size.
    Resize,
    /// The engine has a new snapshot.
    Fresh,
    /// A signal that ends the program.
    Signal(u8),
    /// The job must be suspended.
    Suspend,
    /// The job was continued.
    Continued,
    /// No more keys: the terminal is closed.
    InputClosed,
}

/// Starts the thread that reads keys.
///
/// # Errors
/// The system gives no thread.
pub fn read_keys(to: Sender<ScreenEvent>) -> std::io::Result<()> {
    let read = move || {
        loop {
            let event = match event::read() {
                // Some terminals also report releases; repeats count as presses.
                Ok(event::Event::Key(key)) if key.kind != KeyEventKind::Release => {
                    ScreenEvent::Key(key)
                }
                Ok(event::Event::Resize(..)) => ScreenEvent::Resize,
                Ok(_) => continue,
                Err(_) => ScreenEvent::InputClosed,
            };
            let last = event == ScreenEvent::InputClosed;
            if to.send(event).is_err() || last {
                return;
            }
        }
    };
    thread::Builder::new().name("rubscope-input".into()).spawn(read).map(|_| ())
}

/// Starts the thread that waits for signals. If the drawing thread does not end
/// the program soon after a signal to end, this thread does.
///
/// # Errors
/// The system cannot start a thread or watch signals.
#[cfg(unix)]
pub fn watch_signals(to: Sender<ScreenEvent>) -> std::io::Result<()> {
    use signal_hook::consts::{SIGCONT, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGTSTP};
    let mut signals =
        signal_hook::iterator::Signals::new([SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGCONT])?;
    let watch = move || {
        for signal in signals.forever() {
            let event = match signal {
                SIGTSTP => ScreenEvent::Suspend,
                SIGCONT => ScreenEvent::Continued,
                deadly => ScreenEvent::Signal(u8::try_from(deadly).unwrap_or(0)),
            };
            let deadly = matches!(event, ScreenEvent::Signal(_));
            let heard = to.send(event).is_ok();
            if deadly {
                if heard {
                    thread::sleep(GRACE);
                }
                super::terminal::leave();
                std::process::exit(128 + signal);
            }
        }
    };
    thread::Builder::new().name("rubscope-signals".into()).spawn(watch).map(|_| ())
}

/// No signals to wait for.
///
/// # Errors
/// None here.
#[cfg(not(unix))]
pub fn watch_signals(_: Sender<ScreenEvent>) -> std::io::Result<()> {
    Ok(())
}

/// How long the drawing thread may take to end after a signal: a terminal that
/// accepts no output can block it.
#[cfg(unix)]
const GRACE: std::time::Duration = std::time::Duration::from_secs(2);
