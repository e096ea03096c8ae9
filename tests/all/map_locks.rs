//! Two maps and one part file: the second is refused and touches nothing.

#![cfg(unix)]

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A map that takes long enough to be met at work; it is ended by the test.
const LONG: &str = "map --solver event --model rigid --contact unilateral --threads 1 \
                    --speed 300:500:300 --pulse 1e5:1e6:300";

fn command(folder: &Path, more: &str) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("rubscope"));
    command.args(LONG.split_whitespace()).args(more.split_whitespace()).current_dir(folder);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

/// A map that is at work: some of its cells are in its part file.
struct AtWork(Child);

impl AtWork {
    fn start(folder: &Path, more: &str, part: &str) -> Self {
        let child = Self(command(folder, more).spawn().unwrap());
        let since = Instant::now();
        let part = folder.join(part);
        while std::fs::read_to_string(&part).map_or(0, |text| text.lines().count()) < 5 {
            assert!(since.elapsed() < Duration::from_secs(120), "no cells");
            std::thread::sleep(Duration::from_millis(5));
        }
        child
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
        let lines = || std::fs::read_to_string(folder.path().join(part)).unwrap();
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
    std::fs::create_dir(folder.path().join("m.csv.partial")).unwrap();
    let output = command(folder.path(), "--out m.csv").output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains("cannot write m.csv.partial"), "{said}");
    assert_ne!(output.status.code(), Some(0));
}
