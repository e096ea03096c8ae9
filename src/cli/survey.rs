//! `rubscope survey`: which nodal diameters can lock at the speeds of a machine.

use std::io::Write;

use clap::Args;

use super::options::{SceneOptions, ask_unit};
use super::output::OutputOptions;
use super::status::{self, Done};
use crate::sheet::number::with_typed_unit;
use crate::sheet::{CommandLine, survey as report};
use rubscope_solver::scene::{Quantity, keys, speed_range};
use rubscope_solver::study::margins::parameter;
use rubscope_solver::study::survey::Survey;

/// Find which nodal diameters can lock in a range of speeds, and their limits.
///
/// Prints frequencies of casing and disk, critical and lock speeds, coincidences, whirl and
/// flutter, computed with the modes that the scene has for each nodal diameter.
#[derive(Args, Debug)]
pub struct SurveyCommand {
    #[command(flatten)]
    options: SceneOptions,
    /// The speeds of the machine, such as 6000rpm:11000rpm
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true)]
    range: Option<String>,
    /// Also show how a 1 % change of this parameter moves each limit, such as casing.modal_mass_kg
    #[arg(long, value_name = "PATH")]
    by: Option<String>,
    /// Also show nodal diameters without modes of their own
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    output: OutputOptions,
}

impl SurveyCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        self.output.ending()?;
        let scene = self.options.scene()?;
        self.options.note_assumed(&scene);
        // They are empty, or checked.
        let own = speed_range(keys::VIEW_SPEEDS, &scene.view.speeds).ok();
        let range = self.range().map(|text| speed_range("--range", &text)).transpose()?.or(own);
        if let (Some(text), Some(range)) = (&self.range, range)
            && !self.options.in_rpm()
        {
            ask_unit("--range", text, range, &scene);
        }
        let by = match &self.by {
            Some(path) => Some(parameter(path.trim())?),
            None => None,
        };
        status::say_noted();
        let survey = Survey::of(&scene, range, by)?;
        let command = CommandLine::new("survey", &scene)
            .optional("--range", self.range())
            .optional("--by", self.by.as_ref())
            .flag("--all", self.all);
        self.output.deliver(&report::sheet(&survey, self.all, command), out)
    }

    /// Returns the text of `--range`, with `rpm` appended to speeds without a unit if `--rpm` is
    /// given; `None` without the option.
    fn range(&self) -> Option<String> {
        self.range.as_ref().map(|text| with_typed_unit(text, Quantity::Speed))
    }
}
