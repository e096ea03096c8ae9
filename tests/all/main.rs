//! All tests in one program: it links once, and its tests share the cores. One
//! module is run by its name, as in `cargo test event_laws`.
//!
//! Which module holds which solver to what; the modules in no row are those of the
//! command line (`cli_*`, `map_*`, `margins_*`), the explorer (`tui_*`, `pty*`), files
//! and pages.
//!
//! | law | explicit | on a lining | events, exact | events, linear | harmonic balance |
//! |---|---|---|---|---|---|
//! | numbers of other codes | `cases` `explicit_tips` | `explicit_lining` | `event_cases` | `event_linear` | `hbm_locked` `hbm_slip` `hbm_joined` `hbm_lining` |
//! | closed forms | `explicit` `explicit_tip_locks` | `lock_ends` | `event_cases` | `event_linear` | `theory` `hbm_laws` `hbm_whirl` |
//! | plain stepping, or integration | `plain_stepper` `rebound` | `explicit_lining` | `event_modal` | `rebound` | `hbm_time` `hbm_excitation` |
//! | its order | `order` `rebound` | `explicit_lining` | `order` | `explicit_tips` | `hbm_fold` |
//! | leaps are steps | `sliding` `soft_locks` `plain_stepper` | | | | |
//! | no pull, no energy made, mirrors | `motion_laws` | `motion_laws` | `event_laws` | `event_linear_laws` | `hbm_laws` |
//! | sizes of the disk agree | `full_disk` | `explicit_lining` | | | |
//! | live changes | `live_changes` `live_random` | `motion_laws` | `live_event` | `event_linear_laws` | |
//! | hard cases, any input | `explicit_hard` `fuzz_cases` | `motion_laws` | `event_hard` | `event_linear_laws` | `hbm_lining_states` `hbm_branches` |
//! | verdicts, digits, flags | `verdicts` `digits` `map_flags` | `explicit_lining` | `verdicts` `digits` | `event_linear` | |
//! | the paper's bits | `scene_defaults` | | `scene_defaults` | | |

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test states what must hold")]

use proptest::prelude::ProptestConfig;
use rubscope_solver::motion::{RunReport, Sampling, Script, run_to_end};
use rubscope_solver::scene::CheckedScene;

mod bounds;
mod cases;
mod cli_figures;
mod cli_limits;
mod cli_margins;
mod cli_margins_page;
mod cli_precision;
mod cli_program;
mod cli_run;
mod cli_scene;
mod cli_script;
mod cli_support;
mod dependencies;
mod digits;
mod docs;
mod event_cases;
mod event_hard;
mod event_laws;
mod event_linear;
mod event_linear_laws;
mod event_modal;
mod examples;
mod explicit;
mod explicit_hard;
mod explicit_lining;
mod explicit_tip_locks;
mod explicit_tips;
mod file_places;
mod file_signals;
mod file_writer;
mod full_disk;
mod fuzz_cases;
mod fuzz_keys;
mod fuzz_laws;
mod hbm_branches;
mod hbm_cli;
mod hbm_coincidence;
mod hbm_excitation;
mod hbm_fold;
mod hbm_joined;
mod hbm_laws;
mod hbm_lining;
mod hbm_lining_states;
mod hbm_locked;
mod hbm_slip;
mod hbm_support;
mod hbm_time;
mod hbm_whirl;
mod house;
mod lesson_values;
mod live_changes;
mod live_event;
mod live_random;
mod lock_ends;
mod machine_at_speed;
mod machine_in_time;
mod map_adaptive;
mod map_cli;
mod map_flags;
mod map_hostile;
mod map_locks;
mod map_parts;
mod map_signals;
mod map_zone;
mod margins;
mod margins_command;
mod margins_joined;
mod margins_odd;
mod motion_laws;
mod order;
mod own_machine;
mod pauses;
mod plain;
mod plain_self;
mod plain_stepper;
mod pty;
mod pty_bursts;
#[cfg(unix)]
mod pty_config;
mod pty_signals;
#[cfg(unix)]
mod pty_support;
mod python;
mod readme;
mod rebound;
mod scene_defaults;
mod scene_modes;
mod scene_notes;
mod scene_numbers;
mod scenes;
mod security;
mod shortcuts;
mod signs_of_life;
mod sliding;
mod soak;
mod soft_locks;
mod survey;
mod theory;
mod tips_support;
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
mod tui_presentation;
mod tui_random;
mod tui_scenes;
mod tui_screens;
mod tui_support;
mod tui_time;
mod tui_tips;
mod tui_zoom;
mod verdicts;
mod version;

/// The number of random cases of a law; `PROPTEST_CASES` overrides it.
fn drawn(cases: u32) -> ProptestConfig {
    let given = ProptestConfig::default();
    let cases = if std::env::var_os("PROPTEST_CASES").is_some() { given.cases } else { cases };
    ProptestConfig { cases, failure_persistence: None, max_shrink_iters: 200, ..given }
}

/// A scene run to its end once, without the changed runs that say how far to trust it.
fn run_once(scene: &CheckedScene) -> RunReport {
    run_to_end(scene, &Script::default(), Sampling::default(), &mut |_| {})
}
