//! Blade-tip/casing rub of a flexible bladed disk in a flexible casing, after
//! Legrand, Pierre and Peseux (2010).
//!
//! Dependencies point one way: `cli` and `tui` use `report` and `study`, these
//! use `motion` (time domain) and `harmonic` (frequency domain), these use
//! `contact`, and all use `model`, which knows only `numeric`. A `scene` says what to solve and how.
//! Everything below `cli` and `tui` knows no terminal and prints nothing; without
//! the features `cli` and `explorer` the crate is that part alone.
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

#[cfg(feature = "cli")]
pub mod cli;
pub mod contact;
pub mod file;
pub mod harmonic;
pub mod model;
pub mod motion;
mod numeric;
#[cfg(feature = "report")]
pub mod report;
pub mod scene;
pub mod study;

mod tolerances;
#[cfg(feature = "explorer")]
pub mod tui;
