//! The hot paths: whole runs by both solvers, a sweep of the harmonic balance,
//! cells of a map, and what recording a history adds.
//!
//! `cargo bench` prints medians; compare numbers of one run only.
//! `benches/table` puts them into the documents, whose tables name these
//! benchmarks as `group/name`. Where a time is given of one step, it is of a step
//! taken, not of one that was skipped.

#![expect(clippy::unwrap_used, reason = "a benchmark states what must hold")]

mod bench;

use std::hint::black_box;

use bench::{Group, benchmark_group};
use rubscope_solver::harmonic::{Form, locked_motion};
use rubscope_solver::motion::{
    Events, Motion, Sample, Sampling, Script, run_to_end, run_to_verdict, run_with_certainty,
    to_the_end,
};
use rubscope_solver::scene::{CheckedScene, Scene};

type Changes = &'static [(&'static str, &'static str)];

/// The default of a scene is case A of the paper's machine: 20 kN, unilateral.
fn scene(changes: Changes) -> CheckedScene {
    Scene::base().with(changes).unwrap()
}

const SLIP: [(&str, &str); 2] = [("casing.damping_ratio", "0.01"), ("operation.pulse_n", "51742")];
const MICROSECOND: (&str, &str) = ("solver.step_s", "1e-6");
const EVENT: (&str, &str) = ("solver.kind", "event");
const RIGID: (&str, &str) = ("solver.model", "rigid");
const FULL: (&str, &str) = ("solver.model", "full");

fn to_the_end_of(scene: &CheckedScene, mut motion: Motion) -> Motion {
    motion.advance(scene.solver.end_s).unwrap();
    motion
}

/// Whole runs of the explicit solver: case A is nearly all flight, the default
/// scene nearly all lock, slip is contact without a break.
fn explicit() {
    let mut group = benchmark_group("explicit");
    let cases: [(&str, Changes); 9] = [
        ("default scene", &[("operation.pulse_n", "1e6"), ("solver.contact", "bilateral")]),
        ("default scene, unilateral", &[("operation.pulse_n", "1e6")]),
        ("case A, 1e-5 s", &[("solver.step_s", "1e-5")]),
        ("case A, 1e-6 s", &[MICROSECOND]),
        ("case A, 1e-7 s", &[]),
        ("case A, 1e-8 s", &[("solver.step_s", "1e-8")]),
        ("case A, full", &[FULL]),
        ("slip, rigid", &[SLIP[0], SLIP[1], MICROSECOND, RIGID]),
        ("slip, modal", &[SLIP[0], SLIP[1], MICROSECOND]),
    ];
    let full: (&str, Changes) = ("full, contact", &[SLIP[0], SLIP[1], MICROSECOND, FULL]);
    for (name, changes) in cases.into_iter().chain([full]) {
        whole_run(&mut group, name, &scene(changes));
    }
}

/// The same of scenes beyond the paper, of locks at a step that leaves more vibration, and
/// of three sides.
fn beyond() {
    const COARSE: (&str, &str) = ("solver.step_s", "5e-7");
    const SHORT: (&str, &str) = ("solver.end_s", "0.02");
    const SIDES: [(&str, &str); 2] =
        [("bladed_disk.blades", "60"), ("operation.nodal_diameters", "20")];
    const EXPLICIT: (&str, &str) = ("solver.kind", "explicit");
    let many = |blades, stiffness| {
        let size = [("bladed_disk.blades", blades), ("contact.stiffness_n_per_m", stiffness)];
        [&size[..], &[FULL, ("solver.end_s", "0.001")]].concat()
    };
    let mut group = benchmark_group("explicit, beyond");
    for (name, preset, changes) in [
        ("coincidence", "coincidence", vec![("solver.end_s", "0.1")]),
        ("coincidence, 352 blades, full", "coincidence", many("352", "1687.5")),
        ("coincidence, 4096 blades, full", "coincidence", many("4096", "145.02")),
        ("rub", "rub", vec![SHORT]),
        ("digs-in", "digs-in", vec![SHORT]),
        ("soft-lining", "soft-lining", vec![SHORT]),
        ("friction-lock", "friction-lock", vec![EXPLICIT]),
        ("default scene, 5e-7 s", "paper-nd3", vec![COARSE]),
        ("three sides", "paper-nd3", vec![SIDES[0], SIDES[1], MICROSECOND, SHORT]),
    ] {
        whole_run(&mut group, name, &Scene::builtin(preset).unwrap().with(&changes).unwrap());
    }
}

