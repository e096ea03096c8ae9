//! Tests of the program in one binary: it links once, and its tests share the cores. One
//! module is run by its name, as in `cargo test tui_zoom`. Those of the time solvers are in
//! `solver/tests`, where they are optimised as the solver is.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test states what must hold")]

use std::path::{Path, PathBuf};

use rubscope_solver::motion::{RunReport, Sampling, Script, run_to_end};
use rubscope_solver::scene::CheckedScene;

/// A test for each table in a folder of `tests`, and one that none is left out.
macro_rules! files {
    ($folder:literal: $($name:ident)*) => {
        $(#[test] fn $name() { holds(stringify!($name)); })*

        #[test]
        fn every_file_is_run() {
            assert_eq!(crate::tables($folder), [$(stringify!($name)),*]);
        }
    };
}

mod cli_figures;
mod cli_script;
mod cli_support;
mod dependencies;
mod digits;
mod docs;
mod file_names;
mod file_places;
mod file_signals;
mod file_writer;
mod fuzz_cases;
mod fuzz_keys;
mod fuzz_laws;
mod golden;
mod golden_outputs;
mod hbm_branches;
mod hbm_coincidence;
mod hbm_excitation;
mod hbm_joined;
mod hbm_laws;
mod hbm_lining;
mod hbm_lining_states;
mod hbm_locked;
mod hbm_slip;
mod hbm_time;
mod hbm_whirl;
mod house;
mod lesson_values;
mod map_flags;
mod map_signals;
mod map_zone;
mod margins;
mod margins_changes;
mod margins_odd;
mod own_machine;
mod pty;
mod pty_bursts;
mod pty_config;
mod pty_signals;
mod pty_support;
mod python;
#[path = "../../solver/tests/all/random.rs"]
mod random;
mod readme;
mod scene_defaults;
mod scene_modes;
mod screens;
mod security;
mod signs_of_life;
mod soak;
mod stepwise;
mod survey;
mod theory;
mod transcripts;
mod tui_help;
mod tui_hostile;
mod tui_keys;
mod tui_knobs;
mod tui_lessons;
mod tui_lines;
mod tui_loop;
mod tui_map;
mod tui_margins;
mod tui_mouse;
mod tui_random;
mod tui_scenes;
mod tui_screens;
mod tui_support;
mod tui_time;
mod tui_zoom;
mod version;

/// A value is what is expected, up to this part of it.
#[track_caller]
fn close(value: f64, expected: f64, part: f64) {
    assert!((value - expected).abs() <= part * expected.abs(), "{value:e} is not {expected:e}");
}

/// The same up to this difference.
#[track_caller]
fn near(value: f64, expected: f64, most: f64) {
    assert!((value - expected).abs() <= most, "{value:e} is not {expected:e}");
}

/// A built-in scene with some keys set.
fn scene(name: &str, changes: &[(&str, &str)]) -> CheckedScene {
    rubscope_solver::scene::Scene::builtin(name).unwrap().with(changes).unwrap()
}

/// What the program prints of a run.
fn told(report: &RunReport) -> String {
    use rubscope::sheet::{CommandLine, sentence::Facts, summary::lines};
    let command = CommandLine::new("run", &report.scene);
    lines(report, Default::default(), &Facts::of(report), command).join("\n")
}

/// A scene run to its end once, without the changed runs that say how far to trust it.
fn run_once(scene: &CheckedScene) -> RunReport {
    run_to_end(scene, &Script::default(), Sampling::default(), &mut |_| {})
}

/// A table of tests by its folder and its name.
fn table(folder: &str, name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(folder).join(format!("{name}.txt"))
}

/// The names of the tables in a folder.
fn tables(folder: &str) -> Vec<String> {
    let files = std::fs::read_dir(table(folder, "").parent().unwrap()).unwrap();
    let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names
        .filter_map(|name| Some(name.strip_suffix(".txt").or(name.strip_suffix(".jsonl"))?.into()))
        .collect();
    names.sort();
    names
}
