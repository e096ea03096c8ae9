//! A table: headings with names for files and words for people, rows of cells, and notes.
//! Text, CSV, the page and the screen are written from it.

use std::borrow::Cow;
use std::io::{Result, Write};

use super::line::wrapped;
use super::number::{exact, per_speed, rounded, short, speed_unit};

/// Spaces between two columns of text.
const APART: usize = 2;

/// Line width of the notes below a table.
pub const WIDTH: usize = 100;

/// One cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum TableCell {
    /// A number; a number that is not finite leaves the cell empty.
    Number(f64),
    /// A number for files, and its text for people; one that is not finite is empty in files.
    Told(f64, String),
    /// A word or two.
    Word(String),
    /// No value.
    Empty,
}

/// Columns of speeds, which text shows in the chosen unit. CSV keeps rad/s.
const SPEEDS: [&str; 3] = ["speed_rad_s", "wave_speed_rad_s", "speed [rad/s]"];

/// The heading of a column.
#[derive(Clone, Debug, PartialEq)]
pub struct Heading {
    /// Name in files, with the SI unit, such as `speed_rad_s`; `None` for a column that is only
    /// shown.
    name: Option<Cow<'static, str>>,
    /// Heading shown to people; `None` for a column that only files have.
    words: Option<Cow<'static, str>>,
    /// Whether the numbers are speeds, shown in the chosen unit.
    speeds: bool,
    /// Largest number of significant digits shown.
    digits: usize,
}

impl<S: Into<Cow<'static, str>>> From<S> for Heading {
    /// Creates a heading with the same name in files and on the screen.
    fn from(name: S) -> Self {
        let name = name.into();
        let speeds = SPEEDS.contains(&name.as_ref());
        let words = if speeds && speed_unit() == "rpm" {
            name.replace("rad_s", "rpm").replace("rad/s", "rpm").into()
        } else {
            name.clone()
        };
        Self { name: Some(name), words: Some(words), speeds, digits: DIGITS }
    }
}

/// Default number of significant digits shown.
const DIGITS: usize = 6;

impl Heading {
    /// Creates the heading of a column that files omit.
    pub fn shown(words: impl Into<Cow<'static, str>>) -> Self {
        Self { name: None, ..Self::from(words) }
    }

    /// Creates the heading of a column that only files have.
    pub fn filed(name: impl Into<Cow<'static, str>>) -> Self {
        Self { words: None, ..Self::from(name) }
    }

    /// Sets the heading shown to people.
    pub fn words(self, words: impl Into<Cow<'static, str>>) -> Self {
        Self { words: Some(words.into()), ..self }
    }

    /// Sets the largest number of significant digits shown.
    pub fn digits(self, digits: usize) -> Self {
        Self { digits, ..self }
    }

    /// Formats a cell for people.
    fn text(&self, cell: &TableCell) -> String {
        match cell {
            TableCell::Number(x) => {
                let x = if self.speeds { per_speed(*x) } else { *x };
                short(if self.digits < DIGITS { rounded(x, self.digits) } else { x })
            }
            TableCell::Told(_, text) | TableCell::Word(text) => text.clone(),
            TableCell::Empty => "-".to_string(),
        }
    }
}

impl TableCell {
    fn in_csv(&self) -> String {
        match self {
            Self::Number(x) | Self::Told(x, _) if x.is_finite() => exact(*x),
            Self::Word(word) => word.clone(),
            Self::Number(_) | Self::Told(..) | Self::Empty => String::new(),
        }
    }
}

impl From<f64> for TableCell {
    fn from(x: f64) -> Self {
        if x.is_finite() { Self::Number(x) } else { Self::Empty }
    }
}

impl<T: Into<TableCell>> From<Option<T>> for TableCell {
    fn from(known: Option<T>) -> Self {
        known.map_or(Self::Empty, T::into)
    }
}

impl From<bool> for TableCell {
    fn from(yes: bool) -> Self {
        Self::Word(yes.to_string())
    }
}

