//! Steady states against speed (`rubscope hbm`): the sheet of each view (`rubscope.hbm/3` in JSON).
//! A view is one file with one [`View`], listed in [`VIEWS`].

mod branches;
mod campbell;
pub mod coincidence;
mod compliance;
mod excitation;
mod forced;
pub mod locked;
mod slip;
mod smooth;
mod view;
mod whirl;

pub use locked::LOCKED;
pub use view::{Request, View};

/// The views that have an option, in the order of the help.
pub const VIEWS: [&View; 9] = [
    &branches::BRANCHES,
    &slip::SLIP,
    &campbell::CAMPBELL,
    &excitation::EXCITATION,
    &smooth::SMOOTH,
    &coincidence::COINCIDENCE,
    &forced::FORCED,
    &whirl::WHIRL,
    &compliance::COMPLIANCE,
];
