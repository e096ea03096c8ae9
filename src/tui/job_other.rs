//! Without jobs there is nothing to stop.

use std::io::Result;

/// Nothing to note.
pub fn want_stop(_: bool) {}

/// Nothing to stop.
///
/// # Errors
/// None here.
pub fn stop() -> Result<()> {
    Ok(())
}

/// No shell continues a job.
pub fn is_orphaned() -> bool {
    true
}
