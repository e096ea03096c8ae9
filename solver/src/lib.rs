//! Blade-tip/casing rub of a flexible bladed disk in a flexible casing, after Legrand, Pierre and
//! Peseux (2010).
//!
//! A complete program: it runs a scene, varies the clearance, and stops each run on a condition of
//! its own.
//!
//! ```
//! use rubscope_solver::motion::{ActiveSet, Motion, simulate};
//! use rubscope_solver::scene::{Scene, SceneError};
//!
//! /// Returns whether one corner has held the wave for a millisecond.
//! fn is_caught(motion: &Motion) -> bool {
//!     let contacts = motion.contacts();
//!     let in_corner = matches!(contacts.active_set, ActiveSet::Corner(..));
//!     in_corner && motion.t_s() - contacts.since >= 1e-3
//! }
//!
//! fn main() -> Result<(), SceneError> {
//!     let mut scene = Scene::builtin("paper-nd3")?;
//!     println!("{}", simulate(&scene.checked()?).outcome.verdict); // locked
//!
//!     for clearance_um in [50.0, 100.0, 400.0] {
//!         scene.set_clearance(1e-6 * clearance_um)?;
//!         let checked = scene.checked()?; // the error names the key that is wrong
//!         let mut motion = Motion::new(&checked);
//!         while !is_caught(&motion) && motion.t_s() < 0.05 {
//!             let until = motion.t_s() + 1e-4;
//!             if let Err(failure) = motion.advance(until) {
//!                 println!("{failure}");
//!                 break;
//!             }
//!         }
//!         let state = motion.state();
//!         println!("{clearance_um} um: {} s, {} m", state.t_s, state.amplitude());
//!     }
//!     Ok(())
//! }
//! ```
//!
//! A [`scene::Scene`] contains all inputs. It is built in, read from a file
//! ([`scene::Scene::load`]), or from a text in the same format ([`scene::Scene::from_toml`]); it can
//! describe your own machine and its modes.
//! [`scene::Scene::set`] changes any key. [`scene::Scene::checked`] validates the scene; its result
//! is the input of everything below.
//!
//! | to compute | use |
//! |---|---|
//! | frequencies, critical and coincidence speeds | [`model::Machine`] |
//! | the verdict of a run, and whether a tiny change alters it | [`motion::simulate`] |
//! | the verdict alone | [`motion::run_to_verdict`], with [`motion::to_the_end`] |
//! | the motion in time, with changes of speed, pulse and damping | [`motion::Motion`] |
//! | the locked motion against speed | [`harmonic::locked_motion`] of [`scene::Scene::machine`] |
//! | slip, whirl, flutter, rest on a lining | [`harmonic`] |
//! | verdicts over two parameters | [`study::MapPlan::compute`] (one cell), [`study::Map::fill`] (all) |
//! | the distance to every limit, and its sensitivities | [`study::margins::Margins::of`] |
//! | the nearest changes that alter a verdict | [`study::margins::Margins::ask_runs`] |
//! | another clearance, or any other key | [`scene::Scene::set_clearance`], [`scene::Scene::set`] |
//! | every number of nodal diameters | [`study::survey::Survey::of`] |
//!
//! Units are SI. A negative multiplier pushes, a positive one pulls. The folder `examples` of this
//! package has more complete programs. Comments cite equations by section of `docs/theory.md`. This
//! crate prints nothing and formats no reports; the package `rubscope` does. Error types can gain
//! variants (`non_exhaustive`). Verdicts, laws and solvers are exhaustive enums: the compiler
//! reports every `match` that lacks a newly added variant.

// The program of the README is a test too.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod harmonic;
pub mod model;
pub mod motion;
pub mod numeric;
pub mod scene;
pub mod study;
