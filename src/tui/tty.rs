//! The terminal as a device: its settings, its size, and writing to it without ever blocking in the
//! kernel. A terminal that accepts no output (a frozen SSH client, the copy mode of `screen`, a
//! pseudo-terminal that nobody reads) would block a thread for ever.

use std::fs::File;
use std::io::{ErrorKind, Result};
use std::os::fd::{AsFd, OwnedFd};
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::sync::RwLock;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::OFlags;
use rustix::io::Errno;
use rustix::termios::{self, LocalModes, OptionalActions, QueueSelector, Termios};

/// While a write waits for the terminal, time after which it checks again whether to give up.
const LOOK: Duration = Duration::from_millis(20);

/// Largest number of bytes of one write if it could block: less than the free space at which the
/// kernel reports the terminal as writable.
const CAUTIOUS: usize = 128;

/// An open terminal: the output, and the keyboard, which may be another device.
pub struct Tty {
    out: OwnedFd,
    keys: OwnedFd,
    /// Whether a write to `out` returns instead of blocking if the terminal accepts no output.
    returns: bool,
    /// Settings of the terminal before the screen was set up; `None` until then. No thread holds
    /// this lock while it writes to the terminal.
    before: RwLock<Option<Termios>>,
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
        let input = std::io::stdin();
        let keys = if termios::isatty(&input) {
            input.as_fd().try_clone_to_owned()?
        } else {
            match opened(Path::new("/dev/tty")) {
                Some(file) => file.into(),
                None => out.try_clone()?,
            }
        };
        Ok(Self { out, keys, returns, before: RwLock::new(None) })
    }

    /// Makes the terminal send every key as it is pressed. Its present settings are stored for
    /// [`Self::put_back`], unless they are `ours`, from an earlier call.
    ///
    /// # Errors
    /// The terminal rejects the settings.
    pub fn make_raw(&self, ours: bool) -> Result<()> {
        let mut settings = termios::tcgetattr(&self.keys)?;
        if let Ok(mut before) = self.before.write()
            && !(ours && before.is_some())
        {
            *before = Some(settings.clone());
        }
        settings.make_raw();
        Ok(termios::tcsetattr(&self.keys, OptionalActions::Now, &settings)?)
    }

    /// Restores the settings that [`Self::make_raw`] stored, without waiting for pending output.
    pub fn put_back(&self) {
        // Another thread holds the lock for one assignment at most, so a few attempts suffice.
        let before = (0..1000).find_map(|_| self.before.try_read().ok());
        if let Some(before) = before.as_ref().and_then(|before| before.as_ref()) {
            let _ = termios::tcsetattr(&self.keys, OptionalActions::Now, before);
        }
    }

    /// Writes bytes and returns how many were written. If the terminal accepts no output, waits
    /// until it does or `stop` returns true.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn send(&self, bytes: &[u8], stop: impl Fn() -> bool) -> Result<usize> {
        let mut sent = 0;
        while let Some(rest) = bytes.get(sent..).filter(|rest| !rest.is_empty()) {
            if stop() {
                break;
            }
            if !self.returns && !self.has_room()? {
                continue;
            }
            let most = if self.returns { rest.len() } else { CAUTIOUS.min(rest.len()) };
            match rustix::io::write(&self.out, rest.get(..most).unwrap_or(rest)) {
                Ok(count) => sent += count,
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

    /// Writes bytes for at most `limit`; returns whether all were written.
    pub fn send_within(&self, bytes: &[u8], limit: Duration) -> bool {
        let began = Instant::now();
        // At least one attempt, however short the limit is.
        let tried = std::cell::Cell::new(false);
        let stop = || tried.replace(true) && began.elapsed() >= limit;
        self.send(bytes, stop).is_ok_and(|sent| sent == bytes.len())
    }

    /// Waits up to [`LOOK`] until the terminal accepts output; returns whether it does.
    fn has_room(&self) -> Result<bool> {
        let wait = Timespec { tv_sec: 0, tv_nsec: i64::from(LOOK.subsec_nanos()) };
        let mut fds = [PollFd::new(&self.out, PollFlags::OUT)];
        match poll(&mut fds, Some(&wait)) {
            Ok(ready) => Ok(ready > 0),
            Err(Errno::INTR) => Ok(false),
            Err(error) => Err(error.into()),
        }
    }

    /// Reads typed bytes and returns their number; `None` if nothing arrived. Waits up to `wait`,
    /// or without limit if that is `None`.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn read(&self, bytes: &mut [u8], wait: Option<Duration>) -> Result<Option<usize>> {
        let wait = wait.and_then(|wait| Timespec::try_from(wait).ok());
        // After an interruption nothing is lost: the next poll reports the same bytes.
        match poll(&mut [PollFd::new(&self.keys, PollFlags::IN)], wait.as_ref()) {
            Ok(0) | Err(Errno::INTR) => return Ok(None),
            Ok(_) => {}
            Err(error) => return Err(error.into()),
        }
        match rustix::io::read(&self.keys, bytes) {
            Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
            Ok(count) => Ok(Some(count)),
            Err(Errno::INTR) => Ok(None),
            Err(Errno::AGAIN) => {
                // On some systems `poll` reports a terminal as readable when it is not.
                std::thread::sleep(LOOK);
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
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

    /// Returns whether keyboard and output are the same terminal, so that its reports arrive among
    /// the keys.
    pub fn hears_itself(&self) -> bool {
        let device = |file: &OwnedFd| rustix::fs::fstat(file).ok().map(|state| state.st_rdev);
        device(&self.keys).is_some_and(|keys| Some(keys) == device(&self.out))
    }

    /// Returns whether a process in the background may write to the terminal (`TOSTOP` is off).
    pub fn may_write_from_background(&self) -> bool {
        termios::tcgetattr(&self.keys)
            .is_ok_and(|settings| !settings.local_modes.contains(LocalModes::TOSTOP))
    }
}

/// Opens the terminal of standard output again, because non-blocking writes are a property of the
/// open file, and the shell shares that of standard output. `None` if it cannot be opened.
fn reopened() -> Option<File> {
    let out = std::io::stdout();
    let named = termios::ttyname(&out, Vec::new()).ok();
    let named = named.map(|name| PathBuf::from(std::ffi::OsString::from_vec(name.into_bytes())));
    // The terminal may have no name here (another root directory). It is the controlling terminal
    // if it has a foreground process group.
    let ours = termios::tcgetpgrp(&out).is_ok().then(|| "/dev/tty".into());
    let ways = [named, Some("/proc/self/fd/1".into()), ours];
    ways.into_iter().flatten().find_map(|path| opened(&path))
}

fn opened(path: &Path) -> Option<File> {
    let flags = (OFlags::NONBLOCK | OFlags::NOCTTY).bits();
    let mut options = File::options();
    options.read(true).write(true).custom_flags(flags.cast_signed());
    options.open(path).ok().filter(|file| termios::isatty(file))
}
