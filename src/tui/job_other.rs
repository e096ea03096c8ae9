//! Without jobs there is nothing to stop.

use std::io::Result;

/// Does nothing: there is nothing to stop.
pub fn want_stop(_: bool) {}

/// Does nothing: there is nothing to stop.
///
/// # Errors
/// None here.
pub fn stop() -> Result<()> {
    Ok(())
}

/// Returns true: no shell continues a job.
pub fn is_orphaned() -> bool {
    true
}
