//! The text of a table: its encoding, the separator of its cells, and its records with their line
//! numbers.

use anyhow::{Result, bail};
use csv::StringRecord;

/// Records of a table with their line numbers, and the separator of their cells.
pub(super) struct Cells {
    /// Records that contain anything but empty cells, each with its line number.
    pub records: Vec<(u64, StringRecord)>,
    /// Separator of the cells.
    pub separator: u8,
}

/// Splits the bytes of a file into records. Comment lines begin with `#`.
///
/// The separator is that of a first line `sep=;`, otherwise the first of semicolon, tab and bar
/// that the last line contains (a title before the names has no cells), otherwise the comma.
///
/// # Errors
/// The bytes are no text.
pub(super) fn cells(bytes: &[u8]) -> Result<Cells> {
    let text = text(bytes)?.replace("\r\n", "\n").replace('\r', "\n");
    let first = text.lines().next().unwrap_or_default().trim().trim_matches('"');
    let named = first.get(..4).filter(|start| start.eq_ignore_ascii_case("sep="));
    let named = named.and_then(|_| first.as_bytes().get(4).copied());
    // As a comment, the line keeps its place in the count of lines.
    let text = if named.is_some() { format!("#{text}") } else { text };
    let last = text.lines().rfind(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let contained = |c: &u8| last.unwrap_or_default().as_bytes().contains(c);
    let found = || [b';', b'\t', b'|'].into_iter().find(contained).unwrap_or(b',');
    let separator = named.unwrap_or_else(found);
    let mut reader = csv::ReaderBuilder::new();
    reader.delimiter(separator).comment(Some(b'#')).flexible(true).trim(csv::Trim::All);
    let mut reader = reader.has_headers(false).from_reader(text.as_bytes());
    // Reading text that is already in memory cannot fail, since any number of cells is accepted.
    let records = reader.records().flatten();
    let records = records.filter(|record| !record.iter().all(str::is_empty));
    let numbered = records.map(|record| {
        // The reader reports the position before any skipped lines.
        let (line, start) = record.position().map_or((0, 0), |at| (at.line(), at.byte()));
        let before = text.get(start as usize..).unwrap_or_default().lines();
        let is_skipped = |line: &&str| line.is_empty() || line.starts_with('#');
        (line + before.take_while(is_skipped).count() as u64, record)
    });
    Ok(Cells { records: numbered.collect(), separator })
}

/// Decodes text in UTF-8, in UTF-16 with or without a byte order mark, or in Windows-1252.
fn text(bytes: &[u8]) -> Result<String> {
    let zeros = |parity: usize| {
        let zeros = bytes.iter().skip(parity).step_by(2).filter(|byte| **byte == 0).count();
        4 * zeros > bytes.len()
    };
    let utf_16 = |bytes: &[u8], number: fn([u8; 2]) -> u16| {
        let units = bytes.chunks_exact(2).map(|pair| number([pair[0], pair[1]]));
        let decoded: Result<String, _> = char::decode_utf16(units).collect();
        decoded.or_else(|_| no_text("text in UTF-16 with errors"))
    };
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => text(rest),
        [0xff, 0xfe, rest @ ..] => utf_16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => utf_16(rest, u16::from_be_bytes),
        [b'P', b'K', 3, 4, ..] | [0xd0, 0xcf, 0x11, 0xe0, ..] => no_text("a workbook"),
        _ if zeros(1) => utf_16(bytes, u16::from_le_bytes),
        _ if zeros(0) => utf_16(bytes, u16::from_be_bytes),
        _ if bytes.contains(&0) => no_text("binary data"),
        _ => Ok(String::from_utf8(bytes.to_vec())
            .unwrap_or_else(|_| bytes.iter().map(|byte| windows_1252(*byte)).collect())),
    }
}

fn no_text(what: &str) -> Result<String> {
    bail!("this is {what}: save the table as CSV in UTF-8")
}

/// Characters of Windows-1252 from 0x80 to 0x9f, where it differs from Latin-1.
const WINDOWS_1252: &str = "€\u{81}‚ƒ„…†‡ˆ‰Š‹Œ\u{8d}Ž\u{8f}\u{90}‘’“”•–—˜™š›œ\u{9d}žŸ";

fn windows_1252(byte: u8) -> char {
    let special = usize::from(byte).checked_sub(0x80).and_then(|at| WINDOWS_1252.chars().nth(at));
    special.unwrap_or(char::from(byte))
}
