//! Parts of a map: the cells that one shard computed, as CSV, and how parts are merged.
//!
//! The first line begins with `#` and records the version and the commit of the program, the
//! scene, the axes and the shard. A table with one row per cell follows. A part is untrusted
//! input: every value is checked before use, and lines have a maximum length.

use std::io::{BufRead, Read, Result, Write};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::map::names;
use rubscope_solver::scene::Scene;
use rubscope_solver::study::{Axis, AxisError, Cell, Map, MapPlan};

/// Version and commit of the program.
const VERSION: &str = env!("RUBSCOPE_VERSION");
/// Start of the first line, before the version.
const PROGRAM: &str = "# rubscope ";
/// Separates the version from the origin of the cells.
const COMMAND: &str = " map ";
/// Longest first line \[bytes\]; a usual one has about 1500.
const LONGEST_FIRST: u64 = 1 << 20;
/// Longest line of the table \[bytes\].
const LONGEST_ROW: u64 = 256;

/// One shard of a map: cells `number - 1`, `number - 1 + count`, and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Number of the shard, counted from 1.
    pub number: u32,
    /// Number of shards.
    pub count: u32,
}

impl Shard {
    /// Parses `K/COUNT`, counted from 1.
    pub fn parse(text: &str) -> Option<Self> {
        let (number, count) = text.split_once('/')?;
        let shard = Self { number: number.trim().parse().ok()?, count: count.trim().parse().ok()? };
        shard.is_valid().then_some(shard)
    }

    /// Iterates over the indices of this shard's cells.
    pub fn indices(self, cells: usize) -> impl IndexedParallelIterator<Item = usize> {
        (self.number as usize - 1..cells).into_par_iter().step_by(self.count as usize)
    }

    fn is_valid(self) -> bool {
        (1..=self.count).contains(&self.number)
    }

    fn has(self, index: usize) -> bool {
        index % self.count as usize == self.number as usize - 1
    }
}

/// Why a file is not a part of the map, or why the parts do not form a complete map.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{file}: {reason}")]
pub struct PartError {
    file: String,
    reason: String,
}

/// Everything that determines the cells of a part, as JSON in its first line.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Origin {
    scene: String,
    x: Axis,
    y: Axis,
    sensitivity: bool,
    shard: Shard,
}

impl Origin {
    fn of(plan: &MapPlan, shard: Shard) -> Self {
        let (x, y) = (plan.x.clone(), plan.y.clone());
        Self { scene: plan.scene.to_toml(), x, y, sensitivity: plan.sensitivity, shard }
    }

    /// Returns the plan, fully checked.
    fn plan(&self) -> std::result::Result<MapPlan, AxisError> {
        let axis = |axis: &Axis| Axis::new(&axis.path, axis.from, axis.to, axis.count, axis.log);
        let scene = Scene::from_toml_unchecked(&self.scene)?;
        let (x, y) = (axis(&self.x)?, axis(&self.y)?);
        let plan = MapPlan { scene, x, y, sensitivity: self.sensitivity };
        plan.check()?;
        Ok(plan)
    }

    /// Names the first difference that makes two parts belong to different maps.
    fn difference(&self, other: &Self) -> Option<&'static str> {
        [
            ("the x axis", self.x != other.x),
            ("the y axis", self.y != other.y),
            ("the scene", self.scene != other.scene),
            ("--no-sensitivity", self.sensitivity != other.sensitivity),
            ("the number of shards", self.shard.count != other.shard.count),
        ]
        .into_iter()
        .find_map(|(what, differs)| differs.then_some(what))
    }
}

/// Writes the cells of one shard.
///
/// # Errors
/// The writer failed.
pub fn write(map: &Map, shard: Shard, out: &mut dyn Write) -> Result<()> {
    let plan = &map.plan;
    let origin = serde_json::to_string(&Origin::of(plan, shard))?;
    writeln!(out, "{PROGRAM}{VERSION}{COMMAND}{origin}\n{}", columns(plan))?;
    for (index, cell) in map.cells.iter().enumerate() {
        if let Some(Cell { verdict, sensitive, depends_on_step }) = cell {
            let start = start_of_row(plan, index);
            writeln!(out, "{start}{verdict},{sensitive},{depends_on_step}")?;
        }
    }
    Ok(())
}

