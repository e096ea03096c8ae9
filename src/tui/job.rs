//! This program as a job of a shell: stopping it, as Ctrl-Z does for a program
//! that does not catch it.

use std::io::Result;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};

use nix::unistd::{Pid, getpgid, getpgrp, getpid, getppid, getsid};

use super::ending::ended_by;

/// Whether the job has been asked to stop, and not to continue since.
static WANTED: AtomicBool = AtomicBool::new(false);

/// Most generations of parents that are asked for their job.
const GENERATIONS: usize = 64;

/// Records that the job is to stop, or to continue.
pub fn want_stop(wanted: bool) {
    WANTED.store(wanted, SeqCst);
}

/// Stops this job, unless a signal to continue or to end came in the meantime:
/// a stopped program could not hear it any more.
///
/// # Errors
/// The system refuses.
pub fn stop() -> Result<()> {
    if !WANTED.swap(false, SeqCst) || ended_by().is_some() {
        return Ok(());
    }
    signal_hook::low_level::emulate_default_handler(signal_hook::consts::SIGTSTP)
}

/// Returns whether no shell could continue this job: no process of it has a parent in another job
/// of the same session, as POSIX has it of orphaned groups.
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

/// Returns the parent of a process, if it is in this container: the system gives processes, groups
/// and sessions outside it the number 0.
fn parent(process: Pid) -> Option<Pid> {
    if process == getpid() {
        return seen(getppid());
    }
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let parent = status.lines().find_map(|line| line.strip_prefix("PPid:"))?;
    seen(Pid::from_raw(parent.trim().parse().ok()?))
}

/// Returns `None` for a process outside this container.
fn seen(process: Pid) -> Option<Pid> {
    Some(process).filter(|process| process.as_raw() != 0)
}
