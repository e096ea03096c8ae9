//! Parts of a map that nobody should believe: each is refused in one line, soon,
//! wherever a part is read.

use std::path::Path;
use std::process::Output;
use std::time::Duration;

const MAP: &str = "map --contact bilateral --model rigid --step 1e-6 --speed 250:500:4 \
                   --pulse 0:4e5:3 --set title=Monday";
/// Patience: a part is refused within milliseconds, also on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

fn run(folder: &Path, command: &str) -> Output {
    assert_cmd::cargo::cargo_bin_cmd!("rubscope")
        .args(command.split_whitespace())
        .current_dir(folder)
        .timeout(PATIENCE)
        .output()
        .unwrap()
}

/// A part of the map with all its cells.
fn part() -> String {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &format!("{MAP} --out m.part"));
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    std::fs::read_to_string(folder.path().join("m.part")).unwrap()
}

/// The part with this change in its first line, and all checksums as they must be.
pub fn resigned(part: &str, from: &str, to: &str) -> String {
    let (first, cells) = part.split_once('\n').unwrap();
    let (text, _) = first.rsplit_once(",\"crc32\":\"").unwrap();
    assert!(text.contains(from), "{text} has no {from}");
    let text = text.replacen(from, to, 1);
    let header = crc32fast::hash(text.as_bytes());
    let mut signed = format!("{text},\"crc32\":\"{header:08x}\"}}\n");
    for cell in cells.lines() {
        let (cell, _) = cell.rsplit_once(' ').unwrap();
        signed.push_str(&signed_cell(header, cell));
    }
    signed
}

fn signed_cell(header: u32, cell: &str) -> String {
    let mut hasher = crc32fast::Hasher::new_with_initial(header);
    hasher.update(cell.as_bytes());
    format!("{cell} {:08x}\n", hasher.finalize())
}

/// The reason why `map merge` refuses these bytes.
fn reason(bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.part"), bytes).unwrap();
    refused(&run(folder.path(), "map merge a.part --out m.svg"), folder.path(), &["a.part"])
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
fn a_header_without_meaning_is_refused() {
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
        ("rubscope.map-part/2", "rubscope.map-part/1", "schema rubscope.map-part/1 where"),
        ("rubscope.map-part/2", "\\u001b[2J", "schema "),
    ] {
        let said = reason(resigned(&part, from, to).as_bytes());
        assert!(said.starts_with("rubscope: a.part: not a part of a map: "), "{said}");
        assert!(said.contains(expected), "{to} gave {said}");
    }
}

#[test]
fn more_cells_than_a_map_may_have_are_refused() {
    let many = resigned(&part(), "\"count\":4", "\"count\":99999");
    let many = resigned(&many, "\"count\":3", "\"count\":99999");
    let said = reason(many.as_bytes());
    assert!(said.contains("map = 99999 x 99999 cells: allowed is from 1 to 16000000"), "{said}");
}

