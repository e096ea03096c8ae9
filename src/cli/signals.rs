//! Signals that end a command. A file change in progress is finished first, and temporary files
//! are removed.

/// Starts the thread that waits for SIGINT, SIGTERM, SIGHUP and SIGQUIT. A signal that was ignored
/// at the start, as under `nohup`, stays ignored.
///
/// # Errors
/// The thread or the signal handlers cannot be set up.
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
            // Ending by the signal itself lets a shell loop end as well.
            let _ = signal_hook::low_level::emulate_default_handler(signal);
            signal_hook::low_level::exit(128 + signal);
        }
    };
    std::thread::Builder::new().name("rubscope-signals".into()).spawn(wait).map(|_| ())
}

/// Longest wait for a file change to finish: the disk may not respond.
const LONGEST_CHANGE: std::time::Duration = std::time::Duration::from_secs(2);

/// Returns the signals that were ignored when the program started, as a bit mask from signal 1 on;
/// 0 if `/proc` is missing.
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
