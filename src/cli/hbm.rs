//! `rubscope hbm`: steady states against speed, in the frequency domain.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;

use super::Done;
use super::options::{SceneOptions, Swept};
use super::range::linspace;
use super::status::{Refusal, Status, say};
use crate::harmonic::{
    Branches, Campbell, Corner, Form, HarmonicError, NoSlip, SlipSpectrum, Sweep, corner_branch,
    drives, excited_lock, locked_motion, slip_limits, slip_over, slip_spectrum,
};
use crate::model::Machine;
use crate::report::hbm::{self as report, HbmReport};
use crate::report::number::short;
use crate::report::table::Table;
use crate::report::{file, json};
use crate::scene::Scene;

/// Speeds of a sweep when none are asked for.
const SPEEDS: usize = 51;
/// Arc length between points of a branch followed through its fold.
const ARC: f64 = 0.05;
/// Engine-order lines drawn beside those of the scene.
const ORDERS: [u32; 4] = [1, 2, 3, 4];

/// Locked motion against speed, by harmonic balance.
///
/// `--speed FROM:TO:COUNT` sweeps the speed; a single speed gives one point,
/// none the range from standstill to the speed of the scene. Without one of
/// the views below, the locked motion itself is shown.
#[derive(Args, Debug)]
pub struct Hbm {
    #[command(flatten)]
    options: SceneOptions,
    /// Blade equations: printed (Eq. 27), blade (Eq. 19) or modal (the time model's, exact)
    #[arg(long, value_name = "FORM", default_value = "modal")]
    form: String,
    /// Keep the damping of casing and blades, which the paper's equations drop
    #[arg(long)]
    damped: bool,
    /// The two blades that hold the wave, phase neighbours [default: 6,21 where they are]
    #[arg(long, value_name = "I,J", allow_hyphen_values = true)]
    blades: Option<String>,
    /// View: every equilibrium, its stability, and the thresholds of each branch
    #[arg(long, group = "view")]
    branches: bool,
    /// View: the corner branch followed through its fold (very soft blades)
    #[arg(long, group = "view")]
    fold: bool,
    /// View: lasting slip, the fixed point of the map from corner to corner
    #[arg(long, group = "view")]
    slip: bool,
    /// View: Fourier series of slip and what is left out with up to COUNT harmonics
    #[arg(long, group = "view", value_name = "COUNT", num_args = 0..=1, default_missing_value = "16")]
    harmonics: Option<u32>,
    /// View: frequencies against speed, engine orders, and the coincidences (30)
    #[arg(long, group = "view")]
    campbell: bool,
    /// View: response of the damped lock to the scene's engine-order excitation
    #[arg(long, group = "view")]
    excitation: bool,
    /// Print everything as JSON (rubscope.hbm/1)
    #[arg(long)]
    json: bool,
    /// Write the table with every figure to FILE (.csv)
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// What a view has to say: JSON, tables with their titles, the table for files.
struct Answer {
    json: HbmReport,
    tables: Vec<(String, Table)>,
    file: Table,
    /// The locked motion, where it is the subject.
    sweep: Option<Sweep>,
}

impl Hbm {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let resolved = self.options.resolve(Swept { speed: true, pulse: false })?;
        let speeds = match resolved.speeds {
            Some(range) => range.values(),
            None if self.options.names_a_speed() || self.harmonics.is_some() => {
                vec![resolved.scene.operation.speed_rad_s]
            }
            None => linspace(0.0, resolved.scene.operation.speed_rad_s, SPEEDS),
        };
        let answer = self.answer(&resolved.scene, &speeds)?;
        if let Some(path) = &self.out {
            save(path, &answer.file)?;
        }
        if self.json {
            json::write(&answer.json, out)?;
        } else {
            let machine = resolved.scene.machine();
            report::write_heading(&machine, &resolved.scene.title, answer.sweep.as_ref(), out)?;
            for (title, table) in &answer.tables {
                writeln!(out)?;
                if !title.is_empty() {
                    writeln!(out, "{title}")?;
                }
                table.write_text(out)?;
            }
        }
        answer.sweep.iter().for_each(warn_missing);
        Ok(Status::Done)
    }

