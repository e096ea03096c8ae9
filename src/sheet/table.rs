//! A table: headings with names for files and words for people, rows of cells, and notes.
//! Text, CSV, JSON, the page and the screen are written from it.

use std::borrow::Cow;
use std::io::{Result, Write};

use serde::{Serialize, Serializer};
use serde_json::{Value, json};

use super::line::wrapped;
use super::number::{exact, per_speed, rounded, short, speed_unit};

/// Number of spaces between two columns of the text.
const APART: usize = 2;

/// Width to which the notes below a table and the sentences of reports are wrapped \[characters\].
pub const WIDTH: usize = 100;

/// One cell of a table; the default is an empty one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TableCell {
    /// Value in files, with numbers in SI units: `null`, which CSV leaves empty and the screen shows as
    /// `-`, for no value and for a number that is not finite.
    pub(super) value: Value,
    /// Text on the screen, where it does not follow from the value.
    text: Option<String>,
}

/// Names of columns of rotor or wave speeds, which text shows in the unit the user chose. Files keep
/// rad/s.
const SPEEDS: [&str; 2] = ["speed_rad_s", "wave_speed_rad_s"];

/// The heading of a column.
#[derive(Clone, Debug, PartialEq)]
pub struct Heading {
    /// Name in files, with the SI unit, such as `speed_rad_s`; `None` for a column that is only
    /// shown.
    name: Option<Cow<'static, str>>,
    /// Heading on the screen; `None` for a column that only files have.
    words: Option<Cow<'static, str>>,
    /// Whether the numbers are speeds \[rad/s\], which the screen shows in the unit the user chose.
    speeds: bool,
}

impl<S: Into<Cow<'static, str>>> From<S> for Heading {
    /// Creates a heading with the same name in files and on the screen, where a speed has the unit
    /// that the user chose.
    fn from(name: S) -> Self {
        let name = name.into();
        let speeds = SPEEDS.contains(&name.as_ref());
        let words = if speeds && speed_unit() == "rpm" {
            name.replace("rad_s", "rpm").into()
        } else {
            name.clone()
        };
        Self { name: Some(name), words: Some(words), speeds }
    }
}

impl Heading {
    /// Creates the heading of a column that files omit.
    pub fn shown(words: impl Into<Cow<'static, str>>) -> Self {
        Self { name: None, ..Self::from(words) }
    }

    /// Creates the heading of a column that only files have.
    pub fn filed(name: impl Into<Cow<'static, str>>) -> Self {
        Self { words: None, ..Self::from(name) }
    }

    /// Sets the heading on the screen.
    pub fn words(self, words: impl Into<Cow<'static, str>>) -> Self {
        Self { words: Some(words.into()), ..self }
    }

    /// Formats a cell of this column for the screen.
    fn text(&self, cell: &TableCell) -> String {
        match (&cell.text, &cell.value, cell.number()) {
            (Some(text), ..) | (None, Value::String(text), _) => text.clone(),
            (None, _, Some(x)) => short(if self.speeds { per_speed(x) } else { x }),
            (None, Value::Null, None) => "-".to_string(),
            (None, value, None) => value.to_string(),
        }
    }
}

impl TableCell {
    /// Creates a number for files with its text for the screen.
    pub fn told(x: f64, text: String) -> Self {
        Self { text: Some(text), ..Self::from(x) }
    }

    /// Creates a number that the screen shows with at most `digits` significant digits.
    pub fn digits(x: Option<f64>, digits: usize) -> Self {
        x.map(|x| Self::told(x, short(rounded(x, digits)))).unwrap_or_default()
    }

    /// Returns the number in the cell; `None` for a whole one, which counts something.
    fn number(&self) -> Option<f64> {
        self.value.as_f64().filter(|_| self.value.is_f64())
    }

    fn in_csv(&self) -> String {
        match (&self.value, self.number()) {
            (_, Some(x)) => exact(x),
            (Value::String(word), _) => word.clone(),
            (Value::Null, _) => String::new(),
            (value, _) => value.to_string(),
        }
    }
}

impl<T: Serialize> From<T> for TableCell {
    fn from(content: T) -> Self {
        Self { value: json!(content), text: None }
    }
}

