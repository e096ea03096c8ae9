//! `rubscope run`: simulates a scene in time; prints a summary or JSON, and writes the history.

use std::io::Write;
use std::time::Instant;

use clap::Args;

use super::options::SceneOptions;
use super::output::OutputOptions;
use super::script::RequestedScript;
use super::sign;
use super::status::{self, Done, Refusal, Status};
use crate::sheet::history::HISTORY_VALUES;
use crate::sheet::{CommandLine, History, Wall, summary};
use rubscope_solver::motion::{Sample, Sampling, Verdict, run_to_end, to_the_end};
use rubscope_solver::scene::SolverKind;

/// Simulate a scene in time and report how it ends.
#[derive(Args, Debug)]
pub struct RunCommand {
    #[command(flatten)]
    options: SceneOptions,
    #[command(flatten)]
    output: OutputOptions,
    /// Number of samples in the history
    #[arg(long, value_name = "COUNT", default_value_t = 2000, requires = "out",
          value_parser = super::range::whole::<2, 1_000_000>)]
    samples: u32,
    /// Add the gap of every blade to the history
    #[arg(long, requires = "out")]
    gaps: bool,
    /// Change the running motion: TIME:PATH=VALUE or TIME:pulse, TIME in seconds; repeatable
    #[arg(long, value_name = "TIME:CHANGE", allow_hyphen_values = true)]
    at: Vec<String>,
    /// One run only: skip the extra runs that check whether a tiny change, half the step or the
    /// event solver changes the outcome
    #[arg(long)]
    no_sensitivity: bool,
    /// Compute every step of the explicit solver: no skipped steps, no early verdict
    #[arg(long)]
    plain: bool,
}

impl RunCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let mut scene = self.options.scene()?;
        self.options.ask_speed(&scene);
        if self.plain {
            if scene.solver.kind != SolverKind::Explicit {
                let reason = "--plain: only for --solver explicit; the event solver has no steps";
                return Err(Refusal::because(reason).into());
            }
            scene = scene.by_every_step();
        }
        let script = RequestedScript::of(&self.at, &scene)?;
        let acts = &script.changes;
        let has_file = self.output.ending()?.is_some();
        let gaps = if self.gaps { scene.bladed_disk.blades } else { 0 };
        let most = History::most_samples(gaps);
        if self.samples > most {
            let allowed = format!(
                "up to {most} with the gaps of {gaps} blades: a history has at most {HISTORY_VALUES} \
                 values"
            );
            return Err(Refusal::of("--samples", self.samples, allowed).into());
        }
        let mut history = History::new(gaps);
        // Both ends are samples, so there is one interval fewer. The smallest gap needs the gaps
        // of all blades, also if they have no columns.
        let sampling = match has_file {
            true => Sampling { intervals: self.samples - 1, gaps: true },
            false => Sampling::default(),
        };
        status::say_noted();
        let started = Instant::now();
        let mut sink = |sample: &Sample| history.push(sample);
        let mut report = run_to_end(&scene, acts, sampling, &mut sink);
        let mut wall = Wall { run_s: started.elapsed().as_secs_f64(), certainty_s: None };
        if !self.no_sensitivity {
            sign::doing("extra runs determine which digits are reliable");
            let started = Instant::now();
            report.ask_changed_runs(acts, &to_the_end);
            report.ask_events(acts, &to_the_end);
            wall.certainty_s = Some(started.elapsed().as_secs_f64());
        }
        let changes = (script.words.join(", "), script.json);
        let command = CommandLine::new("run", &scene);
        let command = self.at.iter().fold(command, |line, change| line.option("--at", change));
        let command =
            command.flag("--no-sensitivity", self.no_sensitivity).flag("--plain", self.plain);
        let sheet = summary::sheet(&report, wall, changes, &history, command);
        self.output.deliver(&sheet, out)?;
        Ok(match report.outcome.verdict {
            Verdict::Failed => Status::Failed,
            _ => Status::Done,
        })
    }
}
