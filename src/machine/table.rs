//! Reads the modes of a modal analysis from a table saved by a spreadsheet. Handles column names
//! with units, several separators, decimal commas, and frequencies given at two speeds.

use csv::StringRecord;
use rubscope_solver::scene::units::UnitError;
use rubscope_solver::scene::{Quantity, SceneError, frequency_at_rest, hertz_of, keys};

use super::build::{Family, digits};

/// Modes read from a table.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeTable {
    /// Modes of the casing and of the disk.
    pub modes: [Vec<Family>; 2],
    /// Messages about columns and cells that were not used.
    pub notes: Vec<String>,
}

/// A mode with its measured frequencies, each with its rotor speed \[Hz, rad/s\].
type Measured = (Family, Vec<(f64, f64)>);

/// A column: name, unit and index.
type Column = (&'static str, String, usize);

/// Reads the modes of a table: a header line, then a line for each mode.
///
/// The columns are `structure` (casing or disk), `nodal_diameters`, `frequency_hz`, `modal_mass_kg`
/// and, optionally, `damping_ratio`. Lines of the disk may also have the rotor `speed` at which the
/// frequency was determined, and `centrifugal_stiffening`. Two lines with the same nodal diameters
/// at two speeds are one mode, with the mass and damping of the first.
///
/// A unit in a column name, as in `Frequency [kHz]`, `Damping (%)` or `speed_rpm`, applies to its
/// bare numbers. Cells are separated by commas, or by semicolons or tabs; with the latter, numbers
/// may have a decimal comma. Empty lines and lines that begin with `#` are skipped. Other columns
/// are ignored and listed in the notes.
///
/// # Errors
/// A column is missing, or a value is not allowed; the message gives line and column.
pub fn read_modes(text: &str) -> Result<ModeTable, SceneError> {
    let text = text.trim_start_matches('\u{feff}').replace("\r\n", "\n").replace('\r', "\n");
    let head = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let between = |c: &u8| head.unwrap_or_default().as_bytes().contains(c);
    let delimiter = [b';', b'\t'].into_iter().find(between).unwrap_or(b',');
    let mut reader = csv::ReaderBuilder::new();
    reader.delimiter(delimiter).comment(Some(b'#')).flexible(true).trim(csv::Trim::All);
    let mut reader = reader.has_headers(false).from_reader(text.as_bytes());
    // Reading text that is already in memory cannot fail, since any number of cells is accepted.
    let records = reader.records().flatten();
    let mut records = records.filter(|record| !record.iter().all(str::is_empty));
    let names = records.next().unwrap_or_default();
    let (columns, unused) = columns(&names)?;
    let mut notes = Vec::new();
    if !unused.is_empty() {
        notes.push(format!("columns not used: {}", unused.join(", ")));
    }
    let mut found: [Vec<Measured>; 2] = Default::default();
    for record in records {
        // The reader reports the position before any skipped lines.
        let (line, start) = record.position().map_or((0, 0), |at| (at.line(), at.byte()));
        let before = text.get(start as usize..).unwrap_or_default().lines();
        let is_left_out = |line: &&str| line.is_empty() || line.starts_with('#');
        let line = line + before.take_while(is_left_out).count() as u64;
        if record.len() != names.len() {
            let allowed = format!("as many as names in the first line, {}", names.len());
            let given = format!("{} cells", record.len());
            return Err(SceneError::refused(format!("line {line}"), given, allowed));
        }
        let given = |name: &str| {
            let (_, unit, at) = columns.iter().find(|(known, ..)| *known == name)?;
            let cell = record.get(*at).filter(|cell| !matches!(*cell, "" | "-"))?;
            let is_decimal = delimiter != b',' && !cell.contains('.');
            let cell = if is_decimal { cell.replacen(',', ".", 1) } else { cell.to_string() };
            let is_bare = !unit.is_empty() && Quantity::bare(&cell).is_some();
            Some(if is_bare { format!("{cell} {unit}") } else { cell })
        };
        let path = |name: &str| format!("line {line}, {name}");
        let structure = given(STRUCTURE).unwrap_or_default().to_lowercase();
        let structure = match structure.as_str() {
            "casing" => 0,
            "disk" | "bladed disk" => 1,
            other => return Err(SceneError::refused(path(STRUCTURE), other, "casing or disk")),
        };
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
        notes.extend(add(&mut found[structure], mode, speed, &path)?);
    }
    for (mode, speeds) in found[1].iter_mut().filter(|(_, speeds)| !speeds.is_empty()) {
        let name = format!("disk, {} nodal diameters, frequency_hz", mode.nodal_diameters);
        let (rest, stiffening) = frequency_at_rest(&name, speeds, mode.stiffening)?;
        (mode.frequency_hz, mode.stiffening) = (digits(rest), stiffening.map(digits));
    }
    let modes = found.map(|modes| modes.into_iter().map(|(mode, _)| mode).collect());
    Ok(ModeTable { modes, notes })
}

/// Adds a mode, or the second speed of a known one. Returns a note for each value of the second
/// line that is not used.
///
/// # Errors
/// The mode already has all its lines.
fn add(
    modes: &mut Vec<Measured>,
    mode: Family,
    speed: Option<(f64, f64)>,
    path: &dyn Fn(&str) -> String,
) -> Result<Vec<String>, SceneError> {
    let same = |(known, _): &&mut Measured| known.nodal_diameters == mode.nodal_diameters;
    let Some((known, speeds)) = modes.iter_mut().find(same) else {
        modes.push((mode, speed.into_iter().collect()));
        return Ok(Vec::new());
    };
    let Some(speed) = speed.filter(|_| speeds.len() == 1) else {
        let given = format!("{} twice", mode.nodal_diameters);
        let allowed = "one mode for each number of diameters, of the disk also at two Speed [rpm]";
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
    Ok(unused.collect())
}

/// Returns the known columns of the header, each with its unit and index, and the names of the
/// other columns.
///
/// # Errors
/// A required column is missing, a column occurs twice, or a unit is wrong.
fn columns(names: &StringRecord) -> Result<(Vec<Column>, Vec<&str>), SceneError> {
    let (mut columns, mut unused) = (Vec::new(), Vec::new());
    for (at, written) in names.iter().enumerate() {
        match column(written)? {
            Some((name, unit)) => columns.push((name, unit, at)),
            None => unused.extend((!written.is_empty()).then_some(written)),
        }
    }
    for (place, (name, ..)) in COLUMNS.iter().enumerate() {
        let count = columns.iter().filter(|(known, ..)| known == name).count();
        if count > 1 || (count == 0 && place < NEEDED) {
            let given = names.iter().collect::<Vec<_>>().join(",");
            return Err(SceneError::refused("the first line", given, ALLOWED));
        }
    }
    Ok((columns, unused))
}

/// Returns the known column that a header cell names, and its unit; `None` for other names.
///
/// # Errors
/// The unit belongs to another quantity, or the brackets contain no known unit.
fn column(written: &str) -> Result<Option<(&'static str, String)>, SceneError> {
    let mut words = written.split_whitespace().collect::<Vec<_>>().join("_");
    if words.eq_ignore_ascii_case("rpm") {
        words.insert_str(0, "speed_");
    }
    let lower = words.to_ascii_lowercase().replace('-', "_");
    let of = |(name, quantity, others): &(&'static str, Quantity, &[&str])| {
        let rest = [name].into_iter().chain(*others).find_map(|name| lower.strip_prefix(name))?;
        (!rest.starts_with(char::is_alphanumeric)).then_some((*name, *quantity, rest.len()))
    };
    let Some((name, quantity, rest)) = COLUMNS.iter().find_map(of) else { return Ok(None) };
    let rest = words.get(words.len() - rest..).unwrap_or_default();
    let parts = rest.split(|c: char| "_/,:[](){}".contains(c));
    let unit = parts.filter(|part| !matches!(*part, "" | "-" | "in")).collect::<Vec<_>>().join("/");
    let has_unit = |name: &str| lower.starts_with(name) && !name.ends_with(&unit.to_lowercase());
    if !unit.is_empty() && MODE[1..].iter().any(|name| has_unit(name)) {
        return Ok(None);
    }
    let one = format!("1 {unit}");
    let is_prefix = !unit.is_empty() && Quantity::bare(&one).is_some();
    match quantity.read(&one) {
        Ok(_) if !is_prefix => Ok(Some((name, unit))),
        Err(why) if rest.contains(['[', '(']) || matches!(why, UnitError::Other { .. }) => {
            let why = match why {
                UnitError::NoNumber => UnitError::Unknown { unit, wanted: quantity },
                why => why,
            };
            Err(SceneError::Unit { key: "the first line".into(), value: written.into(), why })
        }
        _ => Ok(None),
    }
}

/// Column names, their quantity, and alternative names. The first [`NEEDED`] columns are required.
const COLUMNS: [(&str, Quantity, &[&str]); 7] = [
    (STRUCTURE, Quantity::Plain, &[]),
    (MODE[0], Quantity::Plain, &["nodal_diameter"]),
    (MODE[1], Quantity::Speed, &["frequency"]),
    (MODE[2], Quantity::Mass, &["modal_mass", "mass"]),
    (DAMPING, Quantity::Plain, &["damping"]),
    (SPEED, Quantity::Speed, &["rotor_speed"]),
    (STIFFENING, Quantity::Plain, &[]),
];
const NEEDED: usize = 4;
const ALLOWED: &str = "structure, nodal_diameters, frequency_hz, modal_mass_kg and, if known, \
                       damping_ratio, speed and centrifugal_stiffening, each once";
const STRUCTURE: &str = "structure";
const MODE: [&str; 3] = ["nodal_diameters", "frequency_hz", "modal_mass_kg"];
const DAMPING: &str = "damping_ratio";
const SPEED: &str = "speed";
/// Optional column of the disk; also the name of the key in a scene file.
pub(super) const STIFFENING: &str = "centrifugal_stiffening";

impl Family {
    /// Reads a mode from texts looked up by column name, such as `frequency_hz`. `path` gives the
    /// name that an error uses.
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
        Ok(Self {
            nodal_diameters: number(MODE[0], keys::DIAMETERS)? as u32,
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
    fn tables_of_spreadsheets_are_read_or_refused_by_their_line() {
        let head = "structure,nodal_diameters,frequency_hz,modal_mass_kg";
        let table = format!("\u{feff}{head}\r\nCasing,4,310.7,3.1\r\ndisk,4,151.3,5.5\r\n");
        let [casing, disk] = read_modes(&table).unwrap().modes;
        assert_eq!((casing[0].frequency_hz, disk[0].modal_mass_kg), (310.7, 5.5));
        for (table, refusal) in [
            (format!("{head}\ncasing,4,310,7,3,1"), "line 2 = 6 cells: allowed is as many as"),
            (format!("{head}\ncasing,4,310"), "line 2 = 3 cells"),
            (head.replace("structure", "struct"), "the first line = struct,nodal_diameters"),
            (format!("{head},structure"), "each once"),
            (format!("{head}\nrotor,4,310.7,3.1"), "line 2, structure = rotor"),
        ] {
            let error = read_modes(&table).unwrap_err().to_string();
            assert!(error.contains(refusal), "{table}: {error}");
        }
    }

    #[test]
    fn tables_of_spreadsheets_have_semicolons_decimal_commas_and_names_with_units() {
        let of = |table: &str| read_modes(table).unwrap().modes;
        let expected = of("structure,nodal_diameters,frequency_hz,modal_mass_kg,damping_ratio\n\
             casing,4,310.7,3.1,0.01\ndisk,4,151.3,5.5,\n");
        for (separator, comma) in [(";", ","), ("\t", ","), (";", "."), (",", ".")] {
            let table = "\u{feff}# of the rig\r\n\r\nStructure;Nodal diameters;Frequency [Hz];\
                         \"Modal mass (kg)\";Damping ratio;Remark\r\n\
                         Casing;4;310.7;3.1;0.01;\r\ndisk;4;151.3;5.5;;\"left; or right\"\r\n;;;;;\r\n";
            let table = table.replace('.', comma).replace("left;", "left").replace(';', separator);
            assert_eq!(of(&table), expected, "{table}");
            assert_eq!(read_modes(&table).unwrap().notes, ["columns not used: Remark"]);
        }
    }

    #[test]
    fn units_in_the_names_of_columns_are_heard() {
        let of = |head: &str, row: &str| read_modes(&format!("{head}\ncasing,4,310,3,\n{row}\n"));
        let head = "structure,nodal diameter,frequency,mass [kg]";
        let ratio = |name: &str, cell: &str| {
            let row = format!("bladed disk,4,151,5,{cell}");
            let [_, disk] = of(&format!("{head},{name}"), &row).unwrap().modes;
            disk[0].damping_ratio.unwrap()
        };
        for (name, cell) in
            [("Damping ratio [%]", "0.3"), ("damping (%)", "0.3 %"), ("Damping", "0.003")]
        {
            assert!((ratio(name, cell) - 0.003).abs() < 1e-15, "{name}");
        }
        let bare = of(&format!("{head},Speed"), "disk,4,151,5,9000").unwrap_err().to_string();
        assert_eq!(
            bare,
            "line 3, speed = 9000: allowed is a number with its unit, or Speed [rpm] in the first line"
        );
        for name in ["Rotor speed [rpm]", "RPM", "Speed [U/min]", "Speed [Hz]"] {
            assert!(of(&format!("{head},{name}"), "disk,4,151,5,0").is_ok(), "{name}");
            let turning = of(&format!("{head},{name}"), "disk,4,151,5,50").unwrap_err();
            assert!(turning.to_string().contains("centrifugal_stiffening"), "{turning}");
        }
        let strange =
            of(&format!("{head},Speed [m/s]"), "disk,4,151,5,50").unwrap_err().to_string();
        assert!(
            strange.starts_with("the first line = Speed [m/s]: this is a velocity; it takes rad/s"),
            "{strange}"
        );
    }

    #[test]
    fn the_unit_of_a_column_is_that_of_its_bare_cells() {
        let of = |names: &str, cells: &str| {
            let head = format!("structure;nodal diameters [-];{names}");
            read_modes(&format!("{head}\ndisk;5;{cells}\n"))
        };
        let (speed, stiffness) = ("Speed [rpm];Centrifugal stiffening", "9000;1,5");
        let names = format!("Frequency;Mass;Damping;{speed}");
        let expected = of(&names, &format!("310,7;3,1;0,012;{stiffness}")).unwrap();
        assert_eq!(expected.notes, [""; 0]);
        for (names, cells) in [
            ("frequency_hz;modal_mass_kg;damping_ratio", "310,7;3,1;0,012"),
            ("Frequency, Hz;Mass in kg;Damping, %", "310.7;3.1;1.2"),
            ("Frequency [kHz];Modal mass (g);Damping [%]", "0,3107;3100;1,2"),
            ("Frequency_khz;mass_t;damping_ratio_percent", "0,3107;0,0031;1,2"),
            ("Frequency (kHz);Mass [g];Damping%", "310,7 Hz;3,1kg;1,2"),
            ("frequency_hz;Mass [g];Damping", "0,3107k;3.1k;0,012"),
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
        for (name, why) in [
            ("Speed [m/s]", "this is a velocity; it takes rad/s, rpm or Hz"),
            ("Speed (knots)", "no unit knots; it takes rad/s, rpm or Hz"),
            ("speed_kg", "this is a mass; it takes rad/s, rpm or Hz"),
            ("Damping [‰]", "no unit ‰; it takes %"),
        ] {
            let refused = of(&format!("frequency;mass;{name}"), "310;3;1").unwrap_err();
            assert_eq!(refused.to_string(), format!("the first line = {name}: {why}"));
        }
        for (names, cells, why) in [
            ("frequency_hz_rad_s;mass", "140;3", "the first line = "),
            ("frequency [kHz];mass", "1.4k;3", "no unit k kHz; it takes rad/s, rpm or Hz"),
            ("frequency;mass;Speed", "310;3;9k", "a number with its unit, or Speed [rpm]"),
        ] {
            let refused = of(names, cells).unwrap_err().to_string();
            assert!(refused.contains(why), "{names}: {refused}");
        }
        // A name that ends in something other than a unit is an unknown column, even if it is an SI
        // prefix.
        for name in
            ["Speed n", "Speed of the test", "Massive", "Damping measured", "speed_k", "Speed µ"]
        {
            let read = of(&format!("frequency;mass;{name}"), "310;3;1").unwrap();
            assert_eq!(read.notes, [format!("columns not used: {name}")]);
        }
        let twice = of("frequency;mass;Speed [rpm];Speed [Hz]", "310;3;;").unwrap_err();
        assert!(
            twice.to_string().contains("speed and centrifugal_stiffening, each once"),
            "{twice}"
        );
    }

    #[test]
    fn what_two_lines_of_a_mode_say_otherwise_is_told() {
        let table = "structure,nodal_diameters,frequency_hz,modal_mass_kg,damping_ratio,speed_rpm,by\n\
                     disk,2,352,3.9,,0,me\ndisk,2,410,4.1,0.01,10000,\n\
                     disk,3,371,3.7,0.02,0,\ndisk,3,427,3.7,0.03,10000,you\n";
        let read = read_modes(table).unwrap();
        let mode =
            |place: usize| (read.modes[1][place].modal_mass_kg, read.modes[1][place].damping_ratio);
        assert_eq!([mode(0), mode(1)], [(3.9, Some(0.01)), (3.7, Some(0.02))]);
        assert_eq!(
            read.notes,
            [
                "columns not used: by",
                "line 3, modal_mass_kg = 4.1 is not used: the line before of this mode has 3.9",
                "line 5, damping_ratio = 0.03 is not used: the line before of this mode has 0.02",
            ]
        );
    }

    #[test]
    fn a_table_is_read_and_what_is_wrong_has_its_line() {
        let head = "structure,nodal_diameters,frequency_hz,modal_mass_kg,damping_ratio\n";
        let text =
            format!("# of the rig\n{head}casing, 3, 139.8, 2.0, 0.05\ndisk,3,45.6,9166 g,\n");
        let [casing, disk] = read_modes(&text).unwrap().modes;
        assert_eq!((casing[0].frequency_hz, casing[0].damping_ratio), (139.8, Some(0.05)));
        assert_eq!((disk[0].modal_mass_kg, disk[0].damping_ratio), (9.166, None));
        for (rows, start) in [
            ("casing,3,0,2,\n", "line 2, frequency_hz = 0: allowed is a frequency above 0"),
            ("casing,3,9,2,\ncasing,3,9,2,\n", "line 3, nodal_diameters = 3 twice: allowed is one"),
            ("casing,x,9,2,\n", "line 2, nodal_diameters = x: allowed is a whole number"),
            ("casing,3,9,2 kN,\n", "line 2, modal_mass_kg = 2 kN: this is a force; it takes kg"),
            ("rotor,3,9,2,\n", "line 2, structure = rotor: allowed is casing or disk"),
            ("\n# 1\n\ncasing,3,x,2,\n", "line 5, frequency_hz = x: allowed is a frequency"),
        ] {
            for end in ["\n", "\r\n", "\r"] {
                let table = format!("{head}{rows}").replace('\n', end);
                let message = read_modes(&table).unwrap_err().to_string();
                assert!(message.starts_with(start), "{end:?} {message}");
            }
        }
        let message = read_modes("frequency_hz\n1\n").unwrap_err().to_string();
        assert!(
            message.starts_with("the first line = frequency_hz: allowed is structure, nodal_diam")
        );
    }
}
