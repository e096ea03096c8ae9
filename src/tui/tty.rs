//! The terminal as a device: its settings, its size, and writing to it without
//! ever waiting in the kernel. A terminal that accepts no output (a frozen ssh
//! client, the copy mode of screen, a pseudo-terminal nobody reads) would keep
//! a waiting thread for ever.

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

/// Time between two looks of a writer that waits for room whether it should go on.
const LOOK: Duration = Duration::from_millis(20);

/// Most bytes of one write where the kernel could make it wait: below the
/// count from which it reports that there is room.
const CAUTIOUS: usize = 128;

/// An open terminal.
pub struct Tty {
    out: OwnedFd,
    keys: OwnedFd,
    /// Whether a write returns when there is no room.
    returns: bool,
    /// The settings before the screen was set up. Nobody holds this lock while
    /// writing to the terminal.
    before: RwLock<Option<Termios>>,
}

impl Tty {
    /// Opens the terminal of standard output for writing, and that of the keys
    /// for its settings.
    ///
    /// # Errors
    /// There is no terminal.
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

    /// Makes the terminal send every key as it is pressed. The settings before are kept, unless this screen made
    /// them.
    ///
    /// # Errors
    /// The terminal refuses.
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

    /// Puts the settings back. Does not wait for output.
    pub fn put_back(&self) {
        // The lock is held for one assignment at most.
        let before = (0..1000).find_map(|_| self.before.try_read().ok());
        if let Some(before) = before.as_ref().and_then(|before| before.as_ref()) {
            let _ = termios::tcsetattr(&self.keys, OptionalActions::Now, before);
        }
    }

    /// Writes, and waits for room until `stop` says so; the number of bytes
    /// that were written.
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
                    // Another process that writes to the terminal can have the
                    // room: without a pause this would be a busy loop.
                    if self.has_room()? {
                        std::thread::sleep(Duration::from_millis(1));
                    }
                }
                Err(error) => return Err(error.into()),
            }
        }
        Ok(sent)
    }

    /// Writes for at most this long; whether all was written.
    pub fn send_within(&self, bytes: &[u8], limit: Duration) -> bool {
        let began = Instant::now();
        // At least one try, however late it is.
        let tried = std::cell::Cell::new(false);
        let stop = || tried.replace(true) && began.elapsed() >= limit;
        self.send(bytes, stop).is_ok_and(|sent| sent == bytes.len())
    }

    /// Waits a moment for room.
    fn has_room(&self) -> Result<bool> {
        let wait = Timespec { tv_sec: 0, tv_nsec: i64::from(LOOK.subsec_nanos()) };
        let mut fds = [PollFd::new(&self.out, PollFlags::OUT)];
        match poll(&mut fds, Some(&wait)) {
            Ok(ready) => Ok(ready > 0),
            Err(Errno::INTR) => Ok(false),
            Err(error) => Err(error.into()),
        }
    }

    /// Takes what was typed, and waits for it this long or for ever; none if there
    /// was nothing.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn read(&self, bytes: &mut [u8], wait: Option<Duration>) -> Result<Option<usize>> {
        let wait = wait.and_then(|wait| Timespec::try_from(wait).ok());
        // Each poll reports bytes that are still there.
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
                // Some systems cannot tell what a terminal is ready for.
                std::thread::sleep(LOOK);
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
    }

    /// Drops what was written and not yet taken by the terminal.
    pub fn drop_pending(&self) {
        let _ = termios::tcflush(&self.out, QueueSelector::OFlush);
    }

    /// Returns the columns and rows, as the terminal reports them.
    ///
    /// # Errors
    /// The terminal is closed.
    pub fn size(&self) -> Result<(u16, u16)> {
        let size = termios::tcgetwinsize(&self.out)?;
        Ok((size.ws_col, size.ws_row))
    }

    /// Returns whether this process is in the foreground: in the background, a change of the
    /// settings stops it.
    pub fn in_foreground(&self) -> bool {
        // Without job control on this terminal there is no background.
        nix::unistd::tcgetpgrp(&self.keys).map_or(true, |front| front == nix::unistd::getpgrp())
    }

    /// Returns whether what the terminal reports comes among the keys: both are one terminal.
    pub fn hears_itself(&self) -> bool {
        let device = |file: &OwnedFd| rustix::fs::fstat(file).ok().map(|state| state.st_rdev);
        device(&self.keys).is_some_and(|keys| Some(keys) == device(&self.out))
    }

    /// Returns whether a process in the background may write.
    pub fn may_write_from_background(&self) -> bool {
        termios::tcgetattr(&self.keys)
            .is_ok_and(|settings| !settings.local_modes.contains(LocalModes::TOSTOP))
    }
}

/// Returns the terminal of standard output, opened anew: writes that do not wait are a property of
/// the open file, which the shell shares with standard output.
fn reopened() -> Option<File> {
    let out = std::io::stdout();
    let named = termios::ttyname(&out, Vec::new()).ok();
    let named = named.map(|name| PathBuf::from(std::ffi::OsString::from_vec(name.into_bytes())));
    // Without a name (another root directory), it is the controlling terminal
    // if it has a foreground group.
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
