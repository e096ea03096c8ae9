//! Frequency domain: steady states of the frame that turns with the blades
//! (docs/theory.md, section 8).
//!
//! In that frame a locked motion is an equilibrium: the wave is a point in a
//! corner of the `model::ContactPolygon`, one harmonic is exact, and stability
//! needs only eigenvalues. There is no time step and no initial condition.
//!
//! - the lock, Eq. (27) in three forms: `corner`, `equations`, `locked`
//!   ([`locked_motion`], [`lock_loads`]); very soft blades: `corner_angle`
//! - every equilibrium, its stability and thresholds: `equilibria`, `stability`
//! - slip as a map: `slip`
//! - coincidences and excitation: `coincidence`, `excitation`
//! - blades and casing as one (section 10), the speeds at which their lock flutters, and those
//!   at which a lock holds: `joint`; the whirl in the limit of many
//!   blades: `round_whirl`; on a lining: `lining`

mod coincidence;
mod corner;
mod corner_angle;
mod equations;
mod equilibria;
mod error;
mod excitation;
mod joint;
mod lining;
mod locked;
mod round_whirl;
mod roundness;
mod slip;
mod stability;

pub use coincidence::{
    Campbell, Coincidence, CoincidencePoint, Line, coincidence, shifted_coincidence,
};
pub use corner::{Corner, PAPER_PAIR};
pub use equations::Form;
pub use equilibria::{
    Branches, Character, Equilibrium, GroupContact, Kind, Threshold, equilibria, equilibrium,
};
pub use error::HarmonicError;
pub use excitation::{ExcitedLock, ExcitedLocks, drives};
pub use joint::{
    Joint, flutter_speed, flutters, lock_growth, lock_roots, lock_window, lock_windows,
    undamped_flutter_speed,
};
pub use lining::{
    Cycle, Forced, GroupPush, HopfPoint, LeastStiffness, Lining, LiningState, Rest, RestRoot,
    growth_threshold, least_lock_stiffness,
};
pub use locked::{LockLoads, Locked, LockedPoint, Sweep, lock_loads, locked_motion};
pub use round_whirl::{
    RoundWhirl, RoundWhirlLoads, WhirlOnset, round_whirls, whirl_beginnings, whirl_onset,
    whirl_onsets,
};
pub(crate) use roundness::lobes_of;
pub use roundness::{roundness, roundness_needed};
pub use slip::{NoSlip, SlipLimit, SlipOrbit, SlipPoint, slip_limits, slip_over};
