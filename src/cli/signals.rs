//! Signals that end a command. What it is changing on the disk is finished first,
//! and nothing unfinished stays.

/// Starts the thread that waits for signals; a signal that is ignored, as under
/// `nohup`, stays so.
///
/// # Errors
/// The system cannot start a thread or watch signals.
pub(super) fn watch() -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    let ignored = ignored();
    let heard = [SIGINT, SIGTERM, SIGHUP, SIGQUIT]
        .into_iter()
        .filter(|signal| ignored >> (signal - 1) & 1 == 0);
    let mut signals = signal_hook::iterator::Signals::new(heard)?;
    let wait = move || {
        if let Some(signal) = signals.forever().next() {
            crate::file::settle(LONGEST_CHANGE);
            // The shell sees that it was ended by the signal, and ends its loop.
            let _ = signal_hook::low_level::emulate_default_handler(signal);
            signal_hook::low_level::exit(128 + signal);
        }
    };
    std::thread::Builder::new().name("rubscope-signals".into()).spawn(wait).map(|_| ())
}

/// Longest wait for the change of a file at the end: a disk may not answer.
const LONGEST_CHANGE: std::time::Duration = std::time::Duration::from_secs(2);

/// Returns the signals that were ignored when the program started, a bit each from signal 1 on;
/// none where the system does not tell.
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
