//! The explorer's terminal: setting it up, drawing frames that can be abandoned, and restoring it
//! however the program ends. Any thread may restore it, repeatedly: that takes no lock held during
//! output, and waits a bounded time for the terminal.

use std::io::Error;
use std::sync::OnceLock;
use std::sync::atomic::Ordering::SeqCst;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::{Duration, Instant};

use crossterm::cursor::{Hide, Show};
use crossterm::event::{
    DisableBracketedPaste, EnableBracketedPaste, KeyCode, KeyEvent, KeyModifiers,
};
use crossterm::queue;
use crossterm::style::{Attribute, SetAttribute};
use crossterm::terminal::{
    EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode,
};
use ratatui::Terminal;
use ratatui::backend::{Backend, ClearType, CrosstermBackend, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};

use crate::tui::encode::write_cells;
use crate::tui::ending::ended_by;
use crate::tui::tty::Tty;

/// Ctrl-C.
pub const INTERRUPT: KeyEvent = KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL);

/// The terminal, opened on first use.
static TTY: OnceLock<Tty> = OnceLock::new();
/// Whether the terminal is set up, at least in part, and must be restored.
static HELD: AtomicBool = AtomicBool::new(false);
/// Whether a frame was abandoned, perhaps within an escape sequence.
static TORN: AtomicBool = AtomicBool::new(false);
/// Whether a key that quits has come since the last write began.
static QUITS: AtomicBool = AtomicBool::new(false);
/// Whether `q` is a letter of a text that is being typed.
static TYPING: AtomicBool = AtomicBool::new(false);
/// Whether the explorer wants mouse reports of the terminal.
static MOUSE: AtomicBool = AtomicBool::new(false);

/// Whether frames are sent as synchronized updates.
static WHOLE: AtomicBool = AtomicBool::new(false);

/// Begin and end of a synchronized update (mode 2026): the terminal shows the frame once it is
/// complete. Terminals without this mode ignore both.
const BEGIN_FRAME: &[u8] = b"\x1b[?2026h";
const END_FRAME: &[u8] = b"\x1b[?2026l";

/// Switch mouse reports on and off: clicks and the wheel, without moves (mode 1000), in the
/// encoding without a largest column (mode 1006).
const MOUSE_ON: &[u8] = b"\x1b[?1000h\x1b[?1006h";
const MOUSE_OFF: &[u8] = b"\x1b[?1006l\x1b[?1000l";

/// Number of bytes sent to the terminal so far.
static SENT: AtomicU64 = AtomicU64::new(0);
/// Whether any write had to wait for the terminal.
static SLOW: AtomicBool = AtomicBool::new(false);

/// A write that takes longer than this counts as having waited for the terminal.
const AT_ONCE: Duration = Duration::from_millis(60);

/// A frame is abandoned if the terminal accepts nothing for this long, so that keys are answered
/// where nobody reads it.
const STUCK: Duration = Duration::from_millis(500);

/// Longest wait for the terminal to take the restoring bytes. It applies twice: before and after
/// the pending output is discarded.
const ROOM: Duration = Duration::from_millis(200);

/// After the process was continued in the background, time to wait for the foreground or for a
/// deadly signal before it stops again.
const BACKGROUND: Duration = Duration::from_secs(1);

/// Cancels an escape sequence of an abandoned frame, of which the terminal has only the beginning.
const CANCEL: &[u8] = b"\x18\x1b\\";

/// Largest numbers of columns and rows drawn: two buffers of this size take 50 MB.
pub const MOST: (u16, u16) = (1000, 500);

/// Numbers of columns and rows drawn if the terminal reports none, as a serial line does.
const USUAL: (u16, u16) = (80, 24);

/// The screen type of the explorer.
pub type Screen = Terminal<ScreenBackend>;

fn tty() -> Result<&'static Tty, Error> {
    if TTY.get().is_none() {
        let _ = TTY.set(Tty::open()?);
    }
    TTY.get().ok_or_else(|| Error::other("no terminal"))
}

/// Sets up raw mode, alternate screen, hidden cursor and bracketed paste.
///
/// # Errors
/// Fails if the terminal rejects the settings.
fn enter() -> Result<(), Error> {
    // Set this first, so that a signal during the setup restores the terminal.
    let again = HELD.swap(true, SeqCst);
    // While it was stopped, the shell may have changed the settings that crossterm takes for raw.
    if let Err(error) = disable_raw_mode().and_then(|()| enable_raw_mode()) {
        HELD.store(again, SeqCst);
        return Err(error);
    }
    let mut bytes = Vec::new();
    queue!(bytes, EnterAlternateScreen, Hide, EnableBracketedPaste)?;
    if MOUSE.load(SeqCst) {
        bytes.extend_from_slice(MOUSE_ON);
    }
    write(&bytes)
}

