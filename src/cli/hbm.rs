//! `rubscope hbm`: steady states against speed, in the frequency domain.

use std::io::Write;

use clap::{Arg, ArgAction, ArgGroup, ArgMatches, Args, Command, FromArgMatches};
use strum::VariantNames;

use super::options::SceneOptions;
use super::output::OutputOptions;
use super::status::{self, Done, Refusal};
use super::words::Words;
use crate::sheet::CommandLine;
use crate::sheet::hbm::{LOCKED, Request, VIEWS, View};
use crate::sheet::ticks::linspace;
use rubscope_solver::harmonic::Form;
use rubscope_solver::scene::{Scene, SceneError, keys};

/// Number of speeds of the default sweep, from standstill to the speed of the scene.
const SPEEDS: usize = 51;
/// Help text of `--speed`, which may be a range for this command.
const SWEPT_SPEED: &str =
    "Rotor speed, or speeds as FROM:TO:COUNT; negative turns the other way [rad/s]";

/// Locked motion against speed, by harmonic balance.
///
/// `--speed FROM:TO:COUNT` sweeps the speed; a single speed gives one point;
/// without it the range is from standstill to the speed of the scene. Without
/// one of the views below, the locked motion itself is shown.
#[derive(Args, Debug)]
#[command(mut_arg("speed", |speed| speed.help(SWEPT_SPEED)))]
pub struct HbmCommand {
    #[command(flatten)]
    options: SceneOptions,
    /// Blade equations: printed (Eq. 27, without damping), blade (Eq. 19) or modal (the time
    /// model's, exact)
    #[arg(long, value_name = "FORM", default_value = "modal",
          value_parser = Words::of::<Form>(), hide_possible_values = true)]
    form: String,
    /// Drop the damping of casing and blades, as the paper's equations do
    #[arg(long)]
    undamped: bool,
    /// Keep the damping; the default except with --form printed
    #[arg(long, hide = true, conflicts_with = "undamped")]
    damped: bool,
    /// The two blades that hold the wave, neighbours in phase [default: 6,21 if they are]
    #[arg(long, value_name = "I,J", allow_hyphen_values = true)]
    blades: Option<String>,
    #[command(flatten)]
    view: RequestedView,
    #[command(flatten)]
    output: OutputOptions,
}

/// The view chosen by its option; the locked motion without such an option.
#[derive(Clone, Debug)]
struct RequestedView(&'static View);

impl Args for RequestedView {
    fn augment_args(command: Command) -> Command {
        let command = command.group(ArgGroup::new("view").args(VIEWS.map(|view| view.option)));
        VIEWS.into_iter().fold(command, |command, view| {
            let option = Arg::new(view.option).long(view.option).help(view.help);
            let option = option.action(ArgAction::SetTrue);
            command.arg(match view.always_damped {
                true => option.conflicts_with("undamped"),
                false => option,
            })
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for RequestedView {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let view = VIEWS.into_iter().find(|view| matches.get_flag(view.option));
        Ok(Self(view.unwrap_or(&LOCKED)))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl HbmCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        self.output.ending()?;
        let RequestedView(view) = self.view;
        let resolved = self.options.resolve(&[keys::SPEED])?;
        self.options.ask_speed(&resolved.scene);
        let scene: &Scene = &resolved.scene;
        let speeds = match resolved.range(keys::SPEED) {
            Some(range) => range.values(),
            None if view.one_speed => vec![scene.operation.speed_rad_s],
            None => linspace(0.0, scene.operation.speed_rad_s, SPEEDS),
        };
        let unknown = |_| {
            let allowed = format!("one of {}", Form::VARIANTS.join(", "));
            Refusal::of("--form", &self.form, allowed)
        };
        let (form, pair) = (self.form.parse().map_err(unknown)?, self.pair()?);
        // The paper's own equations have no damping.
        let damped = self.damped || !(self.undamped || form == Form::Printed);
        let (speeds, machine) = (&speeds[..], scene.machine());
        let request = Request { scene, speeds, form, damped, pair, machine };
        let command = CommandLine::new("hbm", scene)
            .optional("--speed", self.options.speed())
            .option("--form", &self.form)
            .flag("--undamped", self.undamped)
            .flag("--damped", self.damped && form == Form::Printed)
            .optional("--blades", self.blades.as_ref())
            .flag(&format!("--{}", view.option), !view.option.is_empty());
        let sheet = request.sheet(view, command).map_err(refused)?;
        status::say_noted();
        self.output.deliver(&sheet, out)
    }

    fn pair(&self) -> Result<Option<[u32; 2]>, Refusal> {
        let Some(text) = &self.blades else { return Ok(None) };
        let mut numbers = text.split(',').map(|number| number.trim().parse::<u32>());
        match (numbers.next(), numbers.next(), numbers.next()) {
            (Some(Ok(first)), Some(Ok(second)), None) => Ok(Some([first, second])),
            _ => Err(Refusal::of("--blades", text, "I,J, the numbers of two blades")),
        }
    }
}

/// Turns an error of the harmonic solver into a refusal (exit status 2): the input was wrong.
fn refused(error: SceneError) -> Refusal {
    // The library names its argument `blades`; the user typed `--blades`.
    let dashes = if error.is_of("blades") { "--" } else { "" };
    Refusal::because(format!("{dashes}{error}"))
}
