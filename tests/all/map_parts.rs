//! Maps in several runs: shards, merging, and runs that are stopped or killed
//! and then continued all give the same bytes.

use std::path::Path;

use crate::cli_support::{refusal, rubscope};

/// A map with several verdicts, fast in any build.
const MAP: &str =
    "map --contact bilateral --model rigid --step 1e-6 --speed 250:500:26 --pulse 0:4e5:9";
/// A map that takes a debug build a second or two, so that it can be stopped.
const SLOW: &str = "map --solver event --contact unilateral --model rigid --zeta-casing 0.05 \
                    --threads 1 --speed 300:500:21 --pulse 1e5:1e6:19";
const FORMATS: [&str; 4] = ["csv", "json", "part", "svg"];

fn words<'a>(command: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    command.split_whitespace().chain(more.iter().copied()).collect()
}

/// Runs a command that must succeed; returns its standard error.
fn done(arguments: &[&str]) -> String {
    let output = rubscope(arguments);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{arguments:?} said {message}");
    message
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_string()
}

fn assert_same_bytes(one: &Path, other: &Path) {
    let bytes = |path: &Path| std::fs::read(path).unwrap();
    assert!(bytes(one) == bytes(other), "{} differs from {}", one.display(), other.display());
}

#[test]
fn seven_shards_merge_to_the_bytes_of_one_run() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    let parts: Vec<String> = (1..=7).map(|k| text(&at(&format!("part-{k}.part")))).collect();
    for (k, part) in parts.iter().enumerate() {
        done(&words(MAP, &["--shard", &format!("{}/7", k + 1), "--out", part]));
    }
    for format in FORMATS {
        let (single, merged) = (at(&format!("single.{format}")), at(&format!("merged.{format}")));
        done(&words(MAP, &["--out", &text(&single)]));
        let files: Vec<&str> = parts.iter().rev().map(String::as_str).collect();
        done(&words("map merge", &[&files[..], &["--out", &text(&merged)]].concat()));
        assert_same_bytes(&single, &merged);
    }
    // Only the results and the parts remain.
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 7 + 2 * FORMATS.len());
}

#[test]
fn parts_that_do_not_belong_together_are_refused_by_name() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| text(&directory.path().join(name));
    let (first, second, other) = (at("first.part"), at("second.part"), at("other.part"));
    done(&words(MAP, &["--shard", "1/2", "--out", &first]));
    done(&words(MAP, &["--shard", "2/2", "--out", &second]));
    let merge = |files: &[&str]| refusal(&[&["map", "merge"], files].concat());
    assert_eq!(
        merge(&[&second]),
        "rubscope: 117 of 234 cells are in none of the parts, the first of them number 0"
    );
    let differs = |what: &str| {
        let said = merge(&[&first, &other]);
        assert_eq!(
            said,
            format!("rubscope: {other} does not belong to {first}: they differ in {what}")
        );
    };
    done(&words(MAP, &["--zeta-casing", "0.04", "--shard", "2/2", "--out", &other]));
    differs("the scene");
    done(&words(MAP, &["--no-sensitivity", "--shard", "2/2", "--out", &other]));
    differs("whether sensitivity was asked for");
    let part = std::fs::read_to_string(&second).unwrap();
    std::fs::write(&other, "speed,pulse\n").unwrap();
    let said = merge(&[&first, &other]);
    assert!(said.starts_with(&format!("rubscope: {other}: not a part of a map")), "{said}");
    // Whole lines count, half a line does not: "1 locked" may have been "1 locked !".
    std::fs::write(&other, part.trim_end()).unwrap();
    assert!(merge(&[&first, &other]).starts_with("rubscope: 1 of 234 cells are in none"));
}

#[test]
fn parts_with_another_title_note_or_view_belong_together() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    let (first, second) = (text(&at("first.part")), text(&at("second.part")));
    let other = ["--set", "title=Tuesday", "--set", "note=on node 2", "--set", "view.charts=map"];
    done(&words(MAP, &["--shard", "1/2", "--out", &first]));
    let share = [&["--shard", "2/2", "--out", &second][..], &other].concat();
    done(&words(MAP, &share));
    let (merged, single) = (at("merged.json"), at("single.json"));
    done(&["map", "merge", &first, &second, "--out", &text(&merged)]);
    done(&words(MAP, &["--out", &text(&single)]));
    // Title and note are those of the first part.
    assert_same_bytes(&merged, &single);
    // A run with another title continues from these cells and keeps its title.
    let resumed = at("resumed.json");
    let said = done(&words(
        MAP,
        &[&["--resume", &second, "--out", &text(&resumed)][..], &["--set", "title=Wednesday"]]
            .concat(),
    ));
    assert!(said.starts_with("rubscope: going on from 117 cells"), "{said}");
    let wednesday = at("wednesday.json");
    done(&words(MAP, &["--out", &text(&wednesday), "--set", "title=Wednesday"]));
    assert_same_bytes(&resumed, &wednesday);
}

