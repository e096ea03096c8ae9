//! Blade-tip/casing rub of a flexible bladed disk in a flexible casing, after
//! Legrand, Pierre and Peseux (2010).
//!
//! Dependencies point one way: `cli` and `tui` use `report` and `study`, these
//! use `motion` (time domain) and `harmonic` (frequency domain), these use
//! `contact`, and all use `model`. A `scene` defines what to solve and how. The
//! modules below `cli` and `tui` do not use a terminal and print nothing.
//!
//! ```
//! use rubscope::motion::{Verdict, simulate};
//! use rubscope::scene::Scene;
//!
//! let mut scene = Scene::builtin("paper-nd3")?; // equality contact, 1 MN
//! let report = simulate(&scene.checked()?);
//! assert_eq!(report.outcome.verdict, Verdict::Locked);
//! scene.set("solver.contact", "unilateral")?; // contact that may only push
//! let report = simulate(&scene.checked()?);
//! assert_eq!(report.outcome.verdict, Verdict::Decay);
//! # Ok::<(), rubscope::scene::SceneError>(())
//! ```

pub mod cli;
pub mod contact;
pub mod harmonic;
pub mod model;
pub mod motion;
pub mod report;
pub mod scene;
pub mod study;
mod tolerances;
pub mod tui;
