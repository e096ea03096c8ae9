//! The explorer without a terminal: a frame of the screen, and a tick of the
//! worker, as the motion plays.
//!
//! `cargo bench` prints medians; `benches/table` puts them into the documents.

#![expect(clippy::unwrap_used, reason = "a benchmark states what must hold")]

#[path = "../tests/all/stepwise.rs"]
mod stepwise;

mod bench;

use std::hint::black_box;
use std::sync::mpsc;
use std::time::Duration;

use bench::benchmark_group;
use ratatui::{Terminal, backend::TestBackend};
use rubscope::tui::worker::{PLAY_TIME, Playback};
use rubscope::tui::{App, Marker, Theme, run};
use rubscope_solver::scene::Scene;
use stepwise::{NoHost, Stepwise};

/// The default scene, with a run that does not end while it is measured.
fn app() -> App {
    let scene = Scene::builtin("paper-nd3").unwrap().with(&[("solver.end_s", "100")]).unwrap();
    App::new(scene, Theme::Dark, Marker::Braille)
}

fn main() {
    let mut group = benchmark_group("explorer");
    for (name, size) in [("a frame, 80 x 24", (80, 24)), ("a frame, 200 x 60", (200, 60))] {
        let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).unwrap();
        let mut app = app();
        let mut engine = Stepwise::new(33e-3 * 5e-3);
        group.bench(name, || {
            // An end of all events is one frame.
            let (_, none) = mpsc::channel();
            run(&mut terminal, &none, &mut app, &mut engine, &mut NoHost, Duration::ZERO)
        });
    }
    // 33 ms of the clock, at the rate it starts with.
    let mut playback = Playback::new(app().order(), PLAY_TIME);
    while playback.is_computing() {
        playback.compute();
    }
    group.bench("a tick of the worker", || {
        playback.play_paced(black_box(Duration::from_millis(33)));
        playback.snapshot()
    });
}