/// A run to its end, by the step taken where most are taken.
fn whole_run(group: &mut Group, name: &str, scene: &CheckedScene) {
    let motion = to_the_end_of(scene, Motion::new(scene));
    let (taken, skipped) = (motion.steps_taken().unwrap(), motion.steps_skipped().unwrap());
    // Where most steps are skipped, the time over those taken tells nothing.
    group.count = if taken > skipped { taken } else { 0 };
    group.bench(name, || to_the_end_of(scene, Motion::new(black_box(scene))).state().u[0]);
}

/// Whole runs of the event solver.
fn event() {
    let mut group = benchmark_group("event");
    let cases: [(&str, f64, Changes); 6] = [
        ("case A, 1e-6", 1e-6, &[EVENT]),
        ("case A, 1e-15", 1e-15, &[EVENT]),
        ("case A, rigid", 1e-15, &[EVENT, RIGID]),
        ("case C, rocking", 1e-15, &[EVENT, RIGID, SLIP[1], ("casing.damping_ratio", "0")]),
        ("slip", 1e-15, &[EVENT, RIGID, SLIP[0], SLIP[1]]),
        ("case B", 1e-15, &[EVENT, RIGID, ("operation.pulse_n", "1e6")]),
    ];
    for (name, tolerance, changes) in cases {
        let scene = scene(changes);
        group.bench(name, || {
            let motion = Events::new(black_box(&scene)).unwrap().with_tolerance(tolerance);
            to_the_end_of(&scene, motion.into()).state().u[0]
        });
    }
}

/// The locked motion at 500 speeds.
fn harmonic() {
    let mut group = benchmark_group("hbm");
    let machine = Scene::base().machine();
    let speeds: Vec<f64> = (1..=500).map(f64::from).collect();
    group.count = 500;
    for (name, form) in [
        ("500 speeds, printed", Form::Printed),
        ("500 speeds, blade", Form::Blade),
        ("500 speeds, modal", Form::Modal),
    ] {
        group.bench(name, || {
            locked_motion(&machine, form, false, None, black_box(&speeds)).unwrap()
        });
    }
}

/// A cell of a map, alone and with the runs that find out whether it is
/// sensitive.
fn map() {
    let mut group = benchmark_group("map");
    let cell = scene(&[EVENT, RIGID, ("operation.pulse_n", "4e5")]);
    group.count = 1;
    group.bench("a cell", || run_to_verdict(black_box(&cell), &to_the_end));
    group.bench("a cell with certainty", || run_with_certainty(black_box(&cell), &to_the_end));
}

/// What recording a history adds to solving.
fn record() {
    let mut group = benchmark_group("record");
    let slip = scene(&[SLIP[0], SLIP[1], MICROSECOND]);
    group.bench("slip, no history", || {
        let none = Sampling::default();
        run_to_end(black_box(&slip), &Script::default(), none, &mut |_| {})
    });
    let sampling = Sampling { intervals: 2000, gaps: true };
    group.bench("slip, 2000 samples", || {
        let mut sum = 0.0;
        let mut add = |sample: &Sample| sum += sample.state.u[0];
        run_to_end(black_box(&slip), &Script::default(), sampling, &mut add);
        sum
    });
}

fn main() {
    explicit();
    beyond();
    event();
    harmonic();
    map();
    record();
}
