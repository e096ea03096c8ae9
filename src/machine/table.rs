//! Reads the modes of a modal analysis from a table saved by a spreadsheet or an FE program: column
//! names with units, several separators and encodings, decimal commas, frequencies at several
//! speeds, and both modes of a pair.

use std::f64::consts::TAU;

use anyhow::Result;
use csv::StringRecord;
use rubscope_solver::scene::{Quantity, SceneError, frequency_at_rest, hertz_of, keys};

use super::build::{Family, digits};
use super::cells::{Cells, cells};
use super::columns::{Columns, DAMPING, MODE, SPEED, STIFFENING, STRUCTURE, is_head};
use super::marks::{Number, decimal_mark};
use rubscope_solver::numeric::rounding::rounded;

/// Modes read from a table.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeTable {
    /// Modes of the casing and of the disk.
    pub modes: [Vec<Family>; 2],
    /// Messages about lines, columns and cells that were not used.
    pub notes: Vec<String>,
}

/// A mode with its measured frequencies, each with its rotor speed \[Hz, rad/s\].
type Measured = (Family, Vec<(f64, f64)>);

/// Largest relative difference between the frequencies or masses of the two modes of a pair. FE meshes
/// split them by less; modes of different families differ by more.
const PAIR: f64 = 1e-3;

/// Reads the modes of a table: a line of names, then a line for each mode.
///
/// The columns are `structure` (casing or disk), `nodal_diameters`, `frequency_hz`, `modal_mass_kg`
/// and, optionally, `damping_ratio`. Lines of the disk may also have the rotor `speed` at which the
/// frequency was determined, and `centrifugal_stiffening`. Lines with the same nodal diameters at
/// several speeds are one mode, with the mass and damping of the first; more than two frequencies
/// are fitted. Two lines with the same nodal diameters, speed, frequency and mass are the two modes
/// of a pair, and one mode here.
///
/// A unit in a column name, as in `Frequency [kHz]`, `Damping (%)` or `speed_rpm`, applies to its
/// bare numbers; a line of units below the names does too. Cells are separated by semicolons, tabs,
/// bars or commas. Empty lines and lines that begin with `#` are skipped. Other columns, and lines
/// before that of the names, are ignored and listed in the notes.
///
/// # Errors
/// A column is missing, a value is not allowed, or a number can be read in two ways; the message
/// gives line and column.
pub fn read_modes(bytes: &[u8]) -> Result<ModeTable> {
    let Cells { mut records, separator } = cells(bytes)?;
    let mut notes = Vec::new();
    let start = records.iter().position(|(_, record)| is_head(record)).unwrap_or(0);
    let before: Vec<String> = records.drain(..start).map(|(line, _)| line.to_string()).collect();
    note_unused(&mut notes, "lines not used, before the names of the columns", &before);
    let mut records = records.into_iter().peekable();
    let (line, mut names) = records.next().unwrap_or_default();
    let line =
        if before.is_empty() { "the first line".to_string() } else { format!("line {line}") };
    if let Some((_, units)) = records.next_if(|(_, record)| is_of_units(record)) {
        let named = names.iter().zip(&units).map(|(name, unit)| match unit {
            "" => name.to_string(),
            unit => format!("{name} [{}]", unit.trim_matches(['[', ']', '(', ')'])),
        });
        names = named.collect();
    }
    let columns = Columns::of(&names, &line)?;
    note_unused(&mut notes, "columns not used", &columns.unused);
    let records: Vec<_> = records.collect();
    let mark = decimal_mark(&numbers(&records, &columns), separator == b',')?;
    let mut found: [Vec<Measured>; 2] = Default::default();
    let mut pairs: [Vec<String>; 2] = Default::default();
    for (line, record) in &records {
        if record.iter().skip(names.len()).any(|cell| !cell.is_empty())
            || record.len() < names.len()
        {
            let allowed = format!("as many as names in the first line, {}", names.len());
            let given = format!("{} cells", record.len());
            return Err(SceneError::refused(format!("line {line}"), given, allowed).into());
        }
        let given = |name: &str| {
            let (cell, unit) = columns.cell(record, name)?;
            let has_comma = name == MODE[0] || (name != STRUCTURE && mark == ',');
            let cell = if has_comma { cell.replacen(',', ".", 1) } else { cell.to_string() };
            // The two modes of a pair have nodal diameters of both signs.
            let cell = if name == MODE[0] { cell.trim_start_matches(SIGNS).into() } else { cell };
            // The exponent of Fortran, as in `1.3D+03`.
            let usual = cell.replace(['D', 'd'], "E");
            let cell = if usual.parse::<f64>().is_ok() { usual } else { cell };
            let is_bare = !unit.is_empty() && Quantity::bare(&cell).is_some();
            Some(if is_bare { format!("{cell} {unit}") } else { cell })
        };
        let path = |name: &str| path(*line, name);
        let structure = given(STRUCTURE).unwrap_or_default();
        let structure = structure_of(&structure).ok_or_else(|| {
            SceneError::refused(path(STRUCTURE), structure, STRUCTURES.join(" or "))
        })?;
        let mode = Family::read(&given, &path)?;
        let speed =
            given(SPEED).filter(|_| structure == 1).map(|text| match Quantity::bare(&text) {
                Some(_) => {
                    let allowed = "a number with its unit, or Speed [rpm] in the first line";
                    Err(SceneError::refused(path(SPEED), text, allowed))
                }
                _ => keys::find(keys::SPEED)?.number(&path(SPEED), &text),
            });
        let speed = speed.transpose()?.map(|speed| (mode.frequency_hz, speed));
        match add(&mut found[structure], &mode, speed, &path)? {
            Some(unused) => notes.extend(unused),
            None => pairs[structure].push(format!("line {line}")),
        }
    }
    for (structure, lines) in ["casing", "disk"].iter().zip(&pairs) {
        let what = "the same as the first ones and not used";
        note_unused(
            &mut notes,
            &format!("second modes of pairs of the {structure}, {what}"),
            lines,
        );
    }
    for (mode, speeds) in found[1].iter_mut().filter(|(_, speeds)| !speeds.is_empty()) {
        let name = format!("disk, {} nodal diameters, frequency_hz", mode.nodal_diameters);
        let (rest, stiffening) = frequency_at_rest(&name, speeds, mode.stiffening)?;
        notes.extend(fit_note(&name, speeds, rest, stiffening.unwrap_or(0.0)));
        (mode.frequency_hz, mode.stiffening) = (digits(rest), stiffening.map(digits));
    }
    let modes = found.map(|modes| modes.into_iter().map(|(mode, _)| mode).collect());
    Ok(ModeTable { modes, notes })
}