fn columns(plan: &MapPlan) -> String {
    let [x, y] = names(plan);
    format!("cell,{x},{y},verdict,sensitive,depends_on_step")
}

/// Returns the columns of a row that the plan determines; a part must match them exactly.
fn start_of_row(plan: &MapPlan, index: usize) -> String {
    let columns = plan.x.count as usize;
    let x = plan.x.value((index % columns) as u32);
    let y = plan.y.value((index / columns) as u32);
    format!("{index},{x},{y},")
}

/// Reads and merges the parts of one map; returns `None` if `parts` is empty.
///
/// # Errors
/// A file is not a part, the parts belong to different maps, or a cell is missing or occurs twice.
pub fn read_all<R: BufRead>(
    parts: impl IntoIterator<Item = (String, R)>,
) -> std::result::Result<Option<Map>, PartError> {
    let mut map: Option<Map> = None;
    let mut known: Vec<(String, Origin)> = Vec::new();
    for (file, reader) in parts {
        let mut lines = Lines { reader, number: 0, text: Vec::new() };
        let refused = |reason| PartError { file: file.clone(), reason };
        let origin = lines.origin().map_err(refused)?;
        if let Some((first, other)) = known.first()
            && let Some(what) = origin.difference(other)
        {
            let reason = format!("does not belong to {first}: they differ in {what}");
            return Err(refused(reason));
        }
        if map.is_none() {
            let plan = origin.plan();
            let plan = plan.map_err(|error| refused(format!("not a part of a map: {error}")))?;
            map = Some(Map::empty(plan));
        }
        known.push((file.clone(), origin));
        if let Some(map) = &mut map {
            lines.add_to(map, &known).map_err(refused)?;
        }
    }
    let Some(map) = map else { return Ok(None) };
    let Some(missing) = map.cells.iter().position(Option::is_none) else { return Ok(Some(map)) };
    let all = map.cells.iter().filter(|cell| cell.is_none()).count();
    let reason = format!("cell {missing} is missing, and {} others", all - 1);
    Err(match known.iter().find(|(_, origin)| origin.shard.has(missing)) {
        Some((file, _)) => PartError { file: file.clone(), reason },
        None => {
            let count = known.first().map_or(1, |(_, origin)| origin.shard.count);
            let number = missing % count as usize + 1;
            let file = format!("no part is shard {number}/{count}");
            PartError { file, reason }
        }
    })
}

/// Reads the lines of a part, none longer than allowed.
struct Lines<R> {
    reader: R,
    /// Number of the last line read, counted from 1.
    number: usize,
    text: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    /// Reads the first line.
    fn origin(&mut self) -> std::result::Result<Origin, String> {
        let fault = |reason: String| format!("not a part of a map: {reason}");
        let line = self.next(LONGEST_FIRST).map_err(fault)?.unwrap_or_default();
        let form = || fault(format!("its first line does not begin with {PROGRAM}"));
        let (version, origin) = line
            .strip_prefix(PROGRAM)
            .and_then(|rest| rest.split_once(COMMAND))
            .ok_or_else(form)?;
        if version != VERSION {
            return Err(format!(
                "was written by rubscope {version}, and this is {VERSION}: allowed are parts of \
                 the same version and commit"
            ));
        }
        let origin: Origin =
            serde_json::from_str(origin).map_err(|error| fault(error.to_string()))?;
        if !origin.shard.is_valid() {
            return Err(fault("its shard is not K/COUNT with K from 1 to COUNT".into()));
        }
        Ok(origin)
    }

    /// Reads all rows of this part into the map.
    fn add_to(
        &mut self,
        map: &mut Map,
        known: &[(String, Origin)],
    ) -> std::result::Result<(), String> {
        let Some(((_, origin), before)) = known.split_last() else { return Ok(()) };
        let columns = columns(&map.plan);
        if self.next(LONGEST_ROW)? != Some(&columns) {
            return Err(format!("line 2 is not {columns}"));
        }
        loop {
            let number = self.number + 1;
            let Some(line) = self.next(LONGEST_ROW)? else { return Ok(()) };
            let row = parse_row(line, &map.plan).filter(|(index, _)| origin.shard.has(*index));
            let (index, cell) =
                row.ok_or_else(|| format!("line {number} is not a row of this shard: {line:?}"))?;
            if map.cells[index].is_some() {
                let other = before.iter().find(|(_, origin)| origin.shard.has(index));
                let place =
                    other.map_or("in it twice".into(), |(file, _)| format!("in {file}, too"));
                return Err(format!("cell {index} (line {number}) is {place}"));
            }
            map.cells.set(index, Some(cell));
            map.runs += 1;
        }
    }

