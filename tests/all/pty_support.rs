//! The built program in a pseudo-terminal whose reader can stop reading, and
//! what its user can do: press keys, send signals, look, hang up.

use std::fs::File;
use std::io::{Read, Write};
use std::num::NonZeroU16;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use portable_pty::{
    Child, CommandBuilder, ExitStatus, MasterPty, PtySize, SlavePty, native_pty_system,
};
use rustix::event::{PollFd, PollFlags, Timespec, poll};

/// A long limit, not a speed test: a loaded machine may be slow.
const PATIENCE: Duration = Duration::from_secs(60);

/// A short run, so that a verdict is there soon.
pub const SHORT: [&str; 6] =
    ["--step", "2e-7", "--end", "0.02", "--set", "view.charts=wheel,response,gaps"];

/// A title, which no screen shows.
const LAST: &str = "\u{1b}]0;last\u{7}";

/// What the reader of the terminal does.
const READS: u8 = 0;
/// It reads at most once more.
const PAUSES: u8 = 1;
const PAUSED: u8 = 2;
const GOES: u8 = 3;

/// A pseudo-terminal with a program in it. Dropping it kills the program.
pub struct Terminal {
    /// Whom signals are for.
    process: u32,
    pub parser: vt100::Parser,
    output: Receiver<Vec<u8>>,
    input: Option<Box<dyn Write + Send>>,
    child: Box<dyn Child + Send + Sync>,
    master: Option<Box<dyn MasterPty + Send>>,
    /// Kept open: a terminal that nobody has open forgets its output.
    slave: Option<Box<dyn SlavePty + Send>>,
    reader: Arc<AtomicU8>,
    before: String,
    /// Everything the program has written.
    written: Vec<u8>,
}

/// How a program is started.
pub struct Start {
    command: CommandBuilder,
    size: PtySize,
    typed: &'static str,
}

impl Start {
    /// The explorer with these arguments.
    pub fn explorer(arguments: &[&str]) -> Self {
        Self::program(env!("CARGO_BIN_EXE_rubscope"), arguments).detached()
    }

    /// Another command of the program.
    pub fn command(arguments: &[&str]) -> Self {
        Self::program(env!("CARGO_BIN_EXE_rubscope"), arguments)
    }

    /// A shell with job control that runs `script`; `"$@"` is the explorer.
    pub fn shell(script: &str, arguments: &[&str]) -> Self {
        let mut all = vec!["-c", script, "sh", env!("CARGO_BIN_EXE_rubscope")];
        all.extend(arguments);
        Self::program("sh", &all)
    }

    fn program(program: &str, arguments: &[&str]) -> Self {
        let mut command = CommandBuilder::new(program);
        command.args(arguments);
        // What the machine of the test has set must not matter.
        command.env("TERM", "xterm-256color");
        command.env("LC_ALL", "C.UTF-8");
        command.env("NO_COLOR", "");
        // Nothing is remembered, and the terminal is not asked for its background.
        command.env("XDG_CONFIG_HOME", "/dev/null");
        command.env("COLORFGBG", "15;0");
        let size = PtySize { rows: 24, cols: 80, pixel_width: 0, pixel_height: 0 };
        Self { command, size, typed: "" }
    }

    /// Without the session's terminal, the terminal outlives the program, as it
    /// does if a shell started it.
    pub fn detached(mut self) -> Self {
        self.command.set_controlling_tty(false);
        self
    }

    /// The program is the one that the terminal hangs up on.
    pub fn leading(mut self) -> Self {
        self.command.set_controlling_tty(true);
        self
    }

    pub fn env(mut self, name: &str, value: &str) -> Self {
        self.command.env(name, value);
        self
    }

    /// What has been typed before the program starts.
    pub fn typed(mut self, text: &'static str) -> Self {
        self.typed = text;
        self
    }

    pub fn folder(mut self, folder: &Path) -> Self {
        self.command.cwd(folder);
        self
    }

    pub fn size(mut self, cols: u16, rows: u16) -> Self {
        (self.size.cols, self.size.rows) = (cols, rows);
        self
    }

