//! What the terminal sends, where there are no Unix terminals: crossterm reads it.

use std::io::Result;

use crossterm::event::{self, Event};

use super::ground::Ground;

/// The keys, the mouse and the pasted text of the terminal.
#[derive(Debug, Default)]
pub struct Input;

impl Input {
    /// Waits for the next event and returns it.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn next(&mut self) -> Result<Option<Event>> {
        event::read().map(Some)
    }

    /// Returns `None`: such a terminal is not asked for its background.
    pub fn take_ground(&mut self) -> Option<Ground> {
        None
    }
}
