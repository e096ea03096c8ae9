//! Parts of a map on disk: a stopped run and a shard write them, `merge` joins
//! them. A header line of JSON describes the map. Then each line is one cell:
//! its number, its verdict, `!` if it is sensitive, and a checksum.
//!
//! The checksum of a cell starts from that of the header, so that no cell of
//! another map, and no altered one, is taken for one of this. It finds accidents;
//! who wants to can compute it for a cell of his own.

mod header;
mod read;

use std::io::Write;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{Cell, Map, MapPlan};

pub use read::{Continued, read_all, read_one};

/// One machine's share of a map: cells `shard - 1, shard - 1 + count, ...`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Which share, counted from 1.
    pub shard: u32,
    /// How many shares there are.
    pub count: u32,
}

impl Shard {
    /// The whole map.
    pub const WHOLE: Self = Self { shard: 1, count: 1 };

    /// Reads `K/COUNT`, counted from 1.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let (shard, count) = text.split_once('/')?;
        let (shard, count) = (shard.trim().parse().ok()?, count.trim().parse().ok()?);
        (1..=count).contains(&shard).then_some(Self { shard, count })
    }

    /// The cells of this share.
    #[must_use]
    pub fn indices(self, cells: usize) -> impl IndexedParallelIterator<Item = usize> + Clone {
        (self.shard as usize - 1..cells).into_par_iter().step_by(self.count as usize)
    }
}

/// Why parts could not be read or joined.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PartError {
    /// Not a part of a map.
    #[error("{file}: not a part of a map: {reason}")]
    Form {
        /// Name of the file.
        file: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A part from another version of the program.
    #[error(
        "{file} was written by rubscope {version}, and this is {}: allowed are parts of the same version",
        header::VERSION
    )]
    Version {
        /// Name of the file.
        file: String,
        /// The version in it.
        version: String,
    },
    /// Parts of different maps.
    #[error("{file} does not belong to {other}: they differ in {what}")]
    Different {
        /// Name of the file.
        file: String,
        /// The first file.
        other: String,
        /// The difference.
        what: String,
    },
    /// Cells that no part has.
    #[error(
        "{missing} of {cells} cells are in none of the parts, the first of them number {first}"
    )]
    Missing {
        /// How many.
        missing: usize,
        /// Out of how many.
        cells: usize,
        /// The first missing cell.
        first: usize,
    },
    /// Parts that disagree about a cell.
    #[error("{file} has another value for cell {index} than a part before it")]
    Conflict {
        /// Name of the file.
        file: String,
        /// Which cell.
        index: usize,
    },
}

/// Writes the lines of a part: its header at once, then cells as they come.
#[derive(Clone, Copy, Debug)]
pub struct PartWriter {
    header: u32,
}

impl PartWriter {
    /// Writes the header line.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn new(plan: &MapPlan, out: &mut dyn Write) -> std::io::Result<Self> {
        let (line, header) = header::line_of(plan)?;
        writeln!(out, "{line}")?;
        Ok(Self { header })
    }

    /// Writes one cell.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn cell(self, index: usize, cell: Cell, out: &mut dyn Write) -> std::io::Result<()> {
        let mark = if cell.sensitive { " !" } else { "" };
        let text = format!("{index} {}{mark}", cell.verdict);
        writeln!(out, "{text} {:08x}", cell_checksum(&text, self.header))
    }
}

/// Writes all computed cells of a map as one part.
///
/// # Errors
/// An error of the writer.
pub fn write(map: &Map, out: &mut dyn Write) -> std::io::Result<PartWriter> {
    let writer = PartWriter::new(&map.plan, out)?;
    for (index, cell) in map.cells.iter().enumerate() {
        if let Some(cell) = cell {
            writer.cell(index, *cell, out)?;
        }
    }
    Ok(writer)
}

/// The checksum of the text of a cell, going on from that of its header.
fn cell_checksum(text: &str, header: u32) -> u32 {
    let mut hasher = crc32fast::Hasher::new_with_initial(header);
    hasher.update(text.as_bytes());
    hasher.finalize()
}

/// Reads a checksum of eight small hexadecimal digits.
fn parse_checksum(text: &str) -> Option<u32> {
    let is_digit = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
    let whole = text.len() == 8 && text.bytes().all(is_digit);
    u32::from_str_radix(text, 16).ok().filter(|_| whole)
}

