//! Time domain: solvers that advance the motion of one scene, the record of
//! contacts they share, and the verdict on how the motion lasts.
//!
//! A solver is a value that holds its whole state: `advance(until)` moves it
//! on, `clone` forks it, nothing is global.

mod contacts;
mod drive;
mod event;
pub mod explicit;
mod kernel;
mod run;
mod script;
mod sensitivity;
mod solver;
pub mod verdict;
mod wave;

pub use contacts::{ContactLog, Impact, Touching, in_phase_order};
pub use drive::{Failure, Pulse, Rotor, State};
pub use event::Event;
pub use explicit::can_adopt;
pub use run::{
    FinalState, ImpactReport, RunReport, Sample, Sampling, Settled, SolverReport, settle, simulate,
    simulate_with, verdict_of,
};
pub use script::{Change, Script};
pub use sensitivity::{is_sensitive, is_sensitive_with};
pub use solver::Motion;
pub use verdict::{Checks, Contact, Outcome, Verdict};