/// Adds a note on what is not used, unless its list is empty.
fn note_unused(notes: &mut Vec<String>, what: &str, list: &[String]) {
    if !list.is_empty() {
        notes.push(format!("{what}: {}", list.join(", ")));
    }
}

/// Signs of a harmonic index.
const SIGNS: [char; 4] = ['+', '-', '\u{2212}', '±'];

/// Words for the casing and for the disk.
const STRUCTURES: [&str; 2] =
    ["casing, housing, stator", "disk, disc, bladed disk, bladed disc, blisk, rotor"];

/// Returns 0 for a word for the casing, 1 for one for the disk.
fn structure_of(cell: &str) -> Option<usize> {
    let word = cell.to_lowercase().replace(['_', '-'], " ");
    STRUCTURES.iter().position(|words| words.split(", ").any(|known| known == word))
}

fn path(line: u64, name: &str) -> String {
    format!("line {line}, {name}")
}

/// Returns whether a record has the units of the columns: it has no digit but in `1/min`, no
/// structure, and a unit of a frequency or a mass.
fn is_of_units(record: &StringRecord) -> bool {
    let is_unit = |cell: &str| {
        let cell = cell.trim_matches(['[', ']', '(', ')']);
        [Quantity::Speed, Quantity::Mass].iter().any(|of| of.read(&format!("1 {cell}")).is_ok())
            && Quantity::bare(&format!("1 {cell}")).is_none()
    };
    let is_number = |cell: &str| cell.starts_with(|c: char| c.is_ascii_digit()) && !is_unit(cell);
    record.iter().any(is_unit)
        && !record.iter().any(|cell| is_number(cell) || structure_of(cell).is_some())
}

