//! `rubscope precision`: run time against error of every solver on one scene.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use super::options::SceneOptions;
use super::status::{self, Refusal, Status, say};
use super::{Done, output, sign};
use crate::report::{CommandLine, Provenance, json, precision as report, svg};
use rubscope_solver::motion::to_the_end;
use rubscope_solver::study::precision::{Effort, Measure, Method, Precision, ways};

/// Measure every solver's speed against its error on a scene.
#[derive(Args, Debug)]
pub struct PrecisionCommand {
    #[command(flatten)]
    options: SceneOptions,
    /// Print the measurements as JSON (rubscope.precision/1)
    #[arg(long)]
    json: bool,
    /// Write the measurements to FILE: .csv, or .svg for the chart
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Number of runs for the median time
    #[arg(long, value_name = "COUNT", default_value_t = 5,
          value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeat: u32,
    /// Smallest time step tried [s]
    #[arg(long, value_name = "SECONDS", default_value_t = 1e-8)]
    finest: f64,
}

impl PrecisionCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let scene = self.options.scene()?;
        if self.finest.is_nan() || self.finest <= 0.0 {
            return Err(Refusal::of("--finest", self.finest, "a time step above 0").into());
        }
        let format = output::format(self.out.as_deref(), &["csv", "svg"])?;
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
        self.deliver(&measure.report(rows), format, out)
    }

    fn deliver(&self, measured: &Precision, format: Option<&str>, out: &mut dyn Write) -> Done {
        let command = CommandLine::new("precision", &measured.scene)
            .option("--repeat", self.repeat)
            .option("--finest", self.finest);
        if self.json {
            json::write_as("rubscope.precision/1", &command, measured, out)?;
        }
        if let Some(path) = &self.out {
            let rows = format!("{} rows", measured.rows.len());
            if format == Some("svg") {
                let figure = report::figure(measured).map_err(Refusal::because)?;
                let command = command.option("--out", "precision.svg");
                let origin = Provenance { command, scene: measured.scene.clone() };
                output::save(path, &rows, out, |out| svg::write(&figure, &origin, out))?;
            } else {
                output::save(path, &rows, out, |out| report::table(measured).write_csv(out))?;
            }
        }
        if !self.json {
            report::write(measured, out)?;
        }
        if measured.reference.method != Method::None {
            return Ok(Status::Done);
        }
        out.flush()?;
        say(&format!("rubscope: nothing to compare with: {}", report::WHY_NONE));
        Ok(Status::Failed)
    }
}
