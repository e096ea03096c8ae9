//! Job control: stops the program as Ctrl-Z does, which the explorer must do itself because it
//! catches the key.

use std::io::Result;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};

use nix::unistd::{Pid, getpgid, getpgrp, getpid, getppid, getsid};

use super::ending::ended_by;

/// Whether a request to stop is pending; a request to continue clears it.
static WANTED: AtomicBool = AtomicBool::new(false);

/// Limit on the number of ancestors that are examined.
const GENERATIONS: usize = 64;

/// Records a request to stop (true) or to continue (false).
pub fn want_stop(wanted: bool) {
    WANTED.store(wanted, SeqCst);
}

/// Stops the program if a request is still pending and no signal has asked it to end, because a
/// stopped program could not handle that signal.
///
/// # Errors
/// The system refused to stop the program.
pub fn stop() -> Result<()> {
    if !WANTED.swap(false, SeqCst) || ended_by().is_some() {
        return Ok(());
    }
    signal_hook::low_level::emulate_default_handler(signal_hook::consts::SIGTSTP)
}

/// Returns whether no shell could continue this job: in POSIX terms, its process group is orphaned
/// (no ancestor belongs to another group of the same session).
pub fn is_orphaned() -> bool {
    let Ok(session) = getsid(None) else { return true };
    let mut process = getpid();
    for _ in 0..GENERATIONS {
        let Some(parent) = parent(process) else { return true };
        if getsid(Some(parent)) != Ok(session) {
            return true;
        }
        if getpgid(Some(parent)) != Ok(getpgrp()) {
            return false;
        }
        process = parent;
    }
    false
}

/// Returns the parent of a process; `None` if it is outside this container, where the system
/// reports the number 0.
fn parent(process: Pid) -> Option<Pid> {
    if process == getpid() {
        return seen(getppid());
    }
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let parent = status.lines().find_map(|line| line.strip_prefix("PPid:"))?;
    seen(Pid::from_raw(parent.trim().parse().ok()?))
}

/// Returns `None` for the number 0, which stands for a process outside this container.
fn seen(process: Pid) -> Option<Pid> {
    Some(process).filter(|process| process.as_raw() != 0)
}
