//! Blades and casing joined by a lining, the smooth contact law
//! (docs/theory.md, section 10): steady states, their stability, and what they do as a
//! parameter changes. Small motions of one wave of all blades; no time step.
//!
//! - the law and its mean over a wave: `law` ([`Lining`]), `share`
//! - rest under preload: `roots`, its Hopf points in speed and the coincidence that the
//!   lining shifts: `hopf`; where its growth ends: `cycle`
//! - waves that stand in the frame of the blades: `equilibria`; which linings hold a
//!   lock: `window`, what it takes: `loads`; followed over a parameter: `continuation`,
//!   `followed`
//! - eigenvalues about all of them: `flow`

mod continuation;
mod cycle;
mod equilibria;
mod flow;
mod followed;
mod hopf;
mod law;
mod loads;
mod roots;
mod share;
mod window;

pub use continuation::follow;
pub use cycle::{Cycle, Whirl};
pub use equilibria::{GroupPush, LiningState};
pub use followed::{BranchEnd, BranchPoint, FollowedBranch, Special};
pub use hopf::{GrowthThreshold, HopfPoint, ShiftedCoincidence, growth_threshold};
pub use law::Lining;
pub(super) use loads::lock_loads;
pub use roots::{Rest, RestRoot};
pub use window::{LeastStiffness, least_lock_stiffness};
