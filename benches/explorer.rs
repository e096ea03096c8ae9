//! The explorer without a terminal: a frame of the screen, and a tick of the
//! worker, as the motion plays.
//!
//! `cargo bench` prints medians; `benches/table` puts them into the documents.

#![expect(clippy::unwrap_used, reason = "a benchmark states what must hold")]

#[path = "../tests/all/stepwise.rs"]
mod stepwise;

use std::hint::black_box;
use std::sync::mpsc;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use ratatui::{Terminal, backend::TestBackend};
use rubscope::tui::worker::Playback;
use rubscope::tui::{App, Marker, Theme, run};
use rubscope_solver::scene::Scene;
use stepwise::{NoHost, Stepwise};

/// The default scene, with a run that does not end while it is measured.
fn app() -> App {
    let scene = Scene::builtin("paper-nd3").unwrap().with(&[("solver.end_s", "100")]).unwrap();
    App::new(scene, Theme::Dark, Marker::Braille)
}

fn explorer(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("explorer");
    for (name, size) in [("a frame, 80 x 24", (80, 24)), ("a frame, 200 x 60", (200, 60))] {
        let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).unwrap();
        let mut app = app();
        let mut engine = Stepwise::new(33e-3 * 5e-3);
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                // An end of all events is one frame.
                let (_, none) = mpsc::channel();
                run(&mut terminal, &none, &mut app, &mut engine, &mut NoHost, Duration::ZERO)
            });
        });
    }
    // 33 ms of the clock, at the rate it starts with.
    let mut playback = Playback::new(app().order());
    while playback.is_computing() {
        playback.compute();
    }
    group.bench_function("a tick of the worker", |bencher| {
        bencher.iter(|| {
            playback.play_paced(black_box(std::time::Duration::from_millis(33)));
            playback.snapshot()
        });
    });
    group.finish();
}

/// Short, so that all of it takes a minute; the options of criterion make it longer.
fn short() -> Criterion {
    Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(1200))
}

criterion_group! { name = all; config = short(); targets = explorer }
criterion_main!(all);
