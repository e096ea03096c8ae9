//! What the terminal sends, read whole and at once: bytes come as fast as they
//! are sent, and a sequence that never ends takes no key with it.

mod decoder;
mod sequence;

use std::collections::VecDeque;
use std::io::Result;
use std::time::Duration;

use crossterm::event::Event;

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
    /// The next event; waits for it.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn next(&mut self) -> Result<Event> {
        let mut silent = Duration::ZERO;
        while self.found.is_empty() {
            let wait = self.decoder.is_unfinished().then_some(MOMENT);
            if self.look(wait)? {
                silent = Duration::ZERO;
            } else {
                silent += MOMENT;
                self.decoder.pause(silent, &mut self.found);
            }
        }
        self.found.pop_front().ok_or_else(|| std::io::ErrorKind::UnexpectedEof.into())
    }

    /// Whether there is another event within this time.
    pub fn has_more(&mut self, within: Duration) -> bool {
        // An error comes again where the event is read.
        !self.found.is_empty() || (self.look(Some(within)).is_ok() && !self.found.is_empty())
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
