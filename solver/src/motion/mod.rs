//! Time domain: solvers that advance the motion of one scene, the record of
//! contacts they share, and the verdict on how the motion lasts.
//!
//! A solver is a value that holds its whole state: `advance(until)` moves it
//! on, `clone` forks it, nothing is global.
//!
//! Read `solver` (what every solver offers), `drive` and `contacts` (what they share), then
//! one kind of solver (`explicit` or `event`), then `run` with `script`, `wave`, `verdict` and
//! `sensitivity`: a whole run, and whether a tiny change makes another of it.

mod contacts;
mod drive;
mod event;
mod explicit;
mod failure;
mod point;
mod propagator;
mod run;
mod script;
mod sensitivity;
mod solver;
pub mod verdict;
mod wave;

pub use contacts::{ActiveSet, ContactLog, EnergyAccount, Hold, Impact, in_phase_order};
pub use drive::{Pulse, Rotor, State};
pub use event::{ExactEvents, LinearEvents};
pub use failure::{Failure, FailureReason};
pub use propagator::FreeFlight;
pub use run::{
    FinalState, ImpactReport, RunReport, Sample, Sampling, SolverReport, VerdictReached, Watch,
    caught_at, judge_end, lock_that_broke, run_to_end, run_to_verdict, simulate, verdict_of,
};
pub use script::{Change, Script};
pub use sensitivity::{CHANGED_RUNS, Certainty, Spread, certainty, run_with_certainty};
pub use solver::{GoOn, Motion, Solver, to_the_end};
pub use verdict::{Basis, Checks, Contact, Outcome, Proof, Verdict};

/// A point or vector of the plane of the two casing coordinates.
type Plane = nalgebra::Complex<f64>;
