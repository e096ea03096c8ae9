//! Signals while a map is computed: the first keeps the cells, the second ends
//! the program at once, and neither waits for a cell.

#![cfg(target_os = "linux")]

use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::cli_support::{hearing, program};

/// A long limit, not a speed test: a loaded machine may be slow.
const PATIENCE: Duration = Duration::from_secs(60);

/// One cell of minutes: an undamped casing that bounces for hours.
const LONG_CELL: [&str; 12] = [
    "map",
    "undamped",
    "--solver",
    "event",
    "--model",
    "rigid",
    "--end",
    "1e6",
    "--speed",
    "500:500:1",
    "--pulse",
    "20000:20000:1",
];

/// A program under test, killed when the test ends.
struct Running(Option<Child>);

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(child) = &mut self.0 {
            let _ = child.kill();
        }
    }
}

impl Running {
    fn start(arguments: &[&str], directory: &Path) -> Self {
        Self::start_with(arguments, directory, Stdio::piped())
    }

    fn start_with(arguments: &[&str], directory: &Path, errors: Stdio) -> Self {
        let child = program()
            .args(arguments)
            .current_dir(directory)
            .stdout(Stdio::piped())
            .stderr(errors)
            .spawn()
            .unwrap();
        Self(Some(child))
    }

    fn signal(&self, name: &str) {
        let id = self.0.as_ref().unwrap().id().to_string();
        assert!(Command::new("kill").args([name, &id]).status().unwrap().success());
    }

    fn computes(&self) -> bool {
        computes(self.0.as_ref().unwrap().id())
    }

    /// Waits for a condition of the files it writes.
    fn wait_until(&self, condition: impl Fn() -> bool) {
        let began = Instant::now();
        while !condition() {
            assert!(began.elapsed() < PATIENCE, "it does not come to work");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    fn finish(self) -> Output {
        self.finish_under("-0")
    }

    /// Sends a signal again and again until it ends.
    fn finish_under(mut self, signal: &str) -> Output {
        let began = Instant::now();
        while self.0.as_mut().unwrap().try_wait().unwrap().is_none() {
            assert!(began.elapsed() < PATIENCE, "it does not end");
            self.signal(signal);
            std::thread::sleep(Duration::from_millis(20));
        }
        self.0.take().unwrap().wait_with_output().unwrap()
    }
}

/// Whether a map has begun to compute: beside its first thread and the one for
/// signals there are those for cells, which start after signals are noted.
pub fn computes(process: u32) -> bool {
    let threads = std::fs::read_dir(format!("/proc/{process}/task"));
    threads.is_ok_and(|threads| threads.count() >= 3)
}

/// Starts a map of one long cell, and waits until it is at work.
fn long_map(directory: &Path) -> Running {
    let arguments = [&LONG_CELL[..], &["--out", "map.csv"]].concat();
    let map = Running::start(&arguments, directory);
    map.wait_until(|| map.computes());
    map
}

#[test]
fn a_signal_stops_a_map_in_the_middle_of_a_cell() {
    for (signal, number) in [("-INT", 2), ("-TERM", 15), ("-HUP", 1)] {
        let directory = tempfile::tempdir().unwrap();
        let map = long_map(directory.path());
        map.signal(signal);
        let output = map.finish();
        assert_eq!(output.status.code(), Some(128 + number), "{signal}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains("0 of 1 cells are kept"), "{said}");
    }
}

/// As under `nohup`, and after `&` in a script.
#[test]
fn what_a_test_starts_hears_the_signals_that_the_test_ignores() {
    let test = "map_signals::a_signal_stops_a_map_in_the_middle_of_a_cell";
    let output = Command::new("sh")
        .args(["-c", "trap '' INT HUP QUIT TERM; exec \"$@\"", "sh"])
        .arg(std::env::current_exe().unwrap())
        .args(["--exact", test])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("1 passed"), "{said}");
}

#[test]
fn a_second_signal_ends_a_map_at_once() {
    // Nobody reads what it says, and the pipe is full: it waits there for ever.
    let (_unread, mut full) = std::io::pipe().unwrap();
    full.write_all(&[b' '; 1 << 16]).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let arguments = [&LONG_CELL[..], &["--out", "map.csv"]].concat();
    let map = Running::start_with(&arguments, directory.path(), full.into());
    map.wait_until(|| map.computes());
    map.signal("-INT");
    std::thread::sleep(Duration::from_millis(300));
    assert_eq!(map.finish_under("-TERM").status.signal(), Some(15));
}

#[test]
fn a_map_without_a_file_keeps_its_cells_when_the_terminal_closes() {
    let directory = tempfile::tempdir().unwrap();
    let map = Running::start(&LONG_CELL, directory.path());
    map.wait_until(|| map.computes());
    map.signal("-HUP");
    let output = map.finish();
    assert_eq!(output.status.code(), Some(129));
    let kept = std::fs::read_to_string(directory.path().join("rubscope-map.partial")).unwrap();
    assert!(kept.contains("rubscope.map-part"), "{kept}");
}

#[test]
fn a_hang_up_that_was_ignored_at_the_start_stays_ignored() {
    let directory = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_rubscope");
    let script = format!("trap '' HUP; exec {program} {} --out map.csv", LONG_CELL.join(" "));
    let child = hearing("sh")
        .args(["-c", &script])
        .current_dir(directory.path())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let map = Running(Some(child));
    map.wait_until(|| map.computes());
    map.signal("-HUP");
    map.signal("-INT");
    assert_eq!(map.finish().status.code(), Some(128 + 2), "the hang-up came through");
}

#[test]
fn a_result_in_the_place_of_the_cells_of_another_map_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let map = long_map(directory.path());
    let short = "map --speed 300:500:2 --pulse 1e3:1e4:2 --end 1e-3 --out";
    std::fs::hard_link(
        directory.path().join("map.csv.partial"),
        directory.path().join("cells.part"),
    )
    .unwrap();
    let arguments: Vec<&str> = short.split(' ').chain(["cells.part"]).collect();
    let output = Running::start(&arguments, directory.path()).finish();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.starts_with("rubscope: cells.part is in use by another map"), "{said}");
    // Another program can put a file there all the same: the cells are saved anew.
    let cells = directory.path().join("map.csv.partial");
    std::fs::remove_file(&cells).unwrap();
    std::fs::write(&cells, "of another program").unwrap();
    map.signal("-TERM");
    let said = String::from_utf8(map.finish().stderr).unwrap();
    assert!(said.contains("--resume rubscope-map.partial"), "{said}");
    assert!(directory.path().join("rubscope-map.partial").exists());
}
