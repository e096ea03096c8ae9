//! A computation that cannot be cut into slices, in a thread of its own.
//! Neither the motion nor the next order waits for it, and dropping it ends the
//! thread within a millisecond of its work.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::available_parallelism;
use std::time::Duration;

use super::thread::WORKER_NAME;
use rubscope_solver::motion::GoOn;

/// A computation under way that sends its results one by one.
pub struct Background<T> {
    results: Option<Receiver<T>>,
    dropped: Arc<AtomicBool>,
}

/// Most threads for one purpose.
const MOST_THREADS: usize = 16;

/// Returns the threads for work in the background: one core is for the screen and the motion.
pub fn spare_threads() -> usize {
    let cores = available_parallelism().map_or(1, usize::from);
    cores.saturating_sub(1).clamp(1, MOST_THREADS)
}

/// Does work on these threads: not every core, as the motion plays on.
pub fn on_spare_cores<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    // The panic hook knows these threads, too.
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(spare_threads())
        .thread_name(|_| WORKER_NAME.to_string())
        .build();
    match pool {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

impl<T: Send + 'static> Background<T> {
    /// Starts `work`, which sends its results and looks at whether to go on.
    pub fn start(work: impl FnOnce(&Sender<T>, GoOn<'_>) + Send + 'static) -> Self {
        let (sender, results) = channel();
        let dropped = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&dropped);
        // The panic hook leaves the screen alone for threads of this name.
        let thread = std::thread::Builder::new().name(WORKER_NAME.to_string());
        let started =
            thread.spawn(move || work(&sender, &|| !flag.load(Ordering::Relaxed))).is_ok();
        Self { results: started.then_some(results), dropped }
    }

    /// Returns the next result, waiting for it no longer than `patience`.
    pub fn receive(&mut self, patience: Duration) -> Option<T> {
        match self.results.as_ref()?.recv_timeout(patience) {
            Ok(result) => Some(result),
            Err(RecvTimeoutError::Timeout) => None,
            // Done, or the thread ended early: what it sent stays.
            Err(RecvTimeoutError::Disconnected) => {
                self.results = None;
                None
            }
        }
    }

    /// Returns whether no more results come.
    pub fn is_done(&self) -> bool {
        self.results.is_none()
    }
}

impl<T> Drop for Background<T> {
    fn drop(&mut self) {
        self.dropped.store(true, Ordering::Relaxed);
    }
}

impl<T> fmt::Debug for Background<T> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_struct("Background").field("done", &self.results.is_none()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_one_by_one_and_a_dropped_computation_ends() {
        let mut job = Background::start(|to, _| (0..3).for_each(|k| to.send(k).unwrap()));
        let mut seen = Vec::new();
        while !job.is_done() {
            seen.extend(job.receive(Duration::from_millis(20)));
        }
        assert_eq!(seen, [0, 1, 2]);
        let (done, ended) = channel();
        let endless: Background<()> = Background::start(move |_, go_on| {
            while go_on() {
                std::thread::yield_now();
            }
            done.send(()).unwrap();
        });
        drop(endless);
        assert_eq!(ended.recv_timeout(Duration::from_secs(60)), Ok(()));
    }
}
