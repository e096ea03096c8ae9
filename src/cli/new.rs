//! `rubscope new`: writes a scene file from modal data. Values that no option gives are asked for
//! on a terminal.

use std::io::{BufRead, IsTerminal, Write, stderr, stdin};
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;

use super::status::{Done, Refusal, Status, note, say, say_noted};
use crate::file;
use crate::machine::{Family, ModalData, doubts, read_modes};
use crate::sheet::CommandLine;
use crate::sheet::check::doubt_lines;
use crate::sheet::number::{rounded, tell_in_rpm, with_typed_unit};
use crate::sheet::survey as report;
use rubscope_solver::scene::speed_range;
use rubscope_solver::scene::{Quantity, Scene, SceneError, keys};
use rubscope_solver::study::margins::{LimitName, Margins};
use rubscope_solver::study::survey::Survey;

/// Largest size of a mode table \[bytes\].
const LARGEST_TABLE: u64 = 1 << 20;
/// Pulse force of the new scene, as a multiple of the smallest force that makes contact.
const PULSE: f64 = 2.0;
/// Significant digits to which the pulse force of the new scene is rounded.
const DIGITS: usize = 2;

/// Write a scene file for your own machine, and survey it.
///
/// Needs the number of blades, radius and clearance, and frequencies and modal masses from a
/// modal analysis. On a terminal, missing values are asked for. Modal masses belong to mode
/// shapes with amplitude 1 at the rim of the casing and at the blade tips.
#[derive(Args, Debug)]
pub struct NewCommand {
    /// The file to write, FILE.toml; an existing file is not replaced
    #[arg(value_name = "FILE")]
    file: String,
    /// Modes as CSV: structure (casing or disk), nodal_diameters, frequency_hz, modal_mass_kg
    /// and, if known, damping_ratio, speed_rpm and centrifugal_stiffening, named in the first
    /// line
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
    /// Rotor speed of the scene, such as 9500rpm [default: the middle of the range]
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true)]
    speed: Option<String>,
    /// Nodal diameters of the scene
    #[arg(long, value_name = "COUNT")]
    nd: Option<String>,
    /// A mode of the casing: nodal diameters, frequency, modal mass, such as 3:139.8Hz:2kg;
    /// repeatable
    #[arg(long, value_name = "DIAMETERS:FREQUENCY:MASS")]
    casing: Vec<String>,
    /// A mode of the bladed disk, in the same form; two modes determine the stiffness between
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
    /// Speeds in rpm, shown and given without a unit
    #[arg(long)]
    rpm: bool,
}

