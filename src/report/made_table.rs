//! A table whose rows are made as they are written: all its cells at once take a hundred
//! times the memory of the numbers that they show.

use std::io::{Result, Write};
use std::rc::Rc;

use super::table::{Column, Layout, Table, TableCell, write_csv_of};

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
