//! What the terminal sends, where there are no Unix terminals: crossterm reads it.

use std::io::Result;
use std::time::Duration;

use crossterm::event::{self, Event};

/// The keys, the mouse and the pasted text of the terminal.
#[derive(Debug, Default)]
pub struct Input;

impl Input {
    /// The next event; waits for it.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn next(&mut self) -> Result<Event> {
        event::read()
    }

    /// Whether there is another event within this time.
    pub fn has_more(&mut self, within: Duration) -> bool {
        event::poll(within).unwrap_or(false)
    }
}
