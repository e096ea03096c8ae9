//! The first line of a table of modes: the value and the unit of each column.

use anyhow::{Result, bail};
use csv::StringRecord;
use rubscope_solver::scene::units::UnitError;
use rubscope_solver::scene::{Quantity, SceneError};

pub(super) const STRUCTURE: &str = "structure";
pub(super) const MODE: [&str; 3] = ["nodal_diameters", "frequency_hz", "modal_mass_kg"];
pub(super) const DAMPING: &str = "damping_ratio";
pub(super) const SPEED: &str = "speed";
/// Optional column of the disk; also the name of the key in a scene file.
pub(super) const STIFFENING: &str = "centrifugal_stiffening";

/// A value of a mode that a column can have: its name in messages; the quantity of its unit, or
/// `None` if it has no unit, so that brackets may contain any remark; and the names of the column in
/// lower case, the most specific one first.
type Meaning = (&'static str, Option<Quantity>, &'static str);

const MEANINGS: [Meaning; 7] = [
    (STRUCTURE, None, "structure, component, part"),
    (MODE[0], None, "nodal diameters, nodal diameter, nd, n d, harmonic index, harmonic"),
    (MODE[1], Some(Quantity::Speed), "natural frequency, eigenfrequency, frequency, freq"),
    (MODE[2], Some(Quantity::Mass), "modal mass, generalized mass, generalised mass, mass"),
    (DAMPING, Some(Quantity::Plain), "damping ratio, modal damping, damping"),
    (
        SPEED,
        Some(Quantity::Speed),
        "rotor speed, rotational speed, rotational velocity, speed, rpm",
    ),
    (STIFFENING, Some(Quantity::Plain), "centrifugal stiffening"),
];

/// Values that a table may leave out.
const OPTIONAL: [&str; 3] = [DAMPING, SPEED, STIFFENING];

/// Where a value stands in the records, and the unit of its bare numbers.
struct Column {
    name: &'static str,
    unit: String,
    place: usize,
}

/// The columns of a table.
pub(super) struct Columns {
    columns: Vec<Column>,
    /// Names of the columns that are not used.
    pub unused: Vec<String>,
}

impl Columns {
    /// Finds the columns in the first line. `line` is how messages call this line.
    ///
    /// # Errors
    /// A column is missing, occurs twice, or has a unit of another quantity.
    pub fn of(names: &StringRecord, line: &str) -> Result<Self> {
        let named = names.iter().enumerate();
        let known = named.clone().filter_map(|(place, name)| Some((place, name, read(name)?)));
        let known: Vec<_> = known.collect();
        // A column with a wrong unit counts only if there is no other one of its value.
        let rank = |read: &Read| (read.unit.is_err(), read.rank);
        let mut columns = Vec::new();
        for meaning @ (name, ..) in MEANINGS {
            let mut found: Vec<_> = known.iter().filter(|(.., read)| read.name == name).collect();
            found.sort_by_key(|(.., read)| rank(read));
            match found[..] {
                [(_, one, a), (_, two, b), ..] if rank(a) == rank(b) => {
                    bail!("{line} has two columns for {name}, {one} and {two}: leave one out")
                }
                [(place, written, read), ..] => {
                    let refused = |why| {
                        let (key, value) = (line.into(), (*written).into());
                        SceneError::Unit { key, value, why }
                    };
                    let unit = read.unit.clone().map_err(refused)?;
                    columns.push(Column { name, unit, place: *place });
                }
                [] if OPTIONAL.contains(&name) => {}
                [] => bail!(missing(meaning, names, line)),
            }
        }
        let is_used = |place| columns.iter().any(|column: &Column| column.place == place);
        let unused = named.filter(|(place, name)| !name.is_empty() && !is_used(*place));
        let unused = unused.map(|(_, name)| name.to_string()).collect();
        Ok(Self { columns, unused })
    }

    /// Returns the cell of a value, and the unit of its column; `None` for an empty cell and for a
    /// value without a column.
    pub fn cell<'a>(&self, record: &'a StringRecord, name: &str) -> Option<(&'a str, &str)> {
        let column = self.columns.iter().find(|column| column.name == name)?;
        let cell = record.get(column.place).filter(|cell| !matches!(*cell, "" | "-"))?;
        Some((cell, &column.unit))
    }
}

