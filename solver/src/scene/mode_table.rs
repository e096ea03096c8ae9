//! The modes of a modal analysis from a table as a spreadsheet saves it: names and units of
//! columns, separators, decimal commas, and frequencies at two speeds.

use super::build::{Family, digits};
use super::modes::{frequency_at_rest, hertz_of, number_of};
use super::{Allowed, SceneError, keys};

/// A mode of a table, with each frequency and its speed \[Hz, rad/s\].
type Measured = (Family, Vec<(f64, f64)>);

/// Reads the modes of a table: a line of names, then a line for each mode. Names are
/// `structure` (casing or disk), `nodal_diameters`, `frequency_hz`, `modal_mass_kg`, and
/// `damping_ratio` if there is one, also as `Frequency [Hz]` or `Damping [%]`. A line of the disk
/// may have the rotor speed of its frequency (`Speed [rpm]`) and `centrifugal_stiffening`; two
/// lines of the same diameters at two speeds are one mode, with the mass of the first. Cells stand
/// between commas, or between semicolons or tabs, with which numbers may have a decimal comma.
/// Empty lines and those that begin with `#` are left out, and columns of other names.
///
/// # Errors
/// A missing column, or a value that is not allowed, by its line and column.
pub fn read_modes(text: &str) -> Result<[Vec<Family>; 2], SceneError> {
    let text = text.trim_start_matches('\u{feff}');
    let head = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let between = |c: &u8| head.unwrap_or_default().as_bytes().contains(c);
    let delimiter = [b';', b'\t'].into_iter().find(between).unwrap_or(b',');
    let mut reader = csv::ReaderBuilder::new();
    reader.delimiter(delimiter).comment(Some(b'#')).flexible(true).trim(csv::Trim::All);
    let mut reader = reader.has_headers(false).from_reader(text.as_bytes());
    let cells = |record: csv::Result<csv::StringRecord>| {
        let record = record.map_err(|error| {
            SceneError::refused("the table", error.to_string(), "lines of cells")
        })?;
        let line = record.position().map_or(0, csv::Position::line);
        Ok::<_, SceneError>((line, record))
    };
    let mut records = reader
        .records()
        .map(cells)
        .filter(|read| !read.as_ref().is_ok_and(|(_, record)| record.iter().all(str::is_empty)));
    let names = records
        .next()
        .transpose()?
        .map_or_else(Vec::new, |(_, record)| record.iter().map(column_name).collect());
    let count = |name: &str| names.iter().filter(|known| *known == name).count();
    if count(STRUCTURE) != 1 || COLUMNS.iter().any(|name| count(name) != 1) {
        let allowed = format!("{STRUCTURE}, {}, each once", COLUMNS.join(", "));
        return Err(SceneError::refused("the first line", names.join(","), allowed));
    }
    let speeds = SPEEDS.map(|(name, _)| name);
    let unknown = |name: &&String| name.starts_with("speed") && !speeds.contains(&name.as_str());
    if let Some(name) = names.iter().find(unknown) {
        let allowed = "Speed with the unit [rpm], [1/min], [rad/s] or [Hz]";
        return Err(SceneError::refused("the first line", name, allowed));
    }
    let mut found: [Vec<Measured>; 2] = Default::default();
    for record in records {
        let (line, record) = record?;
        if record.len() != names.len() {
            let allowed = format!("as many as names in the first line, {}", names.len());
            let given = format!("{} cells", record.len());
            return Err(SceneError::refused(format!("line {line}"), given, allowed));
        }
        let cell = |name: &str| {
            let at = names.iter().position(|known| known == name);
            let cell = at.and_then(|at| record.get(at)).unwrap_or_default();
            if delimiter == b',' { cell.to_string() } else { cell.replace(',', ".") }
        };
        let path = |name: &str| format!("line {line}, {name}");
        let structure = match cell(STRUCTURE).to_lowercase().as_str() {
            "casing" => 0,
            "disk" | "bladed disk" => 1,
            other => return Err(SceneError::refused(path(STRUCTURE), other, "casing or disk")),
        };
        let given = |name: &str| Some(cell(name)).filter(|cell| !cell.is_empty());
        let numbers = COLUMNS.map(cell);
        let percent = given(DAMPING_PERCENT);
        let percent = percent.map(|text| format!("{} %", text.trim_end_matches(['%', ' '])));
        let damping = given(DAMPING).or(percent);
        let mut mode =
            Family::read(numbers.each_ref().map(String::as_str), damping.as_deref(), &path)?;
        let number = |name: &str, key: &str, unit: &str| {
            let text = given(name)?;
            let bare = text.trim().parse::<f64>().is_ok();
            if bare && name == "speed" {
                let allowed = "a number with its unit, or Speed [rpm] in the first line";
                return Some(Err(SceneError::refused(path(name), text, allowed)));
            }
            let text = if bare { format!("{text} {unit}") } else { text };
            Some(keys::find(key).and_then(|key| number_of(&path(name), &text, key)))
        };
        let mut speed = None;
        if structure == 1 {
            mode.stiffening = number(STIFFENING, keys::STIFFENING, "").transpose()?;
            let read = SPEEDS.iter().find_map(|(name, unit)| number(name, keys::SPEED, unit));
            speed = read.transpose()?.map(|speed| (mode.frequency_hz, speed));
        }
        let modes = &mut found[structure];
        let same = |(known, _): &&mut Measured| known.nodal_diameters == mode.nodal_diameters;
        match (modes.iter_mut().find(same), speed) {
            (None, speed) => modes.push((mode, speed.into_iter().collect())),
            (Some((known, speeds)), Some(speed)) if speeds.len() == 1 => {
                known.stiffening = known.stiffening.or(mode.stiffening);
                speeds.push(speed);
            }
            _ => {
                let given = format!("{} twice", mode.nodal_diameters);
                let allowed = "one mode for each number of diameters, of the disk also two speeds";
                return Err(SceneError::refused(path(COLUMNS[0]), given, allowed));
            }
        }
    }
    for (mode, speeds) in found[1].iter_mut().filter(|(_, speeds)| !speeds.is_empty()) {
        let name = format!("disk, {} nodal diameters, frequency_hz", mode.nodal_diameters);
        let (rest, stiffening) = frequency_at_rest(&name, speeds, mode.stiffening)?;
        (mode.frequency_hz, mode.stiffening) = (digits(rest), stiffening.map(digits));
    }
    Ok(found.map(|modes| modes.into_iter().map(|(mode, _)| mode).collect()))
}

