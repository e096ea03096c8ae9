//! Steady states of blades and casing coupled by a lining, the smooth contact law (docs/theory.md,
//! section 10), their stability, and their thresholds. No time steps are taken.
//!
//! - `law`: the force law of a lining and its average over a wave ([`Lining`]).
//! - `rest`: rest under preload, its Hopf points over speed, and the coincidence shifted by the
//!   lining.
//! - `cycle`: limit cycles, in which growth from rest ends, and small motions about any wave.
//! - `forced`: response to an out-of-round casing with all blades in contact.
//! - `states`: steady states in the blade frame, the loads of a lock, and the softest lining that
//!   holds one.

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