impl From<&str> for TableCell {
    fn from(word: &str) -> Self {
        Self::Word(word.to_string())
    }
}

impl From<String> for TableCell {
    fn from(word: String) -> Self {
        Self::Word(word)
    }
}

/// Writes a header line and rows as CSV. Numbers have the fewest digits that read back exactly; a
/// cell without a finite number is empty.
pub(crate) fn write_csv<R: IntoIterator<Item = TableCell>>(
    names: impl IntoIterator<Item = impl AsRef<[u8]>>,
    rows: impl IntoIterator<Item = R>,
    out: &mut dyn Write,
) -> Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(names)?;
    rows.into_iter()
        .try_for_each(|row| csv.write_record(row.into_iter().map(|cell| cell.in_csv())))?;
    csv.flush()
}

/// A column of a table: its heading, and the function that makes its cell from an item.
pub type Column<'a, T, H = &'a str> = (H, fn(&T) -> TableCell);

/// Rows under headings, with notes below.
#[derive(Clone, Debug, Default)]
pub struct Table {
    headings: Vec<Heading>,
    rows: Vec<Vec<TableCell>>,
    notes: Vec<String>,
}

impl Table {
    /// Creates an empty table with these columns.
    pub fn new<H: Into<Heading>>(headings: impl IntoIterator<Item = H>) -> Self {
        let headings = headings.into_iter().map(Into::into).collect();
        Self { headings, ..Self::default() }
    }

    /// Creates a table with a row for each item.
    pub fn of<T, H: Clone + Into<Heading>>(items: &[T], columns: &[Column<'_, T, H>]) -> Self {
        let mut table = Self::new(columns.iter().map(|column| column.0.clone()));
        for item in items {
            table.push(columns.iter().map(|column| (column.1)(item)).collect());
        }
        table
    }

    /// Adds a row, one cell for each column.
    pub fn push(&mut self, mut row: Vec<TableCell>) {
        row.resize(self.headings.len(), TableCell::Empty);
        self.rows.push(row);
    }

    /// Writes every word of it as `spell` does.
    pub fn spelled(mut self, spell: impl Fn(&str) -> String) -> Self {
        for words in self.headings.iter_mut().filter_map(|heading| heading.words.as_mut()) {
            *words = spell(words).into();
        }
        for cell in self.rows.iter_mut().flatten() {
            if let TableCell::Told(_, text) | TableCell::Word(text) = cell {
                *text = spell(text);
            }
        }
        self
    }

    /// Adds a note below the rows.
    pub fn note(&mut self, note: impl Into<String>) {
        self.notes.push(note.into());
    }

    /// Returns the notes.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Returns the headings and rows as padded cells. The columns on the right that do not fit into
    /// `room` characters, with `apart` characters between columns, are left out.
    pub fn lines(&self, room: usize, apart: usize) -> Vec<Vec<String>> {
        let mut layout = Layout::of(&self.headings);
        self.rows.iter().for_each(|row| layout.meet(row));
        let mut used = 0;
        layout.columns.retain(|(_, _, width, _)| {
            used += width + apart;
            used <= room.saturating_add(apart)
        });
        let rows = self.rows.iter().map(|row| layout.line(row));
        std::iter::once(layout.headings()).chain(rows).collect()
    }

    /// Writes the columns that have a name in files as CSV: a header line, then numbers that read
    /// back exactly.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> Result<()> {
        let mut csv = csv::Writer::from_writer(out);
        csv.write_record(self.headings.iter().filter_map(|heading| heading.name.as_deref()))?;
        for row in &self.rows {
            let cells = row.iter().zip(&self.headings);
            let filed = cells.filter(|(_, heading)| heading.name.is_some());
            csv.write_record(filed.map(|(cell, _)| cell.in_csv()))?;
        }
        csv.flush()
    }

    /// Writes aligned text: numbers to the right, words to the left, `-` for a missing
    /// number; below it the notes.
    ///
    /// # Errors
    /// As `write_csv`.
    pub fn write_text(&self, out: &mut dyn Write) -> Result<()> {
        self.write_text_in(usize::MAX, out)
    }

