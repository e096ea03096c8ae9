//! `rubscope map`: how the motion lasts over two quantities of a scene.
//!
//! Computed cells are never lost: with `--out` or `--resume` they are saved in
//! a part file at once, Ctrl-C keeps them and prints how to continue, and a
//! result that cannot be written goes to standard output instead.

use std::fs::File;
use std::io::{BufReader, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use clap::{Args, Subcommand};
use rayon::prelude::*;

use super::options::{SceneOptions, Swept};
use super::part_file::{self, PartFile, save_new};
use super::range::Range;
use super::signals::StopRequest;
use super::status::{self, Refusal, Status, say};
use super::{Done, output, sign};
use crate::file::{self, Written};
use crate::report::{Provenance, json, map as report, svg};
use rubscope_solver::scene::keys;
use rubscope_solver::study::{Axis, AxisError, Cell, Map, MapPlan, Progress, Shard, overlay, part};

/// Most threads: more than any machine has cores for.
const MOST_THREADS: usize = 1024;
/// Most cells of a picture, which takes some hundred bytes a cell.
const MOST_DRAWN: usize = 1_000_000;
/// Columns and rows of a map by default: steps of 10 rad/s and 50 kN.
const COLUMNS: u32 = 51;
const ROWS: u32 = 21;
/// What `--speed` and `--pulse` take here.
const COLUMNS_OF_SPEED: &str =
    "Columns: rotor speeds; negative turns the other way [rad/s] [default: 0:500:51]";
const ROWS_OF_PULSE: &str = "Rows: forces of the pulse on the casing [N] [default: 0:1e6:21]";
/// Width of a map if standard output is not a terminal.
const WIDTH: usize = 115;

/// Map how the motion lasts over pulse and speed, or any two keys.
#[derive(Args, Debug)]
#[command(args_conflicts_with_subcommands = true)]
#[command(mut_arg("speed", |speed| speed.help(COLUMNS_OF_SPEED).value_name("FROM:TO:COUNT")))]
#[command(mut_arg("pulse", |pulse| pulse.help(ROWS_OF_PULSE).value_name("FROM:TO:COUNT")))]
pub struct MapCommand {
    #[command(subcommand)]
    merge: Option<MapSubcommand>,
    #[command(flatten)]
    options: SceneOptions,
    /// Columns: PATH=FROM:TO:COUNT or PATH=log:FROM:TO:COUNT [default: the speed]
    #[arg(long, value_name = "AXIS", conflicts_with = "speed")]
    x: Option<String>,
    /// Rows: PATH=FROM:TO:COUNT or PATH=log:FROM:TO:COUNT [default: the pulse]
    #[arg(long, value_name = "AXIS", conflicts_with = "pulse")]
    y: Option<String>,
    /// Coarse cells first, then only next to another verdict, down to single cells
    #[arg(long, conflicts_with = "shard")]
    adaptive: bool,
    /// Do not look for sensitive cells: takes fewer runs
    #[arg(long)]
    no_sensitivity: bool,
    /// Number of threads [default: every core]
    #[arg(long, value_name = "COUNT", value_parser = threads)]
    threads: Option<usize>,
    /// Compute only share K of COUNT, counted from 1, into --out FILE.part
    #[arg(long, value_name = "K/COUNT", requires = "out")]
    shard: Option<String>,
    /// Continue from the cells in FILE, and save new ones there
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,
    #[command(flatten)]
    result: ResultOptions,
}

/// Where a finished map goes.
#[derive(Args, Debug)]
struct ResultOptions {
    /// Print the map as JSON (rubscope.map/1)
    #[arg(long)]
    json: bool,
    /// Write the map to FILE: .csv, .json, .svg, or .part to be merged later
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Subcommand, Debug)]
enum MapSubcommand {
    /// Join the parts that shards computed
    Merge(Merge),
}

#[derive(Args, Debug)]
struct Merge {
    /// Parts of one map
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    result: ResultOptions,
}

