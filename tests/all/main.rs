//! All tests in one program: it links once, and its tests share the cores. One
//! module is run by its name, as in `cargo test event_laws`.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test states what must hold")]

use proptest::prelude::ProptestConfig;

mod beyond_defaults;
mod beyond_events;
mod beyond_explicit;
mod beyond_laws;
mod beyond_locks;
mod beyond_random;
mod beyond_scenes;
mod beyond_smooth;
mod beyond_support;
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
mod event_modal;
mod examples;
mod explicit;
mod explicit_hard;
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
mod order;
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
mod scene_notes;
mod scenes;
mod security;
mod signs_of_life;
mod sliding;
mod soak;
mod soft_locks;
mod theory;
mod tui_beyond;
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
mod tui_zoom;
mod verdicts;
mod version;

/// The number of random cases of a law; `PROPTEST_CASES` overrides it.
fn drawn(cases: u32) -> ProptestConfig {
    let given = ProptestConfig::default();
    let cases = if std::env::var_os("PROPTEST_CASES").is_some() { given.cases } else { cases };
    ProptestConfig { cases, failure_persistence: None, max_shrink_iters: 200, ..given }
}