/// The name of a column as keys are written: `frequency_hz` for `Frequency [Hz]`.
fn column_name(written: &str) -> String {
    let lower = written.to_lowercase().replace('%', " percent ");
    let words = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let name = words.collect::<Vec<_>>().join("_");
    let name = name.strip_prefix("rotor_").unwrap_or(&name);
    match name {
        "nodal_diameter" => "nodal_diameters",
        "frequency" => "frequency_hz",
        "mass" | "mass_kg" | "modal_mass" => "modal_mass_kg",
        "rpm" | "speed_r_min" | "speed_u_min" => "speed_rpm",
        "damping" => DAMPING,
        "damping_percent" => DAMPING_PERCENT,
        other => other,
    }
    .to_string()
}

/// What a line of the table is of.
const STRUCTURE: &str = "structure";
/// What a mode needs.
const COLUMNS: [&str; 3] = ["nodal_diameters", "frequency_hz", "modal_mass_kg"];
/// Its damping ratio, if it has one: a number, or in per cent.
const DAMPING: &str = "damping_ratio";
const DAMPING_PERCENT: &str = "damping_ratio_percent";
/// What a mode of the disk may have: the speed of its frequency, with the unit of bare numbers,
const SPEEDS: [(&str, &str); 5] = [
    ("speed_rpm", "rpm"),
    ("speed_1_min", "rpm"),
    ("speed_rad_s", "rad/s"),
    ("speed_hz", "Hz"),
    ("speed", ""),
];
/// and what it stiffens by.
pub(super) const STIFFENING: &str = "centrifugal_stiffening";