/// Switches mouse reports, now if the terminal is set up, and at every later setup.
///
/// # Errors
/// Fails if the terminal is closed.
pub fn set_mouse(on: bool) -> Result<(), Error> {
    MOUSE.store(on, SeqCst);
    if !HELD.load(SeqCst) {
        return Ok(());
    }
    write(if on { MOUSE_ON } else { MOUSE_OFF })
}

/// Switches synchronized updates on or off.
pub fn set_whole_frames(whole: bool) {
    WHOLE.store(whole, SeqCst);
}

/// Restores the terminal. May be called at any time, from any thread, and on a closed terminal.
pub fn leave() {
    let Some(tty) = TTY.get().filter(|_| HELD.load(SeqCst)) else { return };
    let front = tty.in_foreground();
    if front {
        let _ = disable_raw_mode();
    }
    // In the background the settings belong to the shell, and writing may stop the process.
    if front || tty.may_write_from_background() {
        let mut bytes = CANCEL.to_vec();
        if WHOLE.load(SeqCst) {
            // An abandoned frame may have begun an update without ending it.
            bytes.extend_from_slice(END_FRAME);
        }
        // Sent even if mouse reports are off: the sequence that switched them off may be lost.
        bytes.extend_from_slice(MOUSE_OFF);
        // Writing into a vector cannot fail.
        let _ = queue!(
            bytes,
            DisableBracketedPaste,
            LeaveAlternateScreen,
            Show,
            SetAttribute(Attribute::Reset)
        );
        let send = || tty.send(&bytes, |idle| idle >= ROOM);
        if send().is_ok_and(|sent| sent < bytes.len()) && front {
            tty.drop_pending();
            let _ = send();
        }
    }
    HELD.store(false, SeqCst);
}

/// Sets up the terminal at the start, or after the job was continued, once the process is in the
/// foreground; until then the job is stopped. The system would stop it on its own, but repeatedly,
/// and then no signal could end it.
///
/// # Errors
/// Fails if the terminal cannot be set up again.
pub fn regain() -> Result<(), Error> {
    while let Some(tty) = TTY.get().filter(|_| ended_by().is_none()) {
        if tty.in_foreground() {
            return enter();
        }
        // A signal that arrives together with the continuation ends the loop here.
        let began = Instant::now();
        while began.elapsed() < BACKGROUND && ended_by().is_none() && !tty.in_foreground() {
            std::thread::sleep(Duration::from_millis(10));
        }
        if ended_by().is_none() && !tty.in_foreground() {
            if super::job::is_orphaned() {
                return Err(Error::other("no shell could bring it to the foreground"));
            }
            super::job::want_stop(true);
            super::job::stop()?;
        }
    }
    Ok(())
}

/// Writes a frame, or a sequence between frames. It is abandoned if the terminal accepts nothing for
/// `STUCK`, or less where a key that quits waits, or a signal has ended the program.
///
/// # Errors
/// Fails if the terminal is closed.
pub fn write(bytes: &[u8]) -> Result<(), Error> {
    let began = Instant::now();
    QUITS.store(false, SeqCst);
    let sent = tty()?.send(bytes, |idle| is_stuck(idle) || ended_by().is_some())?;
    SENT.fetch_add(sent as u64, SeqCst);
    if began.elapsed() > AT_ONCE {
        SLOW.store(true, SeqCst);
    }
    if sent < bytes.len() {
        TORN.store(true, SeqCst);
    }
    Ok(())
}

/// Returns whether a terminal that has accepted nothing for this long is not waited for.
fn is_stuck(idle: Duration) -> bool {
    idle >= if QUITS.load(SeqCst) { AT_ONCE } else { STUCK }
}

/// Says whether `q` is typed into a text.
pub fn set_typing(typing: bool) {
    TYPING.store(typing, SeqCst);
}

/// Takes note of a key that has come, before it is handled: no frame keeps one that quits waiting.
pub fn hear(key: &KeyEvent) {
    if *key == INTERRUPT || (key.code == KeyCode::Char('q') && !TYPING.load(SeqCst)) {
        QUITS.store(true, SeqCst);
    }
}

/// Returns whether a frame was abandoned since the last call; then the whole screen must be drawn
/// again.
pub fn take_torn() -> bool {
    TORN.swap(false, SeqCst)
}

/// Reads typed bytes; none if nothing arrived within `wait`, which has no limit if it is `None`.
///
/// # Errors
/// Fails if the terminal is closed.
pub fn read(wait: Option<Duration>) -> Result<Vec<u8>, Error> {
    tty()?.read(wait)
}

