//! Blade-tip/casing rub of a flexible bladed disk in a flexible casing, after Legrand, Pierre and
//! Peseux (2010).
//!
//! Start with a [`scene::Scene`]: a built-in one, a file ([`scene::Scene::load`]), or a text in
//! the same form with your own machine and its modes ([`scene::Scene::from_toml`]). [`scene::Scene::checked`] validates it: the error names the key
//! that is wrong, and the result dereferences to the scene and is the input of everything below.
//!
//! | to compute | use |
//! |---|---|
//! | frequencies, critical and coincidence speeds | [`model::Machine`] |
//! | the verdict of a run, and whether a tiny change alters it | [`motion::simulate`] |
//! | the verdict alone | [`motion::run_to_verdict`], with [`motion::to_the_end`] |
//! | the state step by step, with changes of speed, pulse and damping | [`motion::Motion`] |
//! | the locked motion against speed | [`harmonic::locked_motion`] of [`scene::Scene::machine`] |
//! | slip, whirl, flutter, rest on a lining | [`harmonic`] |
//! | verdicts over two parameters | [`study::MapPlan::compute`] (one cell), [`study::Map::fill`] (all) |
//! | the distance to every limit, and its sensitivities | [`study::margins::Margins::of`] |
//! | the nearest changes that alter a verdict | [`study::margins::Margins::ask_runs`] |
//! | another clearance, or any other key | [`scene::Scene::set_clearance`], [`scene::Scene::set`] |
//! | every number of nodal diameters | [`study::survey::Survey::of`] |
//!
//! Units are SI. A multiplier is negative where the contact pushes. The package's `examples` are
//! complete programs; `docs/theory.md` contains the equations that comments cite by number. This
//! crate prints nothing and formats no reports: that is the package `rubscope`. Error types can
//! gain variants (`non_exhaustive`). Verdicts, laws and solvers are exhaustive enums, so that the
//! compiler reports a `match` that lacks a variant of a newer version.
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
