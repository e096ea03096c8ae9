//! `rubscope hbm`: steady states against speed, in the frequency domain.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use strum::VariantNames;

use super::hbm_lining::LiningOptions;
use super::hbm_views::{self as views, Asked, HbmView};
use super::options::{SceneOptions, Swept};
use super::range::{Range, linspace};
use super::status::{self, Refusal, Status, say};
use super::words::Words;
use super::{Done, output};
use crate::report::number::speed;
use crate::report::{CommandLine, hbm as report, json};
use rubscope_solver::harmonic::{Form, Sweep};
use rubscope_solver::scene::{Quantity, Scene};

/// Default number of speeds of a sweep.
const SPEEDS: usize = 51;
/// What `--speed` takes here.
const SWEPT_SPEED: &str =
    "Rotor speed, or speeds as FROM:TO:COUNT; negative turns the other way [rad/s]";

/// The options of views that have the damping of the scene in any case.
const ALWAYS_DAMPED: [&str; 6] =
    ["slip", "excitation", "whirl", "compliance", "smooth", "coincidence"];

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
    #[arg(long, conflicts_with_all = ALWAYS_DAMPED)]
    undamped: bool,
    /// Keep the damping, as without this option; with --form printed too
    #[arg(long, hide = true, conflicts_with = "undamped")]
    damped: bool,
    /// The two blades that hold the wave, phase neighbours [default: 6,21 where they are]
    #[arg(long, value_name = "I,J", allow_hyphen_values = true)]
    blades: Option<String>,
    /// View: every equilibrium, its stability, and the thresholds of each branch
    #[arg(long, group = "view")]
    branches: bool,
    /// View: lasting slip, the fixed point of the map from corner to corner
    #[arg(long, group = "view")]
    slip: bool,
    /// With --slip: also the speeds where slip exists over damping ratios of
    /// the casing
    #[arg(long, value_name = "FROM:TO:COUNT", requires = "slip", allow_hyphen_values = true)]
    zetas: Option<String>,
    /// View: frequencies against speed, engine orders, and the coincidences (30)
    #[arg(long, group = "view")]
    campbell: bool,
    /// View: response of the damped lock to the scene's engine-order excitation
    #[arg(long, group = "view")]
    excitation: bool,
    #[command(flatten)]
    lining: LiningOptions,
    /// View: whirl of inclined tips in the limit of many blades, where it begins, and where a
    /// lock flutters
    #[arg(long, group = "view")]
    whirl: bool,
    /// View: the joint compliance B(omega) in the complex plane; a whirl is where it
    /// crosses the negative real axis
    #[arg(long, group = "view")]
    compliance: bool,
    /// With --compliance: casing frequencies of the table [default: beyond every
    /// resonance]
    #[arg(long, value_name = "FROM:TO:COUNT", requires = "compliance", allow_hyphen_values = true)]
    omegas: Option<String>,
    /// Print everything as JSON (rubscope.hbm/1)
    #[arg(long)]
    json: bool,
    /// Write the table with every number to FILE (.csv)
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl HbmCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        if let Some(path) = &self.out {
            output::format(path, &["csv"])?;
        }
        let resolved = self.options.resolve(Swept { speed: true, pulse: false })?;
        let speeds = match resolved.speeds {
            Some(range) => range.values(),
            None if self.compliance => {
                vec![resolved.scene.operation.speed_rad_s]
            }
            None => linspace(0.0, resolved.scene.operation.speed_rad_s, SPEEDS),
        };
        let (form, pair) = (self.form()?, self.pair()?);
        // The paper's own equations have no damping.
        let damped = self.damped || !(self.undamped || form == Form::Printed);
        let asked = Asked { scene: &resolved.scene, speeds: &speeds, form, damped, pair };
        let view = self.view()?;
        let answer = views::answer(&asked, &view)?;
        status::say_noted();
        if self.json {
            json::write_as("rubscope.hbm/1", &self.command(&resolved.scene), &answer.json, out)?;
        }
        if let Some(path) = &self.out {
            let rows = format!("{} rows", answer.file.len());
            output::save(path, &rows, out, |out| answer.file.write_csv(out))?;
        }
        if !self.json {
            let machine = asked.machine(&view);
            let sweep = answer.sweep.as_deref();
            let heading = report::Heading {
                scene: &resolved.scene,
                machine: &machine,
                speed: asked.fastest(),
                damped: damped || view.is_always_damped(),
                sweep,
            };
            heading.write(out)?;
            for (title, table) in &answer.tables {
                writeln!(out)?;
                if !title.is_empty() {
                    writeln!(out, "{title}")?;
                }
                table.write_text(out)?;
            }
        }
        answer.sweep.as_deref().into_iter().for_each(warn_missing);
        Ok(Status::Done)
    }

    /// The command that gives the same table again.
    fn command(&self, scene: &Scene) -> CommandLine {
        let command = CommandLine::new("hbm", scene)
            .optional("--speed", self.options.speed())
            .option("--form", &self.form)
            .flag("--undamped", self.undamped)
            .flag("--damped", self.damped && self.form == Form::Printed.to_string())
            .optional("--blades", self.blades.as_ref())
            .flag("--branches", self.branches)
            .flag("--slip", self.slip)
            .optional("--zetas", self.zetas.as_ref())
            .flag("--campbell", self.campbell)
            .flag("--excitation", self.excitation)
            .flag("--whirl", self.whirl)
            .flag("--compliance", self.compliance)
            .optional("--omegas", self.omegas.as_ref());
        self.lining.add_to(command)
    }

    fn view(&self) -> Result<HbmView, Refusal> {
        let values = |option: &str, text: &Option<String>, of: Quantity| match text {
            Some(text) => Range::parse(option, text, of).map(|range| Some(range.values())),
            None => Ok(None),
        };
        if let Some(view) = self.lining.view() {
            return Ok(HbmView::Lining(view));
        }
        let zetas = values("--zetas", &self.zetas, Quantity::Plain)?;
        let omegas = values("--omegas", &self.omegas, Quantity::Speed)?;
        Ok(match self {
            Self { branches: true, .. } => HbmView::Branches,
            Self { slip: true, .. } => HbmView::Slip(zetas.unwrap_or_default()),
            Self { campbell: true, .. } => HbmView::Campbell,
            Self { excitation: true, .. } => HbmView::Excitation,
            Self { whirl: true, .. } => HbmView::Whirl,
            Self { compliance: true, .. } => HbmView::Compliance(omegas),
            _ => HbmView::Locked,
        })
    }

    fn form(&self) -> Result<Form, Refusal> {
        let allowed = || format!("one of {}", Form::VARIANTS.join(", "));
        self.form.parse().map_err(|_| Refusal::of("--form", &self.form, allowed()))
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

fn warn_missing(sweep: &Sweep) {
    if let Some(first) = sweep.missing.first() {
        say(&format!(
            "rubscope: no locked motion at {} of {} speeds, the first of them {}: the blades are so soft that the branch folds back",
            sweep.missing.len(),
            sweep.missing.len() + sweep.points.len(),
            speed(*first)
        ));
    }
}