fn threads(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (1..=MOST_THREADS).contains(count));
    count.ok_or_else(|| format!("allowed is a whole number from 1 to {MOST_THREADS}"))
}

impl MapCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        if let Some(MapSubcommand::Merge(merge)) = &self.merge {
            return merge.run(out);
        }
        let format = self.result.format()?;
        let shard = self.shard()?;
        if self.shard.is_some() && format != Some("part") {
            return Err(Refusal::because("--shard: allowed with --out FILE.part only").into());
        }
        if self.adaptive && format == Some("part") {
            let reason = "--adaptive: allowed with --out FILE.csv, .json or .svg, since a part \
                          holds cells that were run";
            return Err(Refusal::because(reason).into());
        }
        let plan = self.plan()?;
        check_picture(&plan, format)?;
        self.result.try_place()?;
        let mut map = Map::empty(plan);
        let part = match self.part_file() {
            Some(path) => Some(PartFile::open(&path, &mut map)?),
            None => None,
        };
        self.result.refuse_locked(part.as_ref())?;
        status::say_noted();
        let kept = Kept { adaptive: self.adaptive, threads: self.threads, part };
        if let Some(signal) = compute(&mut map, shard, &kept, out)? {
            return Ok(Status::Signal(signal));
        }
        self.result.refuse_locked(kept.part.as_ref())?;
        self.result.deliver(&map, out)?;
        // The result now has the cells of the part that this command made for it; one
        // that the user named stays.
        if let Some(part) = kept.part.filter(|_| self.resume.is_none()) {
            part.remove();
        }
        Ok(Status::Done)
    }

    fn plan(&self) -> anyhow::Result<MapPlan> {
        let swept = Swept { speed: self.x.is_none(), pulse: self.y.is_none() };
        let resolved = self.options.resolve(swept)?;
        let axis = |text: &Option<String>, path: &str, range: Option<Range>, from, to, count| {
            let axis = match (text, range) {
                (Some(text), _) => Axis::parse(text),
                (None, Some(range)) => {
                    let count = u32::try_from(range.count).unwrap_or(u32::MAX);
                    Axis::new(path, range.from, range.to, count, false)
                }
                (None, None) => Axis::new(path, from, to, count, false),
            };
            axis.map_err(|error: AxisError| Refusal::because(error.to_string()))
        };
        let scene = resolved.scene;
        let plan = MapPlan {
            x: axis(&self.x, keys::SPEED, resolved.speeds, 0.0, 500.0, COLUMNS)?,
            y: axis(&self.y, keys::PULSE, resolved.pulses, 0.0, 1e6, ROWS)?,
            scene: scene.into_scene(),
            sensitivity: !self.no_sensitivity,
        };
        plan.check()?;
        Ok(plan)
    }

    fn shard(&self) -> Result<Shard, Refusal> {
        let Some(text) = &self.shard else { return Ok(Shard::WHOLE) };
        Shard::parse(text)
            .ok_or_else(|| Refusal::of("--shard", text, "K/COUNT with K from 1 to COUNT"))
    }

    /// Where cells are saved as soon as they are known.
    fn part_file(&self) -> Option<PathBuf> {
        self.resume.clone().or_else(|| self.own_part())
    }

    /// The part file next to the result.
    fn own_part(&self) -> Option<PathBuf> {
        let mut name = self.result.out.clone()?.into_os_string();
        name.push(".partial");
        Some(PathBuf::from(name))
    }
}

impl Merge {
    fn run(&self, out: &mut dyn Write) -> Done {
        let format = self.result.format()?;
        let map = read_parts(&self.files)?;
        check_picture(&map.plan, format)?;
        part::require_complete(&map).map_err(|error| Refusal::because(error.to_string()))?;
        self.result.try_place()?;
        self.result.deliver(&map, out)?;
        Ok(Status::Done)
    }
}

