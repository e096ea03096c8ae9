| leaps are steps | `shortcuts` `sliding` `soft_locks`//! Tests of the time solvers in one binary: it links once, and its tests share the cores.
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! One module is run by its name, as in `cargo test event_laws`.
| leaps are steps | `shortcuts` `sliding` `soft_locks`//!
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! Which module holds which solver to what; those of harmonic balance, of margins and of
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! maps, which the program's commands print, are in `tests` of the program.
| leaps are steps | `shortcuts` `sliding` `soft_locks`//!
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! | law | explicit | on a lining | events, exact | events, linear | harmonic balance |
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! |---|---|---|---|---|---|
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! | numbers of other codes | `cases` `explicit_tips` | `explicit_lining` | `event_cases` | `event_linear` | `hbm_locked` `hbm_slip` `hbm_joined` `hbm_lining` |
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! | closed forms | `explicit` `explicit_tip_locks` | `lock_ends` | `event_cases` | `event_linear` | `theory` `hbm_laws` `hbm_whirl` |
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! | plain stepping, or integration | `plain_stepper` `rebound` | `explicit_lining` | `event_modal` | `rebound` | `hbm_time` `hbm_excitation` |
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! | its order | `order` `rebound` | `explicit_lining` | `order` | `explicit_tips` | |
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! | leaps are steps | `sliding` `soft_locks` `plain_stepper` | | | | |
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! | no pull, no energy made, mirrors | `motion_laws` | `motion_laws` | `event_laws` | `event_linear_laws` | `hbm_laws` |
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! | sizes of the disk agree | `full_disk` | `explicit_lining` | | | |
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! | live changes | `live_changes` `live_random` | `motion_laws` | `live_event` | `event_linear_laws` | |
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! | hard cases, any input | `explicit_hard` `fuzz_cases` | `motion_laws` | `event_hard` | `event_linear_laws` | `hbm_lining_states` `hbm_branches` |
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! | verdicts, digits, flags | `verdicts` `digits` `map_flags` | `explicit_lining` | `verdicts` `digits` | `event_linear` | |
| leaps are steps | `shortcuts` `sliding` `soft_locks`//! | the paper's bits | `scene_defaults` | | `scene_defaults` | | |
| leaps are steps | `shortcuts` `sliding` `soft_locks`
| leaps are steps | `shortcuts` `sliding` `soft_locks`#![expect(clippy::unwrap_used, clippy::panic, reason = "a test states what must hold")]
| leaps are steps | `shortcuts` `sliding` `soft_locks`
| leaps are steps | `shortcuts` `sliding` `soft_locks`use proptest::prelude::ProptestConfig;
| leaps are steps | `shortcuts` `sliding` `soft_locks`use rubscope_solver::motion::{RunReport, Sampling, Script, run_to_end};
| leaps are steps | `shortcuts` `sliding` `soft_locks`use rubscope_solver::scene::CheckedScene;
| leaps are steps | `shortcuts` `sliding` `soft_locks`
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod bounds;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod cases;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod event_cases;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod event_hard;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod event_laws;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod event_linear;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod event_linear_laws;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod event_modal;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod examples;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod explicit;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod explicit_hard;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod explicit_lining;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod explicit_tip_locks;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod explicit_tips;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod full_disk;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod live_changes;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod live_event;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod live_random;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod lock_ends;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod machine_at_speed;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod machine_in_time;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod motion_laws;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod order;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod pauses;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod plain;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod plain_self;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod plain_stepper;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod rebound;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod shortcuts;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod sliding;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod soft_locks;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod tips_support;
| leaps are steps | `shortcuts` `sliding` `soft_locks`mod verdicts;
| leaps are steps | `shortcuts` `sliding` `soft_locks`
| leaps are steps | `shortcuts` `sliding` `soft_locks`/// The number of random cases of a law; `PROPTEST_CASES` overrides it.
| leaps are steps | `shortcuts` `sliding` `soft_locks`fn drawn(cases: u32) -> ProptestConfig {
| leaps are steps | `shortcuts` `sliding` `soft_locks`    let given = ProptestConfig::default();
| leaps are steps | `shortcuts` `sliding` `soft_locks`    let cases = if std::env::var_os("PROPTEST_CASES").is_some() { given.cases } else { cases };
| leaps are steps | `shortcuts` `sliding` `soft_locks`    ProptestConfig { cases, failure_persistence: None, max_shrink_iters: 200, ..given }
| leaps are steps | `shortcuts` `sliding` `soft_locks`}
| leaps are steps | `shortcuts` `sliding` `soft_locks`
| leaps are steps | `shortcuts` `sliding` `soft_locks`/// A scene run to its end once, without the changed runs that say how far to trust it.
| leaps are steps | `shortcuts` `sliding` `soft_locks`fn run_once(scene: &CheckedScene) -> RunReport {
| leaps are steps | `shortcuts` `sliding` `soft_locks`    run_to_end(scene, &Script::default(), Sampling::default(), &mut |_| {})
| leaps are steps | `shortcuts` `sliding` `soft_locks`}
