//! The solver behind the screen: a playback without clock or thread, and the thread that drives it.
//! Read `playback` first, then `forecasts` and `studies`.

mod background;
mod comparison;
mod forecasts;
mod full_run;
mod jump;
mod pacing;
mod page;
mod playback;
mod reading;
mod recorder;
mod studies;
mod thread;

pub use comparison::other_law;
pub use playback::Playback;
pub use recorder::{in_blade_frame, rim_point};
pub use thread::{WORKER_NAME, Worker};
