//! Sets up the terminal, and restores it however the program ends.

use std::io::{BufWriter, Stdout, Write, stdout};
use std::sync::atomic::{AtomicBool, Ordering};

use crossterm::{
    cursor::{Hide, Show},
    execute,
    terminal::{EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode},
};
use ratatui::{Terminal, backend::CrosstermBackend};

use super::worker::WORKER_NAME;

/// Whether the terminal is set up.
static TAKEN: AtomicBool = AtomicBool::new(false);

/// A frame is written in one piece.
const FRAME_BYTES: usize = 1 << 16;

/// The terminal of the explorer.
pub type Screen = Terminal<CrosstermBackend<BufWriter<Stdout>>>;

/// Raw keys, the alternate screen, no cursor.
///
/// # Errors
/// The terminal refuses.
pub fn enter() -> std::io::Result<()> {
    enable_raw_mode()?;
    TAKEN.store(true, Ordering::SeqCst);
    execute!(stdout(), EnterAlternateScreen, Hide)
}

/// Restores the terminal; may be called at any time, from any thread, and on a
/// closed terminal.
pub fn leave() {
    if TAKEN.swap(false, Ordering::SeqCst) {
        // An error cannot be reported any more.
        let mut out = stdout();
        let _ = execute!(out, LeaveAlternateScreen, Show);
        let _ = out.flush();
        let _ = disable_raw_mode();
    }
}

/// Opens the screen on standard output.
///
/// # Errors
/// The terminal refuses.
pub fn open() -> std::io::Result<Screen> {
    enter()?;
    Terminal::new(CrosstermBackend::new(BufWriter::with_capacity(FRAME_BYTES, stdout())))
}

/// A panic restores the terminal before it is reported. Panics of the worker
/// are caught and shown on the screen, so the hook does not report them.
pub fn install_panic_hook() {
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if std::thread::current().name() == Some(WORKER_NAME) {
            return;
        }
        leave();
        report(info);
    }));
}

/// Restores the terminal when dropped.
pub struct Guard;

impl Drop for Guard {
    fn drop(&mut self) {
        leave();
    }
}

/// What the run loop needs besides a backend.
pub trait Host {
    /// Gives the terminal to the shell until the job is continued.
    ///
    /// # Errors
    /// The terminal cannot be set up again.
    fn suspend(&mut self) -> std::io::Result<()>;
    /// Sets up the terminal again after the job was continued from outside.
    ///
    /// # Errors
    /// The terminal cannot be set up again.
    fn resume(&mut self) -> std::io::Result<()>;
    /// Puts a text on the clipboard of the terminal.
    ///
    /// # Errors
    /// The terminal cannot be written to.
    fn copy(&mut self, text: &str) -> std::io::Result<()>;
}

/// A host without a terminal, for tests.
#[derive(Debug, Default)]
pub struct NoHost;

impl Host for NoHost {
    fn suspend(&mut self) -> std::io::Result<()> {
        Ok(())
    }
    fn resume(&mut self) -> std::io::Result<()> {
        Ok(())
    }
    fn copy(&mut self, _: &str) -> std::io::Result<()> {
        Ok(())
    }
}

/// The real terminal and its shell.
#[derive(Debug, Default)]
pub struct Shell;

impl Host for Shell {
    #[cfg(unix)]
    fn suspend(&mut self) -> std::io::Result<()> {
        leave();
        signal_hook::low_level::emulate_default_handler(signal_hook::consts::SIGTSTP)?;
        enter()
    }

    #[cfg(not(unix))]
    fn suspend(&mut self) -> std::io::Result<()> {
        Ok(())
    }

    fn resume(&mut self) -> std::io::Result<()> {
        // The shell may have changed the settings of the terminal.
        leave();
        enter()
    }

    fn copy(&mut self, text: &str) -> std::io::Result<()> {
        // OSC 52: the terminal, not this machine, owns the clipboard.
        let mut out = stdout();
        write!(out, "\x1b]52;c;{}\x07", base64(text.as_bytes()))?;
        out.flush()
    }
}

/// Base 64 with padding, as OSC 52 wants it.
fn base64(bytes: &[u8]) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for chunk in bytes.chunks(3) {
        let byte = |k: usize| u32::from(chunk.get(k).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            let sign = SIGNS.get((bits >> (18 - 6 * k) & 63) as usize).copied().unwrap_or(b'A');
            out.push(if k <= chunk.len() { char::from(sign) } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_the_examples_of_rfc_4648() {
        for (text, expected) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(text.as_bytes()), expected);
        }
    }
}
