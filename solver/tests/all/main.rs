//! Tests of the time solvers in one binary: it links once, and its tests share the cores.
//! One module is run by its name, as in `cargo test event_laws`; the first lines of each say
//! what it is for and how to add a case.
//!
//! Which module holds which solver to what; those of harmonic balance, of margins and of
//! maps, which the program's commands print, are in `tests` of the program. What some 360 scenes
//! come to, by every step taken and by events, is judged by the golden set there.
//!
//! | law | explicit | on a lining | events | harmonic balance |
//! |---|---|---|---|---|
//! | numbers of other codes | `cases` `explicit_tips` | `explicit_lining` | `theory` | `theory` `hbm_joined` `hbm_lining` |
//! | closed forms | `explicit` `explicit_tip_locks` | `lock_ends` | `event_cases` `event_hard` | `theory` `hbm_laws` `hbm_whirl` |
//! | plain stepping, or integration | `plain_stepper` `rebound` | `explicit_lining` `machine_in_time` | `live_event` `rebound` | `hbm_time` `hbm_excitation` |
//! | its order | `live_event` `rebound` | `explicit_lining` | `live_event` `explicit_tips` | |
//! | no pull, no energy made, mirrors | `motion_laws` | `motion_laws` | `event_laws` | `hbm_laws` |
//! | sizes of the disk agree | `cases` | `explicit_lining` | | |
//! | live changes | `live_random` | `motion_laws` | `live_event` `event_laws` | |
//! | hard cases, any input | `explicit_hard` `fuzz_cases` | `motion_laws` | `event_hard` `event_laws` | `hbm_lining_states` `hbm_branches` |
//! | verdicts, digits, flags | `verdicts` `certainty` `digits` `map_flags` | `explicit_lining` | `verdicts` `digits` | |
//! | the paper's bits | `scene_defaults` | | `scene_defaults` | |

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test states what must hold")]

use rubscope_solver::motion::{RunReport, Sampling, Script, run_to_end};
use rubscope_solver::scene::CheckedScene;

mod bounds;
mod cases;
mod certainty;
mod event_cases;
mod event_hard;
mod event_laws;
mod examples;
mod explicit;
mod explicit_hard;
mod explicit_lining;
mod explicit_tip_locks;
mod explicit_tips;
mod imperfect;
mod keys;
mod lasting_locks;
mod live_event;
mod live_random;
mod lock_ends;
mod machine_at_speed;
mod machine_in_time;
mod motion_laws;
mod pauses;
mod plain;
mod plain_stepper;
mod random;
mod rebound;
mod tips_support;
mod verdicts;

/// A value is what is expected, up to this difference.
#[track_caller]
fn close(value: f64, expected: f64, most: f64) {
    assert!((value - expected).abs() <= most, "{value:.12e} is not {expected:e}");
}

/// A scene run to its end once, without the changed runs that say how far to trust it.
fn run_once(scene: &CheckedScene) -> RunReport {
    run_to_end(scene, &Script::default(), Sampling::default(), &mut |_| {})
}