#[cfg(unix)]
mod stopped {
    use super::*;
    use crate::cli_support::program;
    use std::process::{Child, Command, Stdio};
    use std::time::{Duration, Instant};

    /// Starts the slow map and waits until some of its cells are on disk.
    fn started(directory: &Path, more: &[&str]) -> Child {
        let mut child = program()
            .args(words(SLOW, more))
            .args(["--out", "map.csv"])
            .current_dir(directory)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let noted = directory.join("map.csv.partial");
        let lines = || std::fs::read_to_string(&noted).map_or(0, |text| text.lines().count());
        let since = Instant::now();
        while lines() < 20 && child.try_wait().unwrap().is_none() {
            assert!(since.elapsed() < Duration::from_secs(60), "no cells after a minute");
            std::thread::sleep(Duration::from_millis(2));
        }
        child
    }

    /// Continues in the directory of a stopped run; returns the messages.
    fn goes_on(directory: &Path, more: &[&str]) -> String {
        let output = assert_cmd::cargo::cargo_bin_cmd!("rubscope")
            .args(words(SLOW, more))
            .args(["--out", "map.csv"])
            .current_dir(directory)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stderr).unwrap()
    }

    fn single() -> tempfile::TempDir {
        let directory = tempfile::tempdir().unwrap();
        done(&words(SLOW, &["--out", &text(&directory.path().join("map.csv"))]));
        directory
    }

    #[test]
    fn a_killed_run_goes_on_and_ends_with_the_bytes_of_one_that_was_not() {
        let single = single();
        // With --resume, and with only the same command.
        for more in [&["--resume", "map.csv.partial"][..], &[]] {
            let directory = tempfile::tempdir().unwrap();
            let mut child = started(directory.path(), &[]);
            child.kill().unwrap();
            assert!(!child.wait().unwrap().success(), "the run ended before it could be killed");
            assert!(!directory.path().join("map.csv").exists());
            let said = goes_on(directory.path(), more);
            assert!(said.starts_with("rubscope: going on from "), "{said}");
            assert!(!said.starts_with("rubscope: going on from 0 "), "{said}");
            assert_same_bytes(&directory.path().join("map.csv"), &single.path().join("map.csv"));
            // What the user named stays.
            let named = !more.is_empty();
            assert_eq!(directory.path().join("map.csv.partial").exists(), named);
        }
    }

    #[test]
    fn an_interrupted_run_says_how_to_go_on() {
        let directory = tempfile::tempdir().unwrap();
        let child = started(directory.path(), &[]);
        let number = child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &number]).status().unwrap().success());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130));
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.starts_with("rubscope: stopped; "), "{said}");
        let advice = " of 399 cells are kept in map.csv.partial: go on with the same command\n";
        assert!(said.ends_with(advice), "{said}");
        let kept = std::fs::read_to_string(directory.path().join("map.csv.partial")).unwrap();
        let cells: usize =
            said["rubscope: stopped; ".len()..said.len() - advice.len()].parse().unwrap();
        assert_eq!(kept.lines().count(), 1 + cells);
        // Another map does not use these cells, and does not delete them.
        let output = assert_cmd::cargo::cargo_bin_cmd!("rubscope")
            .args(words(MAP, &["--out", "map.csv"]))
            .current_dir(directory.path())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2));
        let said = String::from_utf8(output.stderr).unwrap();
        let start =
            format!("rubscope: map.csv.partial holds {cells} cells of another map: allowed is");
        assert!(said.starts_with(&start), "{said}");
        let after = std::fs::read_to_string(directory.path().join("map.csv.partial")).unwrap();
        assert_eq!(after, kept);
        goes_on(directory.path(), &["--resume", "map.csv.partial"]);
        assert_same_bytes(&directory.path().join("map.csv"), &single().path().join("map.csv"));
    }
}
