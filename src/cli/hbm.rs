//! `rubscope hbm`: steady states against speed, in the frequency domain.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;

use super::Done;
use super::options::{SceneOptions, Swept};
use super::range::linspace;
use super::status::{Refusal, Status, say};
use crate::harmonic::{Form, HarmonicError, Sweep, locked_motion};
use crate::model::Machine;
use crate::report::hbm::{HbmReport, locked_table, summary_table, write_heading};
use crate::report::table::Table;
use crate::report::{file, json};

/// Speeds of a sweep when none are asked for.
const SPEEDS: usize = 51;

/// Locked motion against speed, by harmonic balance.
///
/// `--speed FROM:TO:COUNT` sweeps the speed; a single speed gives one point,
/// none the range from standstill to the speed of the scene.
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
    /// Print everything as JSON (rubscope.hbm/1)
    #[arg(long)]
    json: bool,
    /// Write the table with every figure to FILE (.csv)
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Hbm {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let resolved = self.options.resolve(Swept { speed: true, pulse: false })?;
        let form = self.form()?;
        let pair = self.pair()?;
        let speeds = match resolved.speeds {
            Some(range) => range.values(),
            None if self.options.names_a_speed() => vec![resolved.scene.operation.speed_rad_s],
            None => linspace(0.0, resolved.scene.operation.speed_rad_s, SPEEDS),
        };
        let machine = resolved.scene.machine();
        let sweep = locked_motion(&machine, form, self.damped, pair, &speeds).map_err(refused)?;
        if let Some(path) = &self.out {
            save(path, &locked_table(&sweep))?;
        }
        if self.json {
            let report = HbmReport::new(&machine, form, self.damped);
            json::write(&report.with_sweep(&machine.rim, &sweep), out)?;
        } else {
            self.print(&machine, &resolved.scene.title, &sweep, out)?;
        }
        warn_missing(&sweep);
        Ok(Status::Done)
    }

    fn print(
        &self,
        machine: &Machine,
        title: &str,
        sweep: &Sweep,
        out: &mut dyn Write,
    ) -> anyhow::Result<()> {
        write_heading(machine, title, Some(sweep), out)?;
        if self.out.is_none() {
            writeln!(out)?;
            summary_table(sweep).write_text(out)?;
        }
        Ok(())
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
