//! A table: headings with names for files and words for the screen, rows of cells, and notes. It is
//! written as aligned text, CSV, a page or a screen panel. Rows are stored, or computed while they
//! are written, because all cells at once need a hundred times the memory of their numbers.

use std::borrow::Cow;
use std::io::{Result, Write};
use std::rc::Rc;

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
    rows: Rows,
    notes: Vec<String>,
}

/// Computes the rows of one item, given its index.
type RowsAt = Rc<dyn Fn(usize) -> Result<Vec<Vec<TableCell>>>>;

#[derive(Clone)]
enum Rows {
    There(Vec<Vec<TableCell>>),
    /// `count` rows in all, computed for one item after another; an item may give several.
    Made {
        count: usize,
        places: usize,
        at: RowsAt,
    },
}

impl Default for Rows {
    fn default() -> Self {
        Self::There(Vec::new())
    }
}

impl std::fmt::Debug for Rows {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::There(rows) => rows.fmt(out),
            Self::Made { count, .. } => write!(out, "{count} rows"),
        }
    }
}

impl Table {
    /// Creates an empty table with these columns.
    pub fn new<H: Into<Heading>>(headings: impl IntoIterator<Item = H>) -> Self {
        let headings = headings.into_iter().map(Into::into).collect();
        Self { headings, ..Self::default() }
    }

    /// Creates a table whose `count` rows are computed while they are written: `at` returns the
    /// rows of each of `places` items.
    pub fn made<H: Into<Heading>>(
        headings: impl IntoIterator<Item = H>,
        [places, count]: [usize; 2],
        at: impl Fn(usize) -> Result<Vec<Vec<TableCell>>> + 'static,
    ) -> Self {
        Self { rows: Rows::Made { count, places, at: Rc::new(at) }, ..Self::new(headings) }
    }

    /// Creates a table with a row for each item.
    pub fn of<T, H: Clone + Into<Heading>>(items: &[T], columns: &[Column<'_, T, H>]) -> Self {
        let mut table = Self::new(columns.iter().map(|column| column.0.clone()));
        for item in items {
            table.push(columns.iter().map(|column| (column.1)(item)).collect());
        }
        table
    }

    /// Adds a row, one cell per column, to a table of stored rows.
    pub fn push(&mut self, mut row: Vec<TableCell>) {
        row.resize(self.headings.len(), TableCell::Empty);
        if let Rows::There(rows) = &mut self.rows {
            rows.push(row);
        }
    }

    /// Applies `spell` to the headings and to the texts of stored rows.
    pub fn spelled(mut self, spell: impl Fn(&str) -> String) -> Self {
        for words in self.headings.iter_mut().filter_map(|heading| heading.words.as_mut()) {
            *words = spell(words).into();
        }
        let Rows::There(rows) = &mut self.rows else { return self };
        for cell in rows.iter_mut().flatten() {
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
        match &self.rows {
            Rows::There(rows) => rows.len(),
            Rows::Made { count, .. } => *count,
        }
    }

    /// Returns whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn each(&self, mut row: impl FnMut(&[TableCell]) -> Result<()>) -> Result<()> {
        match &self.rows {
            Rows::There(rows) => rows.iter().try_for_each(|cells| row(cells)),
            Rows::Made { places, at, .. } => (0..*places)
                .try_for_each(|place| at(place)?.iter().try_for_each(|cells| row(cells))),
        }
    }

    /// Returns the headings and rows as padded cells. The columns on the right that do not fit into
    /// `room` characters, with `apart` characters between columns, are left out.
    pub fn lines(&self, room: usize, apart: usize) -> Vec<Vec<String>> {
        let mut lines = Vec::new();
        let keep = |line| {
            lines.push(line);
            Ok(())
        };
        // Only computed rows can fail.
        let _ = self.each_line(room, apart, keep);
        lines
    }

    fn each_line(
        &self,
        room: usize,
        apart: usize,
        mut told: impl FnMut(Vec<String>) -> Result<()>,
    ) -> Result<()> {
        let mut layout = Layout::of(&self.headings);
        self.each(|row| {
            layout.meet(row);
            Ok(())
        })?;
        let mut used = 0;
        layout.columns.retain(|(_, _, width, _)| {
            used += width + apart;
            used <= room.saturating_add(apart)
        });
        told(layout.headings())?;
        self.each(|row| told(layout.line(row)))
    }

    /// Writes the columns that have a name in files as CSV: a header line, then numbers that read
    /// back exactly.
    ///
    /// # Errors
    /// The writer failed, or a row could not be computed.
    pub fn write_csv(&self, out: &mut dyn Write) -> Result<()> {
        let mut csv = csv::Writer::from_writer(out);
        csv.write_record(self.headings.iter().filter_map(|heading| heading.name.as_deref()))?;
        self.each(|row| {
            let cells = row.iter().zip(&self.headings);
            let filed = cells.filter(|(_, heading)| heading.name.is_some());
            Ok(csv.write_record(filed.map(|(cell, _)| cell.in_csv()))?)
        })?;
        csv.flush()
    }

    /// Writes aligned text and the notes: numbers to the right, words to the left, `-` for a
    /// missing number. Computed rows are computed twice, first to measure the columns.
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
            self.each_line(room, APART, |line| writeln!(out, "{}", line.join(&apart).trim_end()))?;
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

#[cfg(test)]
mod made_table_tests {
    use super::*;

    const COLUMNS: &[Column<'_, f64>] =
        &[("x_m", |x| (*x).into()), ("word", |x| if *x > 1.0 { "large, so" } else { "" }.into())];

    fn made() -> Table {
        // Item `n` has `n` rows.
        let items = |place: usize| (0..place).map(move |k| place as f64 + k as f64 / 3.0);
        let cells = |x: f64| COLUMNS.iter().map(|column| (column.1)(&x)).collect();
        let headings = COLUMNS.iter().map(|column| column.0);
        Table::made(headings, [3, 3], move |place| Ok(items(place).map(cells).collect()))
    }

    fn told(write: impl Fn(&mut dyn Write) -> Result<()>) -> String {
        let mut text = Vec::new();
        write(&mut text).unwrap();
        String::from_utf8(text).unwrap()
    }

    #[test]
    fn it_is_written_as_a_table_of_all_rows() {
        let (made, whole) = (made(), Table::of(&[1.0, 2.0, 2.0 + 1.0 / 3.0], COLUMNS));
        assert_eq!(told(|out| made.write_csv(out)), told(|out| whole.write_csv(out)));
        assert_eq!(told(|out| made.write_text(out)), told(|out| whole.write_text(out)));
        assert_eq!((made.len(), whole.len()), (3, 3));
        let none = Table::default();
        assert!(none.is_empty() && told(|out| none.write_text(out)).is_empty());
    }

    #[test]
    fn a_row_that_cannot_be_made_is_an_error() {
        let fails = |_| Err(std::io::Error::other("no such row"));
        let failing = Table::made(["x_m"], [1, 1], fails);
        assert!(failing.write_csv(&mut Vec::new()).is_err());
        assert!(failing.write_text(&mut Vec::new()).is_err());
    }
}
