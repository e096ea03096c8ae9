//! `rubscope new`: a scene file from what an engineer has. What no option gives is asked for
//! on a terminal.

use std::io::{BufRead, IsTerminal, Write, stderr, stdin};
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;

use super::Done;
use super::status::{Refusal, Status};
use crate::file;
use crate::report::survey as report;
use rubscope_solver::numeric::rounding::rounded;
use rubscope_solver::scene::{Family, ModalData, Quantity, Scene, SceneError, read_modes};
use rubscope_solver::study::margins::{LimitName, Margins};
use rubscope_solver::study::survey::{Survey, speed_range};

/// Largest table of modes \[bytes\].
const LARGEST_TABLE: u64 = 1 << 20;
/// Pulse of the new scene over the smallest pulse that makes contact.
const PULSE: f64 = 2.0;
/// Digits of that pulse.
const DIGITS: usize = 2;

/// Write a scene file of a machine of one's own, and survey it.
///
/// From the number of blades, radius and clearance, and frequencies and modal masses of a
/// modal analysis. What is not given is asked for on a terminal. Modal masses are of mode
/// shapes with the amplitude 1 at the rim of the casing, and at the tips of the blades.
#[derive(Args, Debug)]
pub struct NewCommand {
    /// The file to write, FILE.toml; one that exists is left alone
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Modes as CSV: structure (casing or disk), nodal_diameters, frequency_hz, modal_mass_kg
    /// and, if known, damping_ratio, named in the first line
    #[arg(long, value_name = "FILE")]
    modes: Option<PathBuf>,
    /// Number of blades
    #[arg(long, value_name = "COUNT")]
    blades: Option<String>,
    /// Inner radius of the casing, such as 0.5 or 500mm
    #[arg(long, value_name = "LENGTH")]
    radius: Option<String>,
    /// Clearance of the blade tips, such as 0.3mm
    #[arg(long, value_name = "LENGTH")]
    clearance: Option<String>,
    /// The speed that the scene begins with, such as 9500rpm; the middle of the range if not
    /// given
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true)]
    speed: Option<String>,
    /// Nodal diameters that the scene begins with
    #[arg(long, value_name = "COUNT")]
    nd: Option<String>,
    /// A mode of the casing: nodal diameters, frequency, modal mass, such as 3:139.8Hz:2kg;
    /// repeatable
    #[arg(long, value_name = "DIAMETERS:FREQUENCY:MASS")]
    casing: Vec<String>,
    /// A mode of the bladed disk, in the same way; two of them give the stiffness between
    /// blades; repeatable
    #[arg(long, value_name = "DIAMETERS:FREQUENCY:MASS")]
    disk: Vec<String>,
    /// Damping ratio of the casing
    #[arg(long, value_name = "RATIO")]
    casing_damping: Option<String>,
    /// Damping ratio of the bladed disk
    #[arg(long, value_name = "RATIO")]
    disk_damping: Option<String>,
    /// The speeds of the machine, such as 6000rpm:11000rpm
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true)]
    range: Option<String>,
    /// Show speeds in rpm
    #[arg(long)]
    rpm: bool,
}

