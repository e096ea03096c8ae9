//! Blade-tip/casing rub of a flexible bladed disk in a flexible casing, after
//! Legrand, Pierre and Peseux (2010).
//!
//! Begin with a [`scene::Scene`]: a built-in one, a file ([`scene::Scene::load`]), or your own
//! machine from a table of modes ([`scene::read_modes`], [`scene::ModalData::to_toml`],
//! [`scene::Scene::from_toml`]). [`scene::Scene::checked`] refuses what cannot be solved, and
//! names it; all below takes what it returns, which is a scene, too.
//!
//! | to find | ask |
//! |---|---|
//! | frequencies, critical and coincidence speeds | [`model::Machine`] |
//! | how a run ends, and whether a tiny change ends otherwise | [`motion::simulate`] |
//! | only how it ends | [`motion::run_to_verdict`], with [`motion::to_the_end`] |
//! | the state on the way, with changes of speed, pulse and damping | [`motion::Motion`] |
//! | the locked motion against speed | [`harmonic::locked_motion`] of [`scene::Scene::machine`] |
//! | slip, whirl, flutter, rest on a lining | [`harmonic`] |
//! | verdicts over two parameters | [`study::MapPlan::compute`] a cell, [`study::Map::fill`] all |
//! | the distance to every limit, and what moves it | [`study::margins::Margins::of`] |
//! | the nearest changes of a verdict | [`study::margins::Margins::ask_runs`] |
//! | another clearance | [`scene::Scene::set_clearance`]; all keys: [`scene::Scene::set`] |
//! | every number of nodal diameters | [`study::survey::Survey::of`] |
//!
//! Units are SI. A multiplier is negative where the contact pushes. The package's `examples`
//! are whole programs; `docs/theory.md` has the equations that are cited by number. Nothing
//! here knows a terminal, prints, or formats a report: the package `rubscope` does. Errors may get
//! new cases (`non_exhaustive`); a `match` on a verdict, a law or a solver is whole, so that the
//! compiler names what another version has more.
//!
//! ```
//! use rubscope_solver::motion::{Verdict, simulate};
//! use rubscope_solver::scene::Scene;
//!
//! let mut scene = Scene::builtin("paper-nd3")?; // equality contact, 1 MN
//! let report = simulate(&scene.checked()?);
//! assert_eq!(report.outcome.verdict, Verdict::Locked);
//! scene.set("solver.contact", "unilateral")?; // contact that may only push
//! let report = simulate(&scene.checked()?);
//! assert_eq!(report.outcome.verdict, Verdict::Decay);
//! # Ok::<(), rubscope_solver::scene::SceneError>(())
//! ```

pub mod harmonic;
pub mod model;
pub mod motion;
pub mod numeric;
pub mod scene;
pub mod study;
pub mod tolerances;
