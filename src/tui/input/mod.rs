//! What the terminal sends, read whole and at once: bytes come as fast as they
//! are sent, and a sequence that never ends takes no key with it.

mod decoder;
mod sequence;

use std::collections::VecDeque;
use std::io::Result;
use std::time::Duration;

use crossterm::event::Event;

use super::ground::Ground;
use super::terminal;
use decoder::Decoder;

/// After this long without a byte, what is unfinished will hardly go on; a pasted text may.
const MOMENT: Duration = Duration::from_millis(100);

/// Most bytes of one look.
const MOST: usize = 4096;

/// The keys, the mouse and the pasted text of the terminal.
#[derive(Debug, Default)]
pub struct Input {
    decoder: Decoder,
    found: VecDeque<Event>,
}

impl Input {
    /// Waits for the next event and returns it; `None` where the terminal has reported its
    /// background instead.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn next(&mut self) -> Result<Option<Event>> {
        let mut silent = Duration::ZERO;
        while self.found.is_empty() && self.decoder.ground.is_none() {
            let wait = self.decoder.is_unfinished().then_some(MOMENT);
            if self.look(wait)? {
                silent = Duration::ZERO;
            } else {
                silent += MOMENT;
                self.decoder.pause(silent, &mut self.found);
            }
        }
        Ok(self.found.pop_front())
    }

    /// Returns the background that the terminal has reported since the last call.
    pub fn take_ground(&mut self) -> Option<Ground> {
        self.decoder.ground.take()
    }

    /// Takes what is there, and waits for it this long or for ever; whether there
    /// was anything.
    fn look(&mut self, wait: Option<Duration>) -> Result<bool> {
        let mut bytes = [0; MOST];
        let Some(count) = terminal::read(&mut bytes, wait)? else { return Ok(false) };
        for byte in bytes.iter().take(count) {
            self.decoder.take(*byte, &mut self.found);
        }
        if count < MOST {
            self.decoder.end(&mut self.found);
        }
        Ok(true)
    }
}
