//! Parts of a map on disk: a stopped run and a shard write them, `merge` joins
//! them. A header line of JSON describes the map. Then each line is one cell:
//! its number, verdict, and `!` if it is sensitive.

use std::io::{BufRead, Write};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{Axis, AxisError, Cell, Map, MapPlan};
use crate::scene::Scene;

/// Version of the format and of the numbers in it.
const SCHEMA: &str = "rubscope.map-part/1";

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

/// The header line: everything that determines the cells, and title and note of
/// the scene for readers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Header {
    schema: String,
    version: String,
    scene: String,
    x: Axis,
    y: Axis,
    sensitivity: bool,
}

impl Header {
    fn of(plan: &MapPlan) -> Self {
        Self {
            schema: SCHEMA.to_string(),
            version: env!("CARGO_PKG_VERSION").to_string(),
            scene: plan.scene.to_toml(),
            x: plan.x.clone(),
            y: plan.y.clone(),
            sensitivity: plan.sensitivity,
        }
    }

    /// The plan it describes.
    fn plan(&self) -> Result<MapPlan, AxisError> {
        let again = |axis: &Axis| Axis::new(&axis.path, axis.from, axis.to, axis.count, axis.log);
        let plan = MapPlan {
            scene: Scene::from_toml_unchecked(&self.scene)?,
            x: again(&self.x)?,
            y: again(&self.y)?,
            sensitivity: self.sensitivity,
        };
        plan.check_size()?;
        Ok(plan)
    }
}

/// Writes the header line of a part.
///
/// # Errors
/// An error of the writer.
pub fn write_header(plan: &MapPlan, out: &mut dyn Write) -> std::io::Result<()> {
    serde_json::to_writer(&mut *out, &Header::of(plan))?;
    writeln!(out)
}

/// Writes one cell.
///
/// # Errors
/// An error of the writer.
pub fn write_cell(index: usize, cell: Cell, out: &mut dyn Write) -> std::io::Result<()> {
    let mark = if cell.sensitive { " !" } else { "" };
    writeln!(out, "{index} {}{mark}", cell.verdict)
}

/// Writes all computed cells of a map as one part.
///
/// # Errors
/// An error of the writer.
pub fn write(map: &Map, out: &mut dyn Write) -> std::io::Result<()> {
    write_header(&map.plan, out)?;
    for (index, cell) in map.cells.iter().enumerate() {
        if let Some(cell) = cell {
            write_cell(index, *cell, out)?;
        }
    }
    Ok(())
}

