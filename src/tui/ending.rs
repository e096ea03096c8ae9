//! The signal that ends the program. After it nothing more is drawn.

use std::sync::atomic::{AtomicU8, Ordering::SeqCst};
use std::time::Duration;

/// Longest wait for files at the end of the program. A busy disk takes about a second; one that
/// never answers must not block the exit.
pub const PATIENCE: Duration = Duration::from_secs(5);

/// The first deadly signal received; 0 if none.
static ENDED_BY: AtomicU8 = AtomicU8::new(0);

/// Records a deadly signal; later ones are ignored.
pub fn end(signal: u8) {
    let _ = ENDED_BY.compare_exchange(0, signal, SeqCst, SeqCst);
}

/// Returns the number of the first deadly signal received; `None` if there was none.
pub fn ended_by() -> Option<u8> {
    Some(ENDED_BY.load(SeqCst)).filter(|signal| *signal != 0)
}