#[test]
fn bytes_that_are_no_lines_of_a_part_are_refused() {
    let part = part();
    let (first, cells) = part.split_once('\n').unwrap();
    let with = |more: &[u8]| [format!("{first}\n").as_bytes(), more].concat();
    let long = vec![b'x'; 2 << 20];
    for (bytes, expected) in [
        (Vec::new(), "no complete first line"),
        (b"speed,pulse\n1,2\n".to_vec(), "expected value"),
        (vec![0; 5000], "no complete first line"),
        ([&long[..], b"\n"].concat(), "line 1 has over 1048576 bytes"),
        (vec![b'['; 1 << 19], "no complete first line"),
        ([&vec![b'['; 1 << 19][..], b"\n"].concat(), "a.part"),
        (b"\xff\xfe{}\n".to_vec(), "line 1 is not UTF-8 text"),
        (with(b"1 locked \xff\n"), "line 2 is not UTF-8 text"),
        (with(b"\0\0\0\n"), "line 2 is not a cell"),
        (with(&long), "line 2 has over 64 bytes"),
        (with(b"1 \x1b[31m\xc2\x9b1m\n"), "line 2 is not a cell: \"1 \\u{1b}[31m"),
        (with(b"\n"), "line 2 is not a cell: \"\""),
        (with(b"1 locked 00000000\n"), "line 2 is a cell that does not agree with its checksum"),
        (with(cells.repeat(1000).as_bytes()), "more than 10012 lines of cells"),
        (part.replacen("Monday", "Sunday", 1).into_bytes(), "does not agree with its checksum"),
        (part.replacen("\"crc32\"", "\"crc64\"", 1).into_bytes(), "a.part"),
    ] {
        let said = reason(&bytes);
        assert!(said.contains(expected), "{expected}: {said}");
    }
    if Path::new("/dev/zero").exists() {
        let folder = tempfile::tempdir().unwrap();
        let said = refused(&run(folder.path(), "map merge /dev/zero"), folder.path(), &[]);
        assert!(said.contains("line 1 has over 1048576 bytes"), "{said}");
    }
}

#[test]
fn a_cell_outside_the_map_or_of_no_verdict_is_refused() {
    let part = part();
    let first = part.lines().next().unwrap();
    let (text, _) = first.rsplit_once(",\"crc32\":\"").unwrap();
    let header = crc32fast::hash(text.as_bytes());
    for (cell, expected) in [
        ("12 decay", "cell 12 outside the map"),
        ("18446744073709551616 decay", "line 2 is a cell"),
        ("-1 decay", "line 2 is a cell"),
        ("1 lost", "line 2 is a cell"),
        ("1 decay !!", "line 2 is a cell"),
        ("1 decay ! !", "line 2 is a cell"),
    ] {
        let said = reason(format!("{first}\n{}", signed_cell(header, cell)).as_bytes());
        assert!(said.contains(expected), "{cell}: {said}");
    }
}

/// Where parts are read, with the name that the part has there.
const READERS: [(&str, &str); 4] = [
    ("a.part", "map merge a.part --out m.csv"),
    ("a.part", "{MAP} --resume a.part --out m.csv"),
    ("m.csv.partial", "{MAP} --out m.csv"),
    ("m.part.partial", "{MAP} --shard 1/2 --out m.part"),
];

#[test]
fn every_reader_refuses_altered_verdicts_and_other_versions() {
    let part = part();
    let version = env!("CARGO_PKG_VERSION");
    let other = resigned(&part, &format!("\"version\":\"{version}\""), "\"version\":\"9.9.9\"");
    let verdicts = ["decay", "bounce", "slip", "locked", "adhesive", "failed"];
    let cell = part.lines().nth(5).unwrap();
    let verdict = cell.split(' ').nth(1).unwrap();
    let lie = verdicts.iter().find(|other| **other != verdict).unwrap();
    let altered = part.replacen(cell, &cell.replacen(verdict, lie, 1), 1);
    let versions = format!("was written by rubscope 9.9.9, and this is {version}: allowed are");
    for (name, command) in READERS {
        let command = command.replace("{MAP}", MAP);
        for (bytes, expected) in [
            (&other, &versions[..]),
            (&altered, "line 6 is a cell that does not agree with its checksum"),
        ] {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            let said = refused(&run(folder.path(), &command), folder.path(), &[name]);
            assert!(said.starts_with(&format!("rubscope: {name}")), "{said}");
            assert!(said.contains(expected), "{said}");
            assert!(std::fs::read_to_string(&path).unwrap() == *bytes, "{name} was changed");
        }
    }
}

#[test]
fn a_part_that_went_through_windows_is_read() {
    let part = part().replace('\n', "\r\n");
    for (name, command) in READERS {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(name), &part).unwrap();
        let output = run(folder.path(), &command.replace("{MAP}", MAP));
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{said}");
        assert!(said.contains("12 cells"), "{said}");
    }
}
