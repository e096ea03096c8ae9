//! What the run loop needs besides a backend: the shell, the clipboard, files.

use std::io::Result;
use std::path::PathBuf;
use std::sync::mpsc::Sender;

use super::events::ScreenEvent;
use super::files::{FileJob, FileResult, FoundScenes, run_in_thread};
use super::job;
use super::line::Line;
use super::terminal;

/// Environment of the run loop besides its backend.
pub trait Host {
    /// Gives the terminal to the shell until the job is continued; false where
    /// there is none. A key asks for it now; a signal has asked before.
    ///
    /// # Errors
    /// The terminal cannot be set up again.
    fn suspend(&mut self, by_key: bool) -> Result<bool>;
    /// Sets up the terminal again after the job was continued from outside.
    ///
    /// # Errors
    /// The terminal cannot be set up again.
    fn resume(&mut self) -> Result<()>;
    /// Puts a text on the clipboard of the terminal.
    ///
    /// # Errors
    /// The terminal cannot be written to.
    fn copy(&mut self, text: &str) -> Result<()>;
    /// Returns how much the terminal is sent.
    fn line(&self) -> Line;
    /// Bytes sent to the terminal so far.
    fn sent(&self) -> u64;
    /// Returns whether a write had to wait for the terminal.
    fn is_slow(&self) -> bool;
    /// Asks the terminal for mouse events, or no longer.
    fn mouse(&mut self, on: bool);
    /// Writes a file. Without a result, that comes later as an event.
    fn write(&mut self, job: FileJob) -> Option<FileResult>;
    /// Records why a file was not written, until a screen has shown it.
    fn unseen(&mut self, reason: Option<String>);
    /// Reads the scenes of a directory. Without a result, that comes later as an
    /// event.
    fn find_scenes(&mut self, directory: PathBuf) -> Option<FoundScenes>;
}

/// The real terminal, its shell, and a thread for files.
#[derive(Debug)]
pub struct Shell {
    /// Channel for the results of files.
    pub events: Sender<ScreenEvent>,
    /// Reason why a file was not written, until a screen has shown it.
    pub unseen: Option<String>,
    /// Limit on the bytes that are sent to the terminal.
    pub line: Line,
}

impl Host for Shell {
    fn suspend(&mut self, by_key: bool) -> Result<bool> {
        if job::is_orphaned() {
            // Nobody could continue it.
            return terminal::regain().map(|()| false);
        }
        if by_key {
            job::want_stop(true);
        }
        terminal::leave();
        job::stop()?;
        terminal::regain().map(|()| true)
    }

    fn resume(&mut self) -> Result<()> {
        // The shell may have changed the settings of the terminal.
        terminal::regain()
    }

    fn copy(&mut self, text: &str) -> Result<()> {
        // OSC 52: the terminal, not this machine, owns the clipboard.
        terminal::write(format!("\x1b]52;c;{}\x07", base64(text.as_bytes())).as_bytes())
    }

    fn line(&self) -> Line {
        self.line
    }

    fn sent(&self) -> u64 {
        terminal::sent()
    }

    fn is_slow(&self) -> bool {
        terminal::is_slow()
    }

    fn mouse(&mut self, on: bool) {
        // A terminal that is lost shows itself at the next frame.
        let _ = terminal::set_mouse(on);
    }

    fn write(&mut self, job: FileJob) -> Option<FileResult> {
        let events = self.events.clone();
        // Without a receiver the program is about to end.
        let done = move |result| _ = events.send(ScreenEvent::Written(result));
        run_in_thread(move || job.run(), FileResult::Failed, done)
    }

    fn unseen(&mut self, reason: Option<String>) {
        self.unseen = reason;
    }

    fn find_scenes(&mut self, directory: PathBuf) -> Option<FoundScenes> {
        let events = self.events.clone();
        let done = move |found| _ = events.send(ScreenEvent::Scenes(found));
        run_in_thread(move || FoundScenes::of(&directory), FoundScenes::failed, done)
    }
}

/// Encodes bytes in base 64 with padding, as OSC 52 needs it.
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
