//! The solver beside the screen: a player without clock or thread, the thread
//! that drives it, and a stand-in that is driven by hand.

mod comparison;
mod forecast;
mod player;
mod recorder;
mod stepwise;
mod studies;
mod thread;

pub use forecast::SAMPLES;
pub use player::Player;
pub use recorder::in_blade_frame;
pub use stepwise::Stepwise;
pub use thread::{WORKER_NAME, Worker};
