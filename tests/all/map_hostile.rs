//! Shares of a map that nobody should believe: each is refused in one line, soon.

use std::path::Path;
use std::process::Output;

use crate::cli_support::hearing;

const MAP: &str = "map --contact bilateral --model rigid --step 1e-6 --speed 250:500:4 \
                   --pulse 0:4e5:3 --set title=Monday --shard 1/1";
/// Patience in seconds: a part is refused within milliseconds, also on a busy machine.
const PATIENCE: &str = "120";

fn run(folder: &Path, command: &str) -> Output {
    hearing("timeout")
        .args([PATIENCE, env!("CARGO_BIN_EXE_rubscope")])
        .args(command.split_whitespace())
        .current_dir(folder)
        .output()
        .unwrap()
}

/// A part of the map with all its cells.
fn part() -> String {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &format!("{MAP} --out m.csv"));
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    std::fs::read_to_string(folder.path().join("m.csv")).unwrap()
}

/// The reason why `map merge` refuses these bytes.
fn reason(bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.csv"), bytes).unwrap();
    refused(&run(folder.path(), "map merge a.csv --out m.svg"), folder.path(), &["a.csv"])
}

/// One clean line, exit 2, and nothing written.
fn refused(output: &Output, folder: &Path, files: &[&str]) -> String {
    let said = String::from_utf8(output.stderr.clone()).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(output.stdout.is_empty());
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(!said.trim_end().chars().any(char::is_control) && said.len() < 4000, "{said:?}");
    assert_eq!(crate::file_writer::names(folder), files);
    said
}

#[test]
fn a_first_line_without_meaning_is_refused() {
    let part = part();
    for (from, to, expected) in [
        ("\"count\":4", "\"count\":4294967295", "a count from 1 to 100000"),
        ("\"count\":4", "\"count\":0", "a count from 1 to 100000"),
        ("\"count\":4", "\"count\":-1", "invalid value"),
        ("\"to\":500.0,\"count\":4", "\"to\":1e308,\"count\":1", "operation.speed_rad_s = 1e308"),
        ("\"to\":500.0", "\"to\":1e308", "operation.speed_rad_s = 1e308: allowed is"),
        ("\"to\":500.0", "\"to\":1e999", "number out of range"),
        ("\"to\":500.0", "\"to\":NaN", "expected value"),
        ("\"to\":500.0", "\"to\":null", "invalid type"),
        ("radius_m = 0.5", "radius_m = 0.0", "casing.radius_m = 0: allowed is"),
        ("radius_m = 0.5", "radius_m = 0.4", "casing.radius_m = 0.4: allowed is above"),
        ("blade_length_m = 0.4999", "blade_length_m = 0.6", "above bladed_disk.blade_length_m"),
        ("damping_ratio = 0.04", "damping_ratio = nan", "damping_ratio = NaN: allowed is"),
        ("blades = 22", "blades = 0", "bladed_disk.blades = 0: allowed is"),
        ("operation.speed_rad_s", "title", "axis title: allowed are keys that hold a number"),
        ("operation.speed_rad_s", "speed", "unknown key speed"),
        ("operation.speed_rad_s", "\\u001b[31m\\u202e", "unknown key"),
        ("Monday", "\\\\u001b]0;mine\\\\u0007", "title = "),
        ("Monday", "\\\\u202eyadnoM", "title = "),
        ("\"sensitivity\":true", "\"sensitivity\":true,\"more\":1", "unknown field `more`"),
        ("\"log\":false", "\"log\":1", "invalid type"),
        ("# rubscope", "# scope", "its first line does not begin with # rubscope"),
    ] {
        assert!(part.contains(from), "{from}");
        let said = reason(part.replacen(from, to, 1).as_bytes());
        assert!(said.starts_with("rubscope: a.csv: not a share of a map: "), "{said}");
        assert!(said.contains(expected), "{to} gave {said}");
    }
    let other = part.replacen(env!("RUBSCOPE_COMMIT"), "0a1b2c3d4-modified-5e6f70819", 1);
    let said = reason(other.as_bytes());
    assert!(said.contains("its first line does not begin with # rubscope"), "{said}");
}

#[test]
fn more_cells_than_a_map_may_have_are_refused() {
    let many = part().replacen("\"count\":4", "\"count\":99999", 1);
    let many = many.replacen("\"count\":3", "\"count\":99999", 1);
    let said = reason(many.as_bytes());
    assert!(said.contains("map = 99999 x 99999 cells: allowed is from 1 to 16000000"), "{said}");
}

#[test]
fn bytes_that_are_no_lines_of_a_part_are_refused() {
    let part = part();
    let lines: Vec<&str> = part.lines().collect();
    let with = |more: &[u8]| [format!("{}\n{}\n", lines[0], lines[1]).as_bytes(), more].concat();
    for (bytes, expected) in [
        (Vec::new(), "its first line does not begin"),
        (b"speed,pulse\n1,2\n".to_vec(), "its first line does not begin"),
        (vec![0; 5000], "its first line does not begin"),
        (b"\xff\xfe{}\n".to_vec(), "UTF-8"),
        (format!("{}\n", lines[0]).into_bytes(), "cell 0 is missing, and 11 others"),
        (with(b"1,locked \xff\n"), "line 3 is not a row"),
        (with(b"\0\0\0\n"), "line 3 is not a row"),
        (with(&vec![b'x'; 2 << 20]), "line 3 is not a row"),
        (with(b"1 \x1b[31m\xc2\x9b1m\n"), "line 3 is not a row"),
        (with(b"12,250,0,decay,false,false\n"), "line 3 is not a row"),
        (with(b"18446744073709551616,250,0,decay,false,false\n"), "line 3 is not a row"),
        (with(b"-1,250,0,decay,false,false\n"), "line 3 is not a row"),
        (with(b"0,250,0,lost,false,false\n"), "line 3 is not a row"),
        (with(b"0,250,0,decay\n"), "line 3 is not a row"),
        (with(b"0,251,0,decay,false,false\n"), "line 3 is not a row"),
        (with(b"0,250,1,decay,false,false\n"), "line 3 is not a row"),
        (with(b"0,250,0,decay,false,false\n1,250,0,decay,false,false\n"), "line 4 is not a row"),
        (format!("{}\ncell,a,b,c,d,e\n", lines[0]).into_bytes(), "line 2 is not cell,speed_"),
        ([lines[0].as_bytes(), b"\n\xff\n"].concat(), "line 2 is not cell,speed_"),
        (with(b"0,250,0,decay,false,1\n"), "line 3 is not a row"),
    ] {
        let said = reason(&bytes);
        assert!(said.contains(expected), "{expected}: {said}");
    }
    if Path::new("/dev/zero").exists() {
        let folder = tempfile::tempdir().unwrap();
        let said = refused(&run(folder.path(), "map merge /dev/zero"), folder.path(), &[]);
        assert!(said.contains("its first line does not begin"), "{said}");
    }
}

#[test]
fn a_part_that_went_through_windows_is_read() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.csv"), part().replace('\n', "\r\n")).unwrap();
    let output = run(folder.path(), "map merge a.csv --out m.csv");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("12 rows"), "{said}");
}