/// Refuses a picture in which no cell could be seen.
fn check_picture(plan: &MapPlan, format: Option<&str>) -> Result<(), Refusal> {
    if format != Some("svg") || plan.len() <= MOST_DRAWN {
        return Ok(());
    }
    let cells = format!("an .svg of {} cells", plan.len());
    Err(Refusal::of("--out", cells, format!("up to {MOST_DRAWN} cells in a picture")))
}

fn read_parts(files: &[PathBuf]) -> anyhow::Result<Map> {
    let mut parts = Vec::new();
    for path in files {
        let shown = path.display().to_string();
        let file = File::open(path)
            .map_err(|error| Refusal::because(format!("cannot read {shown}: {error}")))?;
        parts.push((shown, BufReader::new(file)));
    }
    let map = part::read_all(parts).map_err(|error| Refusal::because(error.to_string()))?;
    map.ok_or_else(|| Refusal::because("no part of a map was given").into())
}

impl ResultOptions {
    fn format(&self) -> Result<Option<&'static str>, Refusal> {
        let Some(path) = &self.out else { return Ok(None) };
        output::ending(path, &["csv", "json", "svg", "part"]).map(Some)
    }

    /// Tries the place of the result, before anything is computed.
    fn try_place(&self) -> anyhow::Result<()> {
        self.out.as_deref().map_or(Ok(()), output::try_place)
    }

    /// Refuses a result in the place of a part that another map writes.
    fn refuse_locked(&self, own: Option<&PartFile>) -> Result<(), Refusal> {
        self.out.as_deref().map_or(Ok(()), |path| part_file::refuse_locked(path, own))
    }

    /// Prints and writes the finished map. If it cannot be written, it goes
    /// to standard output as JSON, so that nothing computed is lost.
    fn deliver(&self, map: &Map, out: &mut dyn Write) -> anyhow::Result<()> {
        if self.json {
            json::write(&report::MapJson { map, with_time: true }, out)?;
        } else if self.out.is_none() {
            report::write_text(map, width(), out)?;
        }
        let (Some(path), Some(format)) = (&self.out, self.format()?) else { return Ok(()) };
        let shown = path.display();
        // The file may be standard output itself, and comes after what is there.
        out.flush()?;
        let error = match write_file(map, format, path) {
            Ok(written) => {
                let cells = format!("{} cells", map.cells.iter().flatten().count());
                output::say_written(written, &cells, &shown);
                return Ok(());
            }
            Err(error) => error,
        };
        let kept = match format {
            "part" => "its cells are on standard output, to be saved as a part",
            _ => "the whole map is on standard output as JSON",
        };
        Err(output::print_instead(path, error, kept, out, |out| match format {
            "part" => part::write(map, out).map(drop),
            // It is there already.
            _ if self.json => Ok(()),
            _ => json::write(&report::MapJson { map, with_time: false }, out),
        }))
    }
}

/// Width that a map in text may have.
fn width() -> usize {
    let size = crossterm::terminal::size().ok().filter(|_| std::io::stdout().is_terminal());
    size.map_or(WIDTH, |(columns, _)| usize::from(columns))
}

fn write_file(map: &Map, format: &str, path: &Path) -> std::io::Result<Written> {
    file::replace(path, |out| match format {
        "csv" => report::write_csv(map, out),
        "json" => json::write(&report::MapJson { map, with_time: false }, out),
        "svg" => {
            let command = report::command(map).option("--out", "map.svg");
            let origin = Provenance { command, scene: map.plan.scene.clone() };
            svg::write(&report::figure(map, &overlay::curves(&map.plan)), &origin, out)
        }
        _ => part::write(map, out).map(drop),
    })
}

/// How often the bar and the signals are checked.
const LOOK: Duration = Duration::from_millis(100);

