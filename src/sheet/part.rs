//! Shares of a map: the cells of one shard as CSV, and how they join to a map.
//!
//! The first line of a share begins with `#` and names the version and commit of the
//! program, the scene and the axes. It is the same in every share of a map.

use std::fmt::Display;
use std::io::{BufRead, BufReader, Read, Write};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::map::{self, row};
use super::table::Table;
use rubscope_solver::scene::{Scene, SceneError};
use rubscope_solver::study::{Axis, Cell, Doubt, Map, MapPlan};

/// Start of the first line; the origin of the cells follows as JSON.
const START: &str = concat!("# rubscope ", env!("RUBSCOPE_VERSION"), " map ");
/// Largest length of the first line of a share \[bytes\]; usually it is about 1500.
const LONGEST_FIRST: u64 = 1 << 20;
/// Largest size of the table of a share \[bytes\]: about 64 for each cell of the largest map.
const LARGEST_TABLE: u64 = 1 << 30;

/// One machine's share of a map: cells `number - 1, number - 1 + count, ...`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Number of the share, counted from 1.
    pub number: usize,
    /// Number of shares.
    pub count: usize,
}

impl Shard {
    /// Parses `K/COUNT`; `None` unless both are numbers and K is from 1 to COUNT.
    pub fn parse(text: &str) -> Option<Self> {
        let (number, count) = text.split_once('/')?;
        let shard = Self { number: number.trim().parse().ok()?, count: count.trim().parse().ok()? };
        (1..=shard.count).contains(&shard.number).then_some(shard)
    }

    /// Iterates over the indices of this shard's cells in a map of `cells` cells.
    pub fn indices(self, cells: usize) -> impl IndexedParallelIterator<Item = usize> {
        (self.number - 1..cells).into_par_iter().step_by(self.count)
    }
}

/// Everything that determines the cells of a map; part of the first line of a share.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Origin {
    scene: String,
    x: Axis,
    y: Axis,
    sensitivity: bool,
}

impl Origin {
    /// Returns the plan, completely checked.
    fn plan(self) -> Result<MapPlan, SceneError> {
        let axis = |axis: Axis| Axis::new(&axis.path, axis.from, axis.to, axis.count, axis.log);
        let scene = Scene::from_toml_unchecked(&self.scene)?;
        let (x, y) = (axis(self.x)?, axis(self.y)?);
        let plan = MapPlan { scene, x, y, sensitivity: self.sensitivity };
        plan.check()?;
        Ok(plan)
    }
}

/// Writes the cells of the map that were computed, as a share.
///
/// # Errors
/// An error of the writer.
pub fn write(map: &Map, out: &mut dyn Write) -> std::io::Result<()> {
    let MapPlan { scene, x, y, sensitivity } = &map.plan;
    let (scene, sensitivity) = (scene.to_toml(), *sensitivity);
    let origin = Origin { scene, x: x.clone(), y: y.clone(), sensitivity };
    writeln!(out, "{START}{}", serde_json::to_string(&origin)?)?;
    let is_computed = |index: &usize| map.cells[*index].is_some();
    let computed: Vec<usize> = (0..map.cells.len()).filter(is_computed).collect();
    let table = Table::new(columns(&map.plan), computed.len(), |place| {
        let index = computed[place];
        std::iter::once((index as u64).into()).chain(row(map, index)).collect()
    });
    table.write_csv(out)
}

/// Returns the names of the columns of a share.
fn columns(plan: &MapPlan) -> Vec<String> {
    std::iter::once("cell".to_string()).chain(map::columns(plan)).collect()
}

/// Reads named shares of one map and joins them.
///
/// # Errors
/// A file is not a share, shares belong to different maps, or a cell is missing or there twice. The
/// message names the file.
pub fn read_all<R: Read>(shares: impl IntoIterator<Item = (String, R)>) -> Result<Map, String> {
    let mut joined: Option<(String, Map)> = None;
    for (name, reader) in shares {
        let refused = |reason: &dyn Display| format!("{name}: {reason}");
        let mut reader = BufReader::new(reader);
        let mut first = String::new();
        let read = reader.by_ref().take(LONGEST_FIRST).read_line(&mut first);
        read.map_err(|error| refused(&error))?;
        let (known, mut map) = match joined {
            Some((known, map)) if known == first.trim_end() => (known, map),
            before => {
                let plan = plan(&first)
                    .map_err(|reason| refused(&format!("not a share of a map: {reason}")))?;
                if before.is_some() {
                    return Err(refused(&"a share of another map than the file before it"));
                }
                (first.trim_end().to_string(), Map::empty(plan))
            }
        };
        let mut table = csv::Reader::from_reader(reader.take(LARGEST_TABLE));
        let columns = columns(&map.plan);
        let own = |given: &csv::StringRecord| given.is_empty() || given.iter().eq(&columns);
        if !table.headers().is_ok_and(own) {
            return Err(refused(&format!("line 2 is not {}", columns.join(","))));
        }
        let mut record = csv::StringRecord::new();
        loop {
            // The origin is one line above the table.
            let line = table.position().line() + 1;
            let read = table.read_record(&mut record);
            if matches!(read, Ok(false)) {
                break;
            }
            let (index, cell) = read
                .ok()
                .and_then(|_| parse_row(&record, &map.plan))
                .ok_or_else(|| refused(&format!("line {line} is not a row of this map")))?;
            if map.cells[index].is_some() {
                return Err(refused(&format!("cell {index} (line {line}) is there twice")));
            }
            map.cells[index] = Some(cell);
            map.runs += 1;
        }
        joined = Some((known, map));
    }
    let (_, map) = joined.ok_or("no share of a map was given")?;
    let mut missing = (0..map.cells.len()).filter(|index| map.cells[*index].is_none());
    if let Some(first) = missing.next() {
        return Err(format!("cell {first} is missing, and {} others", missing.count()));
    }
    Ok(map)
}

fn plan(first: &str) -> Result<MapPlan, String> {
    let origin = first
        .strip_prefix(START)
        .ok_or_else(|| format!("its first line does not begin with {START}"))?;
    let origin: Origin = serde_json::from_str(origin).map_err(|error| error.to_string())?;
    origin.plan().map_err(|error| error.to_string())
}

/// Parses a row of a share; `None` if it is not the row of one of the cells of the map.
fn parse_row(record: &csv::StringRecord, plan: &MapPlan) -> Option<(usize, Cell)> {
    let index = record.get(0)?.parse().ok().filter(|index| *index < plan.len())?;
    let (row, column) = (index / plan.x.count as usize, index % plan.x.count as usize);
    // Another machine may round the values of a logarithmic axis differently.
    let is_at = |text: &str, value: f64| {
        text.parse().is_ok_and(|given: f64| (given - value).abs() <= 1e-12 * value.abs())
    };
    let [x, y] = [plan.x.value(column as u32), plan.y.value(row as u32)];
    if !is_at(record.get(1)?, x) || !is_at(record.get(2)?, y) {
        return None;
    }
    let verdict = record.get(3)?.parse().ok()?;
    let doubt = match (record.get(4)?, record.get(5)?) {
        ("true", "") => Doubt::Sensitive,
        ("false", "true") => Doubt::Step,
        ("false", "false") => Doubt::None,
        ("false", "") => Doubt::Unexamined,
        _ => return None,
    };
    Some((index, Cell { verdict, doubt }))
}
