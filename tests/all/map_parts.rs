//! Shards and merging give the bytes of one run; shares that do not make one whole map are
//! refused.

use std::path::Path;

use crate::cli_support::{self, ended, map_words as words, program, refusal};

/// A map with several verdicts, fast in any build.
const MAP: &str =
    "map --contact bilateral --model rigid --step 1e-6 --speed 250:500:26 --pulse 0:4e5:9";
const FORMATS: [&str; 3] = ["csv", "json", "svg"];

/// Runs a command that must succeed; returns its standard error.
fn done(arguments: &[&str]) -> String {
    String::from_utf8(ended(program().args(arguments), 0).stderr).unwrap()
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
    let parts: Vec<String> = (1..=7).map(|k| text(&at(&format!("part-{k}.csv")))).collect();
    for (k, part) in parts.iter().enumerate() {
        let said = done(&words(MAP, &["--shard", &format!("{}/7", k + 1), "--out", part]));
        let rows = if k < 3 { 34 } else { 33 };
        assert_eq!(said, format!("rubscope: wrote {rows} rows to {part}\n"));
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
fn a_share_is_a_table_below_a_line_that_names_its_origin() {
    let directory = tempfile::tempdir().unwrap();
    let path = text(&directory.path().join("part.csv"));
    done(&words(MAP, &["--shard", "2/2", "--out", &path]));
    let part = std::fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = part.lines().collect();
    let version = cli_support::text(&["--version"]);
    let (program, origin) = lines[0].split_once(" map ").unwrap();
    assert_eq!(program, format!("# {}", version.trim_end()));
    let origin: serde_json::Value = serde_json::from_str(origin).unwrap();
    assert_eq!(origin["x"]["path"], "operation.speed_rad_s");
    assert!(origin["scene"].as_str().unwrap().contains("contact = \"bilateral\""));
    assert_eq!(lines[1], "cell,speed_rad_s,pulse_n,verdict,sensitive,depends_on_step");
    assert_eq!((lines[2], lines.len()), ("1,260,0,decay,false,false", 2 + 117));
}

#[test]
fn shares_that_do_not_belong_together_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| text(&directory.path().join(name));
    let (first, second, other) = (at("first.csv"), at("second.csv"), at("other.csv"));
    done(&words(MAP, &["--shard", "1/2", "--out", &first]));
    done(&words(MAP, &["--shard", "2/2", "--out", &second]));
    let merge = |files: &[&str]| refusal(&[&["map", "merge"], files].concat());
    assert_eq!(merge(&[&second]), "rubscope: cell 0 is missing, and 116 others");
    assert_eq!(
        merge(&[&first, &second, &first]),
        format!("rubscope: {first}: cell 0 (line 3) is there twice")
    );
    let differs = format!("rubscope: {other}: a share of another map than the file before it");
    for option in [&["--zeta-casing", "0.04"][..], &["--no-sensitivity"]] {
        done(&words(MAP, &[option, &["--shard", "2/2", "--out", &other]].concat()));
        assert_eq!(merge(&[&first, &other]), differs);
    }
    std::fs::write(&other, "speed,pulse\n").unwrap();
    for files in [[&first, &other], [&other, &first]] {
        let said = merge(&files.map(String::as_str));
        assert!(said.starts_with(&format!("rubscope: {other}: not a share of a map: ")), "{said}");
    }
    let share = std::fs::read_to_string(&second).unwrap();
    std::fs::write(&other, share.trim_end().rsplit_once('\n').unwrap().0).unwrap();
    assert_eq!(merge(&[&first, &other]), "rubscope: cell 233 is missing, and 0 others");
}