impl NewCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let shown = self.file.display();
        let is_toml = self.file.extension().is_some_and(|end| end.eq_ignore_ascii_case("toml"));
        if !is_toml {
            return Err(Refusal::of("FILE", shown, "a name that ends in .toml").into());
        }
        if self.file.symlink_metadata().is_ok() {
            let allowed = "a name that is not taken: this file exists";
            return Err(Refusal::of("FILE", shown, allowed).into());
        }
        let mut data = self.data(&Asking::new())?;
        let scene = Scene::from_toml(&data.to_toml()?)?.checked()?;
        let touching = Margins::of(&scene).limit(LimitName::TouchingPulse).and_then(|l| l.value);
        data.pulse_n = touching.map_or(data.pulse_n, |pulse| rounded(PULSE * pulse, DIGITS));
        let text = data.to_toml()?;
        file::create(&self.file, |out| out.write_all(text.as_bytes()))
            .with_context(|| format!("cannot write {shown}"))?;
        writeln!(out, "Wrote {shown}.")?;
        writeln!(out)?;
        crate::report::number::tell_in_rpm(self.rpm);
        let scene = Scene::from_toml(&text)?.checked()?;
        report::write(&Survey::of(&scene, Some(data.range_rad_s), None), out)?;
        Ok(Status::Done)
    }

    /// Returns everything that was given, and what is asked for.
    fn data(&self, asking: &Asking) -> anyhow::Result<ModalData> {
        let [mut casing, mut disk] = match &self.modes {
            Some(path) => table(path)?,
            None => [Vec::new(), Vec::new()],
        };
        for (option, texts, modes) in
            [("--casing", &self.casing, &mut casing), ("--disk", &self.disk, &mut disk)]
        {
            for text in texts {
                modes.push(family(option, text)?);
            }
            modes.sort_by_key(|mode| mode.nodal_diameters);
            let twice = modes.windows(2).find_map(|pair| match pair {
                [a, b] if a.nodal_diameters == b.nodal_diameters => Some(a),
                _ => None,
            });
            if let Some(mode) = twice {
                let given = format!("{} nodal diameters twice", mode.nodal_diameters);
                let allowed = "one mode for each number of diameters";
                return Err(Refusal::of(option, given, allowed).into());
            }
        }
        let first = casing.first().map(|mode| mode.nodal_diameters.to_string());
        let blades = asking.value("--blades", self.blades.as_ref(), "Number of blades", None)?;
        let blades = whole("--blades", &blades)?;
        let length = |asking: &Asking, option: &'static str, given, what| {
            asking
                .value(option, given, what, None)
                .and_then(|text| number(option, &text, Quantity::Length))
        };
        let radius = "Inner radius of the casing [m, or such as 500mm]";
        let radius_m = length(asking, "--radius", self.radius.as_ref(), radius)?;
        let clearance = "Clearance of the blade tips [m, or such as 0.3mm]";
        let clearance_m = length(asking, "--clearance", self.clearance.as_ref(), clearance)?;
        if radius_m <= 0.0 {
            return Err(Refusal::of("--radius", radius_m, "a length above 0").into());
        }
        if !(clearance_m > 0.0 && clearance_m < radius_m) {
            let allowed = format!("a length above 0 and below the radius, {radius_m} m");
            return Err(Refusal::of("--clearance", format!("{clearance_m} m"), allowed).into());
        }
        let nd = asking.value("--nd", self.nd.as_ref(), "Nodal diameters", first.as_deref())?;
        let nodal_diameters = whole("--nd", &nd)?;
        for (option, name, modes) in
            [("--casing", "casing", &mut casing), ("--disk", "bladed disk", &mut disk)]
        {
            if modes.is_empty() {
                let what = format!("Frequency of the {name} with {nd} nodal diameters [Hz]");
                let frequency = asking.value(option, None, &what, None)?;
                let what = format!("Modal mass of that mode of the {name} [kg]");
                let mass = asking.value(option, None, &what, None)?;
                modes.push(family(option, &format!("{nd}:{frequency}:{mass}"))?);
            }
        }
        let ratio = |option, given, what| {
            asking
                .value(option, given, what, Some(USUAL_DAMPING))
                .and_then(|text| number(option, &text, Quantity::Plain))
        };
        let damping_ratios = [
            ratio("--casing-damping", self.casing_damping.as_ref(), "Damping ratio of the casing")?,
            ratio(
                "--disk-damping",
                self.disk_damping.as_ref(),
                "Damping ratio of the bladed disk",
            )?,
        ];
        let range = "Speeds of the machine, FROM:TO, such as 6000rpm:11000rpm";
        let range = asking.value("--range", self.range.as_ref(), range, None)?;
        let refused = |error: rubscope_solver::study::survey::SurveyError| {
            Refusal::because(format!("--{error}"))
        };
        let range_rad_s = speed_range(&range).map_err(refused)?;
        let speed = |text: &String| number("--speed", text, Quantity::Speed);
        let speed_rad_s = self.speed.as_ref().map(speed).transpose()?;
        let title = self.file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        Ok(ModalData {
            title: title.unwrap_or_default(),
            blades,
            radius_m,
            clearance_m,
            nodal_diameters,
            casing,
            disk,
            damping_ratios,
            range_rad_s,
            speed_rad_s: speed_rad_s.unwrap_or(0.5 * (range_rad_s[0] + range_rad_s[1])),
            pulse_n: 1.0,
        })
    }
}

/// Damping ratio where none is given.
const USUAL_DAMPING: &str = "0.01";

/// Returns the modes of a table.
fn table(path: &Path) -> anyhow::Result<[Vec<Family>; 2]> {
    let shown = path.display();
    let text = file::read_text(path, LARGEST_TABLE)
        .map_err(|error| Refusal::because(format!("cannot read {shown}: {error}")))?;
    Ok(read_modes(&text).map_err(|error| Refusal::because(format!("{shown}: {error}")))?)
}

/// Returns a mode from `DIAMETERS:FREQUENCY:MASS`.
fn family(option: &str, text: &str) -> Result<Family, SceneError> {
    let parts: Vec<&str> = text.split(':').collect();
    let [diameters, frequency, mass] = parts.as_slice() else {
        let allowed = "DIAMETERS:FREQUENCY:MASS, such as 3:139.8Hz:2kg";
        return Err(SceneError::refused(option, text, allowed));
    };
    Family::read([diameters, frequency, mass], None, &|name| format!("{option} {text}: {name}"))
}

fn whole(option: &str, text: &str) -> Result<u32, Refusal> {
    text.trim().parse().map_err(|_| Refusal::of(option, text, "a whole number"))
}

fn number(option: &str, text: &str, of: Quantity) -> anyhow::Result<f64> {
    let refused = |why| Refusal::because(format!("{option} = {text}: {why}"));
    let read = of.read(text).map_err(refused)?;
    match read.is_finite() {
        true => Ok(read),
        false => Err(Refusal::of(option, text, "a finite number").into()),
    }
}

/// Who answers questions: a user at a terminal, or nobody.
struct Asking {
    answers: bool,
}

impl Asking {
    fn new() -> Self {
        Self { answers: stdin().is_terminal() }
    }

    /// Returns what was given, or the answer to a question; an empty answer is the usual one.
    fn value(
        &self,
        option: &'static str,
        given: Option<&String>,
        what: &str,
        usual: Option<&str>,
    ) -> anyhow::Result<String> {
        if let Some(given) = given {
            return Ok(given.clone());
        }
        if !self.answers {
            return match usual {
                Some(usual) => Ok(usual.to_string()),
                None => {
                    let what = format!("new: {option} is missing ({what}); nobody is there to ask");
                    Err(Refusal::because(what).into())
                }
            };
        }
        let hint = usual.map_or(String::new(), |usual| format!(" (Enter: {usual})"));
        loop {
            write!(stderr(), "{what}{hint}: ")?;
            stderr().flush()?;
            let mut line = String::new();
            if stdin().lock().read_line(&mut line)? == 0 {
                return Err(Refusal::because(format!("new: {option} is missing ({what})")).into());
            }
            match (line.trim(), usual) {
                ("", None) => {}
                ("", Some(usual)) => return Ok(usual.to_string()),
                (answer, _) => return Ok(answer.to_string()),
            }
        }
    }
}
