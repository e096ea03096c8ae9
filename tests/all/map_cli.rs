//! The command line of the map: axes, where results go, failures of writing,
//! the text in the terminal, and the parallel line of docs/commands.md.

use std::process::Output;

use crate::cli_support::{self, map_words as words, refusal, rubscope};

const MAP: &str =
    "map --contact bilateral --model rigid --step 1e-6 --speed 250:500:11 --pulse 0:4e5:9";

fn message(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[test]
fn any_two_keys_are_axes() {
    let command = "map slip --json --x casing.damping_ratio=log:1e-4:0.1:4 \
                   --y operation.speed_rad_s=300:500:3";
    let map = cli_support::json(&words(command, &[]));
    assert_eq!(map["schema"], "rubscope.map/1");
    let values: Vec<f64> = serde_json::from_value(map["damping_ratio"].clone()).unwrap();
    for (value, expected) in values.iter().zip([1e-4, 1e-3, 1e-2, 1e-1]) {
        // Equal factors, to the round-off of a power.
        assert!((value / expected - 1.0).abs() < 1e-12, "{values:?}");
    }
    assert_eq!(map["speed_rad_s"], serde_json::json!([300.0, 400.0, 500.0]));
    assert_eq!(map["verdict"].as_array().unwrap().len(), 3);
    assert_eq!(map["verdict"][0].as_array().unwrap().len(), 4);
    assert_eq!(map["runs"], 12);
}

#[test]
fn axes_are_refused_in_one_line_that_says_what_is_allowed() {
    for (arguments, said) in [
        (&["--x", "casing.damping=0:1:3"][..], "unknown key casing.damping"),
        (&["--x", "solver.kind=0:1:3"], "axis solver.kind: allowed are keys that hold a number"),
        (
            &["--x", "casing.damping_ratio=0:0.1"],
            "axis casing.damping_ratio=0:0.1: allowed is PATH=FROM:TO:COUNT",
        ),
        (
            &["--x", "casing.damping_ratio=log:0:0.1:5"],
            "axis casing.damping_ratio = log:0:0.1:5: allowed is log: with both ends above 0",
        ),
        (
            &["--x", "operation.pulse_n=log:1e-300:1e6:4"],
            "axis operation.pulse_n = log:1e-300:1e6:4: allowed is log: with ends that differ by a \
             factor of at most 1e30",
        ),
        (
            &["--x", "operation.pulse_n=1:1000:4"],
            "map = operation.pulse_n on both axes: allowed is two different keys; columns (x) are \
             the speed and rows (y) the pulse by default",
        ),
        (&["--y", "casing.damping_ratio=0:-0.1:5"], "casing.damping_ratio = -0.1: allowed is"),
        (&["--y", "operation.pulse_n=0:nan:5"], "operation.pulse_n = NaN: allowed is"),
        (
            &["--y", "operation.pulse_n=0:1:0"],
            "axis operation.pulse_n = 0:1:0: allowed is a count from 1",
        ),
        (
            &["--speed", "0:500:100000", "--pulse", "0:1:100000"],
            "map = 100000 x 100000 cells: allowed is from 1 to 16000000 cells",
        ),
        (&["--speed", "0:500:0"], "--speed = 0:500:0: allowed is FROM:TO:COUNT"),
        (&["--shard", "3/2", "--out", "a.csv"], "--shard = 3/2: allowed is K/COUNT with K from 1"),
        (&["--shard", "1/2", "--out", "a.svg"], "--out = a.svg: allowed is a file name ending in"),
        (&["--out", "a.part"], "--out = a.part: allowed is a file name ending in .csv, .json or"),
        (&["--out", "a.png"], "--out = a.png: allowed is a file name ending in .csv"),
        (
            &["--out", "a/.csv"],
            "--out = a/.csv: allowed is a file name ending in .csv, .json or .svg, after a name",
        ),
    ] {
        let refused = refusal(&[&["map"], arguments].concat());
        assert!(refused.starts_with(&format!("rubscope: {said}")), "{refused}");
    }
}

#[test]
fn the_text_map_fits_marks_the_two_speeds_and_explains_its_signs() {
    let text =
        cli_support::text(&["map", "--step", "1e-6", "--pulse", "0:4e5:9", "--no-sensitivity"]);
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines.iter().all(|line| line.chars().count() <= 80), "{text}");
    let marked = |name: &str| lines.iter().find(|line| line.contains(name)).unwrap().find('^');
    // 10 rad/s a column: 292.878 and 411.934 rad/s are nearest to 29 and 41.
    assert_eq!(marked("Omega_c = 292.878"), Some(14 + 29));
    assert_eq!(marked("Omega_lock = 411.934"), Some(14 + 41));
    let legend = ["#  locked, ", "%  adhesive, ", ".  decay, "];
    assert!(legend.iter().all(|sign| text.contains(sign)), "{text}");
    let wide = ["map", "--step", "1e-5", "--speed", "0:1:400", "--pulse", "0:0:1"];
    let text = cli_support::text(&wide);
    assert!(text.contains("Shown is one column of 4 and every row."), "{text}");
}