impl Family {
    /// A mode from the texts of its diameters, frequency and mass, and its damping ratio;
    /// `path` names each for a refusal.
    ///
    /// # Errors
    /// The first that is not allowed.
    pub fn read(
        [diameters, frequency, mass]: [&str; 3],
        damping: Option<&str>,
        path: &dyn Fn(&str) -> String,
    ) -> Result<Self, SceneError> {
        let whole = keys::find(keys::DIAMETERS)?;
        let most = match whole.allowed {
            Allowed::Whole { max, .. } => max,
            _ => u64::MAX,
        };
        let [of_diameters, of_frequency, of_mass] = COLUMNS.map(path);
        let read = diameters.trim().parse().ok().filter(|n| u64::from(*n) <= most);
        let refused = || SceneError::refused(of_diameters, diameters, whole.allowed.to_string());
        let ratio = |text: &str| number_of(&path(DAMPING), text, keys::find(keys::CASING_DAMPING)?);
        Ok(Self {
            nodal_diameters: read.ok_or_else(refused)?,
            frequency_hz: hertz_of(&of_frequency, frequency)?,
            modal_mass_kg: number_of(&of_mass, mass, keys::find(keys::CASING_MASS)?)?,
            damping_ratio: damping.map(ratio).transpose()?,
            stiffening: None,
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
        let [casing, disk] = read_modes(&table).unwrap();
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
        let expected = read_modes(
            "structure,nodal_diameters,frequency_hz,modal_mass_kg,damping_ratio\n\
             casing,4,310.7,3.1,0.01\ndisk,4,151.3,5.5,\n",
        );
        for (separator, comma) in [(";", ","), ("\t", ","), (";", "."), (",", ".")] {
            let table = "\u{feff}# of the rig\r\n\r\nStructure;Nodal diameters;Frequency [Hz];\
                         \"Modal mass (kg)\";Damping ratio;Remark\r\n\
                         Casing;4;310.7;3.1;0.01;\r\ndisk;4;151.3;5.5;;\"left; or right\"\r\n;;;;;\r\n";
            let table = table.replace('.', comma).replace("left;", "left").replace(';', separator);
            assert_eq!(read_modes(&table), expected, "{table}");
        }
    }

    #[test]
    fn units_in_the_names_of_columns_are_heard() {
        let of = |head: &str, row: &str| read_modes(&format!("{head}\ncasing,4,310,3,\n{row}\n"));
        let head = "structure,nodal diameter,frequency,mass [kg]";
        let ratio = |name: &str, cell: &str| {
            let [_, disk] =
                of(&format!("{head},{name}"), &format!("bladed disk,4,151,5,{cell}")).unwrap();
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
            strange.starts_with("the first line = speed_m_s: allowed is Speed with"),
            "{strange}"
        );
    }

    #[test]
    fn a_table_is_read_and_what_is_wrong_has_its_line() {
        let head = "structure,nodal_diameters,frequency_hz,modal_mass_kg,damping_ratio\n";
        let text =
            format!("# of the rig\n{head}casing, 3, 139.8, 2.0, 0.05\ndisk,3,45.6,9166 g,\n");
        let [casing, disk] = read_modes(&text).unwrap();
        assert_eq!((casing[0].frequency_hz, casing[0].damping_ratio), (139.8, Some(0.05)));
        assert_eq!((disk[0].modal_mass_kg, disk[0].damping_ratio), (9.166, None));
        for (rows, start) in [
            ("casing,3,0,2,\n", "line 2, frequency_hz = 0: allowed is a frequency above 0"),
            ("casing,3,9,2,\ncasing,3,9,2,\n", "line 3, nodal_diameters = 3 twice: allowed is one"),
            ("casing,x,9,2,\n", "line 2, nodal_diameters = x: allowed is a whole number"),
            ("casing,3,9,2 kN,\n", "line 2, modal_mass_kg = 2 kN: this is a force; it takes kg"),
            ("rotor,3,9,2,\n", "line 2, structure = rotor: allowed is casing or disk"),
        ] {
            let message = read_modes(&format!("{head}{rows}")).unwrap_err().to_string();
            assert!(message.starts_with(start), "{message}");
        }
        let message = read_modes("frequency_hz\n1\n").unwrap_err().to_string();
        assert!(
            message.starts_with("the first line = frequency_hz: allowed is structure, nodal_diam")
        );
    }
}
