//! The signal that ends the program. After it nothing is drawn any more.

use std::sync::atomic::{AtomicU8, Ordering::SeqCst};
use std::time::Duration;

/// Longest wait for the last file at the end of the program: a busy disk takes a second, one
/// that never answers must not keep the user.
pub const PATIENCE: Duration = Duration::from_secs(5);

/// The first signal that ends the program; 0 if there was none.
static ENDED_BY: AtomicU8 = AtomicU8::new(0);

/// Records a signal that ends the program.
pub fn end(signal: u8) {
    let _ = ENDED_BY.compare_exchange(0, signal, SeqCst, SeqCst);
}

/// Returns the signal that ends the program, if there was one.
pub fn ended_by() -> Option<u8> {
    Some(ENDED_BY.load(SeqCst)).filter(|signal| *signal != 0)
}
