//! This program as a job of a shell: stopping it, as Ctrl-Z does for a program
//! that does not catch it.

use std::io::Result;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};

use rustix::process::{Pid, getpgid, getpgrp, getpid, getsid};

use super::terminal;

/// Whether the job has been asked to stop, and not to continue since.
static WANTED: AtomicBool = AtomicBool::new(false);

/// Most generations of parents that are asked for their job.
const GENERATIONS: usize = 64;

/// The job is to stop, until it is asked to continue.
pub fn want_stop(wanted: bool) {
    WANTED.store(wanted, SeqCst);
}

/// Stops this job, unless a signal to continue or to end came in the meantime:
/// a stopped program could not hear it any more.
///
/// # Errors
/// The system refuses.
pub fn stop() -> Result<()> {
    if !WANTED.swap(false, SeqCst) || terminal::ended_by().is_some() {
        return Ok(());
    }
    signal_hook::low_level::emulate_default_handler(signal_hook::consts::SIGTSTP)
}

/// Whether no shell could continue this job: no process of it has a parent in
/// another job of the same session, as POSIX has it of orphaned groups.
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

/// The parent of a process.
fn parent(process: Pid) -> Option<Pid> {
    if process == getpid() {
        return rustix::process::getppid();
    }
    let number = process.as_raw_nonzero();
    let status = std::fs::read_to_string(format!("/proc/{number}/status")).ok()?;
    let parent = status.lines().find_map(|line| line.strip_prefix("PPid:"))?;
    Pid::from_raw(parent.trim().parse().ok()?)
}
