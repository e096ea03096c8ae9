//! `rubscope precision`: run time against error of every solver on one scene.

use std::io::Write;

use clap::Args;

use super::options::SceneOptions;
use super::output::OutputOptions;
use super::sign;
use super::status::{self, Done, Refusal, Status, say};
use crate::sheet::{CommandLine, precision as report};
use rubscope_solver::motion::to_the_end;
use rubscope_solver::study::precision::{Effort, Measure, Method, ways};

/// Measure every solver's speed against its error on a scene.
#[derive(Args, Debug)]
pub struct PrecisionCommand {
    #[command(flatten)]
    options: SceneOptions,
    #[command(flatten)]
    output: OutputOptions,
    /// Number of runs for the median time
    #[arg(long, value_name = "COUNT", default_value_t = 5,
          value_parser = super::range::whole::<1, 1000>)]
    repeat: u32,
    #[arg(help = "Smallest time step tried [s]")]
    #[arg(long, value_name = "SECONDS", default_value_t = 1e-8)]
    finest: f64,
}

impl PrecisionCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let scene = self.options.scene()?;
        if self.finest.is_nan() || self.finest <= 0.0 {
            return Err(Refusal::of("--finest", self.finest, "a time step above 0").into());
        }
        self.output.ending()?;
        let effort = Effort { repeats: self.repeat, finest_s: self.finest, ..Effort::default() };
        let ways = ways(&scene, effort);
        let form = "{spinner} {bar:30} {pos}/{len} {msg} {elapsed}";
        let bar = sign::bar(ways.len() as u64, form);
        bar.set_message("the reference");
        let Some(measure) = Measure::new(&scene, effort, &to_the_end)? else {
            return Ok(Status::Failed);
        };
        status::say_noted();
        let mut rows = Vec::with_capacity(ways.len());
        for way in ways {
            bar.set_message(report::series(&way));
            rows.extend(measure.row(way, effort, &to_the_end)?);
            bar.inc(1);
        }
        let measured = measure.report(rows);
        let command = CommandLine::new("precision", &measured.scene)
            .option("--repeat", self.repeat)
            .option("--finest", self.finest);
        let done = self.output.deliver(&report::sheet(&measured, command), out)?;
        if measured.reference.method != Method::None {
            return Ok(done);
        }
        out.flush()?;
        say(&format!("rubscope: nothing to compare with: {}", report::WHY_NONE));
        Ok(Status::Failed)
    }
}
