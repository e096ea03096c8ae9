//! A computation that cannot be divided into slices, in a thread of its own. Neither the playback
//! nor the next order waits for it; when it is dropped, the thread ends as soon as the work looks:
//! that of runs within about a millisecond, that of the margins within their rest of 200 ms.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::available_parallelism;
use std::time::Duration;

use rubscope_solver::motion::GoOn;

/// Name of the threads that compute, by which the panic hook recognises them.
pub const WORKER_NAME: &str = "rubscope-worker";

/// A running computation that sends results one by one.
#[derive(Debug)]
pub struct Background<T> {
    /// Where the results arrive; `None` once no more will come.
    results: Option<Receiver<T>>,
    /// Whether this handle was dropped, which tells the thread to stop.
    dropped: Arc<AtomicBool>,
}

/// Largest number of threads for one computation.
const MOST_THREADS: usize = 16;

/// Runs `work` on a thread pool that leaves one core free, because the playback continues.
pub fn on_spare_cores<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    let cores = available_parallelism().map_or(1, usize::from);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(cores.saturating_sub(1).clamp(1, MOST_THREADS))
        .thread_name(|_| WORKER_NAME.to_string())
        .build();
    match pool {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

impl<T: Send + 'static> Background<T> {
    /// Starts `work` in a thread. It sends results and must poll the given `GoOn`, which turns
    /// false when the computation is dropped.
    pub fn start(work: impl FnOnce(&Sender<T>, GoOn<'_>) + Send + 'static) -> Self {
        let (sender, results) = channel();
        let dropped = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&dropped);
        let thread = std::thread::Builder::new().name(WORKER_NAME.to_string());
        let started =
            thread.spawn(move || work(&sender, &|| !flag.load(Ordering::Relaxed))).is_ok();
        Self { results: started.then_some(results), dropped }
    }

    /// Returns the next result; waits for it up to `patience`. `None` if none arrives in that time,
    /// or no more will come.
    pub fn receive(&mut self, patience: Duration) -> Option<T> {
        match self.results.as_ref()?.recv_timeout(patience) {
            Ok(result) => Some(result),
            Err(RecvTimeoutError::Timeout) => None,
            // The work is complete, or the thread ended early; results already received stay valid.
            Err(RecvTimeoutError::Disconnected) => {
                self.results = None;
                None
            }
        }
    }

    /// Returns whether no more results will come.
    pub fn is_done(&self) -> bool {
        self.results.is_none()
    }
}

impl<T> Drop for Background<T> {
    fn drop(&mut self) {
        self.dropped.store(true, Ordering::Relaxed);
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
