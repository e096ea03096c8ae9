//! The first line of a table of modes: the value and the unit of each column.

use csv::StringRecord;
use rubscope_solver::scene::units::UnitError;
use rubscope_solver::scene::{Quantity, SceneError};

use super::error::TableError;

pub(super) const STRUCTURE: &str = "structure";
pub(super) const MODE: [&str; 3] = ["nodal_diameters", "frequency_hz", "modal_mass_kg"];
pub(super) const DAMPING: &str = "damping_ratio";
pub(super) const SPEED: &str = "speed";
/// Optional column of the disk; also the name of the key in a scene file.
pub(super) const STIFFENING: &str = "centrifugal_stiffening";

/// A value of a mode that a column can have.
struct Meaning {
    /// Name in messages.
    name: &'static str,
    /// Quantity of its unit; `None` if it has no unit, so that brackets may contain any remark.
    quantity: Option<Quantity>,
    /// Names of the column in lower case, the most specific one first.
    names: &'static [&'static str],
    /// Whether a table must have the column.
    needed: bool,
}

const MEANINGS: [Meaning; 7] = [
    Meaning {
        name: STRUCTURE,
        quantity: None,
        names: &["structure", "component", "part"],
        needed: true,
    },
    Meaning {
        name: MODE[0],
        quantity: None,
        names: &["nodal diameters", "nodal diameter", "nd", "n d", "harmonic index", "harmonic"],
        needed: true,
    },
    Meaning {
        name: MODE[1],
        quantity: Some(Quantity::Speed),
        names: &["natural frequency", "eigenfrequency", "frequency", "freq"],
        needed: true,
    },
    Meaning {
        name: MODE[2],
        quantity: Some(Quantity::Mass),
        names: &["modal mass", "generalized mass", "generalised mass", "mass"],
        needed: true,
    },
    Meaning {
        name: DAMPING,
        quantity: Some(Quantity::Plain),
        names: &["damping ratio", "modal damping", "damping"],
        needed: false,
    },
    Meaning {
        name: SPEED,
        quantity: Some(Quantity::Speed),
        names: &["rotor speed", "rotational speed", "rotational velocity", "speed", "rpm"],
        needed: false,
    },
    Meaning {
        name: STIFFENING,
        quantity: Some(Quantity::Plain),
        names: &["centrifugal stiffening"],
        needed: false,
    },
];

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
    pub fn of(names: &StringRecord, line: &str) -> Result<Self, TableError> {
        let named: Vec<_> =
            names.iter().enumerate().map(|(at, name)| (at, name, read(name))).collect();
        let mut columns = Vec::new();
        for meaning in &MEANINGS {
            // A column with a wrong unit counts only if there is no other one of this value.
            let mut found: Vec<_> = named
                .iter()
                .filter_map(|(place, written, read)| Some((*place, *written, read.as_ref()?)))
                .filter(|(.., read)| read.name == meaning.name)
                .map(|(place, written, read)| {
                    ((read.unit.is_err(), read.rank), place, written, read)
                })
                .collect();
            found.sort_by_key(|(order, ..)| *order);
            match found.as_slice() {
                [(order, _, one, _), (other, _, two, _), ..] if order == other => {
                    let names = [*one, *two].map(str::to_string);
                    return Err(TableError::Twice { line: line.into(), names, name: meaning.name });
                }
                [(_, place, written, read), ..] => {
                    let unit = read.unit.clone().map_err(|why| SceneError::Unit {
                        key: line.into(),
                        value: (*written).into(),
                        why,
                    })?;
                    columns.push(Column { name: meaning.name, unit, place: *place });
                }
                [] if meaning.needed => return Err(missing(meaning, names, line)),
                [] => {}
            }
        }
        let is_used = |at: usize| columns.iter().any(|column| column.place == at);
        let unused = named.iter().filter(|(at, name, _)| !name.is_empty() && !is_used(*at));
        let unused = unused.map(|(_, name, _)| (*name).to_string()).collect();
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

/// Returns the error for a value without a column, with the most similar name in the first line.
fn missing(meaning: &Meaning, names: &StringRecord, line: &str) -> TableError {
    let likeness = |written: &str| {
        let written = words(written).join(" ");
        let each = meaning.names.iter().map(|name| strsim::jaro_winkler(name, &written));
        each.fold(0.0, f64::max)
    };
    let others = names.iter().filter(|name| !name.is_empty() && read(name).is_none());
    let nearest = others.max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let nearest = match nearest {
        Some(_) if names.len() == 1 => {
            "; it has one cell only: separate cells by semicolons, tabs, bars or commas".into()
        }
        Some(name) => format!("; the nearest found is {name}"),
        None => String::new(),
    };
    let understood = meaning.names.join(", ");
    TableError::Missing { line: line.into(), name: meaning.name, understood, nearest }
}

/// Content of a column name: the value, the rank of the name among the names of this value, and the
/// unit.
struct Read {
    name: &'static str,
    rank: usize,
    unit: Result<String, UnitError>,
}

/// Returns the words of a column name in lower case.
fn words(written: &str) -> Vec<String> {
    let words = written.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect()
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
    let mut ends: Vec<usize> = ends.collect();
    ends.reverse();
    ends.into_iter().find_map(|end| {
        let (start, rest) = written.split_at_checked(end)?;
        let start = words(start).join(" ");
        let place = |meaning: &Meaning| meaning.names.iter().position(|name| *name == start);
        let meaning = MEANINGS.iter().find(|meaning| place(meaning).is_some())?;
        let rest = if start == "rpm" { "rpm" } else { rest };
        Some(Read { name: meaning.name, rank: place(meaning)?, unit: unit(meaning, rest)? })
    })
}

/// Reads the unit after a name, as in ` [kHz]`, `, %` or `_rpm`; `None` if it is none. Brackets
/// alone must contain one of the right quantity.
fn unit(meaning: &Meaning, rest: &str) -> Option<Result<String, UnitError>> {
    let inner = rest
        .trim()
        .strip_prefix(['[', '(', '{'])
        .and_then(|rest| rest.strip_suffix([']', ')', '}']));
    let in_brackets = inner.is_some_and(|inner| !inner.contains(['[', '(', '{']));
    let parts = rest.split(|c: char| c.is_whitespace() || "_/,.:[](){}".contains(c));
    let parts = parts.filter(|part| !matches!(*part, "" | "-" | "in"));
    let unit = parts.collect::<Vec<_>>().join("/");
    let Some(wanted) = meaning.quantity else {
        return (in_brackets || unit.is_empty()).then(|| Ok(String::new()));
    };
    if unit.is_empty() || (unit == "1" && wanted == Quantity::Plain) {
        return Some(Ok(String::new()));
    }
    let one = format!("1 {unit}");
    let is_prefix = Quantity::bare(&one).is_some();
    match wanted.read(&one) {
        Ok(_) if !is_prefix => Some(Ok(unit)),
        _ if in_brackets && meaning.names.contains(&unit.to_lowercase().as_str()) => {
            Some(Ok(String::new()))
        }
        Ok(_) | Err(UnitError::NoNumber) => {
            in_brackets.then_some(Err(UnitError::Unknown { unit, wanted }))
        }
        Err(why) if in_brackets || matches!(why, UnitError::Other { .. }) => Some(Err(why)),
        Err(_) => None,
    }
}
