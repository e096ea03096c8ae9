//! Shares of a map: the cells of one shard as CSV, and how they join to a map.
//!
//! The first line of a share begins with `#` and names the version and commit of the
//! program, the scene and the axes. It is the same in every share of a map.

use std::io::{BufRead, BufReader, Read, Write};

use anyhow::{anyhow, ensure};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::map::{self, row};
use super::table::Table;
use rubscope_solver::scene::Scene;
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

/// Returns the plan in the first line of a share, completely checked.
fn plan(first: &str) -> anyhow::Result<MapPlan> {
    let origin = first
        .strip_prefix(START)
        .ok_or_else(|| anyhow!("its first line does not begin with {START}"))?;
    let Origin { scene, x, y, sensitivity } = serde_json::from_str(origin)?;
    let axis = |axis: Axis| Axis::new(&axis.path, axis.from, axis.to, axis.count.into(), axis.log);
    let scene = Scene::from_toml_unchecked(&scene)?;
    let plan = MapPlan { scene, x: axis(x)?, y: axis(y)?, sensitivity };
    plan.check()?;
    Ok(plan)
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
    let mut joined = None;
    for (name, share) in shares {
        read(share, &mut joined).map_err(|why| format!("{name}: {why}"))?;
    }
    let (_, map) = joined.ok_or("no share of a map was given")?;
    let mut missing = (0..map.cells.len()).filter(|index| map.cells[*index].is_none());
    if let Some(first) = missing.next() {
        return Err(format!("cell {first} is missing, and {} others", missing.count()));
    }
    Ok(map)
}

/// Adds a share to the map that the shares before it have `joined`, and their first line.
fn read(share: impl Read, joined: &mut Option<(String, Map)>) -> anyhow::Result<()> {
    let mut share = BufReader::new(share);
    let mut first = String::new();
    share.by_ref().take(LONGEST_FIRST).read_line(&mut first)?;
    let (_, map) = match joined {
        Some(same) if same.0 == first.trim_end() => same,
        before => {
            let plan = plan(&first).map_err(|why| anyhow!("not a share of a map: {why}"))?;
            ensure!(before.is_none(), "a share of another map than the file before it");
            before.insert((first.trim_end().to_string(), Map::empty(plan)))
        }
    };
    let mut table = csv::Reader::from_reader(share.take(LARGEST_TABLE));
    let columns = columns(&map.plan);
    let own = |given: &csv::StringRecord| given.is_empty() || given.iter().eq(&columns);
    ensure!(table.headers().is_ok_and(own), "line 2 is not {}", columns.join(","));
    let mut record = csv::StringRecord::new();
    loop {
        // The origin is one line above the table.
        let line = table.position().line() + 1;
        let found = match table.read_record(&mut record) {
            Ok(false) => return Ok(()),
            Ok(true) => parse_row(&record, &map.plan),
            Err(_) => None,
        };
        let (index, cell) = found.ok_or_else(|| anyhow!("line {line} is not a row of this map"))?;
        ensure!(map.cells[index].is_none(), "cell {index} (line {line}) is there twice");
        map.cells[index] = Some(cell);
        map.runs += 1;
    }
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