    /// Starts it in a terminal that is closed after a moment; how it ends.
    pub fn abandoned(self, moment: Duration) -> ExitStatus {
        let pair = native_pty_system().openpty(self.size).unwrap();
        let mut child = pair.slave.spawn_command(self.command).unwrap();
        drop(pair.slave);
        std::thread::sleep(moment);
        drop(pair.master);
        patiently("it does not end", || {
            std::thread::sleep(Duration::from_millis(2));
            child.try_wait().unwrap()
        })
    }

    /// The explorer, with the verdict of the paper's scene on its screen.
    pub fn locked(self) -> Terminal {
        let mut terminal = self.open();
        terminal.wait_for(" LOCKED ");
        terminal
    }

    pub fn open(self) -> Terminal {
        let pair = native_pty_system().openpty(self.size).unwrap();
        let before = settings(&*pair.master);
        let mut input = pair.master.take_writer().unwrap();
        input.write_all(self.typed.as_bytes()).unwrap();
        let child = pair.slave.spawn_command(self.command).unwrap();
        let mut from = pair.master.try_clone_reader().unwrap();
        let (sender, output) = channel();
        let reader = Arc::new(AtomicU8::new(READS));
        let state = Arc::clone(&reader);
        std::thread::spawn(move || {
            let mut buffer = [0; 4096];
            loop {
                match state.load(Ordering::SeqCst) {
                    READS => {}
                    GOES => return,
                    paused => {
                        // Unless it shall read again by now.
                        let _ = state.compare_exchange(
                            paused,
                            PAUSED,
                            Ordering::SeqCst,
                            Ordering::SeqCst,
                        );
                        std::thread::sleep(Duration::from_millis(5));
                        continue;
                    }
                }
                let Ok(count) = from.read(&mut buffer) else { return };
                if count == 0 || sender.send(buffer[..count].to_vec()).is_err() {
                    return;
                }
            }
        });
        // A terminal without a size has the usual one.
        let of = |cells| NonZeroU16::new(cells).unwrap();
        let (rows, cols) = match (self.size.rows, self.size.cols) {
            (0, 0) => (24, 80),
            (rows, cols) => (rows.min(500), cols.min(1000)),
        };
        Terminal {
            process: child.process_id().unwrap(),
            parser: vt100::Parser::new(of(rows), of(cols), 0),
            output,
            input: Some(input),
            child,
            master: Some(pair.master),
            slave: Some(pair.slave),
            reader,
            before,
            written: Vec::new(),
        }
    }
}

/// What looks find at last.
pub fn patiently<T>(missing: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let began = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(began.elapsed() < PATIENCE, "{missing}");
    }
}

/// The settings of the terminal, as text to compare.
fn settings(master: &dyn MasterPty) -> String {
    format!("{:?}", master.get_termios().unwrap())
}

impl Terminal {
    pub fn send(&mut self, keys: &str) {
        self.send_bytes(keys.as_bytes());
    }

    pub fn send_bytes(&mut self, bytes: &[u8]) {
        let input = self.input.as_mut().unwrap();
        input.write_all(bytes).unwrap();
        input.flush().unwrap();
    }

    /// Takes what the program has written so far; it must not have ended.
    pub fn read(&mut self) {
        while let Ok(bytes) = self.output.try_recv() {
            self.heard(&bytes);
        }
        let ended = self.child.try_wait().unwrap();
        assert!(ended.is_none(), "it ended: {ended:?}\n{}", self.text());
    }