/// Lists columns of a table: the name of a field of the items, or a name and the function that makes
/// the cell.
macro_rules! columns {
    (@ $name:ident) => { (stringify!($name), |item| item.$name.into()) };
    (@ $name:ident $cell:expr) => { (stringify!($name), $cell) };
    ($($name:ident $(: $cell:expr)?),* $(,)?) => {
        [$($crate::sheet::table::columns!(@ $name $($cell)?)),*]
    };
}
pub(crate) use columns;

/// A column of a table: its heading, and the function that makes its cell from an item.
pub type Column<'a, T, H = &'a str> = (H, fn(&T) -> TableCell);

/// Rows under headings, with notes below. A row is made each time it is written, so that a long
/// table takes no more memory than the items it is made of.
pub struct Table<'a> {
    headings: Vec<Heading>,
    count: usize,
    row: Box<dyn Fn(usize) -> Vec<TableCell> + 'a>,
    notes: Vec<String>,
    /// Largest width of the text \[characters\]; columns on the right that do not fit are left out.
    room: usize,
}

impl<'a> Table<'a> {
    /// Creates a table of `count` rows; `row` returns the cells of a row, one for each heading.
    pub fn new<H: Into<Heading>>(
        headings: impl IntoIterator<Item = H>,
        count: usize,
        row: impl Fn(usize) -> Vec<TableCell> + 'a,
    ) -> Self {
        let headings = headings.into_iter().map(Into::into).collect();
        Self { headings, count, row: Box::new(row), notes: Vec::new(), room: usize::MAX }
    }

    /// Creates a table of these rows.
    pub fn with_rows<H: Into<Heading>>(
        headings: impl IntoIterator<Item = H>,
        rows: Vec<Vec<TableCell>>,
    ) -> Self {
        Self::new(headings, rows.len(), move |row| rows[row].clone())
    }

    /// Creates a table with a row for each item.
    pub fn of<T: 'a, H: Clone + Into<Heading> + 'a>(
        items: impl AsRef<[T]> + 'a,
        columns: impl AsRef<[(H, fn(&T) -> TableCell)]> + 'a,
    ) -> Self {
        let headings: Vec<H> = columns.as_ref().iter().map(|column| column.0.clone()).collect();
        let count = items.as_ref().len();
        Self::new(headings, count, move |row| {
            let item = &items.as_ref()[row];
            columns.as_ref().iter().map(|column| (column.1)(item)).collect()
        })
    }

    /// Leaves the columns from `count` on to files.
    pub fn shown(mut self, count: usize) -> Self {
        self.headings.iter_mut().skip(count).for_each(|heading| heading.words = None);
        self
    }

    /// Limits the width of the text \[characters\].
    pub fn within(self, room: usize) -> Self {
        Self { room, ..self }
    }

    /// Adds a note below the rows.
    pub fn note(&mut self, note: impl Into<String>) {
        self.notes.push(note.into());
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Returns whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Iterates over the names of the columns in files.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.headings.iter().filter_map(|heading| heading.name.as_deref())
    }

