//! The golden set: some 360 scenes in `tests/golden`, each with what the solvers say of it. It
//! judges a rebuilt solver by what users see: verdict, blades in contact, impacts, and the
//! displacements at three instants.
//!
//! A scene is one line, `{"name": .., "scene": ..}`; the words of `scene` can be pasted behind
//! `rubscope run`. `tests/golden/draw.py` drew the random ones. `RUBSCOPE_GOLDEN=write cargo test
//! golden` adds what is expected where it is missing: by every step taken (`plain`) and by events, with
//! contact that only pushes (`event`; null where the event solver refuses the scene).
//!
//! Tolerances are measured. Each run is repeated with a start that differs by 1e-12 and by 1e-11,
//! both ways. A coordinate may differ by 100 times what 1e-12 changes it by, as round-off adds up
//! to 1e-11 over a million steps, and by 1e-9 of its largest value. What the changes alter
//! (verdict, blades, impacts, or a coordinate by more than a hundredth of the clearance) is not
//! compared.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use rubscope::cli::script::RequestedScript;
use rubscope_solver::motion::{Sampling, run_to_end};
use rubscope_solver::scene::{CheckedScene, ContactLaw, Scene, SolverKind};
use serde::{Deserialize, Serialize};

/// Instants at which a run is sampled.
const SAMPLES: u32 = 200;

#[derive(Serialize, Deserialize)]
struct Case {
    name: String,
    scene: String,
    #[serde(default)]
    plain: Option<Seen>,
    #[serde(default)]
    event: Option<Seen>,
}

/// What is seen of a run; null where tiny changes of the start alter it.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
struct Seen {
    verdict: Option<String>,
    blades: Option<Vec<Vec<u32>>>,
    impacts: Option<u64>,
    states: Vec<Instant>,
    /// Steps that were skipped; without any, a run is the one that takes every step.
    #[serde(skip)]
    skipped: Option<u64>,
}

/// Casing displacement \[m\] and blade modes \[rad\] at one instant, and how far they may differ.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
struct Instant {
    t_s: f64,
    u: [f64; 2],
    alpha: [f64; 2],
    within: Option<[f64; 2]>,
}

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

