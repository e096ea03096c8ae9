//! Reading parts. A part is a file that anyone may have written or cut: nothing
//! in it is believed before it is checked, and no line or file is read beyond the
//! length that a part can have.

use std::io::{BufRead, Read};

use super::header::{self, Fault};
use super::{PartError, PartWriter, cell_checksum, parse_checksum};
use crate::study::{Cell, Map, MapPlan};

/// Longest header line \[bytes\]; the usual ones have about 1500.
const LONGEST_HEADER: usize = 1 << 20;
/// Longest line of a cell \[bytes\]; the longest that is written has 30.
const LONGEST_CELL: usize = 64;
/// Lines of cells that a part may have more than there are cells: those that it
/// has twice.
const MOST_AGAIN: usize = 10_000;

/// Reads parts of one map and joins them; cells may be missing.
///
/// # Errors
/// A file that is no part, or parts that do not belong together.
pub fn read_all<R: BufRead>(
    parts: impl IntoIterator<Item = (String, R)>,
) -> Result<Option<Map>, PartError> {
    let mut joined: Option<(String, Map)> = None;
    for (file, reader) in parts {
        let mut lines = Lines::new(file, reader);
        let (plan, checksum) = lines.header()?;
        let (other, map) =
            joined.get_or_insert_with(|| (lines.file.clone(), Map::empty(plan.clone())));
        if let Some(what) = plan.difference(&map.plan) {
            let (other, what) = (other.clone(), what.to_string());
            return Err(PartError::Different { file: lines.file, other, what });
        }
        read_cells(&mut lines, checksum, map)?;
    }
    Ok(joined.map(|(_, map)| map))
}

/// A part that can be continued.
#[derive(Debug)]
pub struct Continued {
    /// What it holds.
    pub map: Map,
    /// Writes further cells of it.
    pub writer: PartWriter,
    /// Bytes of its whole lines; what follows was cut short.
    pub whole: u64,
}

/// Reads one part, to go on with it.
///
/// # Errors
/// A file that is no part.
pub fn read_one(file: String, reader: impl BufRead) -> Result<Continued, PartError> {
    let mut lines = Lines::new(file, reader);
    let (plan, header) = lines.header()?;
    let mut map = Map::empty(plan);
    read_cells(&mut lines, header, &mut map)?;
    Ok(Continued { map, writer: PartWriter { header }, whole: lines.whole })
}

fn read_cells(
    lines: &mut Lines<impl BufRead>,
    header: u32,
    map: &mut Map,
) -> Result<(), PartError> {
    let most = map.cells.len() + MOST_AGAIN;
    loop {
        let number = lines.number + 1;
        let Some(line) = lines.next(LONGEST_CELL)? else { return Ok(()) };
        let Some((index, cell)) = parse_cell(line, header) else {
            let reason = match line.rsplit_once(' ') {
                Some((_, end)) if parse_checksum(end).is_some() => {
                    "a cell that does not agree with its checksum"
                }
                _ => "not a cell",
            };
            let reason = format!("line {number} is {reason}: {line:?}");
            return Err(lines.fault(reason));
        };
        if number > 1 + most {
            return Err(lines.fault(format!("more than {most} lines of cells")));
        }
        match map.cells.get(index) {
            None => return Err(lines.fault(format!("cell {index} outside the map"))),
            Some(Some(known)) if *known != cell => {
                return Err(PartError::Conflict { file: lines.file.clone(), index });
            }
            Some(Some(_)) => {}
            Some(None) => {
                map.cells.set(index, Some(cell));
                map.runs += 1;
            }
        }
    }
}

/// The lines of a part, none longer than allowed.
struct Lines<R> {
    file: String,
    reader: R,
    /// The line read last, counted from 1.
    number: usize,
    /// Bytes of the whole lines so far.
    whole: u64,
    text: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    fn new(file: String, reader: R) -> Self {
        Self { file, reader, number: 0, whole: 0, text: Vec::new() }
    }

    fn header(&mut self) -> Result<(MapPlan, u32), PartError> {
        let Some(line) = self.next(LONGEST_HEADER)? else {
            return Err(self.fault("no complete first line".into()));
        };
        header::read(line).map_err(|fault| match fault {
            Fault::Form(reason) => self.fault(reason),
            Fault::Version(version) => PartError::Version { file: self.file.clone(), version },
        })
    }

    /// The next line without its end. None at the end, and for a line without an
    /// end: a run that was killed, or a full disk, may cut the last line short,
    /// and half a line may still read as a cell.
    fn next(&mut self, most: usize) -> Result<Option<&str>, PartError> {
        self.number += 1;
        self.text.clear();
        let mut line = self.reader.by_ref().take(most as u64 + 1);
        if let Err(error) = line.read_until(b'\n', &mut self.text) {
            return Err(self.fault(error.to_string()));
        }
        if self.text.pop_if(|last| *last == b'\n').is_none() {
            if self.text.len() > most {
                return Err(self.fault(format!("line {} has over {most} bytes", self.number)));
            }
            return Ok(None);
        }
        self.whole += self.text.len() as u64 + 1;
        // A file that went through Windows.
        let _ = self.text.pop_if(|last| *last == b'\r');
        match std::str::from_utf8(&self.text) {
            Ok(line) => Ok(Some(line)),
            Err(_) => Err(self.fault(format!("line {} is not UTF-8 text", self.number))),
        }
    }

    fn fault(&self, reason: String) -> PartError {
        PartError::Form { file: self.file.clone(), reason }
    }
}

/// Reads a cell, if the line is one and agrees with its checksum.
fn parse_cell(line: &str, header: u32) -> Option<(usize, Cell)> {
    let (text, end) = line.rsplit_once(' ')?;
    if cell_checksum(text, header) != parse_checksum(end)? {
        return None;
    }
    let mut words = text.split(' ');
    let index = words.next()?.parse().ok()?;
    let verdict = words.next()?.parse().ok()?;
    let sensitive = match words.next() {
        None => false,
        Some("!") => true,
        Some(_) => return None,
    };
    words.next().is_none().then_some((index, Cell { verdict, sensitive }))
}
