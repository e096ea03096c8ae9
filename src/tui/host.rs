//! What the event loop needs besides a backend: job control, clipboard and files.

use std::io::Result;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::mpsc::Sender;

use super::events::ScreenEvent;
use super::files::{FILES_NAME, FileJob, FileResult, FoundScenes};
use super::job;
use super::line::Line;
use super::terminal;

/// The environment of the event loop: the real shell, or a stand-in for tests.
pub trait Host {
    /// Returns the terminal to the shell until the job is continued; returns false if no shell
    /// could continue it. `by_key` says that the user pressed Ctrl-Z; otherwise a stop signal
    /// arrived.
    ///
    /// # Errors
    /// Fails if the terminal cannot be set up again.
    fn suspend(&mut self, by_key: bool) -> Result<bool>;
    /// Sets up the terminal again after the job was continued by a signal.
    ///
    /// # Errors
    /// Fails if the terminal cannot be set up again.
    fn resume(&mut self) -> Result<()>;
    /// Puts a text on the clipboard of the user's terminal.
    ///
    /// # Errors
    /// Fails if the terminal cannot be written to.
    fn copy(&mut self, text: &str) -> Result<()>;
    /// Returns the limit on the bytes sent to the terminal.
    fn line(&self) -> Line {
        Line::Auto
    }
    /// Writes a file. `None` means that the event with the result will arrive.
    fn write(&mut self, job: FileJob) -> Option<ScreenEvent>;
    /// Reads the scenes of a directory. `None` means that the event with them will arrive.
    fn find_scenes(&mut self, directory: PathBuf) -> Option<ScreenEvent>;
    /// Records why a file was not written, to be printed on exit; `None` once a frame has shown the
    /// reason.
    fn unseen(&mut self, _: Option<String>) {}
}

/// The real terminal and shell; files are written in a thread of their own.
#[derive(Debug)]
pub struct Shell {
    /// Channel for the results of file operations.
    pub events: Sender<ScreenEvent>,
    /// Why a file was not written; `None` if it was, or once a frame has shown the reason.
    pub unseen: Option<String>,
    /// Limit on the bytes sent to the terminal.
    pub line: Line,
}

impl Host for Shell {
    fn suspend(&mut self, by_key: bool) -> Result<bool> {
        if job::is_orphaned() {
            // No shell is left that could continue the job.
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
        // The shell may have changed the terminal settings.
        terminal::regain()
    }

    fn copy(&mut self, text: &str) -> Result<()> {
        // OSC 52 sets the clipboard of the terminal, also through SSH.
        let copy = format!("\x1b]52;c;{}\x07", base64(text.as_bytes()));
        let inside = |variable: &str| std::env::var_os(variable).is_some_and(|set| !set.is_empty());
        let bytes = match (inside("TMUX"), inside("STY")) {
            // tmux takes it where `set-clipboard` is on, and hands the second one through where
            // `allow-passthrough` is.
            (true, _) => format!("{copy}\x1bPtmux;\x1b{copy}\x1b\\"),
            (false, true) => format!("\x1bP{copy}\x1b\\"),
            (false, false) => copy,
        };
        terminal::write(bytes.as_bytes())
    }

    fn line(&self) -> Line {
        self.line
    }

    fn write(&mut self, job: FileJob) -> Option<ScreenEvent> {
        let failed = |why| ScreenEvent::Written(FileResult::Failed(why));
        self.in_thread(move || ScreenEvent::Written(job.run()), failed)
    }

    fn unseen(&mut self, reason: Option<String>) {
        self.unseen = reason;
    }

    fn find_scenes(&mut self, directory: PathBuf) -> Option<ScreenEvent> {
        let failed = |why| ScreenEvent::Scenes(FoundScenes::failed(why));
        self.in_thread(move || ScreenEvent::Scenes(FoundScenes::of(&directory)), failed)
    }
}

impl Shell {
    /// Runs `work` in a thread that sends its event, or that of `failed` after a panic. If the
    /// thread cannot start, returns that of `failed`.
    fn in_thread(
        &self,
        work: impl FnOnce() -> ScreenEvent + Send + 'static,
        failed: fn(String) -> ScreenEvent,
    ) -> Option<ScreenEvent> {
        let events = self.events.clone();
        let work = move || {
            let done = catch_unwind(AssertUnwindSafe(work));
            // Sending fails only if the program is about to end.
            _ = events.send(done.unwrap_or_else(|_| failed("internal error".into())));
        };
        let started = std::thread::Builder::new().name(FILES_NAME.into()).spawn(work);
        started.err().map(|error| failed(error.to_string()))
    }
}

/// Encodes bytes in base64 with padding, as OSC 52 requires.
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
