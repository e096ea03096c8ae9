//! Blades and casing joined by a lining, the smooth contact law
//! (docs/theory.md, section 10): steady states, their stability, and what they do as a
//! parameter changes. Small motions of one wave of all blades; no time step.
//!
//! - the law and its mean over a wave: `law` ([`Lining`])
//! - rest under preload, its Hopf points in speed and the coincidence that the lining
//!   shifts: `rest`; where its growth ends, and small motions about any wave: `cycle`
//! - waves that stand in the frame of the blades, what a lock takes and which linings hold
//!   one: `states`

mod cycle;
mod forced;
mod law;
mod rest;
mod states;

pub use cycle::Cycle;
pub use forced::Forced;
pub use law::Lining;
pub use rest::{HopfPoint, LeastStiffness, growth_threshold};
pub use rest::{Rest, RestRoot};
pub use states::least_lock_stiffness;
pub(super) use states::lock_loads;
pub use states::{GroupPush, LiningState};
