//! Frequency domain: steady states of the frame that turns with the blades
//! (docs/theory.md, section 8).
//!
//! In that frame a locked motion is an equilibrium: the wave is a point in a
//! corner of the `model::ContactPolygon`, one harmonic is exact, and stability
//! needs only eigenvalues. There is no time step and no initial condition.
//!
//! - the lock, Eq. (27) in three forms: `equations`, `newton`, `locked`
//!   ([`locked_motion`]); its loads and the end of its branch, with their
//!   derivatives: `lock_loads`
//! - every equilibrium, its stability and thresholds: `equilibria`, `stability`,
//!   `branches`; very soft blades: `corner_angle`, `fold`
//! - slip as a map and its Fourier series: `saddle_flow`, `slip`, `spectrum`
//! - blades and casing as one: `joint`; their lock: `joined_lock`, `joined_stability`,
//!   and the speed from which it flutters: `flutter`; the whirl on a rim of many blades and the speed
//!   where it begins: `rim`, `onset`; on the polygon: `whirl`, `whirl_arc`
//! - coincidences and excitation: `campbell`, `excitation`
//! - blades and casing joined (section 10): `joint`; on a lining: `lining`;
//!   what a coincidence does against speed: `coincidence`

mod branches;
mod campbell;
mod coincidence;
mod configuration;
mod corner;
mod corner_angle;
mod equations;
mod equilibria;
mod error;
mod excitation;
mod flutter;
mod fold;
mod form;
mod joined_lock;
mod joined_stability;
mod joint;
mod lining;
mod lock_loads;
mod locked;
mod newton;
mod onset;
mod rim;
mod saddle_flow;
mod slip;
mod spectrum;
mod stability;
mod whirl;
mod whirl_arc;

pub use branches::{Branches, Threshold};
pub use campbell::{Campbell, Coincidence, Line};
pub use coincidence::{CoincidencePoint, coincidence, shifted_coincidence};
pub use corner::{Corner, PAPER_PAIR};
pub use equilibria::{Character, Equilibrium, GroupContact, Kind, equilibria, equilibrium};
pub use error::HarmonicError;
pub use excitation::{ExcitedLock, ExcitedLocks, drives};
pub use flutter::{flutter_speed, lock_roots, undamped_flutter_speed};
pub use fold::{CornerBranch, Fold, corner_branch};
pub use form::Form;
pub use joint::Joint;
pub use lining::{
    BranchEnd, BranchPoint, Cycle, FollowedBranch, GroupPush, GrowthThreshold, HopfPoint,
    LeastStiffness, Lining, LiningState, Rest, RestRoot, ShiftedCoincidence, Special, Whirl,
    follow, growth_threshold, least_lock_stiffness,
};
pub use lock_loads::{LockLoads, lock_fold_speed, lock_loads};
pub use locked::{Locked, LockedPoint, Sweep, locked_motion};
pub use onset::{WhirlOnset, whirl_onset, whirl_onsets};
pub use rim::{RimLoads, RimWave, rim_waves};
pub use slip::{
    Crossing, NoSlip, SlipLimit, SlipOrbit, SlipPoint, SlipRegion, slip_limits, slip_map, slip_over,
};
pub use spectrum::{Harmonic, SlipSpectrum, Truncation, slip_spectrum};
pub use whirl::{NoWhirl, WhirlOrbit, WhirlPoint, whirl_over};
