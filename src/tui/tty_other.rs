//! The terminal as a device, where there are no Unix terminals. Writes may wait:
//! a console window always takes its output.

use std::io::{Result, Write, stdout};
use std::time::Duration;

/// An open terminal.
pub struct Tty;

impl Tty {
    /// Creates the terminal; nothing needs to be opened.
    ///
    /// # Errors
    /// None here.
    pub fn open() -> Result<Self> {
        Ok(Self)
    }

    /// Makes the terminal send every key as it is pressed.
    ///
    /// # Errors
    /// The terminal refuses.
    pub fn make_raw(&self, _: bool) -> Result<()> {
        crossterm::terminal::enable_raw_mode()
    }

    /// Puts the settings back.
    pub fn put_back(&self) {
        let _ = crossterm::terminal::disable_raw_mode();
    }

    /// Writes all.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn send(&self, bytes: &[u8], _: impl Fn() -> bool) -> Result<usize> {
        let mut out = stdout();
        out.write_all(bytes)?;
        out.flush()?;
        Ok(bytes.len())
    }

    /// Writes all; whether that was possible.
    pub fn send_within(&self, bytes: &[u8], _: Duration) -> bool {
        self.send(bytes, || false).is_ok()
    }

    /// Does nothing: no output waits here.
    pub fn drop_pending(&self) {}

    /// Returns the columns and rows.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn size(&self) -> Result<(u16, u16)> {
        crossterm::terminal::size()
    }

    /// Returns true: there is no background.
    pub fn in_foreground(&self) -> bool {
        true
    }

    /// Returns a console window does not report its background.
    pub fn hears_itself(&self) -> bool {
        false
    }

    /// Returns true: there is no background.
    pub fn may_write_from_background(&self) -> bool {
        true
    }
}