    /// Its resident memory \[MB\] and threads.
    #[cfg(target_os = "linux")]
    pub fn usage(&self) -> (u64, u64) {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.process)).unwrap();
        let number = |name: &str| -> u64 {
            let line = status.lines().find(|line| line.starts_with(name)).unwrap();
            line.split_whitespace().nth(1).unwrap().parse().unwrap()
        };
        (number("VmRSS:") / 1024, number("Threads:"))
    }

    fn heard(&mut self, bytes: &[u8]) {
        self.written.extend_from_slice(bytes);
        self.parser.process(bytes);
    }

    /// The end of the terminal that programs write to.
    fn slave_file(&self) -> File {
        let name = self.master.as_ref().unwrap().tty_name().unwrap();
        File::options().write(true).open(name).unwrap()
    }

    /// Takes what the program writes next, if it comes soon.
    fn listen(&mut self) {
        if let Ok(bytes) = self.output.recv_timeout(Duration::from_millis(5)) {
            self.heard(&bytes);
        }
    }

    /// Whether a private mode of the terminal is set, by its last change.
    pub fn has_mode(&self, mode: u16) -> bool {
        let last = |end: char| {
            let change = format!("\u{1b}[?{mode}{end}");
            self.written.windows(change.len()).rposition(|bytes| bytes == change.as_bytes())
        };
        last('h') > last('l')
    }

    pub fn text(&self) -> String {
        self.parser.screen().contents()
    }

    /// Whether the program has written these bytes, which may be none of the screen.
    pub fn has_written(&self, bytes: &[u8]) -> bool {
        self.written.windows(bytes.len()).any(|part| part == bytes)
    }

    /// Waits until the screen contains a text.
    pub fn wait_for(&mut self, text: &str) {
        self.wait_until(text, |screen| screen.contents().contains(text));
    }

    /// Waits until a condition on the screen holds.
    pub fn wait_until(&mut self, what: &str, holds: impl Fn(&vt100::Screen) -> bool) {
        let began = Instant::now();
        while !holds(self.parser.screen()) {
            assert!(began.elapsed() < PATIENCE, "no {what:?} in\n{}", self.text());
            match self.output.recv_timeout(Duration::from_millis(100)) {
                Ok(bytes) => self.heard(&bytes),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    panic!("ended without {what:?}:\n{}", self.text())
                }
            }
        }
    }

    /// Whether the program ends before a condition on the screen holds.
    pub fn ends_before(&mut self, holds: impl Fn(&vt100::Screen) -> bool) -> bool {
        let began = Instant::now();
        while !holds(self.parser.screen()) {
            if self.child.try_wait().unwrap().is_some() {
                return true;
            }
            assert!(began.elapsed() < PATIENCE, "neither in\n{}", self.text());
            self.listen();
        }
        false
    }

    /// Signals are for the job of the shell from now on, not for the shell.
    #[cfg(target_os = "linux")]
    pub fn follow_the_job(&mut self) {
        let shell = self.process;
        let children = std::fs::read_to_string(format!("/proc/{shell}/task/{shell}/children"));
        self.process = children.unwrap().split_whitespace().next().unwrap().parse().unwrap();
    }

    /// Sends a signal to the program, which may have ended.
    pub fn signal(&self, signal: &str) {
        let id = self.process.to_string();
        let sent = Command::new("kill").args(["-s", signal, &id]).status().unwrap();
        assert!(sent.success() || self.state().is_none(), "kill -s {signal}");
    }

    /// Waits until the program is stopped (`T`) or has ended (`Z`), where the system tells it
    /// in a file.
    pub fn wait_for_state(&self, letter: char) {
        patiently(&format!("it is not {letter}"), || {
            std::thread::sleep(Duration::from_millis(5));
            self.state().is_none_or(|state| state == letter).then_some(())
        });
    }

    /// The letter of its state; none where no file tells it, and of a program that is gone.
    pub fn state(&self) -> Option<char> {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.process)).ok()?;
        stat.rsplit_once(") ")?.1.chars().next()
    }

    /// The processor time of the program so far, where the system tells it in a file, and whether
    /// it has ended.
    #[cfg(target_os = "linux")]
    fn used_s(&self) -> (f64, bool) {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.process)).unwrap();
        let fields: Vec<&str> = stat.rsplit_once(") ").unwrap().1.split(' ').collect();
        // In ticks of 10 ms: its own, and those of the system for it.
        let ticks = [11, 12].map(|place: usize| fields[place].parse::<f64>().unwrap());
        ((ticks[0] + ticks[1]) / 100.0, fields[0] == "Z")
    }

    #[cfg(target_os = "linux")]
    pub fn processor_s(&self) -> f64 {
        self.used_s().0
    }

    /// The same at the end of the program, which is waited for.
    #[cfg(target_os = "linux")]
    pub fn last_processor_s(&self) -> f64 {
        patiently("it does not end", || {
            std::thread::sleep(Duration::from_millis(5));
            let (used, ended) = self.used_s();
            ended.then_some(used)
        })
    }

    /// Nobody reads the terminal any more, and the program has filled it.
    pub fn block(&mut self) {
        self.reader.store(PAUSES, Ordering::SeqCst);
        let slave = self.slave_file();
        // Whoever writes at the moment makes it look full too.
        let mut full = 0;
        patiently("the terminal is never full", || {
            // Each of these is a whole screen; the system keeps some ten kilobytes.
            self.send("\u{c}");
            std::thread::sleep(Duration::from_millis(10));
            let mut room = [PollFd::new(&slave, PollFlags::OUT)];
            let is_full = self.reader.load(Ordering::SeqCst) == PAUSED
                && poll(&mut room, Some(&Timespec::default())).unwrap() == 0;
            full = if is_full { full + 1 } else { 0 };
            (full > 1).then_some(())
        });
    }

    /// The terminal is read again.
    pub fn unblock(&mut self) {
        self.reader.store(READS, Ordering::SeqCst);
    }

    /// Gives the terminal another size.
    pub fn resize(&mut self, cols: u16, rows: u16) {
        let size = PtySize { rows, cols, pixel_width: 0, pixel_height: 0 };
        self.master.as_ref().unwrap().resize(size).unwrap();
        let of = |cells| NonZeroU16::new(cells).unwrap();
        self.parser.screen_mut().set_size(of(rows), of(cols));
        // A program without this terminal for its own is told by whoever has it.
        self.signal("WINCH");
    }

    /// Closes the terminal, like a window. Only a leading program is told.
    pub fn hang_up(&mut self) {
        self.reader.store(GOES, Ordering::SeqCst);
        // The reader ends at the next output; the screen is drawn every second.
        patiently("nothing was drawn for a minute", || {
            let next = self.output.recv_timeout(Duration::from_millis(20));
            matches!(next, Err(RecvTimeoutError::Disconnected)).then_some(())
        });
        (self.slave, self.input, self.master) = (None, None, None);
    }

    /// Waits for the end of a program whose terminal nobody may be reading.
    pub fn ended(&mut self) -> ExitStatus {
        patiently("it does not end", || {
            let status = self.child.try_wait().unwrap();
            // If it is read, this must go on: a full terminal would block it.
            if status.is_none() {
                self.listen();
            }
            status
        })
    }

    /// Presses a key that quits.
    pub fn quit(&mut self, key: &str) {
        self.send(key);
        assert_eq!(self.wait(), 0, "{key:?}");
    }

    /// Waits for the end and reads the rest, which restores the terminal; the exit status.
    pub fn wait(&mut self) -> u32 {
        let status = self.ended();
        self.unblock();
        // What is written now comes after all that the program wrote.
        self.slave_file().write_all(LAST.as_bytes()).unwrap();
        patiently("the rest never came", || {
            self.listen();
            self.written.ends_with(LAST.as_bytes()).then_some(())
        });
        assert_eq!(status.signal(), None, "killed");
        self.assert_restored();
        status.exit_code()
    }

    pub fn assert_restored(&self) {
        let screen = self.parser.screen();
        assert!(!screen.alternate_screen(), "still on the alternate screen");
        assert!(!screen.hide_cursor(), "the cursor is still hidden");
        assert!(!screen.bracketed_paste(), "pasted text is still marked");
        assert_eq!(screen.mouse_protocol_mode(), vt100::MouseProtocolMode::None);
        // Clicks, drags, moves, and two ways to write them.
        for mode in [1000, 1002, 1003, 1006, 1015] {
            assert!(!self.has_mode(mode), "mouse mode {mode} is still on");
        }
        let after = settings(&**self.master.as_ref().unwrap());
        assert_eq!(after, self.before, "the settings of the terminal changed");
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        self.reader.store(GOES, Ordering::SeqCst);
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
