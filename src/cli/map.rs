//! `rubscope map`: the verdicts over two parameters of a scene.

use std::fs::File;
use std::io::{IsTerminal, Write};
use std::path::PathBuf;

use clap::{Args, Subcommand};
use rayon::prelude::*;

use super::options::{SceneOptions, note_adjusted};
use super::output::OutputOptions;
use super::range::{Range, whole};
use super::sign;
use super::status::{self, Done, Refusal, Status};
use crate::sheet::map as report;
use crate::sheet::number::from_shown;
use crate::sheet::part::{self, Shard};
use rubscope_solver::scene::keys;
use rubscope_solver::study::{Axis, Map, MapPlan};

/// Upper bound of `--threads`, above the number of cores of usual machines.
const MOST_THREADS: u32 = 1024;
/// Largest number of cells in a picture; each takes about a hundred bytes of SVG.
const MOST_DRAWN: usize = 1_000_000;
/// Help texts of `--speed` and `--pulse`, which are ranges for this command.
const COLUMNS_OF_SPEED: &str =
    "Columns: rotor speeds; negative turns the other way [rad/s] [default: 0:500:51]";
const ROWS_OF_PULSE: &str = "Rows: forces of the pulse on the casing [N] [default: 0:1e6:21]";
/// Width of the text map if standard output is not a terminal \[characters\].
const WIDTH: usize = 115;

/// Map the verdict over two parameters (default: pulse and speed).
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
    /// Skip the search for sensitive cells, which needs more runs
    #[arg(long)]
    no_sensitivity: bool,
    /// Number of threads [default: every core]
    #[arg(long, value_name = "COUNT", value_parser = whole::<1, MOST_THREADS>)]
    threads: Option<u32>,
    /// Compute only share K of COUNT, counted from 1, for map merge; needs --out FILE.csv
    #[arg(long, value_name = "K/COUNT", requires = "out")]
    shard: Option<String>,
    #[command(flatten)]
    output: OutputOptions,
}

#[derive(Subcommand, Debug)]
enum MapSubcommand {
    /// Join the shares that --shard computed
    Merge(Merge),
}

#[derive(Args, Debug)]
struct Merge {
    /// Shares of one map
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    output: OutputOptions,
}

impl MapCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        if let Some(MapSubcommand::Merge(merge)) = &self.merge {
            return merge.run(out);
        }
        let read = |text: &String| {
            let refused = || Refusal::of("--shard", text, "K/COUNT with K from 1 to COUNT");
            Shard::parse(text).ok_or_else(refused)
        };
        let shard = self.shard.as_ref().map(read).transpose()?;
        let ending = match shard {
            Some(_) => self.output.ending_among(&["csv"])?,
            None => self.output.ending()?,
        };
        let plan = self.plan()?;
        check_picture(&plan, ending)?;
        status::say_noted();
        let mut map = Map::empty(plan);
        self.compute(&mut map, shard)?;
        if shard.is_none() {
            return self.output.deliver(&report::sheet(&map, width()), out);
        }
        let what = format!("{} rows", map.runs);
        self.output.save(&what, out, |out| part::write(&map, out))?;
        Ok(Status::Done)
    }

    fn plan(&self) -> anyhow::Result<MapPlan> {
        let axes = [(&self.x, keys::SPEED), (&self.y, keys::PULSE)];
        let swept = axes.iter().filter(|(text, _)| text.is_none()).map(|(_, key)| *key);
        let resolved = self.options.resolve(&swept.collect::<Vec<_>>())?;
        let axis = |(text, path): (&Option<String>, &str), to, count| match text {
            Some(text) => Axis::parse(text),
            None => {
                let usual = Range { from: 0.0, to, count };
                let Range { from, to, count } = resolved.range(path).unwrap_or(usual);
                Axis::new(path, from, to, count as u64, false)
            }
        };
        // Steps of 10 rad/s (or 100 rpm) and 50 kN; both ranges end at a round number in the unit
        // shown.
        let fastest = if self.options.in_rpm() { from_shown(5000.0, "rad/s") } else { 500.0 };
        let mut plan = MapPlan {
            x: axis(axes[0], fastest, 51)?,
            y: axis(axes[1], 1e6, 21)?,
            scene: resolved.scene.clone().into_scene(),
            sensitivity: !self.no_sensitivity,
        };
        note_adjusted(&plan.make_compatible(|key| self.options.sets(key))?);
        Ok(plan)
    }

    fn compute(&self, map: &mut Map, shard: Option<Shard>) -> anyhow::Result<()> {
        // Without a number, 0: every core.
        let threads = self.threads.unwrap_or(0) as usize;
        let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let whole = Shard { number: 1, count: 1 };
        let indices = shard.unwrap_or(whole).indices(map.cells.len());
        let form = "{spinner} {bar:30} {pos}/{len} cells, {per_sec}, {eta} left";
        let bar = sign::bar(indices.len() as u64, form);
        let count = |_, _| bar.inc(1);
        builder.build()?.install(|| map.fill(indices, &|| true, &count));
        Ok(())
    }
}

impl Merge {
    fn run(&self, out: &mut dyn Write) -> Done {
        let ending = self.output.ending()?;
        let mut shares = Vec::new();
        for path in &self.files {
            let shown = path.display().to_string();
            let file = File::open(path)
                .map_err(|error| Refusal::because(format!("cannot read {shown}: {error}")))?;
            shares.push((shown, file));
        }
        let map = part::read_all(shares).map_err(Refusal::because)?;
        check_picture(&map.plan, ending)?;
        self.output.deliver(&report::sheet(&map, width()), out)
    }
}

/// Refuses a picture with too many cells.
fn check_picture(plan: &MapPlan, ending: Option<&str>) -> Result<(), Refusal> {
    if ending != Some("svg") || plan.len() <= MOST_DRAWN {
        return Ok(());
    }
    let cells = format!("an .svg of {} cells", plan.len());
    Err(Refusal::of("--out", cells, format!("up to {MOST_DRAWN} cells in a picture")))
}

/// Returns the width of the text map \[characters\]: that of the terminal if standard output is
/// one, otherwise [`WIDTH`].
fn width() -> usize {
    let size = crossterm::terminal::size().ok().filter(|_| std::io::stdout().is_terminal());
    size.map_or(WIDTH, |(columns, _)| usize::from(columns))
}
