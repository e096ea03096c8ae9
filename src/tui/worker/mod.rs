//! The solver beside the screen: a player without clock or thread, the thread
//! that drives it, and a stand-in that is driven by hand.

mod forecast;
mod player;
mod recorder;
mod stepwise;
mod thread;

pub use player::Player;
pub use stepwise::Stepwise;
pub use thread::{WORKER_NAME, Worker};
