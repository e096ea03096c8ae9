//! The worker thread: it receives what the screen sends, of which only the latest order counts, and
//! has one place for the latest snapshot. Neither side waits for the other.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::background::WORKER_NAME;
use super::playback::{PLAY_TIME, Playback};
use crate::tui::engine::{Engine, Order, Snapshot, Waker};

/// Time between two ticks while the motion plays.
const TICK: Duration = Duration::from_millis(33);

/// What the screen sends.
enum Message {
    /// What to show now.
    Order(Box<Order>),
    /// A frame was drawn.
    Drawn,
}

/// The latest snapshot; `None` once it was taken.
type Latest = Arc<Mutex<Option<Snapshot>>>;

/// Replaces the latest snapshot; returns the one before if it was not taken. A panic cannot leave it
/// half-written, so a poisoned lock is safe to use.
fn exchange(latest: &Latest, new: Option<Snapshot>) -> Option<Snapshot> {
    std::mem::replace(&mut *latest.lock().unwrap_or_else(PoisonError::into_inner), new)
}

/// Handle of the thread; dropping it ends the thread at its next tick.
pub struct Worker {
    messages: Sender<Message>,
    latest: Latest,
}

impl Worker {
    /// Starts the thread. It calls `wake` when a snapshot is ready and the previous one was taken.
    ///
    /// # Errors
    /// Fails if the system cannot start a thread.
    pub fn spawn(wake: Waker) -> std::io::Result<Self> {
        let ((messages, sent), latest) = (channel(), Latest::default());
        let theirs = Arc::clone(&latest);
        std::thread::Builder::new()
            .name(WORKER_NAME.to_string())
            .spawn(move || run(&sent, &theirs, &wake))?;
        Ok(Self { messages, latest })
    }
}

impl Engine for Worker {
    fn order(&mut self, order: &Order) {
        // Sending fails only if the thread has ended.
        _ = self.messages.send(Message::Order(order.clone().into()));
    }

    fn take(&mut self) -> Option<Snapshot> {
        exchange(&self.latest, None)
    }

    fn drawn(&mut self) {
        _ = self.messages.send(Message::Drawn);
    }
}

fn run(sent: &Receiver<Message>, latest: &Latest, wake: &Waker) {
    let publish = |snapshot: Snapshot| {
        if exchange(latest, Some(snapshot)).is_none() {
            wake();
        }
    };
    let mut playback: Option<Playback> = None;
    let mut playing = None;
    loop {
        let busy = playback.as_ref().is_some_and(Playback::is_computing);
        let Some((order, drawn)) = receive(sent, busy, playing.is_some()) else { return };
        let tick = catch_panic(|| {
            let fresh = order.is_some();
            if let Some(order) = order {
                playing = order.playing.then(|| playing.unwrap_or_else(Instant::now));
                match &mut playback {
                    Some(playback) => playback.apply(&order),
                    None => playback = Some(Playback::new(*order, PLAY_TIME)),
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
            Ok(snapshot) => _ = snapshot.map(publish),
            Err(trouble) => {
                (playback, playing) = (None, None);
                publish(Snapshot { trouble: Some(trouble), ..Snapshot::default() });
            }
        }
    }
}

/// Receives what was sent: the latest order, if any, and whether a frame was drawn. Waits if there
/// is nothing to do. `None` ends the thread.
fn receive(
    sent: &Receiver<Message>,
    busy: bool,
    playing: bool,
) -> Option<(Option<Box<Order>>, bool)> {
    let first = match (busy, playing) {
        (true, _) => sent.recv_timeout(Duration::ZERO),
        (false, true) => sent.recv_timeout(TICK),
        (false, false) => sent.recv().map_err(RecvTimeoutError::from),
    };
    if matches!(first, Err(RecvTimeoutError::Disconnected)) {
        return None;
    }
    let (mut latest, mut drawn) = (None, false);
    for message in first.into_iter().chain(sent.try_iter()) {
        match message {
            Message::Order(order) => latest = Some(order),
            Message::Drawn => drawn = true,
        }
    }
    Some((latest, drawn))
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
