//! Two maps and one part file: the second is refused and touches nothing.

#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::cli_support::program;

/// A map that takes long enough to be met at work; it is ended by the test.
const LONG: &str = "map --solver event --model rigid --contact unilateral --threads 1 \
                    --speed 300:500:300 --pulse 1e5:1e6:300";

fn command(folder: &Path, more: &str) -> Command {
    let mut command = program();
    command.args(LONG.split_whitespace()).args(more.split_whitespace()).current_dir(folder);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

/// A map that is at work: some of its cells are in its part file.
struct AtWork(Child);

impl AtWork {
    fn start(folder: &Path, more: &str, part: &str) -> Self {
        let child = Self(command(folder, more).spawn().unwrap());
        child.wait_for(&folder.join(part));
        child
    }

    /// Until some cells are in its part file.
    fn wait_for(&self, part: &Path) {
        let since = Instant::now();
        while fs::read_to_string(part).map_or(0, |text| text.lines().count()) < 5 {
            assert!(since.elapsed() < Duration::from_secs(120), "no cells");
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    fn end(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Drop for AtWork {
    fn drop(&mut self) {
        self.end();
    }
}

#[test]
fn a_second_map_on_the_same_part_is_refused_and_told_who_has_it() {
    for (first, second, part) in [
        ("--out m.csv", "--out m.csv", "m.csv.partial"),
        ("--out m.csv", "--out ./m.csv", "m.csv.partial"),
        ("--resume a.part", "--resume a.part --out other.csv", "a.part"),
        ("--out m.csv", "--resume m.csv.partial", "m.csv.partial"),
        ("--shard 1/2 --out m.part", "--shard 1/2 --out m.part", "m.part.partial"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let mut at_work = AtWork::start(folder.path(), first, part);
        let output = command(folder.path(), second).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
        assert!(said.contains(&format!("{part} is in use by another map")), "{said}");
        if cfg!(target_os = "linux") && Path::new("/proc/locks").exists() {
            assert!(said.contains(&format!("process {}: allowed is", at_work.0.id())), "{said}");
        }
        assert_eq!(crate::file_writer::names(folder.path()), [part]);
        assert!(at_work.0.try_wait().unwrap().is_none(), "the first map has ended");
        // Killed, it gives the file back with every cell.
        at_work.end();
        let lines = || fs::read_to_string(folder.path().join(part)).unwrap();
        let kept = lines();
        let next = AtWork::start(folder.path(), first, part);
        assert!(lines().starts_with(kept.rsplit_once('\n').unwrap().0));
        drop(next);
    }
}

#[test]
fn maps_with_parts_of_their_own_run_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let _one = AtWork::start(folder.path(), "--shard 1/2 --out a.part", "a.part.partial");
    let _two = AtWork::start(folder.path(), "--shard 2/2 --out b.part", "b.part.partial");
}

#[test]
fn a_part_file_that_is_no_file_is_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("m.csv.partial")).unwrap();
    let output = command(folder.path(), "--out m.csv").output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains("cannot write m.csv.partial"), "{said}");
    assert_ne!(output.status.code(), Some(0));
}

#[cfg(target_os = "linux")]
#[test]
fn cells_saved_without_a_name_take_the_place_of_none() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("rubscope-map.partial"), "of another run").unwrap();
    let child = command(folder.path(), "").spawn().unwrap();
    let number = child.id().to_string();
    // Before it computes, INT ends it at once.
    let since = Instant::now();
    while !crate::map_signals::computes(child.id()) {
        assert!(since.elapsed() < Duration::from_secs(120), "it does not compute");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &number]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    let theirs = fs::read_to_string(folder.path().join("rubscope-map.partial")).unwrap();
    assert_eq!(theirs, "of another run");
    let ours = format!("rubscope-map-{number}.partial");
    assert!(said.contains(&format!("--resume {ours}")), "{said}");
    assert_eq!(crate::file_writer::names(folder.path()), [ours, "rubscope-map.partial".into()]);
}

/// The largest map: the program's own memory, and a byte a cell.
#[cfg(target_os = "linux")]
#[test]
fn a_large_map_takes_little_memory() {
    let folder = tempfile::tempdir().unwrap();
    let axes = "map --solver event --model rigid --contact unilateral --threads 2 --no-sensitivity \
                --speed 300:500:4000 --pulse 1e5:1e6:4000 --out m.csv";
    let mut command = program();
    command.args(axes.split_whitespace()).current_dir(folder.path()).stderr(Stdio::null());
    let at_work = AtWork(command.spawn().unwrap());
    at_work.wait_for(&folder.path().join("m.csv.partial"));
    let status = fs::read_to_string(format!("/proc/{}/status", at_work.0.id())).unwrap();
    let most = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    let kilobytes: u64 = most.trim().trim_end_matches(" kB").parse().unwrap();
    // Two bytes a cell more would be seen; a list of indices takes eight.
    assert!(kilobytes < 48 << 10, "{kilobytes} kB for 16 million cells");
}
