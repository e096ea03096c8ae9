//! The events that the drawing thread waits for, and the thread that waits for signals.

use std::sync::mpsc::Sender;
use std::thread;
use std::time::Duration;

use crossterm::event::{KeyEvent, MouseEvent};

use super::files::{FileResult, FoundScenes};
use super::ground::Ground;
use super::terminal::INTERRUPT;

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
    /// A signal with this number, which ends the program, has arrived.
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
    /// The scene files of the directory that the list of scenes shows were read.
    Scenes(FoundScenes),
    /// The input is closed: the terminal is gone.
    InputClosed,
}

impl ScreenEvent {
    /// Returns whether the event is Ctrl-C, which quits in every dialogue.
    pub fn is_interrupt(&self) -> bool {
        *self == Self::Key(INTERRUPT)
    }

    /// Returns whether the event is a key, a paste or from the mouse.
    pub fn is_input(&self) -> bool {
        matches!(self, Self::Key(_) | Self::Pasted(_) | Self::Mouse(_))
    }
}

/// Starts the thread that waits for signals. If the drawing thread has not ended the program within
/// `GRACE` after a deadly signal, this thread does.
///
/// # Errors
/// Fails if the system cannot start a thread or watch signals.
pub fn watch_signals(to: Sender<ScreenEvent>) -> std::io::Result<()> {
    use super::{ending, job, terminal};
    use nix::sys::signal::{SigSet, SigmaskHow};
    use signal_hook::consts::{SIGCONT, SIGTSTP, SIGWINCH};
    let watched = deadly_signals().into_iter().chain([SIGTSTP, SIGCONT, SIGWINCH]);
    // They wait meanwhile: signal-hook loses one that arrives while its handler is installed.
    let before = SigSet::all().thread_swap_mask(SigmaskHow::SIG_BLOCK)?;
    let mut signals = signal_hook::iterator::Signals::new(watched)?;
    before.thread_set_mask()?;
    let watch = move || {
        for signal in signals.forever() {
            match signal {
                SIGTSTP => {
                    job::want_stop(true);
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