    /// Reads the next line, without its line ending; `None` at the end of the file.
    fn next(&mut self, most: u64) -> std::result::Result<Option<&str>, String> {
        self.number += 1;
        self.text.clear();
        let mut line = self.reader.by_ref().take(most + 1);
        line.read_until(b'\n', &mut self.text).map_err(|error| error.to_string())?;
        if self.text.is_empty() {
            return Ok(None);
        }
        if self.text.len() as u64 > most {
            return Err(format!("line {} has over {most} bytes", self.number));
        }
        let line = std::str::from_utf8(&self.text)
            .map_err(|_| format!("line {} is not UTF-8 text", self.number))?;
        // A file edited on Windows has `\r\n`.
        Ok(Some(line.trim_end_matches(['\r', '\n'])))
    }
}

fn parse_row(line: &str, plan: &MapPlan) -> Option<(usize, Cell)> {
    let (index, _) = line.split_once(',')?;
    let index = index.parse().ok().filter(|index| *index < plan.len())?;
    let mut columns = line.strip_prefix(&start_of_row(plan, index))?.split(',');
    let verdict = columns.next()?.parse().ok()?;
    let mut fact = || columns.next()?.parse().ok();
    let cell = Cell { verdict, sensitive: fact()?, depends_on_step: fact()? };
    columns.next().is_none().then_some((index, cell))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(number: u32, count: u32) -> String {
        let mut scene = Scene::base();
        scene.solver.end_s = 2e-3;
        scene.solver.step_s = 1e-6;
        let x = Axis::parse("operation.speed_rad_s=300:500:5").unwrap();
        let y = Axis::parse("operation.pulse_n=0:40000:4").unwrap();
        let mut map = Map::empty(MapPlan { scene, x, y, sensitivity: false });
        let shard = Shard { number, count };
        map.fill(shard.indices(20), &|| true, &|_, _| {});
        let mut out = Vec::new();
        write(&map, shard, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    fn read(parts: &[String]) -> std::result::Result<Map, String> {
        let named =
            parts.iter().enumerate().map(|(i, part)| (format!("part {i}"), part.as_bytes()));
        read_all(named).map(Option::unwrap).map_err(|error| error.to_string())
    }

    #[test]
    fn shards_join_to_the_map_of_one_run() {
        let whole = read(&[part(1, 1)]).unwrap();
        let mut parts: Vec<String> = (1..=7).rev().map(|number| part(number, 7)).collect();
        assert_eq!(read(&parts).unwrap(), whole);
        let lacking = parts.pop().unwrap();
        let missing = "no part is shard 1/7: cell 0 is missing, and 2 others";
        assert_eq!(read(&parts).unwrap_err(), missing);
        let cut = lacking.trim_end().rsplit_once('\n').unwrap().0.to_string();
        parts.push(cut);
        assert_eq!(read(&parts).unwrap_err(), "part 6: cell 14 is missing, and 0 others");
        parts[6] = lacking.clone();
        parts.push(lacking.clone());
        assert_eq!(read(&parts).unwrap_err(), "part 7: cell 0 (line 3) is in part 6, too");
        let row = lacking.lines().nth(2).unwrap();
        let twice = "part 0: cell 0 (line 6) is in it twice";
        assert_eq!(read(&[format!("{lacking}{row}\n")]).unwrap_err(), twice);
    }

    #[test]
    fn shards_count_from_one() {
        assert_eq!(Shard::parse("2/7"), Some(Shard { number: 2, count: 7 }));
        for text in ["0/7", "8/7", "1", "a/b", "1/0"] {
            assert_eq!(Shard::parse(text), None, "{text}");
        }
    }
}
