//! The terminal as a device: its size, the bytes of its keyboard, and writing to it without ever
//! blocking in the kernel. A terminal that accepts no output (a frozen SSH client, the copy mode of
//! `screen`, a pseudo-terminal that nobody reads) would block a thread for ever.

use std::fs::File;
use std::io::{ErrorKind, IsTerminal, Result};
use std::os::fd::{AsFd, OwnedFd};
use std::os::unix::fs::OpenOptionsExt;
use std::time::{Duration, Instant};

use rustix::buffer::spare_capacity;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::OFlags;
use rustix::io::{Errno, retry_on_intr};
use rustix::termios::{self, LocalModes, QueueSelector};

/// While a write waits for the terminal, time after which it checks again whether to give up.
const LOOK: Duration = Duration::from_millis(20);

/// Largest number of bytes of one write if it could block: less than the free space at which the
/// kernel reports the terminal as writable.
const CAUTIOUS: usize = 128;

/// Most bytes of one read.
const MOST: usize = 4096;

/// An open terminal: the output, and the keyboard, which may be another device.
pub struct Tty {
    out: OwnedFd,
    keys: OwnedFd,
    /// Whether a write to `out` returns instead of blocking if the terminal accepts no output.
    returns: bool,
}

impl Tty {
    /// Opens the terminal of standard output for writing and that of the keyboard for reading.
    ///
    /// # Errors
    /// A file descriptor cannot be duplicated.
    pub fn open() -> Result<Self> {
        let (out, returns) = match reopened() {
            Some(file) => (file.into(), true),
            None => (std::io::stdout().as_fd().try_clone_to_owned()?, false),
        };
        // As crossterm finds it, which switches its settings.
        let input = std::io::stdin();
        let keys = match input.is_terminal() {
            true => input.as_fd().try_clone_to_owned()?,
            false => File::open("/dev/tty")?.into(),
        };
        Ok(Self { out, keys, returns })
    }

    /// Writes bytes and returns how many were written: all, unless `stop` returns true for the time
    /// since the terminal last accepted any.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn send(&self, bytes: &[u8], stop: impl Fn(Duration) -> bool) -> Result<usize> {
        let (mut sent, mut accepted) = (0, Instant::now());
        while let Some(rest) = bytes.get(sent..).filter(|rest| !rest.is_empty()) {
            if stop(accepted.elapsed()) {
                break;
            }
            if !self.returns && !self.has_room()? {
                continue;
            }
            let most = if self.returns { rest.len() } else { CAUTIOUS.min(rest.len()) };
            match rustix::io::write(&self.out, rest.get(..most).unwrap_or(rest)) {
                Ok(count) => (sent, accepted) = (sent + count, Instant::now()),
                Err(Errno::INTR) => {}
                Err(Errno::AGAIN) => {
                    // Another process that writes to the terminal may take the free space first:
                    // without a pause this would be a busy loop.
                    if self.has_room()? {
                        std::thread::sleep(Duration::from_millis(1));
                    }
                }
                Err(error) => return Err(error.into()),
            }
        }
        Ok(sent)
    }

    /// Waits up to [`LOOK`] until the terminal accepts output; returns whether it does.
    fn has_room(&self) -> Result<bool> {
        let wait = Timespec { tv_sec: 0, tv_nsec: i64::from(LOOK.subsec_nanos()) };
        match poll(&mut [PollFd::new(&self.out, PollFlags::OUT)], Some(&wait)) {
            Ok(ready) => Ok(ready > 0),
            Err(Errno::INTR) => Ok(false),
            Err(error) => Err(error.into()),
        }
    }

    /// Reads typed bytes; none if nothing arrived within `wait`, which has no limit if it is
    /// `None`.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn read(&self, wait: Option<Duration>) -> Result<Vec<u8>> {
        let wait = wait.and_then(|wait| Timespec::try_from(wait).ok());
        let mut bytes = Vec::with_capacity(MOST);
        let mut keys = [PollFd::new(&self.keys, PollFlags::IN)];
        if retry_on_intr(|| poll(&mut keys, wait.as_ref()))? > 0
            && retry_on_intr(|| rustix::io::read(&self.keys, spare_capacity(&mut bytes)))? == 0
        {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        Ok(bytes)
    }

    /// Discards the output that was written but not yet accepted by the terminal.
    pub fn drop_pending(&self) {
        let _ = termios::tcflush(&self.out, QueueSelector::OFlush);
    }

    /// Returns the numbers of columns and rows, as the terminal reports them; a serial line reports
    /// 0.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn size(&self) -> Result<(u16, u16)> {
        let size = termios::tcgetwinsize(&self.out)?;
        Ok((size.ws_col, size.ws_row))
    }

    /// Returns whether this process is in the foreground of the terminal. In the background, the
    /// system stops it if it changes the settings.
    pub fn in_foreground(&self) -> bool {
        // The call fails if the terminal has no job control; then there is no background.
        nix::unistd::tcgetpgrp(&self.keys).map_or(true, |front| front == nix::unistd::getpgrp())
    }

    /// Returns whether a process in the background may write to the terminal (`TOSTOP` is off).
    pub fn may_write_from_background(&self) -> bool {
        termios::tcgetattr(&self.keys)
            .is_ok_and(|settings| !settings.local_modes.contains(LocalModes::TOSTOP))
    }
}

/// Opens the terminal of standard output again, because non-blocking writes are a property of the
/// open file, and the shell shares that of standard output. `None` if it is not the controlling
/// terminal.
fn reopened() -> Option<File> {
    // Only the controlling terminal has a foreground process group.
    termios::tcgetpgrp(std::io::stdout()).ok()?;
    let flags = (OFlags::NONBLOCK | OFlags::NOCTTY).bits();
    File::options().write(true).custom_flags(flags.cast_signed()).open("/dev/tty").ok()
}
