//! `rubscope margins`: how far a scene is from every limit, and what moves it.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use super::options::SceneOptions;
use super::status::{self, Refusal, Status};
use super::{Done, gone, output, sign};
use crate::report::{CommandLine, Provenance, json, margins as report, svg};
use rubscope_solver::motion::to_the_end;
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::study::margins::{Margins, SAMPLES, Target, TargetError, Tolerance};

/// Find how far a scene is from every limit, and what moves each limit most.
///
/// Speeds, pulses and the loads of the locked motion, each with its change in per cent
/// by one per cent of every parameter of the scene.
#[derive(Args, Debug)]
pub struct MarginsCommand {
    #[command(flatten)]
    options: SceneOptions,
    /// Print everything as JSON (rubscope.margins/1)
    #[arg(long)]
    json: bool,
    /// Write the limits to FILE: .csv, or .svg for a page
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Find the value of a parameter that puts a limit there, such as omega_lock=450
    #[arg(long, value_name = "NAME=VALUE", requires = "by", allow_hyphen_values = true)]
    target: Option<String>,
    /// The parameter for --target, such as casing.damping_ratio
    #[arg(long, value_name = "PATH", requires = "target")]
    by: Option<String>,
    /// A parameter is known only to so many per cent: how far limits spread; repeatable
    #[arg(long, value_name = "PATH=PERCENT", allow_hyphen_values = true)]
    tolerance: Vec<String>,
    /// Leave out the smallest lasting pulses, which take many runs
    #[arg(long)]
    no_search: bool,
}

impl MarginsCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let format = match &self.out {
            Some(path) => Some(output::format(path, &["csv", "svg"])?),
            None => None,
        };
        let scene = self.options.scene()?;
        let target = match (&self.target, &self.by) {
            (Some(target), Some(by)) => {
                let name = target.split('=').next().unwrap_or_default().trim();
                let refused = |error: TargetError| {
                    Refusal::because(gone::name("margins", name).unwrap_or(error.to_string()))
                };
                Some(Target::parse(target, by).map_err(refused)?)
            }
            _ => None,
        };
        let tolerances = Tolerance::parse_all(&self.tolerance, &scene)
            .map_err(|error| Refusal::because(error.to_string()))?;
        status::say_noted();
        let mut margins = Margins::of(&scene);
        if !self.no_search {
            for law in margins.laws() {
                sign::doing(format!("smallest lasting pulse, {law} law"));
                margins.search(law, &to_the_end);
            }
        }
        if !tolerances.is_empty() {
            let form = "{spinner} {bar:30} {pos}/{len} samples of the tolerances {elapsed}";
            let bar = sign::bar(SAMPLES as u64, form);
            margins.spread(tolerances, &|| bar.inc(1));
        }
        margins.target = target.and_then(|target| target.solve(&scene, &to_the_end));
        self.deliver(&margins, &scene, format, out)?;
        Ok(Status::Done)
    }

    fn deliver(
        &self,
        margins: &Margins,
        scene: &CheckedScene,
        format: Option<&str>,
        out: &mut dyn Write,
    ) -> anyhow::Result<()> {
        let command = self.command(scene);
        if self.json {
            json::write_as("rubscope.margins/1", &command, margins, out)?;
        }
        if let Some(path) = &self.out {
            let rows = format!("{} limits", margins.limits.len());
            if format == Some("svg") {
                let command = command.option("--out", "margins.svg");
                let origin = Provenance { command, scene: scene.clone().into_scene() };
                output::save(path, &rows, out, |out| svg::write_margins(margins, &origin, out))?;
            } else {
                output::save(path, &rows, out, |out| report::table(margins).write_csv(out))?;
            }
        }
        if !self.json {
            report::write(margins, out)?;
        }
        Ok(())
    }

    /// The command that gives the same answer again.
    fn command(&self, scene: &CheckedScene) -> CommandLine {
        let command = CommandLine::new("margins", scene)
            .optional("--target", self.target.as_ref())
            .optional("--by", self.by.as_ref());
        let tolerance = |command: CommandLine, text| command.option("--tolerance", text);
        self.tolerance.iter().fold(command, tolerance).flag("--no-search", self.no_search)
    }
}
