//! Writing that is ended by a signal, by the limit of file sizes or by a full disk
//! leaves what was there before. Only a signal may leave a hidden file beside it.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::cli_support::{hearing, program};
use crate::file_writer::names;

/// A run with a history of some tens of megabytes.
const LARGE: &str = "run --solver event --contact unilateral --model rigid --samples 200000";
/// A run with a history of some hundred kilobytes.
const SMALL: &str = "run --solver event --contact unilateral --model rigid --samples 2000";
const MAP: &str = "map --contact bilateral --model rigid --step 1e-6 --speed 250:500:60 \
                   --pulse 0:4e5:60 --no-sensitivity";
const FIGURES: &str = "figures --only 9 --out .";

const PROGRAM: &str = env!("CARGO_BIN_EXE_rubscope");

#[cfg(target_os = "linux")]
#[test]
fn a_signal_while_a_file_is_written_leaves_the_old_one() {
    for (signal, code) in [("-TERM", 15), ("-INT", 2), ("-KILL", 9)] {
        // It may be complete before the signal comes.
        let mut met = false;
        for _ in 0..40 {
            let folder = tempfile::tempdir().unwrap();
            fs::write(folder.path().join("big.csv"), "old").unwrap();
            let mut child = program()
                .args(LARGE.split_whitespace())
                .args(["--out", "big.csv"])
                .current_dir(folder.path())
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .unwrap();
            let since = Instant::now();
            // The trial of the place has its hidden file for an instant only.
            let large = || {
                let files = fs::read_dir(folder.path()).unwrap().flatten();
                files.filter_map(|file| file.metadata().ok()).any(|file| file.len() > 1 << 16)
            };
            while !large() && child.try_wait().unwrap().is_none() {
                assert!(since.elapsed() < Duration::from_secs(300), "nothing was written");
                std::thread::sleep(Duration::from_micros(200));
            }
            let number = child.id().to_string();
            let _ = Command::new("kill").args([signal, &number]).status();
            let ended = child.wait().unwrap();
            let others: Vec<String> =
                names(folder.path()).into_iter().filter(|name| name != "big.csv").collect();
            assert!(others.iter().all(|name| name.starts_with(".rubscope-")), "{others:?}");
            if !others.is_empty() {
                use std::os::unix::process::ExitStatusExt;
                assert_eq!(ended.signal(), Some(code), "{ended}");
                assert_eq!(fs::read(folder.path().join("big.csv")).unwrap(), b"old");
                met = true;
                break;
            }
        }
        assert!(met, "no signal came while the file was written");
    }
}

/// Runs a command under `sh` with files of at most `blocks` of 512 bytes.
fn limited(folder: &Path, blocks: u32, command: &str) -> Output {
    let script = format!("ulimit -f {blocks} && exec '{PROGRAM}' {command}");
    hearing("sh").args(["-c", &script]).current_dir(folder).output().unwrap()
}

/// The old file stands, no other came, and the text is on standard output.
fn is_kept(output: &Output, folder: &Path, name: &str, start: &str) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.starts_with(&format!("rubscope: cannot write {name}")), "{said}");
    assert!(said.contains("standard output"), "{said}");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.trim_start().starts_with(start), "{}", &text[..text.len().min(200)]);
    assert_eq!(fs::read_to_string(folder.join(name.trim_start_matches("./"))).unwrap(), "old");
}

/// What is written, where, and how its text begins.
const WRITERS: [(&str, &str, &str); 5] = [
    (SMALL, "h.csv", "t_s,theta_rad"),
    ("hbm --speed 0:500:2000", "h.csv", "speed_rad_s"),
    (MAP, "m.csv", "speed_rad_s"),
    (MAP, "m.json", "{"),
    (FIGURES, "./fig09.svg", "<svg"),
];

fn fails_in(folder: &Path, run: impl Fn(&str) -> Output) {
    for (command, name, start) in WRITERS {
        let path = folder.join(name.trim_start_matches("./"));
        fs::write(&path, "old").unwrap();
        let command = if command == FIGURES {
            command.to_string()
        } else {
            format!("{command} --out {name}")
        };
        is_kept(&run(&command), folder, name, start);
        fs::remove_file(&path).unwrap();
        assert!(names(folder).iter().all(|name| name == "full"), "{:?}", names(folder));
    }
}

#[test]
fn the_limit_of_file_sizes_is_a_full_disk_and_not_the_end() {
    let folder = tempfile::tempdir().unwrap();
    // Some 16 kB; the least that shells count is 512 or 1024 bytes.
    fails_in(folder.path(), |command| limited(folder.path(), 16, command));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_the_old_file_and_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let disk = folder.path().join("disk");
    fs::create_dir(&disk).unwrap();
    let mount = Command::new("mount")
        .args(["-t", "tmpfs", "-o", "size=256k", "tmpfs"])
        .arg(&disk)
        .stderr(Stdio::null())
        .status();
    if !mount.is_ok_and(|status| status.success()) {
        println!("skipped: mounting is not allowed here");
        return;
    }
    struct Mounted<'a>(&'a Path);
    impl Drop for Mounted<'_> {
        fn drop(&mut self) {
            let _ = Command::new("umount").arg(self.0).status();
        }
    }
    let _mounted = Mounted(&disk);
    fs::write(disk.join("full"), vec![b'x'; 240 << 10]).unwrap();
    fails_in(&disk, |command| {
        program().args(command.split_whitespace()).current_dir(&disk).output().unwrap()
    });
}

#[cfg(target_os = "linux")]
#[test]
fn a_result_that_can_go_nowhere_names_both_places() {
    let folder = tempfile::tempdir().unwrap();
    let output = limited(folder.path(), 16, &format!("{SMALL} --out h.csv > /dev/full"));
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.starts_with("rubscope: cannot write h.csv: "), "{said}");
    assert!(said.contains("; nor standard output: "), "{said}");
    for command in ["run grazing", "hbm --speed 0:500:2000", "scenes", "man"] {
        let script = format!("exec '{PROGRAM}' {command} > /dev/full");
        let output = hearing("sh").args(["-c", &script]).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{command}: {said}");
        assert!(said.starts_with("rubscope: cannot write standard output: "), "{said}");
    }
}
