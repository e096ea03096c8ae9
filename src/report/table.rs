//! A table of named columns: written as aligned text or as CSV; of rows that are there
//! (`Table`), or that are made as they are written (`MadeTable`): all cells at once take a
//! hundred times the memory of the numbers that they show.

use std::io::{Result, Write};
use std::rc::Rc;

use super::number::{exact, per_speed, short, speed_unit};

/// One cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum TableCell {
    /// A number; what is no finite number is left empty.
    Number(f64),
    /// A word or two.
    Word(String),
    /// No such figure.
    Empty,
}

/// Columns of speeds, which text tells in the unit of speeds. CSV has them as they are.
const SPEEDS: [&str; 5] =
    ["speed_rad_s", "wave_speed_rad_s", "appears_rad_s", "vanishes_rad_s", "speed [rad/s]"];

impl TableCell {
    fn in_text(&self, is_speed: bool) -> String {
        match self {
            Self::Number(x) if is_speed => short(per_speed(*x)),
            Self::Number(x) => short(*x),
            Self::Word(word) => word.clone(),
            Self::Empty => "-".to_string(),
        }
    }

    fn in_csv(self) -> String {
        match self {
            Self::Number(x) => exact(x),
            Self::Word(word) => word,
            Self::Empty => String::new(),
        }
    }
}

impl From<f64> for TableCell {
    fn from(x: f64) -> Self {
        if x.is_finite() { Self::Number(x) } else { Self::Empty }
    }
}

impl From<Option<f64>> for TableCell {
    fn from(x: Option<f64>) -> Self {
        x.map_or(Self::Empty, Self::from)
    }
}

impl From<bool> for TableCell {
    fn from(yes: bool) -> Self {
        Self::Word(yes.to_string())
    }
}

impl From<Option<bool>> for TableCell {
    fn from(known: Option<bool>) -> Self {
        known.map_or(Self::Empty, Self::from)
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

/// Writes rows of cells as CSV, under a header line. Numbers are the shortest
/// that read back as themselves, and what is no figure is left empty.
pub(crate) fn write_csv<R: IntoIterator<Item = TableCell>>(
    names: impl IntoIterator<Item = impl AsRef<[u8]>>,
    rows: impl IntoIterator<Item = R>,
    out: &mut dyn Write,
) -> Result<()> {
    let mut rows = rows.into_iter();
    write_csv_of(names, |row| rows.try_for_each(row), out)
}

/// As `write_csv`, of rows that `each` hands over one by one.
pub(super) fn write_csv_of<R: IntoIterator<Item = TableCell>>(
    names: impl IntoIterator<Item = impl AsRef<[u8]>>,
    each: impl FnOnce(&mut dyn FnMut(R) -> Result<()>) -> Result<()>,
    out: &mut dyn Write,
) -> Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(names)?;
    each(&mut |row| Ok(csv.write_record(row.into_iter().map(TableCell::in_csv))?))?;
    csv.flush()
}

/// A column of a table: its name, and what it shows of an item.
pub type Column<'a, T> = (&'a str, fn(&T) -> TableCell);

/// Rows under named columns; names carry the unit, as in `speed_rad_s`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    names: Vec<String>,
    rows: Vec<Vec<TableCell>>,
}

impl Table {
    /// An empty table with these columns.
    #[must_use]
    pub fn new<S: Into<String>>(names: impl IntoIterator<Item = S>) -> Self {
        Self { names: names.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    /// A row for each item, with these columns: a name, and what it shows.
    #[must_use]
    pub fn of<T>(items: &[T], columns: &[Column<'_, T>]) -> Self {
        let mut table = Self::new(columns.iter().map(|column| column.0));
        for item in items {
            table.push(columns.iter().map(|column| (column.1)(item)).collect());
        }
        table
    }

    /// Adds a row, one cell for each column.
    pub fn push(&mut self, mut row: Vec<TableCell>) {
        row.resize(self.names.len(), TableCell::Empty);
        self.rows.push(row);
    }

    /// Its names and rows.
    pub(super) fn into_parts(self) -> (Vec<String>, Vec<Vec<TableCell>>) {
        (self.names, self.rows)
    }

    /// How many rows there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Writes CSV: a header line, then numbers that read back as themselves.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> Result<()> {
        write_csv(&self.names, self.rows.iter().map(|row| row.iter().cloned()), out)
    }

    /// Writes aligned text: numbers of six digits to the right, words to the
    /// left, `-` if there is no number.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write_text(&self, out: &mut dyn Write) -> Result<()> {
        let mut layout = Layout::of(&self.names);
        self.rows.iter().for_each(|row| layout.meet(row));
        layout.write_names(&self.names, out)?;
        self.rows.iter().try_for_each(|row| layout.write(row, out))
    }
}

/// The columns of aligned text, from the cells that they will have.
pub(super) struct Layout {
    widths: Vec<usize>,
    words: Vec<bool>,
    speeds: Vec<bool>,
}

/// The name of a column in text.
fn shown(name: &str) -> String {
    if !SPEEDS.contains(&name) || speed_unit() != "rpm" {
        return name.to_string();
    }
    name.replace("rad_s", "rpm").replace("rad/s", "rpm")
}

impl Layout {
    /// Of columns with these names.
    pub fn of(names: &[String]) -> Self {
        let widths = names.iter().map(|name| shown(name).chars().count()).collect();
        let speeds = names.iter().map(|name| SPEEDS.contains(&name.as_str())).collect();
        Self { widths, words: vec![false; names.len()], speeds }
    }

