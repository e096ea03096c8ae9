//! Signals that end a command. What it is changing on the disk is finished first,
//! and nothing unfinished stays. A command that can keep what it has computed
//! asks for the first signal to be noted only; the second ends it at once.

use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};

/// Whether the next signal is only noted.
static NOTING: AtomicBool = AtomicBool::new(false);
/// The signal that was noted; 0 for none.
static NOTED: AtomicU8 = AtomicU8::new(0);

/// Signals are noted while this value lives.
pub(super) struct StopRequest(());

impl StopRequest {
    /// Notes the next signal to stop.
    pub(super) fn expect() -> Self {
        NOTED.store(0, Ordering::SeqCst);
        NOTING.store(true, Ordering::SeqCst);
        Self(())
    }

    /// Returns the number of the signal that asked to stop, if one did.
    pub(super) fn received(&self) -> Option<u8> {
        Some(NOTED.load(Ordering::SeqCst)).filter(|&number| number != 0)
    }
}

impl Drop for StopRequest {
    fn drop(&mut self) {
        NOTING.store(false, Ordering::SeqCst);
    }
}

/// Starts the thread that waits for signals; a signal that is ignored, as under
/// `nohup`, stays so.
///
/// # Errors
/// The system cannot start a thread or watch signals.
#[cfg(unix)]
pub(super) fn watch() -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    let ignored = ignored();
    let heard = [SIGINT, SIGTERM, SIGHUP, SIGQUIT]
        .into_iter()
        .filter(|signal| ignored >> (signal - 1) & 1 == 0);
    let mut signals = signal_hook::iterator::Signals::new(heard)?;
    let wait = move || {
        for signal in signals.forever() {
            if signal != SIGQUIT && NOTING.swap(false, Ordering::SeqCst) {
                NOTED.store(u8::try_from(signal).unwrap_or(0), Ordering::SeqCst);
                continue;
            }
            crate::file::settle(LONGEST_CHANGE);
            // The shell sees that it was ended by the signal, and ends its loop.
            let _ = signal_hook::low_level::emulate_default_handler(signal);
            signal_hook::low_level::exit(128 + signal);
        }
    };
    std::thread::Builder::new().name("rubscope-signals".into()).spawn(wait).map(|_| ())
}

/// Longest wait for the change of a file at the end: a disk may not answer.
#[cfg(unix)]
const LONGEST_CHANGE: std::time::Duration = std::time::Duration::from_secs(2);

/// Returns the signals that were ignored when the program started, a bit each from signal 1 on;
/// none where the system does not tell.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Without signals the system ends a command.
///
/// # Errors
/// None here.
#[cfg(not(unix))]
pub(super) fn watch() -> std::io::Result<()> {
    Ok(())
}