/// Returns the numbers of a table but for nodal diameters, which are whole by either mark.
fn numbers(records: &[(u64, StringRecord)], columns: &Columns) -> Vec<Number> {
    let names = MODE[1..].iter().chain(&[DAMPING, SPEED, STIFFENING]);
    let of_record = |(line, record): &(u64, StringRecord)| {
        let number = |name: &&str| {
            let (cell, _) = columns.cell(record, name)?;
            Some(Number { path: path(*line, name), cell: cell.to_string() })
        };
        names.clone().filter_map(number).collect::<Vec<_>>()
    };
    records.iter().flat_map(of_record).collect()
}

/// Adds a mode, or one more speed of a known one. Returns a note for each value that is not used;
/// `None` for the second mode of a pair, which is not added.
///
/// # Errors
/// The mode already has a line at this speed, with another frequency or mass.
fn add(
    modes: &mut Vec<Measured>,
    mode: &Family,
    speed: Option<(f64, f64)>,
    path: &dyn Fn(&str) -> String,
) -> Result<Option<Vec<String>>, SceneError> {
    let same = |(known, _): &&mut Measured| known.nodal_diameters == mode.nodal_diameters;
    let Some((known, speeds)) = modes.iter_mut().find(same) else {
        modes.push((*mode, speed.into_iter().collect()));
        return Ok(Some(Vec::new()));
    };
    let at_speed = match speed {
        None if speeds.is_empty() => Some(known.frequency_hz),
        None => None,
        Some((_, speed)) => speeds.iter().find(|(_, at)| *at == speed).map(|(hertz, _)| *hertz),
    };
    let near = |a: f64, b: f64| (a / b - 1.0).abs() <= PAIR;
    let is_near =
        |hertz| near(hertz, mode.frequency_hz) && near(known.modal_mass_kg, mode.modal_mass_kg);
    if at_speed.is_some_and(is_near) {
        return Ok(None);
    }
    let Some(speed) = speed.filter(|_| at_speed.is_none() && !speeds.is_empty()) else {
        let given = format!("{} twice", mode.nodal_diameters);
        let allowed = format!(
            "one mode for each number of nodal diameters, or a pair whose frequencies and masses \
             differ by {} % at most; for the disk also at several Speed [rpm]",
            100.0 * PAIR
        );
        return Err(SceneError::refused(path(MODE[0]), given, allowed));
    };
    speeds.push(speed);
    known.stiffening = known.stiffening.or(mode.stiffening);
    known.damping_ratio = known.damping_ratio.or(mode.damping_ratio);
    let twice = [
        (MODE[2], Some(known.modal_mass_kg), Some(mode.modal_mass_kg)),
        (DAMPING, known.damping_ratio, mode.damping_ratio),
    ];
    let unused = twice.into_iter().filter_map(|(name, first, second)| {
        let (first, second) = first.zip(second).filter(|(first, second)| first != second)?;
        let path = path(name);
        Some(format!("{path} = {second} is not used: the line before of this mode has {first}"))
    });
    Ok(Some(unused.collect()))
}

/// Returns a note on the fit of three frequencies or more \[Hz, rad/s\] by
/// `f^2 = rest^2 + stiffening (Omega/2 pi)^2`; `None` for fewer, which it meets exactly.
fn fit_note(name: &str, speeds: &[(f64, f64)], rest: f64, stiffening: f64) -> Option<String> {
    let off = |(hertz, speed): &(f64, f64)| {
        ((rest.powi(2) + stiffening * (speed / TAU).powi(2)).sqrt() / hertz - 1.0).abs()
    };
    let most = speeds.iter().map(off).fold(0.0, f64::max);
    (speeds.len() > 2).then(|| {
        format!(
            "{name}: fitted to {} speeds, at most {} % off",
            speeds.len(),
            rounded(100.0 * most, 2)
        )
    })
}

