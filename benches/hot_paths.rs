//! The hot paths: a step in flight and in contact, whole runs of the reference
//! cases by both solvers, a sweep of the harmonic balance, a cell of a map.
//!
//! `cargo bench` prints medians; compare numbers of one run only.

#![expect(clippy::unwrap_used, reason = "a benchmark states what must hold")]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rubscope::harmonic::{Form, locked_motion};
use rubscope::motion::{Motion, Sample, Sampling, Script, run_to_verdict, simulate, simulate_with};
use rubscope::scene::{CheckedScene, Scene};

fn scene(changes: &[(&str, &str)]) -> CheckedScene {
    Scene::base().with(changes).unwrap()
}

const EVENT: [(&str, &str); 2] = [("solver.kind", "event"), ("solver.model", "rigid")];

fn to_the_end(scene: &CheckedScene) -> f64 {
    let mut motion = Motion::new(scene);
    motion.advance(scene.solver.end_s).unwrap();
    motion.state().u[0]
}

/// Steps of the explicit solver: case A is nearly all flight, slip is contact
/// without a break, case B under the equality law is a held lock.
fn explicit(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("explicit");
    for (name, changes) in [
        ("case A, flight", vec![]),
        (
            "slip, contact",
            vec![
                ("casing.damping_ratio", "0.01"),
                ("operation.pulse_n", "51742"),
                ("solver.step_s", "1e-6"),
            ],
        ),
        ("case B, lock", vec![("operation.pulse_n", "1e6"), ("solver.contact", "bilateral")]),
        (
            "case B, full model",
            vec![("operation.pulse_n", "1e6"), ("solver.step_s", "1e-6"), ("solver.model", "full")],
        ),
    ] {
        let scene = scene(&changes);
        let steps = (scene.solver.end_s / scene.solver.step_s).round() as u64;
        group.throughput(Throughput::Elements(steps));
        group.bench_with_input(BenchmarkId::from_parameter(name), &scene, |bencher, scene| {
            bencher.iter(|| to_the_end(black_box(scene)));
        });
    }
    group.finish();
}

/// Whole runs of the event solver.
fn event(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("event");
    for (name, pulse, zeta, model) in [
        ("case A", "20000", "0.05", "rigid"),
        ("case A, moving blades", "20000", "0.05", "modal"),
        ("case C, rocking", "51742", "0", "rigid"),
        ("slip", "51742", "0.01", "rigid"),
        ("case B", "1e6", "0.05", "rigid"),
    ] {
        let scene = scene(&[
            EVENT[0],
            ("solver.model", model),
            ("operation.pulse_n", pulse),
            ("casing.damping_ratio", zeta),
        ]);
        group.bench_with_input(BenchmarkId::from_parameter(name), &scene, |bencher, scene| {
            bencher.iter(|| to_the_end(black_box(scene)));
        });
    }
    group.finish();
}

fn harmonic(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("hbm, 500 speeds");
    let machine = Scene::base().machine();
    let speeds: Vec<f64> = (1..=500).map(f64::from).collect();
    for form in Form::ALL {
        group.bench_function(form.as_ref(), |bencher| {
            bencher
                .iter(|| locked_motion(&machine, form, false, None, black_box(&speeds)).unwrap());
        });
    }
    group.finish();
}

/// What recording a history adds to solving, and what a cell of a map costs.
fn around(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("around");
    let slip = scene(&[
        ("casing.damping_ratio", "0.01"),
        ("operation.pulse_n", "51742"),
        ("solver.step_s", "1e-6"),
    ]);
    group.bench_function("slip without history", |bencher| {
        bencher.iter(|| simulate(black_box(&slip)));
    });
    group.bench_function("slip with 2000 samples", |bencher| {
        let sampling = Sampling { intervals: 2000, gaps: false };
        bencher.iter(|| {
            let mut sum = 0.0;
            let mut add = |sample: &Sample| sum += sample.state.u[0];
            simulate_with(black_box(&slip), &Script::default(), sampling, &mut add);
            sum
        });
    });
    let cell = scene(&[EVENT[0], EVENT[1], ("operation.pulse_n", "4e5")]);
    group.bench_function("a cell of a map", |bencher| {
        bencher.iter(|| run_to_verdict(black_box(&cell), &|| true));
    });
    group.finish();
}

criterion_group!(hot_paths, explicit, event, harmonic, around);
criterion_main!(hot_paths);
