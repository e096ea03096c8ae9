//! Signals that ask a long computation to stop: the first is noted, so that what
//! is computed can be kept; the second ends the program at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

#[cfg(unix)]
use signal_hook::consts::SIGHUP;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// The signals that ask to stop: the user, the system, the terminal that closes.
const ASKING: &[i32] = &[
    SIGINT,
    SIGTERM,
    #[cfg(unix)]
    SIGHUP,
];

/// Whether a signal has asked to stop.
pub(super) struct StopRequest {
    number: Arc<AtomicUsize>,
    last: Arc<AtomicBool>,
}

impl StopRequest {
    /// Notes signals from now on.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn watch() -> std::io::Result<Self> {
        let request =
            Self { number: Arc::new(AtomicUsize::new(0)), last: Arc::new(AtomicBool::new(false)) };
        for &number in ASKING {
            // In this order: the signal that sets the flag does not see it set.
            flag::register_conditional_shutdown(number, 128 + number, Arc::clone(&request.last))?;
            flag::register(number, Arc::clone(&request.last))?;
            let noted = usize::try_from(number).unwrap_or(0);
            flag::register_usize(number, Arc::clone(&request.number), noted)?;
        }
        Ok(request)
    }

    /// The number of the signal that asked to stop, if one did.
    pub(super) fn received(&self) -> Option<u8> {
        u8::try_from(self.number.load(Ordering::Relaxed)).ok().filter(|&number| number != 0)
    }

    /// There is nothing left to keep: the next signal ends the program at once.
    pub(super) fn end_at_once(&self) {
        self.last.store(true, Ordering::Relaxed);
    }
}
