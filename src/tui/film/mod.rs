//! Films: runs that are computed ahead once, from which every instant on the screen is taken.
//!
//! Order in which to read: `plan` (what a film shows), `run` (the film, computed in slices, and its
//! copies of the motion), `head` (one instant of it), `page` and `recorder` (the curves of a page),
//! `jump` and `pacing` (the playback).

mod copies;
mod head;
mod jump;
mod pacing;
mod page;
pub mod plan;
mod recorder;
mod run;

pub use head::Head;
pub use jump::next_change;
pub use pacing::{Reached, Turned, rate_at};
pub use page::{PER_TURN, longest_sample, sample_length};
pub use plan::{FilmPlan, other_law};
pub use recorder::{in_blade_frame, rim_point};
pub use run::Film;
