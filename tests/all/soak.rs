//! Long use of the built program in a pseudo-terminal, with the same keys every
//! time: knobs, views, dialogs, typed values, lessons, files that can and cannot
//! be written, sizes, pastes and bytes that are no keys. It must go on answering,
//! and its memory and threads must not grow.

#![cfg(target_os = "linux")]

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use fastrand::Rng;

use crate::pty_support::{SHORT, Start, Terminal};
use crate::random::one_of;

/// Time between two actions: faster than any user.
const PAUSE: Duration = Duration::from_millis(2);
/// Actions between two looks at the program.
const ROUND: usize = 100;
/// Most resident memory \[MB\], at any time.
const MOST_MEMORY: u64 = 200;
/// Most memory that the second half of a run may add to the first \[MB\].
const MOST_GROWTH: u64 = 32;
/// Size of the terminal where its text is looked at.
const USUAL: (u16, u16) = (100, 40);
/// Most a file may have \[blocks of a shell\]: an export of the screen is larger.
const LARGEST_FILE: u32 = 16;

/// Keys of the charts and knobs, frequent ones several times.
const KEYS: &str = "jjjjkklllllhhhhLLHHuuu1234567778\t\tfvwcxmta[[]]++-=pprn..  b<>(){}y";
/// Texts that are typed as values.
const VALUES: [&str; 12] =
    ["20k", "1e-7", "0", "-5", "1e99", "nan", "abc", "500", "3", "50u", "1e6", "0.02"];
/// Names of files: new ones, the same again, and places that cannot be written.
const FILES: [&str; 8] =
    ["a.toml", "b.toml", "c.csv", "d.svg", "none/e.toml", "locked/f.csv", "folder", "pipe"];
/// What a terminal or a user can send besides keys.
const ODD: [&[u8]; 7] = [
    b"\x1b[200~hjl 20k\nworld\x1b[201~",
    b"\x1b[?62;22c",
    b"\x1b[24;80R",
    b"\x1b]11;rgb:0000/0000/0000\x07",
    b"\xff\xfe\x80",
    b"\x1b[99999999999999999999m",
    "é漢\u{202e}".as_bytes(),
];

fn open(folder: &Path) -> Terminal {
    // A write beyond the limit fails, as on a full disk, and does not kill.
    let script = format!("trap '' XFSZ; ulimit -f {LARGEST_FILE}; exec \"$@\"");
    let config = folder.join("config");
    // Not the config file of the user, which may have another marker.
    let start = Start::shell(&script, &SHORT).folder(folder).size(USUAL.0, USUAL.1);
    start.env("XDG_CONFIG_HOME", config.to_str().unwrap()).open()
}

/// It opens its help and closes it, whatever was before.
fn answers(terminal: &mut Terminal) {
    terminal.resize(USUAL.0, USUAL.1);
    // An escape byte alone is a key only after a moment.
    for _ in 0..3 {
        terminal.send("\x1b");
        std::thread::sleep(Duration::from_millis(100));
    }
    terminal.send("?");
    terminal.wait_for("select the knob above");
    terminal.send("?");
}

/// One thing that a user, a terminal or a window manager does.
fn act(session: &mut Terminal, rng: &mut Rng) {
    let keys: Vec<char> = KEYS.chars().collect();
    match rng.u32(..100) {
        0..70 => {
            let count = rng.u32(..8);
            let text: String = (0..=count).map(|_| one_of(rng, &keys)).collect();
            session.send(&text);
        }
        70..78 => session.send(&format!("\r{}\r", one_of(rng, &VALUES))),
        78..82 => {
            session.send(one_of(rng, &["?jjk?", "g\r", "gjj\rgggg", "ggG", "\x12", "\x0c", "\x7f"]))
        }
        82..90 => {
            let name = one_of(rng, &FILES);
            // The offered name goes; `y` replaces a file, or else copies.
            session.send(one_of(rng, &["s", "e"]));
            session.send(&format!("{}{name}\ry", "\x7f".repeat(40)));
        }
        90..96 => session.resize(rng.u16(10..210), rng.u16(4..64)),
        _ => session.send_bytes(one_of(rng, &ODD)),
    }
}

/// Uses the program until `done` says so, given the time and the actions so far.
fn soak(done: impl Fn(Duration, usize) -> bool) {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("folder")).unwrap();
    let locked = folder.path().join("locked");
    fs::create_dir(&locked).unwrap();
    fs::set_permissions(&locked, std::os::unix::fs::PermissionsExt::from_mode(0o555)).unwrap();
    let mut rng = Rng::with_seed(16);
    let mut session = open(folder.path());
    session.wait_for("speed Ω");
    let began = Instant::now();
    let (mut actions, mut told, mut looks) = (0, 0, Vec::new());
    loop {
        let (memory, threads) = session.usage();
        looks.push((memory, threads));
        let minutes = began.elapsed().as_secs() / 60;
        let last = done(began.elapsed(), actions);
        if actions == 0 || minutes > told || last {
            told = minutes;
            let seconds = began.elapsed().as_secs();
            println!("{seconds:5} s, {actions} actions: {memory} MB, {threads} threads");
        }
        assert!(memory < MOST_MEMORY, "{memory} MB after {actions} actions");
        if last {
            break;
        }
        for _ in 0..ROUND {
            act(&mut session, &mut rng);
            std::thread::sleep(PAUSE);
            session.read();
        }
        actions += ROUND;
        answers(&mut session);
    }
    let (first, second) = looks.split_at(looks.len() / 2);
    let most =
        |looks: &[(u64, u64)]| looks.iter().copied().reduce(|a, b| (a.0.max(b.0), a.1.max(b.1)));
    let (before, after) = (most(first).unwrap(), most(second).unwrap());
    println!("most: {before:?} in the first half, {after:?} in the second (MB, threads)");
    assert!(after.0 <= before.0 + MOST_GROWTH, "memory grows: {looks:?}");
    session.send("\u{3}");
    assert_eq!(session.wait(), 0);
}

#[test]
fn some_use_leaves_it_answering() {
    soak(|_, actions| actions >= 3 * ROUND);
}

/// `RUBSCOPE_SOAK_MINUTES` says how long; ten minutes are hours of a user.
#[test]
#[ignore = "long"]
fn hours_of_use_in_minutes() {
    let minutes = std::env::var("RUBSCOPE_SOAK_MINUTES");
    let minutes: u64 = minutes.ok().and_then(|text| text.parse().ok()).unwrap_or(10);
    soak(|elapsed, _| elapsed >= Duration::from_secs(60 * minutes));
}