/// Returns the number of bytes sent to the terminal so far.
pub fn sent() -> u64 {
    SENT.load(SeqCst)
}

/// Returns whether any write had to wait for the terminal.
pub fn is_slow() -> bool {
    SLOW.load(SeqCst)
}

/// Returns the size of the screen: that of the terminal, at most [`MOST`].
///
/// # Errors
/// Fails if the terminal is closed.
pub fn size() -> Result<Size, Error> {
    tty()?.size().map(bounded)
}

fn bounded((columns, rows): (u16, u16)) -> Size {
    let (columns, rows) = if columns == 0 || rows == 0 { USUAL } else { (columns, rows) };
    Size::new(columns.min(MOST.0), rows.min(MOST.1))
}

/// Sets up the terminal and opens the screen on it.
///
/// # Errors
/// Fails if the terminal rejects the settings.
pub fn open() -> Result<Screen, Error> {
    tty()?;
    regain()?;
    Terminal::new(ScreenBackend::default())
}

/// Makes panics restore the terminal before they are reported. Panics in the threads named in
/// `caught` are not reported: those threads catch them and show them on the screen.
pub fn install_panic_hook(caught: &'static [&'static str]) {
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        let thread = std::thread::current();
        if thread.name().is_some_and(|name| caught.contains(&name)) {
            return;
        }
        leave();
        report(info);
    }));
}

/// Returns whether an error means that the terminal no longer exists.
pub fn is_gone(error: &Error) -> bool {
    use std::io::ErrorKind::{BrokenPipe, NotFound, UnexpectedEof};
    // EIO and ENXIO (the other end is closed) have no `ErrorKind`.
    matches!(error.kind(), BrokenPipe | NotFound | UnexpectedEof)
        || [5, 6].map(Some).contains(&error.raw_os_error())
}

/// Restores the terminal when dropped.
pub struct Guard;

impl Drop for Guard {
    fn drop(&mut self) {
        leave();
    }
}

/// Ratatui backend that collects the bytes of a frame and writes them at once when flushed.
#[derive(Debug, Default)]
pub struct ScreenBackend(Vec<u8>);

impl Backend for ScreenBackend {
    type Error = Error;

    fn draw<'a, I>(&mut self, content: I) -> Result<(), Error>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        write_cells(&mut self.0, size()?.width, content)
    }

    fn hide_cursor(&mut self) -> Result<(), Error> {
        // The cursor is hidden when the screen is opened, and never shown before it is left.
        Ok(())
    }

    fn show_cursor(&mut self) -> Result<(), Error> {
        CrosstermBackend::new(&mut self.0).show_cursor()
    }

    fn get_cursor_position(&mut self) -> Result<Position, Error> {
        CrosstermBackend::new(&mut self.0).get_cursor_position()
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> Result<(), Error> {
        CrosstermBackend::new(&mut self.0).set_cursor_position(position)
    }

    fn clear(&mut self) -> Result<(), Error> {
        self.clear_region(ClearType::All)
    }

    fn clear_region(&mut self, region: ClearType) -> Result<(), Error> {
        CrosstermBackend::new(&mut self.0).clear_region(region)
    }

    fn size(&self) -> Result<Size, Error> {
        size()
    }

    fn window_size(&mut self) -> Result<WindowSize, Error> {
        Ok(WindowSize { columns_rows: self.size()?, pixels: Size::ZERO })
    }

    fn flush(&mut self) -> Result<(), Error> {
        match std::mem::take(&mut self.0) {
            bytes if bytes.is_empty() => Ok(()),
            bytes if WHOLE.load(SeqCst) => write(&[BEGIN_FRAME, &bytes, END_FRAME].concat()),
            bytes => write(&bytes),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_of_any_size_is_drawn_within_bounds() {
        assert_eq!(bounded((120, 40)), Size::new(120, 40));
        assert_eq!(bounded((1, 1)), Size::new(1, 1));
        assert_eq!(bounded((u16::MAX, u16::MAX)), Size::new(1000, 500));
        assert_eq!(bounded((u16::MAX, 20)), Size::new(1000, 20));
        assert_eq!(bounded((0, 0)), Size::new(80, 24));
        assert_eq!(bounded((0, 30)), Size::new(80, 24));
    }

    #[test]
    fn only_a_key_that_quits_shortens_the_wait_for_a_stuck_terminal() {
        let q = KeyCode::Char('q').into();
        for (key, typing, short) in [(q, true, false), (INTERRUPT, true, true), (q, false, true)] {
            QUITS.store(false, SeqCst);
            set_typing(typing);
            hear(&key);
            assert!(is_stuck(STUCK) && is_stuck(AT_ONCE) == short, "{key:?} {typing}");
        }
    }
}