/// How a map is computed and saved.
pub(super) struct Kept {
    /// Refine only next to changes.
    pub adaptive: bool,
    /// Number of threads.
    pub threads: Option<usize>,
    /// Where cells are saved as soon as they are known.
    pub part: Option<PartFile>,
}

/// Computes the cells of a map; the number of the signal that stopped it.
pub(super) fn compute(
    map: &mut Map,
    shard: Shard,
    kept: &Kept,
    out: &mut dyn Write,
) -> anyhow::Result<Option<u8>> {
    let progress = Progress::default();
    let request = StopRequest::expect();
    let notes = kept.part.as_ref();
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = kept.threads {
        builder = builder.num_threads(threads);
    }
    let pool = builder.build()?;
    let indices = shard.indices(map.cells.len());
    let is_missing = |&index: &usize| map.cells[index].is_none();
    let missing = pool.install(|| indices.clone().filter(is_missing).count());
    let finished = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| watch(&progress, &request, &finished, missing as u64));
        let keep = |index: usize, cell: Cell| {
            if let Some(notes) = notes {
                notes.keep(index, cell);
            }
        };
        pool.install(|| {
            if kept.adaptive {
                map.fill_adaptively(&progress, &keep);
            } else {
                map.fill(indices, &progress, &keep);
            }
        });
        finished.store(true, Ordering::Relaxed);
    });
    let trouble = notes.and_then(|notes| Some((notes.name(), notes.trouble()?)));
    if let Some((path, error)) = &trouble {
        say(&format!("rubscope: could not save cells in {}: {error}", path.display()));
    }
    let received = request.received();
    drop(request);
    if let Some(number) = received {
        let complete = notes.filter(|_| trouble.is_none()).and_then(PartFile::path);
        stopped(map, complete, out)?;
        return Ok(Some(number));
    }
    if kept.adaptive {
        say_what_was_saved(map);
    }
    Ok(None)
}

/// The cost of an adaptive map, compared with all its cells.
fn say_what_was_saved(map: &Map) {
    let (runs, cells, stride) = (map.runs, map.cells.len() as u64, map.coarsest_stride());
    let saved = cells.saturating_sub(runs);
    let percent = 100 * saved / cells.max(1);
    say(&format!(
        "rubscope: {runs} runs for {cells} cells, {saved} ({percent} %) saved; started with 1 of \
         {stride} columns and rows, every border between verdicts run to the cell"
    ));
}

/// Saves what is done and prints how to continue. If no part file has all
/// cells, one is written; if that fails, the cells go to standard output.
fn stopped(map: &Map, complete: Option<&Path>, out: &mut dyn Write) -> anyhow::Result<()> {
    let (done, cells) = (map.cells.iter().flatten().count(), map.cells.len());
    let stopped = format!("rubscope: stopped; {done} of {cells} cells are kept");
    if let Some(path) = complete {
        say(&format!("{stopped} in {}: go on with the same command", path.display()));
        return Ok(());
    }
    match save_new(map) {
        Ok(path) => {
            let path = path.display();
            say(&format!("{stopped}: go on with the same command and --resume {path}"));
            Ok(())
        }
        Err((path, error)) => {
            let kept = "its cells are on standard output, to be saved as a part for --resume";
            let print = |out: &mut dyn Write| part::write(map, out).map(drop);
            Err(output::print_instead(&path, error, kept, out, print))
        }
    }
}

/// Updates the bar and handles signals until the cells are done.
fn watch(progress: &Progress, request: &StopRequest, finished: &AtomicBool, cells: u64) {
    let bar = sign::bar(cells, "{spinner} {bar:30} {pos}/{len} cells, {per_sec}, {eta} left");
    while !finished.load(Ordering::Relaxed) {
        if request.received().is_some() {
            progress.stop.store(true, Ordering::Relaxed);
        }
        bar.set_position(progress.done.load(Ordering::Relaxed));
        std::thread::sleep(LOOK.min(Duration::from_millis(1 + cells / 100)));
    }
}