/// Reads parts of one map and joins them; cells may be missing.
///
/// # Errors
/// A file that is no part, or parts that do not belong together.
pub fn read_all<R: BufRead>(
    parts: impl IntoIterator<Item = (String, R)>,
) -> Result<Option<Map>, PartError> {
    let mut joined: Option<(String, String, Map)> = None;
    for (file, mut part) in parts {
        let form = |reason: String| PartError::Form { file: file.clone(), reason };
        let mut line = String::new();
        part.read_line(&mut line).map_err(|error| form(error.to_string()))?;
        let header: Header =
            serde_json::from_str(&line).map_err(|error| form(error.to_string()))?;
        if header.schema != SCHEMA {
            return Err(form(format!("schema {} where {SCHEMA} is read", header.schema)));
        }
        let plan = header.plan().map_err(|error| form(error.to_string()))?;
        let (other, version, map) = joined.get_or_insert_with(|| {
            (file.clone(), header.version.clone(), Map::empty(plan.clone()))
        });
        let differs = (header.version != *version).then_some("the version of rubscope");
        if let Some(what) = differs.or_else(|| plan.difference(&map.plan)) {
            let what = what.to_string();
            return Err(PartError::Different { file, other: other.clone(), what });
        }
        read_cells(&file, part, map)?;
    }
    Ok(joined.map(|(_, _, map)| map))
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

fn read_cells(file: &str, mut part: impl BufRead, map: &mut Map) -> Result<(), PartError> {
    let form = |reason: String| PartError::Form { file: file.to_string(), reason };
    let mut text = String::new();
    while part.read_line(&mut text).map_err(|error| form(error.to_string()))? > 0 {
        // A run that was killed, or a full disk, may cut the last line short,
        // and half a line may still read as a cell.
        let Some(line) = text.strip_suffix('\n') else { break };
        let (index, cell) = parse_cell(line).ok_or_else(|| form(format!("the line {line:?}")))?;
        text.clear();
        match map.cells.get(index) {
            None => return Err(form(format!("cell {index} outside the map"))),
            Some(Some(known)) if *known != cell => {
                return Err(PartError::Conflict { file: file.to_string(), index });
            }
            Some(Some(_)) => {}
            Some(None) => {
                map.cells.set(index, Some(cell));
                map.runs += 1;
            }
        }
    }
    Ok(())
}

fn parse_cell(line: &str) -> Option<(usize, Cell)> {
    let mut words = line.split(' ');
    let index = words.next()?.parse().ok()?;
    let verdict = words.next()?.parse().ok()?;
    let sensitive = match words.next() {
        None => false,
        Some("!") => true,
        Some(_) => return None,
    };
    words.next().is_none().then_some((index, Cell { verdict, sensitive }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Progress;

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
        let mut map = Map::empty(plan());
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
        let cut = whole[..whole.len() - 3].to_vec();
        let map = read(&[cut]).unwrap().unwrap();
        assert_eq!(map.cells.iter().flatten().count(), 19);
        let text = String::from_utf8(whole).unwrap();
        let broken = text.replacen("\n3 ", "\nthree ", 1).into_bytes();
        assert!(read(&[broken]).unwrap_err().to_string().contains("the line \"three"));
    }

    #[test]
    fn parts_of_different_maps_are_refused() {
        let first = part(Shard { shard: 1, count: 2 });
        let text = String::from_utf8(part(Shard { shard: 2, count: 2 })).unwrap();
        let other = text.replacen("blades = 22", "blades = 24", 1).into_bytes();
        let message = read(&[first.clone(), other]).unwrap_err().to_string();
        assert_eq!(message, "part 1 does not belong to part 0: they differ in the scene");
        let conflict = text.replacen("1 decay", "0 failed", 1).into_bytes();
        assert!(matches!(read(&[first, conflict]), Err(PartError::Conflict { index: 0, .. })));
    }

    #[test]
    fn what_decides_no_cell_does_not_part_the_parts() {
        let first = part(Shard { shard: 1, count: 2 });
        let text = String::from_utf8(part(Shard { shard: 2, count: 2 })).unwrap();
        // Title, note and view, and the base values of the keys on the axes.
        let other = text
            .replacen("title = \\\"\\\"", "title = \\\"another\\\"", 1)
            .replacen("note = \\\"\\\"", "note = \\\"seen on Monday\\\"", 1)
            .replacen("\\\"response\\\", ", "", 1)
            .replacen("speed_rad_s = 500.0", "speed_rad_s = 320.0", 1)
            .replacen("pulse_n = 20000.0", "pulse_n = 7.0", 1);
        assert!(other.contains("another") && other.contains("Monday") && other.contains("= 7.0"));
        assert!(!other.contains("response") && other.contains("speed_rad_s = 320.0"), "{other}");
        let joined = read(&[first.clone(), other.into_bytes()]).unwrap().unwrap();
        require_complete(&joined).unwrap();
        // A part from an older version with fewer keys: missing keys have defaults.
        let mut lines = text.replacen("\\norder = 3", "", 1);
        lines = lines.replacen("contact = \\\"unilateral\\\"\\n", "", 1);
        assert!(lines.len() < text.len() - 30);
        require_complete(&read(&[first.clone(), lines.into_bytes()]).unwrap().unwrap()).unwrap();
        // What determines the cells must still agree.
        let damped = text.replacen("damping_ratio = 0.05", "damping_ratio = 0.06", 1);
        assert_ne!(damped, text);
        assert!(read(&[first, damped.into_bytes()]).is_err());
    }

    #[test]
    fn shards_count_from_one() {
        assert_eq!(Shard::parse("2/7"), Some(Shard { shard: 2, count: 7 }));
        for text in ["0/7", "8/7", "1", "a/b", "1/0"] {
            assert_eq!(Shard::parse(text), None, "{text}");
        }
    }
}
