//! Frequency domain: steady states in the frame that rotates with the blades (docs/theory.md,
//! section 8).
//!
//! In that frame a locked motion is an equilibrium: the casing displacement is a point in a corner
//! of the `model::ContactPolygon`. One harmonic is therefore exact, and stability follows from
//! eigenvalues. There are no time steps and no initial conditions.
//!
//! - Equilibria with contact and the motion about them, the lock in the three forms of Eq. (27):
//!   `held`; for a list of speeds `corner`, `locked` ([`locked_motion`], [`lock_loads`]).
//! - All equilibria and their thresholds: `equilibria`.
//! - Slip as a map from corner to corner: `slip`.
//! - Coincidences and engine-order excitation: `coincidence`, `excitation`.
//! - Ranges of speed with a lock or with flutter (section 10): `windows`; with whirl or with growth
//!   without bound, in the limit of many blades: `round_whirl`; all of them for one machine:
//!   `speed_ranges`.
//! - Steady states on a lining: `lining`.
//! - Roundness of the casing that a lock needs (section 11): `roundness`.

mod coincidence;
mod corner;
mod equilibria;
mod error;
mod excitation;
mod held;
mod lining;
mod locked;
mod round_whirl;
mod roundness;
mod slip;
mod speed_ranges;
mod windows;

pub use coincidence::{
    Campbell, Coincidence, CoincidencePoint, Line, coincidence, shifted_coincidence,
};
pub use corner::{Corner, PAPER_PAIR};
pub use equilibria::{
    Branches, Character, Equilibrium, GroupContact, Kind, Threshold, equilibria, equilibrium,
};
pub use excitation::{ExcitedLock, drives, excited_locks};
pub use held::Form;
pub use lining::{
    Cycle, Forced, GroupPush, HopfPoint, LeastStiffness, Lining, LiningState, Rest, RestRoot,
    growth_threshold, least_lock_stiffness,
};
pub use locked::{LockLoads, Locked, LockedPoint, Sweep, lock_loads, locked_motion};
pub use round_whirl::{
    RoundWhirl, RoundWhirlLoads, Rubbing, has_one_wave, round_whirls, whirl_spans,
};
pub(crate) use roundness::lobes_of;
pub use roundness::{roundness, roundness_needed};
pub use slip::{NoSlip, SlipLimit, SlipOrbit, SlipPoint, slip_limits, slip_over};
pub use speed_ranges::{SpeedRanges, lock_window, lock_windows};
pub use windows::{Locks, flutters, joined_grow, lock_growth, undamped_flutter_speed};
