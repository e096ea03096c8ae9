//! Time domain: solvers that compute the motion of a scene, the contact record they share, and the
//! verdict on the motion.
//!
//! A solver contains its whole state: `advance(until)` continues the motion, `fork` copies it, and
//! nothing is global.
//!
//! Order in which to read: `solver` (the common interface), `drive` and `contacts` (shared types),
//! one kind of solver (`explicit` or `event`), then `run` with `script`, `wave`, `lasting`, `verdict`,
//! `report` and `sensitivity`: a whole run, its verdict, and whether a tiny change alters it.

mod contacts;
mod drive;
mod event;
mod explicit;
mod failure;
mod lasting;
mod plane;
mod point;
mod propagator;
mod report;
mod run;
mod script;
mod sensitivity;
mod solver;
pub mod verdict;
mod wave;

use contacts::Ledger;
pub use contacts::{ActiveSet, ContactLog, EnergyAccount, Hold, Impact, in_phase_order};
pub use drive::{Pulse, Rotor, State};
pub(crate) use event::EVENT;
pub use event::Events;
pub use failure::{Failure, FailureReason};
use plane::{Plane, across, dot, size, turned};
pub use propagator::FreeFlight;
pub use report::{
    FinalState, ImpactReport, LAST_PART, RunReport, Seen, SolverReport, VerdictReached, judge_end,
    verdict_of,
};
pub use run::{Sample, Sampling, run_to_end, run_to_verdict, simulate};
pub use script::{Change, Script, Scripted};
pub use sensitivity::{Certainty, Spread, certainty, run_with_certainty};
pub use solver::{GoOn, Motion, Solver, to_the_end};
pub use verdict::{Basis, Checks, Contact, Outcome, Proof, Verdict};
