//! A signal ends a map at once, in the middle of a cell, and nothing stays; a large map
//! takes little memory.

#![cfg(target_os = "linux")]

use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use crate::cli_support::{hearing, program, words};
use crate::pty_support::patiently;

/// One cell of minutes: an undamped casing that bounces for hours.
const LONG_CELL: &str = "map undamped --solver event --model rigid --end 1e6 --speed 500:500:1 \
                         --pulse 20000:20000:1 --out map.csv";

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
    fn start(line: &str, directory: &Path) -> Self {
        let child = program()
            .args(words(line))
            .current_dir(directory)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
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
        patiently("it does not come to work", || {
            std::thread::sleep(Duration::from_millis(5));
            condition().then_some(())
        });
    }

    /// Waits until it ends.
    fn finish(mut self) -> Output {
        patiently("it does not end", || {
            std::thread::sleep(Duration::from_millis(5));
            self.0.as_mut().unwrap().try_wait().unwrap()
        });
        self.0.take().unwrap().wait_with_output().unwrap()
    }
}

/// Whether a map has begun to compute: beside its first thread there are those for cells.
fn computes(process: u32) -> bool {
    let threads = std::fs::read_dir(format!("/proc/{process}/task"));
    threads.is_ok_and(|threads| threads.count() >= 3)
}

/// Starts a map of one long cell, and waits until it is at work.
fn long_map(directory: &Path) -> Running {
    let map = Running::start(LONG_CELL, directory);
    map.wait_until(|| map.computes());
    map
}

#[test]
fn a_signal_stops_a_map_in_the_middle_of_a_cell() {
    for (signal, number) in [("-INT", 2), ("-TERM", 15), ("-HUP", 1)] {
        let directory = tempfile::tempdir().unwrap();
        let map = long_map(directory.path());
        map.signal(signal);
        assert_eq!(map.finish().status.signal(), Some(number), "{signal}");
        assert_eq!(crate::file_writer::names(directory.path()), [] as [&str; 0]);
    }
}

#[test]
fn a_hang_up_that_was_ignored_at_the_start_stays_ignored() {
    let directory = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_rubscope");
    let script = format!("trap '' HUP; exec {program} {LONG_CELL}");
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
    assert_eq!(map.finish().status.signal(), Some(2), "the hang-up came through");
}

/// The largest map: the program's own memory, and two bytes a cell.
#[test]
fn a_large_map_takes_little_memory() {
    let directory = tempfile::tempdir().unwrap();
    let axes = "map --solver event --model rigid --contact unilateral --threads 2 --no-sensitivity \
                --speed 300:500:4000 --pulse 1e5:1e6:4000 --out m.csv";
    let map = Running::start(axes, directory.path());
    map.wait_until(|| map.computes());
    std::thread::sleep(Duration::from_millis(500));
    let process = map.0.as_ref().unwrap().id();
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let most = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    let kilobytes: u64 = most.trim().trim_end_matches(" kB").parse().unwrap();
    // One byte a cell more would be seen; a list of indices takes eight.
    assert!(kilobytes < 48 << 10, "{kilobytes} kB for 16 million cells");
}