    /// As [`Table::write_text`], with only the columns that fit into `room` characters.
    ///
    /// # Errors
    /// As `write_csv`.
    pub fn write_text_in(&self, room: usize, out: &mut dyn Write) -> Result<()> {
        if !self.headings.is_empty() {
            let apart = " ".repeat(APART);
            for line in self.lines(room, APART) {
                writeln!(out, "{}", line.join(&apart).trim_end())?;
            }
        }
        let notes = self.notes.iter().flat_map(|note| wrapped(note, WIDTH));
        notes.into_iter().try_for_each(|line| writeln!(out, "{line}"))
    }
}

/// The columns of a table as shown; their widths grow with the cells measured.
#[derive(Clone, Debug)]
struct Layout {
    /// For each shown column: index in the table, heading, width, and whether it contains words,
    /// which are aligned to the left.
    columns: Vec<(usize, Heading, usize, bool)>,
}

impl Layout {
    fn of(headings: &[Heading]) -> Self {
        let shown = headings.iter().enumerate().filter_map(|(place, heading)| {
            let width = heading.words.as_ref()?.chars().count();
            Some((place, heading.clone(), width, false))
        });
        Self { columns: shown.collect() }
    }

    /// Widens the columns to fit a row.
    fn meet(&mut self, row: &[TableCell]) {
        for (place, heading, width, word) in &mut self.columns {
            let Some(cell) = row.get(*place) else { continue };
            *width = (*width).max(heading.text(cell).chars().count());
            *word |= matches!(cell, TableCell::Word(_));
        }
    }

    fn headings(&self) -> Vec<String> {
        let words = |heading: &Heading| heading.words.as_deref().unwrap_or_default().to_string();
        self.columns
            .iter()
            .map(|(_, heading, width, left)| pad(words(heading), *width, *left))
            .collect()
    }

    fn line(&self, row: &[TableCell]) -> Vec<String> {
        let cell = |(place, heading, width, left): &(usize, Heading, usize, bool)| {
            pad(row.get(*place).map_or_else(String::new, |cell| heading.text(cell)), *width, *left)
        };
        self.columns.iter().map(cell).collect()
    }
}

fn pad(text: String, width: usize, left: bool) -> String {
    if left { format!("{text:<width$}") } else { format!("{text:>width$}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let mut table = Table::new(["speed_rad_s", "state"]);
        table.push(vec![(1.0 / 3.0).into(), "locked, a".into()]);
        table.push(vec![f64::NAN.into()]);
        table
    }

    #[test]
    fn csv_keeps_every_digit_and_leaves_no_figure_empty() {
        let mut out = Vec::new();
        table().write_csv(&mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert_eq!(text, "speed_rad_s,state\n0.3333333333333333,\"locked, a\"\n,\n");
    }

    #[test]
    fn people_and_files_have_columns_of_their_own() {
        let headings = [
            Heading::from("value_n").words("value").digits(2),
            Heading::filed("exact"),
            Heading::shown(""),
        ];
        let mut table = Table::new(headings);
        table.push(vec![1.234.into(), 5.0.into(), "wrong".into()]);
        table.push(vec![TableCell::Told(2000.0, "2 kN".into()), 6.0.into()]);
        table.note("one note");
        let written = |write: fn(&Table, &mut dyn Write) -> Result<()>| {
            let mut out = Vec::new();
            write(&table, &mut out).unwrap();
            String::from_utf8(out).unwrap()
        };
        assert_eq!(written(Table::write_csv), "value_n,exact\n1.234,5\n2000,6\n");
        let text = "value\n  1.2  wrong\n 2 kN  -\none note\n";
        assert_eq!(written(Table::write_text), text);
        assert_eq!(table.lines(7, 2)[1], ["  1.2"]);
    }

    #[test]
    fn text_is_aligned() {
        let mut out = Vec::new();
        table().write_text(&mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert_eq!(text, "speed_rad_s  state\n   0.333333  locked, a\n          -  -\n");
    }
}