/// The line of the document, with the program in place of its name.
#[test]
fn the_parallel_line_of_the_document_gives_the_map_of_one_run() {
    use std::process::Command;
    if Command::new("parallel").arg("--version").output().is_err() {
        println!("skipped: GNU parallel is not installed");
        return;
    }
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/commands.md");
    let text = std::fs::read_to_string(path).unwrap();
    let block = text
        .split("```sh\n")
        .map(|rest| rest.split("```").next().unwrap())
        .find(|block| block.starts_with("parallel "))
        .unwrap();
    let directory = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_rubscope");
    std::os::unix::fs::symlink(program, directory.path().join("rubscope")).unwrap();
    let search = format!("{}:{}", directory.path().display(), std::env::var("PATH").unwrap());
    let run = |script: &str| {
        let output = Command::new("sh")
            .args(["-ec", script])
            .env("PATH", &search)
            // Directory for the files of parallel.
            .env("HOME", directory.path())
            .current_dir(directory.path())
            .output()
            .unwrap();
        assert!(output.status.success(), "{script}: {}", message(&output));
    };
    run(block);
    // The same options without the share.
    let line = block.replace("\\\n", " ");
    let options = line.split("rubscope map ").nth(1).unwrap().split(" --shard").next().unwrap();
    run(&format!("rubscope map {options} --out single.csv"));
    let bytes = |name: &str| std::fs::read(directory.path().join(name)).unwrap();
    assert_eq!(bytes("map.csv"), bytes("single.csv"));
}

#[test]
fn more_threads_than_any_machine_has_are_refused() {
    for threads in ["0", "1025", "1000000000", "18446744073709551616", "two"] {
        let line = refusal(&words(MAP, &["--threads", threads]));
        let expected = "allowed is a whole number from 1 to 1024";
        assert!(line.contains(&format!("'{threads}'")) && line.contains(expected), "{line}");
    }
}

#[test]
fn with_rpm_a_map_is_in_turns_a_minute_with_round_ends() {
    let map = ["map", "--no-sensitivity", "--set", "solver.end_s=1e-3", "--pulse", "0:1e6:3"];
    let text = cli_support::text(&[&map[..], &["--rpm"]].concat());
    assert!(text.contains("(up) against operation.speed_rpm (right)"), "{text}");
    assert!(text.contains("Omega_lock = 3933.68") && text.contains("\n              0 "), "{text}");
    assert!(text.lines().any(|line| line.trim_end().ends_with(" 5000")), "{text}");
    let text = cli_support::text(&map);
    assert!(text.contains("against operation.speed_rad_s (right)"), "{text}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.svg");
    let out = ["--rpm", "--out", path.to_str().unwrap()];
    assert!(rubscope(&[&map[..], &out].concat()).status.success());
    let picture = std::fs::read_to_string(path).unwrap();
    assert!(picture.contains("[rpm]") && picture.contains("4000") && !picture.contains("[rad/s]"));
}
