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
//! - coincidences and excitation: `campbell`, `excitation`

mod branches;
mod campbell;
mod configuration;
mod corner;
mod corner_angle;
mod eigen;
mod equations;
mod equilibria;
mod error;
mod excitation;
mod fold;
mod form;
mod lock_loads;
mod locked;
mod newton;
mod saddle_flow;
mod slip;
mod spectrum;
mod stability;

pub use branches::{Branches, Threshold};
pub use campbell::{Campbell, Coincidence, Line};
pub use corner::{Corner, PAPER_PAIR};
pub use equilibria::{Character, Equilibrium, GroupContact, Kind, equilibria, equilibrium};
pub use error::HarmonicError;
pub use excitation::{ExcitedLock, drives, excited_lock};
pub use fold::{CornerBranch, Fold, corner_branch};
pub use form::Form;
pub use lock_loads::{LockLoads, lock_fold_speed, lock_loads};
pub use locked::{Locked, LockedPoint, Sweep, locked_motion};
pub use slip::{
    Crossing, NoSlip, SlipLimit, SlipOrbit, SlipPoint, SlipRegion, slip_limits, slip_map, slip_over,
};
pub use spectrum::{Harmonic, SlipSpectrum, Truncation, slip_spectrum};