    /// Iterates over the rows.
    fn rows(&self) -> impl Iterator<Item = Vec<TableCell>> + '_ {
        (0..self.count).map(&self.row)
    }

    /// Returns two columns by their names in files; `NaN` stands for a cell without a number, and for
    /// a column that there is not.
    pub fn numbers(&self, names: [&str; 2]) -> Vec<(f64, f64)> {
        let places = names.map(|name| {
            self.headings.iter().position(|heading| heading.name.as_deref() == Some(name))
        });
        let number = |row: &[TableCell], place: Option<usize>| {
            place.and_then(|place| row.get(place)?.number()).unwrap_or(f64::NAN)
        };
        self.rows().map(|row| (number(&row, places[0]), number(&row, places[1]))).collect()
    }

    /// Returns the headings and then the rows as cells padded to the width of their column, with
    /// their text as `spell` writes it, for example in ASCII. The columns on the right that do not
    /// fit into `room` characters, with `apart` spaces between columns, are left out.
    pub fn lines(
        &self,
        room: usize,
        apart: usize,
        spell: impl Fn(&str) -> String,
    ) -> Vec<Vec<String>> {
        let headings = self.headings.iter().enumerate();
        let shown: Vec<(usize, &Heading)> =
            headings.filter(|(_, heading)| heading.words.is_some()).collect();
        let words = shown.iter().filter_map(|(_, heading)| heading.words.as_deref());
        let mut lines: Vec<Vec<String>> = vec![words.map(&spell).collect()];
        // Words are aligned to the left.
        let mut left = vec![false; shown.len()];
        for row in self.rows() {
            for (left, (place, _)) in left.iter_mut().zip(&shown) {
                *left |= row[*place].value.is_string() || row[*place].value.is_boolean();
            }
            let text = |(place, heading): &(usize, &Heading)| spell(&heading.text(&row[*place]));
            lines.push(shown.iter().map(text).collect());
        }
        let mut used = 0;
        for (column, left) in left.into_iter().enumerate() {
            let widths = lines.iter().map(|line| line[column].chars().count());
            let width = widths.max().unwrap_or(0);
            used += width + apart;
            if used > room.saturating_add(apart) {
                lines.iter_mut().for_each(|line| line.truncate(column));
                break;
            }
            for cell in lines.iter_mut().map(|line| &mut line[column]) {
                *cell = if left { format!("{cell:<width$}") } else { format!("{cell:>width$}") };
            }
        }
        lines
    }

    /// Writes the columns that have a name in files as CSV: a header line, then numbers that read
    /// back exactly.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> Result<()> {
        let mut csv = csv::Writer::from_writer(out);
        csv.write_record(self.headings.iter().filter_map(|heading| heading.name.as_deref()))?;
        for row in self.rows() {
            let cells = row.iter().zip(&self.headings);
            let filed = cells.filter(|(_, heading)| heading.name.is_some());
            csv.write_record(filed.map(|(cell, _)| cell.in_csv()))?;
        }
        csv.flush()
    }

    /// Writes aligned text: numbers to the right, words to the left, `-` for a missing number; and
    /// below it the notes.
    ///
    /// # Errors
    /// As `write_csv`.
    pub fn write_text(&self, out: &mut dyn Write) -> Result<()> {
        if !self.headings.is_empty() {
            let apart = " ".repeat(APART);
            for line in self.lines(self.room, APART, str::to_string) {
                writeln!(out, "{}", line.join(&apart).trim_end())?;
            }
        }
        let notes = self.notes.iter().flat_map(|note| wrapped(note, WIDTH));
        notes.into_iter().try_for_each(|line| writeln!(out, "{line}"))
    }
}

/// Writes the columns that have a name in files as a list of objects, one for each row.
impl Serialize for Table<'_> {
    fn serialize<S: Serializer>(&self, out: S) -> std::result::Result<S::Ok, S::Error> {
        let field = |(heading, cell): (&Heading, &TableCell)| {
            Some((heading.name.as_deref()?.to_string(), cell.value.clone()))
        };
        let object = |row: Vec<TableCell>| -> Value {
            Value::Object(self.headings.iter().zip(&row).filter_map(field).collect())
        };
        out.collect_seq(self.rows().map(object))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_and_files_have_columns_of_their_own() {
        let headings =
            [Heading::from("value_n").words("value"), Heading::filed("exact"), Heading::shown("")];
        let first = vec![TableCell::digits(Some(1.234), 2), 5.0.into(), "wrong".into()];
        let second =
            vec![TableCell::told(2000.0, "2 kN".into()), f64::NAN.into(), TableCell::default()];
        let mut table = Table::with_rows(headings, vec![first, second]);
        table.note("one note");
        let (mut csv, mut lines) = (Vec::new(), Vec::new());
        table.write_csv(&mut csv).unwrap();
        table.write_text(&mut lines).unwrap();
        assert_eq!(String::from_utf8(csv).unwrap(), "value_n,exact\n1.234,5\n2000,\n");
        let json = r#"[{"value_n":1.234,"exact":5.0},{"value_n":2000.0,"exact":null}]"#;
        assert_eq!(serde_json::to_string(&table).unwrap(), json);
        let text = "value\n  1.2  wrong\n 2 kN  -\none note\n";
        assert_eq!(String::from_utf8(lines).unwrap(), text);
        assert_eq!(table.lines(7, 2, str::to_string)[1], ["  1.2"]);
    }
}