    /// Makes room for a row.
    pub fn meet(&mut self, row: &[TableCell]) {
        let columns = self.widths.iter_mut().zip(&mut self.words).zip(&self.speeds);
        for (cell, ((width, word), speed)) in row.iter().zip(columns) {
            *width = (*width).max(cell.in_text(*speed).chars().count());
            *word |= matches!(cell, TableCell::Word(_));
        }
    }

    /// Writes the names, if there are any.
    pub fn write_names(&self, names: &[String], out: &mut dyn Write) -> Result<()> {
        if names.is_empty() { Ok(()) } else { self.line(names.iter().map(|name| shown(name)), out) }
    }

    /// Writes a row.
    pub fn write(&self, row: &[TableCell], out: &mut dyn Write) -> Result<()> {
        let cells = row.iter().zip(&self.speeds).map(|(cell, speed)| cell.in_text(*speed));
        self.line(cells, out)
    }

    fn line(&self, row: impl Iterator<Item = String>, out: &mut dyn Write) -> Result<()> {
        let mut text = String::new();
        for ((entry, &width), &word) in row.zip(&self.widths).zip(&self.words) {
            let padded = if word { format!("{entry:<width$}") } else { format!("{entry:>width$}") };
            text.push_str(&padded);
            text.push_str("  ");
        }
        writeln!(out, "{}", text.trim_end())
    }
}

/// The rows of one place of a list.
type RowsAt = Rc<dyn Fn(usize) -> Result<Vec<Vec<TableCell>>>>;

/// Rows under named columns, made place by place of a list.
#[derive(Clone)]
pub struct MadeTable {
    names: Vec<String>,
    places: usize,
    rows: usize,
    at: RowsAt,
}

impl std::fmt::Debug for MadeTable {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "MadeTable({} rows of {:?})", self.rows, self.names)
    }
}

impl From<Table> for MadeTable {
    fn from(table: Table) -> Self {
        let (names, rows) = table.into_parts();
        Self::named(names, rows.len(), move |place| rows.get(place).cloned().unwrap_or_default())
    }
}

impl MadeTable {
    /// With these columns, and so many rows over all of so many places, of which each has
    /// these items.
    pub fn of<T: 'static>(
        columns: &'static [Column<'static, T>],
        [places, rows]: [usize; 2],
        items: impl Fn(usize) -> Result<Vec<T>> + 'static,
    ) -> Self {
        let names = columns.iter().map(|column| column.0.to_string()).collect();
        let cells = |item: &T| columns.iter().map(|column| (column.1)(item)).collect();
        let at: RowsAt = Rc::new(move |place| Ok(items(place)?.iter().map(cells).collect()));
        Self { names, places, rows, at }
    }

    /// With these columns, and a row for each item.
    pub fn over<T: Clone + 'static>(
        columns: &'static [Column<'static, T>],
        items: &Rc<Vec<T>>,
    ) -> Self {
        let (count, items) = (items.len(), Rc::clone(items));
        Self::of(columns, [count; 2], move |place| {
            Ok(items.get(place).cloned().into_iter().collect())
        })
    }

    /// With columns of these names, and a row for each place, which has these cells.
    pub fn named(
        names: Vec<String>,
        rows: usize,
        cells: impl Fn(usize) -> Vec<TableCell> + 'static,
    ) -> Self {
        Self { names, places: rows, rows, at: Rc::new(move |place| Ok(vec![cells(place)])) }
    }

    /// How many rows there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    fn each(&self, mut row: impl FnMut(Vec<TableCell>) -> Result<()>) -> Result<()> {
        (0..self.places).try_for_each(|place| (self.at)(place)?.into_iter().try_for_each(&mut row))
    }

    /// As [`Table::write_csv`].
    ///
    /// # Errors
    /// An error of the writer, or of what makes a row.
    pub fn write_csv(&self, out: &mut dyn Write) -> Result<()> {
        write_csv_of(&self.names, |row| self.each(row), out)
    }

    /// As [`Table::write_text`]; every row is made twice.
    ///
    /// # Errors
    /// As `write_csv`.
    pub fn write_text(&self, out: &mut dyn Write) -> Result<()> {
        let mut layout = Layout::of(&self.names);
        self.each(|row| {
            layout.meet(&row);
            Ok(())
        })?;
        layout.write_names(&self.names, out)?;
        self.each(|row| layout.write(&row, out))
    }
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

    fn made() -> MadeTable {
        // Of each place none, one or two.
        let items = |place: usize| (0..place).map(|k| place as f64 + k as f64 / 3.0).collect();
        MadeTable::of(COLUMNS, [3, 3], move |place| Ok(items(place)))
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
        let kept = MadeTable::from(whole.clone());
        assert_eq!((made.len(), kept.len()), (3, 3));
        assert_eq!(told(|out| kept.write_text(out)), told(|out| whole.write_text(out)));
        let none = MadeTable::from(Table::default());
        assert!(none.is_empty() && told(|out| none.write_text(out)).is_empty());
    }

    #[test]
    fn a_row_that_cannot_be_made_is_an_error() {
        let fails = |_| Err(std::io::Error::other("no such row"));
        let failing = MadeTable::of(COLUMNS, [1, 1], fails);
        assert!(failing.write_csv(&mut Vec::new()).is_err());
        assert!(failing.write_text(&mut Vec::new()).is_err());
    }
}