    fn answer(&self, scene: &Scene, speeds: &[f64]) -> Result<Answer, Refusal> {
        let machine = scene.machine();
        let (form, pair) = (self.form()?, self.pair()?);
        let corner = match pair {
            Some(pair) => Corner::of_blades(&machine.rim, pair),
            None => Corner::paper(&machine.rim),
        };
        let json = HbmReport::new(&machine, form, self.damped);
        if self.campbell || self.branches {
            // These have a meaning without corners too.
            let json = match locked_motion(&machine, form, self.damped, pair, speeds) {
                Ok(sweep) => json.with_sweep(&machine.rim, &sweep),
                Err(HarmonicError::NoCorner { .. }) => json,
                Err(error) => return Err(refused(error)),
            };
            let answer = if self.campbell {
                Self::campbell(json, scene, &machine, speeds)
            } else {
                self.all_branches(json, &machine, speeds)
            };
            return answer.map_err(refused);
        }
        let side = corner.map_err(refused)?.a;
        let sweep = locked_motion(&machine, form, self.damped, pair, speeds).map_err(refused)?;
        let json = json.with_sweep(&machine.rim, &sweep);
        let answer = if self.slip {
            Self::slipping(json, &machine, speeds)
        } else if let Some(most) = self.harmonics {
            Self::series(json, &machine, speeds, most)
        } else if self.fold {
            self.folding(json, &machine, side, speeds)
        } else if self.excitation {
            Self::excited(json, scene, &machine, side, speeds)
        } else {
            Ok(Answer {
                json,
                tables: vec![(String::new(), report::summary_table(&sweep))],
                file: report::locked_table(&sweep),
                sweep: Some(sweep),
            })
        };
        answer.map_err(refused)
    }

    fn all_branches(
        &self,
        json: HbmReport,
        machine: &Machine,
        speeds: &[f64],
    ) -> Result<Answer, HarmonicError> {
        let branches = Branches::over(machine, speeds, self.damped)?;
        let states = report::branch_table(&branches);
        let damping = if self.damped { "with damping" } else { "without damping (see --damped)" };
        Ok(Answer {
            json: json.with_branches(machine, &branches),
            tables: vec![
                (
                    format!("Where branches change between these speeds, {damping}:"),
                    report::threshold_table(&branches),
                ),
                ("Equilibria of the blade frame:".to_string(), states.clone()),
            ],
            file: states,
            sweep: None,
        })
    }

    fn campbell(
        json: HbmReport,
        scene: &Scene,
        machine: &Machine,
        speeds: &[f64],
    ) -> Result<Answer, HarmonicError> {
        let mut orders = ORDERS.to_vec();
        if scene.excitation.amplitude_nm > 0.0 && !orders.contains(&scene.excitation.order) {
            orders.push(scene.excitation.order);
        }
        let campbell = Campbell::of(machine, &orders)?;
        let lines = report::campbell_table(&campbell, speeds);
        Ok(Answer {
            json: json.with_campbell(&campbell, speeds),
            tables: vec![
                (
                    "Coincidences +-omega_c = n_d Omega +- omega_bd, Eq. (30):".to_string(),
                    report::coincidence_table(&campbell),
                ),
                ("Frequencies in the standing frame [rad/s]:".to_string(), lines.clone()),
            ],
            file: lines,
            sweep: None,
        })
    }

    fn slipping(
        json: HbmReport,
        machine: &Machine,
        speeds: &[f64],
    ) -> Result<Answer, HarmonicError> {
        let points = slip_over(machine, speeds)?;
        let limits = slip_limits(machine, speeds)?;
        let told: Vec<String> = limits
            .iter()
            .map(|&(speed, appears)| {
                format!(
                    "{} at {} rad/s",
                    if appears { "appears" } else { "vanishes" },
                    short(speed)
                )
            })
            .collect();
        let title = if told.is_empty() {
            "Slip neither appears nor vanishes between these speeds.".to_string()
        } else {
            format!("Slip {}.", told.join(", "))
        };
        let table = report::slip_table(&points);
        Ok(Answer {
            json: json.with_slip(&points, &limits),
            tables: vec![(title, table.clone())],
            file: table,
            sweep: None,
        })
    }