impl NewCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let (shown, path) = (&self.file, Path::new(&self.file));
        if file::ending(path, &["toml"]).is_none() {
            return Err(Refusal::of("FILE", shown, "a name that ends in .toml").into());
        }
        if !shown.chars().all(keys::is_plain) {
            return Err(Refusal::of("FILE", shown, "a name of visible characters").into());
        }
        if path.symlink_metadata().is_ok() {
            let allowed = "a name that is not taken: this file exists";
            return Err(Refusal::of("FILE", shown, allowed).into());
        }
        tell_in_rpm(self.rpm);
        let mut data = self.data()?;
        let scene = Scene::from_toml(&data.to_toml()?)?.checked()?;
        let margins = Margins::of(&scene);
        let touching = margins.limit(LimitName::TouchingPulse).and_then(|limit| limit.value);
        data.pulse_n = touching.map_or(data.pulse_n, |pulse| rounded(PULSE * pulse, DIGITS));
        let text = data.to_toml()?;
        let scene = Scene::from_toml(&text)?.checked()?;
        say_noted();
        let doubts = doubts(&Margins::of(&scene));
        doubt_lines(&doubts).iter().try_for_each(|line| writeln!(stderr(), "{line}"))?;
        if !doubts.is_empty() && stdin().is_terminal() {
            let what = format!("Write {shown} all the same? yes or no");
            asked("FILE", None, &what, None, &|answer| match answer {
                "yes" | "y" => Ok(()),
                "no" | "n" => Err(Stop.into()),
                _ => Err(Refusal::of("answer", answer, "yes or no").into()),
            })?;
        }
        file::create(path, |out| out.write_all(text.as_bytes()))
            .with_context(|| format!("cannot write {shown}"))?;
        writeln!(out, "Wrote {shown}.")?;
        writeln!(out)?;
        let survey = Survey::of(&scene, Some(data.range_rad_s), None)?;
        let command = CommandLine::new("survey", &scene);
        report::sheet(&survey, false, command).write_text(out)?;
        Ok(Status::Done)
    }

    /// Collects the data from the mode table, the options and, on a terminal, the user's answers.
    fn data(&self) -> anyhow::Result<ModalData> {
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
        }
        let first = casing.first().map(|mode| mode.nodal_diameters.to_string());
        let ask = |option, given: &Option<String>, what, usual, key| {
            asked(option, given.as_deref(), what, usual, &|text| number(option, text, key))
        };
        let blades = ask("--blades", &self.blades, "Number of blades", None, keys::BLADES)? as u32;
        let what = "Inner radius of the casing [m, or such as 500mm]";
        let radius_m = ask("--radius", &self.radius, what, None, keys::CASING_RADIUS)?;
        let what = "Clearance of the blade tips [m, or such as 0.3mm]";
        let read = |text: &str| {
            let clearance = number("--clearance", text, keys::CASING_RADIUS)?;
            let allowed = format!("a length above 0 and below the radius, {radius_m} m");
            let refused = || Refusal::of("--clearance", format!("{clearance} m"), allowed);
            (clearance < radius_m).then_some(clearance).ok_or_else(|| refused().into())
        };
        let clearance_m = asked("--clearance", self.clearance.as_deref(), what, None, &read)?;
        let (what, usual) = ("Nodal diameters", first.as_deref());
        let nd = ask("--nd", &self.nd, what, usual, keys::DIAMETERS)? as u32;
        for (option, name, modes) in
            [("--casing", "casing", &mut casing), ("--disk", "bladed disk", &mut disk)]
        {
            if modes.is_empty() {
                let what = format!("Frequency of the {name} with {nd} nodal diameters [Hz]");
                let read = |text: &str| Ok(family(option, &format!("{nd}:{text}:1"))?.frequency_hz);
                let frequency = asked(option, None, &what, None, &read)?;
                let what = format!("Modal mass of that mode of the {name} [kg]");
                let read = |text: &str| Ok(family(option, &format!("{nd}:{frequency}:{text}"))?);
                modes.push(asked(option, None, &what, None, &read)?);
            }
        }
        let ratio = |option, given: &Option<String>, what, key, modes: &[Family]| {
            let assumed = modes.iter().any(|mode| mode.damping_ratio.is_none());
            if given.is_none() && assumed && !stdin().is_terminal() {
                note(format!("rubscope: {what}: {USUAL_DAMPING} is assumed ({option})"));
            }
            ask(option, given, what, Some(USUAL_DAMPING), key)
        };
        let (what, given) = ("Damping ratio of the casing", &self.casing_damping);
        let of_casing = ratio("--casing-damping", given, what, keys::CASING_DAMPING, &casing)?;
        let (what, given) = ("Damping ratio of the bladed disk", &self.disk_damping);
        let of_disk = ratio("--disk-damping", given, what, keys::BLADE_DAMPING, &disk)?;
        let what = "Speeds of the machine, FROM:TO, such as 6000rpm:11000rpm";
        let read = |text: &str| {
            let speeds = with_typed_unit(text, Quantity::Speed);
            Ok((speed_range("--range", &speeds)?, speeds))
        };
        let (range_rad_s, speeds) = asked("--range", self.range.as_deref(), what, None, &read)?;
        let speed = |text: &String| number("--speed", text, keys::SPEED);
        let speed_rad_s = self.speed.as_ref().map(speed).transpose()?;
        let title =
            Path::new(&self.file).file_stem().map(|stem| stem.to_string_lossy().into_owned());
        Ok(ModalData {
            title: title.unwrap_or_default(),
            blades,
            radius_m,
            clearance_m,
            nodal_diameters: nd,
            casing,
            disk,
            damping_ratios: [of_casing, of_disk],
            range_rad_s,
            speeds,
            speed_rad_s: speed_rad_s.unwrap_or(0.5 * (range_rad_s[0] + range_rad_s[1])),
            pulse_n: 1.0,
        })
    }
}

