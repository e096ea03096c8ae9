//! `rubscope margins`: how far a scene is from every limit, and what moves it.

use std::io::Write;

use clap::Args;

use super::options::SceneOptions;
use super::output::OutputOptions;
use super::sign;
use super::status::{self, Done};
use crate::sheet::number::with_typed_unit;
use crate::sheet::{CommandLine, margins as report};
use rubscope_solver::motion::to_the_end;
use rubscope_solver::scene::Quantity;
use rubscope_solver::study::margins::{LimitName, Margins, Target};

/// Find how far a run is from another verdict and from every limit, and what moves each limit most.
///
/// Prints the nearest changes of speed, pulse, damping and clearance found to alter the verdict.
/// The limits follow: speeds, pulses and loads of the locked motion, each with its change in per
/// cent if a parameter of the scene changes by one per cent.
#[derive(Args, Debug)]
pub struct MarginsCommand {
    #[command(flatten)]
    options: SceneOptions,
    #[command(flatten)]
    output: OutputOptions,
    /// Find the parameter value at which a limit has this value, such as omega_lock=450
    #[arg(long, value_name = "NAME=VALUE", requires = "by", allow_hyphen_values = true)]
    target: Option<String>,
    /// The parameter for --target, such as casing.damping_ratio
    #[arg(long, value_name = "PATH", requires = "target")]
    by: Option<String>,
    /// Skip the search for the nearest changes of the verdict, which needs many runs
    #[arg(long)]
    no_search: bool,
}

impl MarginsCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        self.output.ending()?;
        let scene = self.options.scene()?;
        self.options.ask_speed(&scene);
        self.options.note_assumed(&scene);
        let target = match (&self.target(), &self.by) {
            (Some(target), Some(by)) => Some(Target::parse(target, by)?),
            _ => None,
        };
        status::say_noted();
        let mut margins = Margins::of(&scene);
        margins.target = target.and_then(|target| target.solve(&scene, &to_the_end));
        if !self.no_search {
            let rows = Margins::rows_asked(&scene) as u64;
            let bar = sign::bar(rows, "{spinner} {bar:30} {pos}/{len} {msg} {elapsed}");
            bar.set_message("nearest changes of the verdict");
            margins.ask_runs(true, &to_the_end, &mut |_| bar.inc(1));
        }
        let command = CommandLine::new("margins", &scene)
            .optional("--target", self.target())
            .optional("--by", self.by.as_ref())
            .flag("--no-search", self.no_search);
        self.output.deliver(&report::sheet(&margins, command), out)
    }

    /// Returns the text of `--target`, with `rpm` appended to a speed without a unit if `--rpm` is
    /// given; `None` without the option.
    fn target(&self) -> Option<String> {
        let text = self.target.as_ref()?;
        let parts = text.split_once('=');
        let limit = |name: &str| name.trim().parse::<LimitName>().ok();
        Some(match parts.and_then(|(name, value)| Some((name, value, limit(name)?))) {
            Some((name, value, limit)) => {
                let of = Quantity::of(limit.quantity().unit());
                format!("{name}={}", with_typed_unit(value, of))
            }
            None => text.clone(),
        })
    }
}