/// Returns whether a record can be the first line of a table: it names two values or more.
pub(super) fn is_head(record: &StringRecord) -> bool {
    let names = || record.iter().filter_map(read).map(|read| read.name);
    names().any(|name| names().any(|other| other != name))
}

/// Says that a value has no column, with the most similar name in the first line.
fn missing((name, _, understood): Meaning, names: &StringRecord, line: &str) -> String {
    let likeness = |written: &str| {
        let written = words(written);
        let each = understood.split(", ").map(|name| strsim::jaro_winkler(name, &written));
        each.fold(0.0, f64::max)
    };
    let others = names.iter().filter(|name| !name.is_empty() && read(name).is_none());
    let nearest = match others.max_by(|a, b| likeness(a).total_cmp(&likeness(b))) {
        Some(_) if names.len() == 1 => {
            "; it has one cell only: separate cells by semicolons, tabs, bars or commas".into()
        }
        Some(name) => format!("; the nearest found is {name}"),
        None => String::new(),
    };
    format!(
        "{line} has no column for {name}: understood are {understood}, with the unit in brackets \
         where there is one{nearest}"
    )
}

/// Content of a column name: the value, the rank of the name among the names of this value, and the
/// unit.
struct Read {
    name: &'static str,
    rank: usize,
    unit: Result<String, UnitError>,
}

/// Returns the words of a column name in lower case, with one space between them.
fn words(written: &str) -> String {
    let words = written.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect::<Vec<_>>().join(" ")
}

/// Reads a column name: the longest known name that it begins with, and the unit after it; `None`
/// if there is no such name or if anything but a unit follows.
fn read(written: &str) -> Option<Read> {
    // Ends of the words, from the last one on.
    let is_end = |(at, c): &(usize, char)| {
        let rest = written.get(at + c.len_utf8()..).unwrap_or_default();
        c.is_alphanumeric() && !rest.starts_with(char::is_alphanumeric)
    };
    let ends = written.char_indices().filter(is_end).map(|(at, c)| at + c.len_utf8());
    ends.rev().find_map(|end| {
        let (start, rest) = written.split_at_checked(end)?;
        let start = words(start);
        let rest = if start == "rpm" { "rpm" } else { rest };
        MEANINGS.into_iter().find_map(|meaning| {
            let (name, _, names) = meaning;
            let rank = names.split(", ").position(|known| known == start)?;
            Some(Read { name, rank, unit: unit(meaning, rest)? })
        })
    })
}

/// Reads the unit after a name, as in ` [kHz]`, `, %` or `_rpm`; `None` if it is none. Brackets
/// alone must contain one of the right quantity.
fn unit((_, wanted, names): Meaning, rest: &str) -> Option<Result<String, UnitError>> {
    let inner = rest
        .trim()
        .strip_prefix(['[', '(', '{'])
        .and_then(|rest| rest.strip_suffix([']', ')', '}']));
    let in_brackets = inner.is_some_and(|inner| !inner.contains(['[', '(', '{']));
    let parts = rest.split(|c: char| c.is_whitespace() || "_/,.:[](){}".contains(c));
    let parts = parts.filter(|part| !matches!(*part, "" | "-" | "in"));
    let unit = parts.collect::<Vec<_>>().join("/");
    let Some(wanted) = wanted else {
        return (in_brackets || unit.is_empty()).then(|| Ok(String::new()));
    };
    if unit.is_empty() || (unit == "1" && wanted == Quantity::Plain) {
        return Some(Ok(String::new()));
    }
    let one = format!("1 {unit}");
    let is_prefix = Quantity::bare(&one).is_some();
    match wanted.read(&one) {
        Ok(_) if !is_prefix => Some(Ok(unit)),
        _ if in_brackets && names.split(", ").any(|name| name == unit.to_lowercase()) => {
            Some(Ok(String::new()))
        }
        Ok(_) | Err(UnitError::NoNumber) => {
            in_brackets.then_some(Err(UnitError::Unknown { unit, wanted }))
        }
        Err(why) if in_brackets || matches!(why, UnitError::Other { .. }) => Some(Err(why)),
        Err(_) => None,
    }
}