    fn series(
        json: HbmReport,
        machine: &Machine,
        speeds: &[f64],
        most: u32,
    ) -> Result<Answer, HarmonicError> {
        let mut series: Vec<(f64, Result<SlipSpectrum, NoSlip>)> = Vec::new();
        for &speed in speeds {
            series.push((speed, slip_spectrum(machine, speed, most)?));
        }
        let mut tables = Vec::new();
        for (speed, found) in &series {
            let speed = short(*speed);
            match found {
                Ok(found) => {
                    let title = format!(
                        "A lock needs one harmonic, exactly. Slip at {speed} rad/s, truncated at -H to H:"
                    );
                    tables.push((title, report::truncation_table(found)));
                    let title = "Its harmonics in the standing frame:".to_string();
                    tables.push((title, report::term_table(found)));
                }
                Err(reason) => {
                    let title = format!("No slip at {speed} rad/s ({}).", reason.word());
                    tables.push((title, Table::new(&[])));
                }
            }
        }
        let file = series.iter().find_map(|(_, found)| found.as_ref().ok());
        Ok(Answer {
            file: file.map_or_else(|| Table::new(&["number"]), report::term_table),
            json: json.with_harmonics(&series),
            tables,
            sweep: None,
        })
    }

    fn folding(
        &self,
        json: HbmReport,
        machine: &Machine,
        side: u32,
        speeds: &[f64],
    ) -> Result<Answer, HarmonicError> {
        let from = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        let to = speeds.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let branch = corner_branch(machine, side, self.damped, [from, to], ARC)?;
        let title = match branch.fold {
            Some(fold) => format!(
                "The corner branch folds back at {} rad/s, opened to {} rad from {} rad.",
                short(fold.speed),
                short(fold.opening),
                short(machine.rim.delta)
            ),
            None => "The corner branch does not fold: the blades are as good as rigid.".to_string(),
        };
        let table = report::corner_table(&branch);
        Ok(Answer {
            json: json.with_fold(&branch),
            tables: vec![(title, table.clone())],
            file: table,
            sweep: None,
        })
    }

    fn excited(
        json: HbmReport,
        scene: &Scene,
        machine: &Machine,
        side: u32,
        speeds: &[f64],
    ) -> Result<Answer, HarmonicError> {
        let excitation = &scene.excitation;
        if excitation.amplitude_nm <= 0.0 {
            let allowed = "above 0 with --excitation, such as --set excitation.amplitude_nm=10";
            return Err(HarmonicError::Refused {
                key: "excitation.amplitude_nm",
                value: excitation.amplitude_nm.to_string(),
                allowed: allowed.to_string(),
            });
        }
        let reaches = drives(machine, excitation.order);
        let found = excited_lock(machine, side, excitation, speeds)?;
        let title = format!(
            "Engine order {} with {} N m on each blade{}",
            excitation.order,
            short(excitation.amplitude_nm),
            if reaches {
                ": amplitudes about the damped lock."
            } else {
                " does not drive the modes of these diameters: E is not +-n_d modulo N."
            }
        );
        let table = report::excitation_table(&found);
        Ok(Answer {
            json: json.with_excitation(report::ExcitationReport::of(excitation, reaches, &found)),
            tables: vec![(title, table.clone())],
            file: table,
            sweep: None,
        })
    }

    fn form(&self) -> Result<Form, Refusal> {
        Form::from_word(&self.form).ok_or_else(|| {
            Refusal::of(
                "--form",
                &self.form,
                format!("one of {}", Form::ALL.map(Form::word).join(", ")),
            )
        })
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

/// What has no meaning is refused input, not a failure.
fn refused(error: HarmonicError) -> Refusal {
    let message = error.to_string();
    // The option as typed, where the library names the argument.
    Refusal::because(match error {
        HarmonicError::Blades { .. } => format!("--{message}"),
        _ => message,
    })
}

fn save(path: &Path, table: &Table) -> anyhow::Result<()> {
    let shown = path.display();
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
        return Err(Refusal::of("--out", &shown, "a file name ending in .csv").into());
    }
    file::replace(path, |out| table.write_csv(out))
        .with_context(|| format!("cannot write {shown}"))?;
    say(&format!("rubscope: wrote {} rows to {shown}", table.len()));
    Ok(())
}

fn warn_missing(sweep: &Sweep) {
    if let Some(first) = sweep.missing.first() {
        say(&format!(
            "rubscope: no locked motion at {} of {} speeds, the first of them {first} rad/s: the blades are so soft that the branch folds back",
            sweep.missing.len(),
            sweep.missing.len() + sweep.points.len()
        ));
    }
}