impl Family {
    /// Reads a mode from texts looked up by column name, such as `frequency_hz`. `path` gives the
    /// name that an error uses. Nodal diameters may be written as `2.0`.
    ///
    /// # Errors
    /// Names the first value that is not allowed.
    pub fn read(
        given: &dyn Fn(&str) -> Option<String>,
        path: &dyn Fn(&str) -> String,
    ) -> Result<Self, SceneError> {
        let text = |name| given(name).unwrap_or_default();
        let number = |name, key| keys::find(key)?.number(&path(name), &text(name));
        let known = |name, key| given(name).map(|_| number(name, key)).transpose();
        let diameters = text(MODE[0]);
        let is_zero = |decimals: &str| decimals.bytes().all(|digit| digit == b'0');
        let whole = diameters.split_once('.').filter(|(_, decimals)| is_zero(decimals));
        let whole = whole.map_or(diameters.as_str(), |(whole, _)| whole);
        let diameters = keys::find(keys::DIAMETERS)?.number(&path(MODE[0]), whole)?;
        Ok(Self {
            nodal_diameters: diameters as u32,
            frequency_hz: hertz_of(&path(MODE[1]), &text(MODE[1]))?,
            modal_mass_kg: number(MODE[2], keys::CASING_MASS)?,
            damping_ratio: known(DAMPING, keys::CASING_DAMPING)?,
            stiffening: known(STIFFENING, keys::STIFFENING)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_of_a_column_is_that_of_its_bare_cells() {
        let of = |names: &str, cells: &str| {
            let head = format!("structure;nodal diameters [-];{names}");
            read_modes(format!("{head}\ndisk;5;{cells}\n").as_bytes())
        };
        let (speed, stiffness) = ("Speed [rpm];Centrifugal stiffening", "9000;1,5");
        let names = format!("Frequency;Mass;Damping;{speed}");
        let expected = of(&names, &format!("310,7;3,1;0,012;{stiffness}")).unwrap();
        assert_eq!(expected.notes, [""; 0]);
        for (names, cells) in [
            ("frequency_hz;modal_mass_kg;damping_ratio", "310,7;3,1;0,012"),
            ("Frequency, Hz;Mass in kg;Damping, %", "310,7;3,1;1,2"),
            ("Frequency [kHz];Modal mass (g);Damping [%]", "0,3107;3100;1,2"),
            ("Frequency_khz;mass_t;damping_ratio_percent", "0,3107;0,0031;1,2"),
            ("Frequency (kHz);Mass [g];Damping%", "310,7 Hz;3,1kg;1,2"),
            ("frequency_hz;Mass [g];Damping", "0,3107k;3,1k;0,012"),
            ("Frequency [Hz];Mass (kg);Damping", "0,3107k;3,1;0,012"),
            ("Frequency {1/min};\"Modal\nmass [kg]\";Damping ratio [-]", "18642;3,1;0,012"),
        ] {
            for (speed, rpm) in [
                (speed, "9000"),
                ("Rotor speed [1/min];Centrifugal stiffening", "9000"),
                ("rpm;centrifugal-stiffening", "9k"),
                ("Speed [min⁻¹];centrifugal_stiffening [-]", "9000"),
                ("speed_hz;centrifugal_stiffening", "150"),
                ("Speed / krpm;centrifugal_stiffening", "9"),
                ("Speed;centrifugal_stiffening", "9000 r/min"),
            ] {
                let read = of(&format!("{names};{speed}"), &format!("{cells};{rpm};1,5")).unwrap();
                let [read, known] = [&read, &expected].map(|table| &table.modes[1][0]);
                let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-14;
                assert!(near(read.frequency_hz, known.frequency_hz), "{names} {speed}: {read:?}");
                assert!(near(read.modal_mass_kg, known.modal_mass_kg), "{names}: {read:?}");
                assert!(near(read.damping_ratio.unwrap(), 0.012), "{names}: {read:?}");
            }
        }
    }
}