/// Damping ratio of casing and disk, as typed, if none is given.
const USUAL_DAMPING: &str = "0.01";

/// Reads the mode table and returns the casing's modes, then the disk's; remarks on the table are
/// noted for standard error.
fn table(path: &Path) -> anyhow::Result<[Vec<Family>; 2]> {
    let shown = path.display();
    let bytes = file::read_bytes(path, LARGEST_TABLE)
        .map_err(|error| Refusal::because(format!("cannot read {shown}: {error}")))?;
    let table = read_modes(&bytes);
    let table = table.map_err(|error| Refusal::because(format!("{shown}: {error}")))?;
    table.notes.iter().for_each(|said| note(format!("rubscope: {shown}: {said}")));
    Ok(table.modes)
}

/// Parses a mode given with `option` as `DIAMETERS:FREQUENCY:MASS`.
fn family(option: &str, text: &str) -> Result<Family, SceneError> {
    let parts: Vec<&str> = text.split(':').collect();
    if parts.len() != 3 {
        let allowed = "DIAMETERS:FREQUENCY:MASS, such as 3:139.8Hz:2kg";
        return Err(SceneError::refused(option, text, allowed));
    }
    let names = ["nodal_diameters", "frequency_hz", "modal_mass_kg"];
    let given = |name: &str| {
        let part = names.iter().zip(&parts).find(|(known, _)| **known == name);
        part.map(|(_, text)| (*text).to_string())
    };
    Family::read(&given, &|name| format!("{option} {text}: {name}"))
}

/// Parses a number given with `option`, with or without a unit, within the bounds of the key
/// `path`; returns it in the unit of the key.
fn number(option: &str, text: &str, path: &str) -> anyhow::Result<f64> {
    let key = keys::find(path)?;
    Ok(key.number(option, &with_typed_unit(text, key.quantity()))?)
}

/// Error that ends the command after the user answered that the file should not be written.
#[derive(Debug, thiserror::Error)]
#[error("nothing is written")]
struct Stop;

/// Parses the text `given` with `option` or, without it, an answer of the user to the question
/// `what`; Enter alone gives `usual`. Repeats the question until the answer parses. If standard input
/// is no terminal, takes `usual` or fails.
fn asked<T>(
    option: &str,
    given: Option<&str>,
    what: &str,
    usual: Option<&str>,
    read: &dyn Fn(&str) -> anyhow::Result<T>,
) -> anyhow::Result<T> {
    let missing =
        |more: &str| Refusal::because(format!("new: {option} is missing ({what}){more}")).into();
    let known = if stdin().is_terminal() { given } else { given.or(usual) };
    if let Some(text) = known {
        return read(text);
    }
    if !stdin().is_terminal() {
        return Err(missing("; without a terminal no question is asked"));
    }
    let hint = usual.map_or(String::new(), |usual| format!(" (Enter: {usual})"));
    loop {
        write!(stderr(), "{what}{hint}: ")?;
        stderr().flush()?;
        let mut line = String::new();
        if stdin().lock().read_line(&mut line)? == 0 {
            return Err(missing(""));
        }
        let answer = match (line.trim(), usual) {
            ("", None) => continue,
            ("", Some(usual)) => usual,
            (answer, _) => answer,
        };
        match read(answer) {
            Err(error) if !error.is::<Stop>() => say(&format!("{error:#}")),
            done => return done,
        }
    }
}
