//! The solver behind the screen: a playback without clock or thread, and the thread that drives it.
//! Read `playback` first, then `films` and `studies`.

mod background;
mod films;
mod playback;
mod studies;
mod thread;

pub use background::WORKER_NAME;
pub use playback::{PLAY_TIME, Playback};
pub use studies::Extent;
pub use thread::Worker;
