//! `rubscope run`: one time simulation, as a summary, JSON or a file.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;
use serde::Serialize;

use super::Done;
use super::options::SceneOptions;
use super::script::{self, Script};
use super::status::{Refusal, Status, say};
use crate::motion::{RunReport, Sampling, Verdict, simulate_with};
use crate::report::{self, History, HistoryFormat};
use crate::scene::CheckedScene;

/// Simulate a scene in time and tell how it ends.
#[derive(Args, Debug)]
pub struct Run {
    #[command(flatten)]
    options: SceneOptions,
    /// Print the report as JSON (rubscope.run/1)
    #[arg(long)]
    json: bool,
    /// Write the history to FILE: .csv, or .npz for numpy
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Samples of the history
    #[arg(long, value_name = "COUNT", default_value_t = 2000, requires = "out",
          value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    samples: u32,
    /// Add the gap of every blade to the history
    #[arg(long, requires = "out")]
    gaps: bool,
    /// Change the running motion: TIME:PATH=VALUE or TIME:pulse, TIME in seconds; repeatable
    #[arg(long, value_name = "TIME:CHANGE", allow_hyphen_values = true)]
    at: Vec<String>,
}

/// What `--json` prints: the report, and what was changed on the way.
#[derive(Serialize)]
struct Told<'a> {
    #[serde(flatten)]
    report: &'a RunReport,
    #[serde(skip_serializing_if = "Option::is_none")]
    changes: Option<&'a Script>,
}

impl Run {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let scene = self.options.scene()?;
        let script = Script::resolve(&script::parse(&self.at)?, &scene)?;
        let report = match &self.out {
            None => simulate_with(&scene, &script.changes(), Sampling::default(), &mut |_| {}),
            Some(path) => self.simulate_to(&scene, &script, path)?,
        };
        let changes = Some(&script).filter(|script| !script.is_empty());
        if self.json {
            report::json::write(&Told { report: &report, changes }, out)?;
        } else {
            report::summary::write(&report, out)?;
            if let Some(script) = changes {
                writeln!(out, "Changed on the way: {script}.")?;
            }
        }
        Ok(match report.outcome.verdict {
            Verdict::Failed => Status::Failed,
            _ => Status::Done,
        })
    }

    fn simulate_to(
        &self,
        scene: &CheckedScene,
        script: &Script,
        path: &Path,
    ) -> anyhow::Result<RunReport> {
        let shown = path.display();
        let format = HistoryFormat::of(path)
            .ok_or_else(|| Refusal::of("--out", &shown, "a file name ending in .csv or .npz"))?;
        // Before the simulation, which may take long.
        report::file::check_place(path).with_context(|| format!("cannot write {shown}"))?;
        let mut history = History::new(if self.gaps { scene.bladed_disk.blades } else { 0 });
        // Both ends are samples. The smallest gap needs the gaps of all blades.
        let sampling = Sampling { intervals: self.samples - 1, gaps: true };
        let report =
            simulate_with(scene, &script.changes(), sampling, &mut |sample| history.push(sample));
        report::file::replace(path, |out| format.write(&history, out))
            .with_context(|| format!("cannot write {shown}"))?;
        say(&format!("rubscope: wrote {} samples to {shown}", history.len()));
        Ok(report)
    }
}
