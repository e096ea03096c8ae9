//! The events that the drawing thread waits for, and the threads that send
//! them: one reads keys, one waits for signals.

use std::sync::mpsc::Sender;
use std::thread;
use std::time::Duration;

use crossterm::event::{Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, MouseEvent};

use super::files::{FileResult, FoundScenes};
use super::ground::Ground;
use super::input::Input;

/// Something that happened.
#[derive(Clone, Debug, PartialEq)]
pub enum ScreenEvent {
    /// A key was pressed.
    Key(KeyEvent),
    /// The mouse was moved, or a button or the wheel was used.
    Mouse(MouseEvent),
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
    /// The terminal has reported its background.
    Ground(Ground),
    /// A text was pasted.
    Pasted(String),
    /// The file that was being written is done.
    Written(FileResult),
    /// The scenes of the directory were read.
    Scenes(FoundScenes),
    /// The terminal is closed: no more keys come.
    InputClosed,
}

impl ScreenEvent {
    /// Returns whether it is Ctrl-C, which quits everywhere.
    pub fn is_interrupt(&self) -> bool {
        let interrupt = (KeyCode::Char('c'), KeyModifiers::CONTROL);
        matches!(self, Self::Key(key) if (key.code, key.modifiers) == interrupt)
    }

    /// Returns whether the user has typed, pasted or pointed.
    pub fn is_input(&self) -> bool {
        matches!(self, Self::Key(_) | Self::Pasted(_) | Self::Mouse(_))
    }
}

/// Starts the thread that reads keys, and the report of the background among them.
///
/// # Errors
/// The system cannot start a thread.
pub fn read_keys(to: Sender<ScreenEvent>) -> std::io::Result<()> {
    let read = move || {
        let mut input = Input::default();
        loop {
            let event = input.next().transpose().and_then(screen_event);
            let ground = input.take_ground().map(ScreenEvent::Ground);
            for event in [ground, event].into_iter().flatten() {
                if event.is_interrupt() {
                    // A frame that waits for the terminal must not keep the drawing thread
                    // from hearing it.
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

/// Returns what an event of the terminal is for the explorer, if it is anything.
fn screen_event(event: std::io::Result<Event>) -> Option<ScreenEvent> {
    Some(match event {
        // Some terminals also report releases; repeats count as presses.
        Ok(Event::Key(key)) if key.kind != KeyEventKind::Release => ScreenEvent::Key(key),
        Ok(Event::Mouse(mouse)) => ScreenEvent::Mouse(mouse),
        Ok(Event::Resize(..)) => ScreenEvent::Resize,
        Ok(Event::Paste(text)) => ScreenEvent::Pasted(text),
        Ok(_) => return None,
        Err(_) => ScreenEvent::InputClosed,
    })
}

/// Starts the thread that waits for signals. If the drawing thread does not end
/// the program soon after a signal to end, this thread does.
///
/// # Errors
/// The system cannot start a thread or watch signals.
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
                    // The drawing thread must hear it even if its output is blocked.
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

/// Returns every signal that ends a program which does not catch it, and can be caught; not those
/// of faults in the program itself.
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
        // The real-time signals; the C library has the first two for itself.
        signals.extend(34..=64);
    }
    signals
}

/// Time that the drawing thread may take to end after a signal: it has a file to keep.
const GRACE: Duration = super::ending::PATIENCE;