/// Returns an error if a cell is missing.
///
/// # Errors
/// The map is not complete.
pub fn require_complete(map: &Map) -> Result<(), PartError> {
    let missing = map.cells.iter().filter(|cell| cell.is_none()).count();
    match map.cells.iter().position(Option::is_none) {
        None => Ok(()),
        Some(first) => Err(PartError::Missing { missing, cells: map.cells.len(), first }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Verdict;
    use crate::scene::Scene;
    use crate::study::{Axis, Progress};

    fn plan() -> MapPlan {
        let mut scene = Scene::base();
        scene.solver.end_s = 2e-3;
        scene.solver.step_s = 1e-6;
        MapPlan {
            scene,
            x: Axis::parse("operation.speed_rad_s=300:500:5").unwrap(),
            y: Axis::parse("operation.pulse_n=0:40000:4").unwrap(),
            sensitivity: false,
        }
    }

    fn part(shard: Shard) -> Vec<u8> {
        part_of(plan(), shard)
    }

    fn part_of(plan: MapPlan, shard: Shard) -> Vec<u8> {
        let mut map = Map::empty(plan);
        map.fill(shard.indices(20), &Progress::default(), &|_, _| {});
        let mut out = Vec::new();
        write(&map, &mut out).unwrap();
        out
    }

    fn read(parts: &[Vec<u8>]) -> Result<Option<Map>, PartError> {
        read_all(parts.iter().enumerate().map(|(i, part)| (format!("part {i}"), part.as_slice())))
    }

    #[test]
    fn shards_join_to_the_same_bytes_as_one_run() {
        let whole = part(Shard::WHOLE);
        let parts: Vec<Vec<u8>> = (1..=7).map(|shard| part(Shard { shard, count: 7 })).collect();
        let joined = read(&parts).unwrap().unwrap();
        require_complete(&joined).unwrap();
        let mut out = Vec::new();
        write(&joined, &mut out).unwrap();
        assert_eq!(String::from_utf8(out).unwrap(), String::from_utf8(whole).unwrap());
        let missing = read(&parts[1..]).unwrap().unwrap();
        assert!(matches!(
            require_complete(&missing),
            Err(PartError::Missing { missing: 3, first: 0, .. })
        ));
    }

    #[test]
    fn a_cut_last_line_is_dropped_and_nothing_else_is() {
        let whole = part(Shard::WHOLE);
        for cut in [1, 3, 9, 12] {
            let map = read(&[whole[..whole.len() - cut].to_vec()]).unwrap().unwrap();
            assert_eq!(map.cells.iter().flatten().count(), 19);
        }
        let text = String::from_utf8(whole).unwrap();
        let broken = text.replacen("\n3 ", "\nthree ", 1).into_bytes();
        let reason = read(&[broken]).unwrap_err().to_string();
        assert!(reason.contains("line 5 is a cell that does not agree"), "{reason}");
        let windows = text.replace('\n', "\r\n").into_bytes();
        require_complete(&read(&[windows]).unwrap().unwrap()).unwrap();
    }

    #[test]
    fn an_altered_cell_is_refused_by_its_line() {
        let text = String::from_utf8(part(Shard::WHOLE)).unwrap();
        for (from, to) in
            [("1 decay ", "1 locked "), ("\n1 decay ", "\n1 decay ! "), ("\n7 ", "\n8 ")]
        {
            let altered = text.replacen(from, to, 1);
            assert_ne!(altered, text);
            let reason = read(&[altered.into_bytes()]).unwrap_err().to_string();
            assert!(reason.contains("is a cell that does not agree with its checksum"), "{reason}");
        }
        // Nor a whole cell of another map.
        let mut other = Map::empty(MapPlan { sensitivity: true, ..plan() });
        other.fill(Shard::WHOLE.indices(20), &Progress::default(), &|_, _| {});
        let mut lines = Vec::new();
        write(&other, &mut lines).unwrap();
        let lines = String::from_utf8(lines).unwrap();
        let mixed =
            format!("{}\n{}\n", text.lines().next().unwrap(), lines.lines().nth(1).unwrap());
        assert!(read(&[mixed.into_bytes()]).unwrap_err().to_string().contains("line 2"));
    }

    #[test]
    fn parts_of_different_maps_are_refused() {
        let first = part(Shard { shard: 1, count: 2 });
        let mut damped = plan();
        damped.scene.casing.damping_ratio = 0.06;
        let mut other = Vec::new();
        write(&Map::empty(damped), &mut other).unwrap();
        let message = read(&[first.clone(), other]).unwrap_err().to_string();
        assert_eq!(message, "part 1 does not belong to part 0: they differ in the scene");
        let conflicting = Map::empty(plan());
        conflicting.cells.set(0, Some(Cell { verdict: Verdict::Failed, sensitive: false }));
        let mut conflict = Vec::new();
        write(&conflicting, &mut conflict).unwrap();
        assert!(matches!(read(&[first, conflict]), Err(PartError::Conflict { index: 0, .. })));
    }

    #[test]
    fn what_decides_no_cell_does_not_part_the_parts() {
        let first = part(Shard { shard: 1, count: 2 });
        // Title, note and view, and the base values of the keys on the axes.
        let mut other = plan();
        other.scene.title = "another".into();
        other.scene.note = "seen on Monday".into();
        other.scene.view.charts = vec!["map".into()];
        other.scene.operation.speed_rad_s = 320.0;
        other.scene.operation.pulse_n = 7.0;
        let second = part_of(other, Shard { shard: 2, count: 2 });
        require_complete(&read(&[first, second]).unwrap().unwrap()).unwrap();
    }

    #[test]
    fn shards_count_from_one() {
        assert_eq!(Shard::parse("2/7"), Some(Shard { shard: 2, count: 7 }));
        for text in ["0/7", "8/7", "1", "a/b", "1/0"] {
            assert_eq!(Shard::parse(text), None, "{text}");
        }
    }
}
