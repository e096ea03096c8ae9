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

/// The computation of a result, at once or in a thread; the latest value that the thread sends is
/// the result.
#[derive(Debug)]
pub struct Job<T> {
    /// Where the results arrive; `None` once no more will come.
    coming: Option<Receiver<T>>,
    /// Whether this handle was dropped, which tells the thread to stop.
    dropped: Arc<AtomicBool>,
    /// The latest result; `None` before the first.
    pub found: Option<Arc<T>>,
}

impl<T: Send + 'static> Job<T> {
    /// Creates the job of a result that is known.
    pub fn done(found: T) -> Self {
        Self { coming: None, dropped: Arc::default(), found: Some(Arc::new(found)) }
    }

    /// Starts `work` in a thread. It sends results, which fails only if the job was dropped, and
    /// must poll the given `GoOn`, which then turns false.
    pub fn by(work: impl FnOnce(&Sender<T>, GoOn<'_>) + Send + 'static) -> Self {
        let (sender, results) = channel();
        let dropped = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&dropped);
        let thread = std::thread::Builder::new().name(WORKER_NAME.to_string());
        let started =
            thread.spawn(move || work(&sender, &|| !flag.load(Ordering::Relaxed))).is_ok();
        Self { coming: started.then_some(results), dropped, found: None }
    }

    /// Collects the results of the thread; waits for one up to `patience`.
    pub fn work(&mut self, mut patience: Duration) {
        while let Some(coming) = &self.coming {
            match coming.recv_timeout(patience) {
                Ok(found) => (self.found, patience) = (Some(Arc::new(found)), Duration::ZERO),
                Err(RecvTimeoutError::Timeout) => return,
                // The work is complete, or the thread ended early; what was found stays valid.
                Err(RecvTimeoutError::Disconnected) => self.coming = None,
            }
        }
    }

    /// Returns whether no more results will come.
    pub fn is_done(&self) -> bool {
        self.coming.is_none()
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.dropped.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_result_stays_and_a_dropped_computation_ends() {
        let mut job = Job::by(|to, _| (0..3).for_each(|k| to.send(k).unwrap()));
        while !job.is_done() {
            job.work(Duration::from_millis(20));
        }
        assert_eq!(job.found.as_deref(), Some(&2));
        let (done, ended) = channel();
        let endless: Job<()> = Job::by(move |_, go_on| {
            while go_on() {
                std::thread::yield_now();
            }
            done.send(()).unwrap();
        });
        drop(endless);
        assert_eq!(ended.recv_timeout(Duration::from_secs(60)), Ok(()));
    }
}
