//! The worker thread: one slot for the latest order, one for the latest snapshot. Neither side
//! waits for the other: a newer order replaces an older one, and a newer snapshot one that was not
//! taken.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::background::WORKER_NAME;
use super::playback::Playback;
use crate::tui::engine::{Engine, Order, Snapshot, Waker};

/// Time between two ticks while the motion plays.
const TICK: Duration = Duration::from_millis(33);

#[derive(Default)]
struct Slots {
    order: Option<Order>,
    snapshot: Option<Snapshot>,
    /// Whether a frame was drawn since the thread last checked.
    drawn: bool,
    quit: bool,
}

#[derive(Default)]
struct Shared {
    slots: Mutex<Slots>,
    wake: Condvar,
}

impl Shared {
    /// Locks the slots. A panic cannot leave them half-written: each is replaced as a whole, so a
    /// poisoned lock is safe to use.
    fn lock(&self) -> MutexGuard<'_, Slots> {
        self.slots.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Handle of the thread; dropping it ends the thread at its next tick.
pub struct Worker {
    shared: Arc<Shared>,
}

impl Worker {
    /// Starts the thread. It calls `wake` when a snapshot is ready and the previous one was taken.
    ///
    /// # Errors
    /// Fails if the system cannot start a thread.
    pub fn spawn(wake: Waker) -> std::io::Result<Self> {
        let shared = Arc::new(Shared::default());
        let theirs = Arc::clone(&shared);
        std::thread::Builder::new()
            .name(WORKER_NAME.to_string())
            .spawn(move || run(&theirs, &wake))?;
        Ok(Self { shared })
    }
}

impl Engine for Worker {
    fn order(&mut self, order: &Order) {
        self.shared.lock().order = Some(order.clone());
        self.shared.wake.notify_one();
    }

    fn take(&mut self) -> Option<Snapshot> {
        self.shared.lock().snapshot.take()
    }

    fn drawn(&mut self) {
        self.shared.lock().drawn = true;
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.shared.lock().quit = true;
        self.shared.wake.notify_one();
    }
}

fn run(shared: &Shared, wake: &Waker) {
    let mut playback: Option<Playback> = None;
    let mut playing = None;
    loop {
        let busy = playback.as_ref().is_some_and(Playback::is_computing);
        let Some((order, drawn)) = next_order(shared, busy, playing.is_some()) else { return };
        let tick = catch_panic(|| {
            let fresh = order.is_some();
            if let Some(order) = order {
                playing = order.playing.then(|| playing.unwrap_or_else(Instant::now));
                match &mut playback {
                    Some(playback) => playback.apply(&order),
                    None => playback = Some(Playback::new(order)),
                }
            }
            let playback = playback.as_mut()?;
            let mut moved = fresh;
            if drawn {
                playback.drawn();
            }
            if let Some(last) = playing.as_mut() {
                let elapsed = last.elapsed();
                if elapsed >= TICK {
                    *last = Instant::now();
                    moved |= playback.play_paced(elapsed);
                }
            }
            if playback.is_computing() {
                playback.compute();
                moved = true;
            }
            moved.then(|| playback.snapshot())
        });
        match tick {
            Ok(None) => {}
            Ok(Some(snapshot)) => publish(shared, snapshot, wake),
            Err(trouble) => {
                playback = None;
                playing = None;
                publish(shared, Snapshot { trouble: Some(trouble), ..Snapshot::default() }, wake);
            }
        }
    }
}

/// Returns the next order, if any, and whether a frame was drawn; waits if there is nothing to do.
/// `None` ends the thread.
fn next_order(shared: &Shared, busy: bool, playing: bool) -> Option<(Option<Order>, bool)> {
    let mut slots = shared.lock();
    if slots.order.is_none() && !slots.quit && !busy {
        slots = if playing {
            shared.wake.wait_timeout(slots, TICK).unwrap_or_else(PoisonError::into_inner).0
        } else {
            shared.wake.wait(slots).unwrap_or_else(PoisonError::into_inner)
        };
    }
    (!slots.quit).then(|| (slots.order.take(), std::mem::take(&mut slots.drawn)))
}

fn publish(shared: &Shared, mut snapshot: Snapshot, wake: &Waker) {
    let first = {
        let mut slots = shared.lock();
        let waiting = slots.snapshot.take();
        let first = waiting.is_none();
        if let Some(waiting) = waiting.filter(|waiting| waiting.run == snapshot.run) {
            snapshot.trouble = snapshot.trouble.or(waiting.trouble);
        }
        slots.snapshot = Some(snapshot);
        first
    };
    if first {
        wake();
    }
}

/// Runs `work` and turns a panic into one line of text.
fn catch_panic<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| {
        let what = payload
            .downcast_ref::<&str>()
            .map(ToString::to_string)
            .or_else(|| payload.downcast_ref::<String>().cloned())
            .unwrap_or_else(|| "unknown reason".to_string());
        format!("the solver stopped ({what}); r restarts")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::engine::FullRunState;
    use crate::tui::{App, Marker, Theme};
    use rubscope_solver::scene::Scene;

    fn order(speed: f64, number: u64) -> Order {
        let mut scene = Scene::base();
        scene.operation.speed_rad_s = speed;
        scene.solver.step_s = 1e-6;
        let app = App::new(scene.checked().unwrap(), Theme::Mono, Marker::Ascii);
        Order { number, run: number, rate: 5e-3, open: Vec::new(), ..app.order() }
    }

    #[test]
    fn an_order_does_not_wait_for_a_forecast_of_minutes() {
        let mut worker = Worker::spawn(Arc::new(|| {})).unwrap();
        let mut endless = Scene::builtin("undamped").unwrap().as_reference();
        endless.solver.end_s = 1e6;
        let app = App::new(endless.checked().unwrap(), Theme::Mono, Marker::Ascii);
        worker.order(&Order { number: 1, compare: true, ..app.order() });
        std::thread::sleep(Duration::from_millis(50));
        worker.order(&order(419.0, 2));
        for _ in 0..60_000 {
            if let Some(snapshot) = worker.take()
                && snapshot.number == 2
                && matches!(snapshot.results.full_run, Some(FullRunState::Done(_)))
            {
                return;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        panic!("the order still waits");
    }

    #[test]
    fn a_panic_becomes_a_line() {
        let line = catch_panic(|| -> () { panic!("no {}", "blades") }).unwrap_err();
        assert!(line.contains("no blades"), "{line}");
    }
}