fn read(file: &Path) -> Vec<Case> {
    let text = std::fs::read_to_string(file).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// The scene of these words, and its changes on the way.
fn parse(words: &str) -> (Scene, Vec<String>) {
    let mut words = words.split_whitespace();
    let mut scene = Scene::builtin(words.next().unwrap()).unwrap();
    let (mut keys, mut changes) = (Vec::new(), Vec::new());
    while let Some(option) = words.next() {
        let value = words.next().unwrap();
        match option {
            "--set" => keys.push(value.split_once('=').unwrap()),
            "--at" => changes.push(value.to_string()),
            other => panic!("{other} is not an option of a golden scene"),
        }
    }
    if !keys.is_empty() {
        scene = scene.with(&keys).unwrap().into_scene();
    }
    (scene, changes)
}

/// The scene with a start that differs by this part.
fn nudged(scene: &Scene, part: f64) -> Scene {
    let mut nudged = scene.clone();
    let initial = &mut nudged.initial;
    let at_rest = [initial.u_c_m, initial.u_s_m, initial.v_c_m_s, initial.v_s_m_s] == [0.0; 4];
    nudged.operation.pulse_n *= 1.0 + part;
    if !at_rest {
        let rate = part * scene.machine().omega_c * scene.clearance().abs();
        nudged.initial.v_c_m_s += rate;
        nudged.initial.v_s_m_s -= 0.7 * rate;
    } else if scene.operation.pulse_n == 0.0 {
        nudged.operation.speed_rad_s *= 1.0 + part;
    }
    nudged
}

/// Runs a scene; at the instants of `instants`, or at those that its impacts suggest.
fn see(scene: &CheckedScene, changes: &[String], instants: Option<&[f64]>) -> Seen {
    let script = RequestedScript::of(changes, scene).unwrap();
    let mut states = Vec::new();
    let sampling = Sampling { intervals: SAMPLES, gaps: false };
    let mut keep = |sample: &rubscope_solver::motion::Sample| {
        let state = &sample.state;
        states.push(Instant { t_s: state.t_s, u: state.u, alpha: state.alpha, within: None });
    };
    let report = run_to_end(scene, &script.changes, sampling, &mut keep);
    let end = scene.solver.end_s;
    let times = match instants {
        Some(times) => times.to_vec(),
        None => {
            let impact = |n: usize| report.impacts.get(n).map(|impact| impact.t_s);
            let first = impact(0).map_or(end / 3.0, |t| t / 2.0);
            let later = impact(1).or(impact(0)).map_or(end / 1.5, |t| t + end / 50.0);
            vec![first, later, end]
        }
    };
    let place = |t: f64| (t / end * f64::from(SAMPLES)).round() as usize;
    Seen {
        verdict: Some(report.outcome.verdict.to_string()),
        blades: Some(report.outcome.contacts.iter().map(|c| c.blades.clone()).collect()),
        impacts: Some(report.impact_count),
        states: times.iter().filter_map(|t| states.get(place(*t)).cloned()).collect(),
        skipped: report.solver.steps_skipped,
    }
}

fn by_steps(scene: &Scene, plain: bool) -> CheckedScene {
    let mut scene = scene.clone();
    scene.solver.kind = SolverKind::Explicit;
    let scene = scene.checked().unwrap();
    if plain { scene.by_every_step() } else { scene }
}

/// None where the event solver refuses the scene or its changes.
fn by_events(scene: &Scene, changes: &[String]) -> Option<CheckedScene> {
    let mut scene = scene.clone();
    scene.solver.kind = SolverKind::Event;
    if scene.solver.contact == ContactLaw::Bilateral {
        scene.solver.contact = ContactLaw::Unilateral;
    }
    let checked = scene.checked().ok()?;
    RequestedScript::of(changes, &checked).ok()?;
    Some(checked)
}

/// What a run shows, with the tolerances that changes of its start give.
fn measure(scene: &Scene, changes: &[String], solver: &dyn Fn(&Scene) -> CheckedScene) -> Seen {
    let mut seen = see(&solver(scene), changes, None);
    let times: Vec<f64> = seen.states.iter().map(|state| state.t_s).collect();
    let clearance = scene.clearance().abs();
    let largest = |part: fn(&Instant) -> [f64; 2]| {
        seen.states.iter().flat_map(part).fold(0.0_f64, |most, x| most.max(x.abs()))
    };
    let sizes = [largest(|state| state.u), largest(|state| state.alpha)];
    let sizes = [sizes[0].max(clearance), sizes[1].max(1e-15)];
    let mut within = vec![Some(sizes.map(|size| 1e-9 * size)); seen.states.len()];
    for part in [1e-12, -1e-12, 1e-11, -1e-11] {
        let other = see(&solver(&nudged(scene, part)), changes, Some(&times));
        if other.verdict != seen.verdict {
            seen.verdict = None;
        }
        if other.blades != seen.blades {
            seen.blades = None;
        }
        if other.impacts != seen.impacts {
            seen.impacts = None;
        }
        let scale = 100.0 * 1e-12 / part.abs();
        for (place, state) in seen.states.iter().enumerate() {
            let Some(other) = other.states.get(place) else {
                within[place] = None;
                continue;
            };
            let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
            let found = [apart(state.u, other.u), apart(state.alpha, other.alpha)];
            within[place] = within[place].and_then(|limit| {
                let wider = [0, 1].map(|k| limit[k].max(1e-9 * sizes[k] + scale * found[k]));
                (wider[0] < 0.01 * clearance && wider[1] < 0.01 * sizes[1]).then_some(wider)
            });
        }
    }
    for (state, within) in seen.states.iter_mut().zip(within) {
        state.within = within;
    }
    seen
}

/// The first difference beyond what is allowed.
fn difference(expected: &Seen, seen: &Seen) -> Option<String> {
    if expected.verdict.is_some() && expected.verdict != seen.verdict {
        return Some(format!("verdict {:?}, expected {:?}", seen.verdict, expected.verdict));
    }
    if expected.blades.is_some() && expected.blades != seen.blades {
        return Some(format!("blades {:?}, expected {:?}", seen.blades, expected.blades));
    }
    if expected.impacts.is_some() && expected.impacts != seen.impacts {
        return Some(format!("impacts {:?}, expected {:?}", seen.impacts, expected.impacts));
    }
    expected.states.iter().zip(&seen.states).find_map(|(right, state)| {
        let [most_u, most_alpha] = right.within?;
        let far = |a: [f64; 2], b: [f64; 2], most: f64| {
            (0..2).any(|k| a[k].is_nan() || (a[k] - b[k]).abs() > most)
        };
        let wrong = far(state.u, right.u, most_u) || far(state.alpha, right.alpha, most_alpha);
        let (t, u, a) = (right.t_s, state.u, state.alpha);
        wrong.then(|| {
            format!("at {t} s u {u:?}, alpha {a:?}, expected {:?}, {:?} within {most_u:e}, {most_alpha:e}", right.u, right.alpha)
        })
    })
}

files! {
    "golden": bilateral builtin changing full imperfect lining modal other_modes reference restitution rigid
    slope_friction
}

fn holds(name: &str) {
    let file = folder().join(name).with_extension("jsonl");
    let mut cases = read(&file);
    if std::env::var("RUBSCOPE_GOLDEN").is_ok_and(|word| word == "write") {
        cases.par_iter_mut().filter(|case| case.plain.is_none()).for_each(|case| {
            let (scene, changes) = parse(&case.scene);
            let plain = |scene: &Scene| by_steps(scene, true);
            case.plain = Some(measure(&scene, &changes, &plain));
            let events = |scene: &Scene| by_events(scene, &changes).unwrap();
            case.event = by_events(&scene, &changes).map(|_| measure(&scene, &changes, &events));
        });
        let lines = cases.iter().map(|case| serde_json::to_string(case).unwrap() + "\n");
        std::fs::write(file, lines.collect::<String>()).unwrap();
    }
    let wrong: Vec<String> = cases.par_iter().flat_map_iter(failures).collect();
    assert!(wrong.is_empty(), "{} differ:\n{}", wrong.len(), wrong.join("\n"));
}

fn failures(case: &Case) -> Vec<String> {
    let (scene, changes) = parse(&case.scene);
    let runs = [
        ("default", case.plain.as_ref(), Some(by_steps(&scene, false))),
        ("plain", case.plain.as_ref(), Some(by_steps(&scene, true))),
        ("event", case.event.as_ref(), by_events(&scene, &changes)),
    ];
    let (mut wrong, mut takes_every_step) = (Vec::new(), false);
    for (solver, expected, scene) in runs {
        let name = format!("{} by {solver}", case.name);
        match (expected, scene) {
            (Some(_), _) if solver == "plain" && takes_every_step => {}
            (Some(expected), Some(scene)) => {
                let times: Vec<f64> = expected.states.iter().map(|state| state.t_s).collect();
                let seen = see(&scene, &changes, Some(&times));
                takes_every_step = seen.skipped == Some(0);
                wrong.extend(difference(expected, &seen).map(|what| format!("{name}: {what}")));
            }
            (None, None) => {}
            (None, Some(_)) => wrong.push(format!("{name}: accepted, expected a refusal")),
            (Some(_), None) => wrong.push(format!("{name}: refused")),
        }
    }
    wrong
}
