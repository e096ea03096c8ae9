//! Rows that are computed while they are written, for tables and JSON, because all rows at once
//! need a hundred times the memory of their numbers; and JSON objects built from parts.

use std::io;
use std::rc::Rc;

use serde::Serialize;
use serde::ser::{Error, SerializeMap, SerializeSeq, Serializer};
use serde_json::{Value, json};

use crate::report::table::{Column, Table};
use rubscope_solver::harmonic::HarmonicError;

/// Computes the rows of one item, given its index.
type RowsAt<T> = Rc<dyn Fn(usize) -> Result<Vec<T>, HarmonicError>>;

/// Rows that are computed for one item after another.
#[derive(Clone)]
pub struct Rows<T> {
    places: usize,
    count: usize,
    at: RowsAt<T>,
}

impl<T: 'static> Rows<T> {
    /// Creates `count` rows, computed by `at` for each of `places` items.
    pub fn new(
        [places, count]: [usize; 2],
        at: impl Fn(usize) -> Result<Vec<T>, HarmonicError> + 'static,
    ) -> Self {
        Self { places, count, at: Rc::new(at) }
    }

    /// Stores one row per item.
    pub fn of(items: Vec<T>) -> Self
    where
        T: Clone,
    {
        Self::new([items.len(); 2], move |place| {
            Ok(items.get(place).cloned().into_iter().collect())
        })
    }

    /// Returns the rows as a table with these columns.
    pub fn table(&self, columns: &'static [Column<'static, T>]) -> Table {
        let at = Rc::clone(&self.at);
        let cells = |item: &T| columns.iter().map(|column| (column.1)(item)).collect();
        let headings = columns.iter().map(|column| column.0);
        Table::made(headings, [self.places, self.count], move |place| {
            Ok(at(place).map_err(io::Error::other)?.iter().map(cells).collect())
        })
    }
}

/// A JSON object, as a list of fields in order.
#[derive(Default)]
pub struct Parts(Vec<(&'static str, Part)>);

/// Value of one field.
enum Part {
    Whole(Value),
    /// An array that is computed while it is written.
    Rows(Rows<Value>),
    Parts(Parts),
}

impl std::fmt::Debug for Parts {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.debug_list().entries(self.0.iter().map(|(name, _)| name)).finish()
    }
}

impl Serialize for Parts {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        let mut map = out.serialize_map(None)?;
        self.0.iter().try_for_each(|(name, part)| map.serialize_entry(name, part))?;
        map.end()
    }
}

impl Serialize for Part {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Whole(value) => value.serialize(out),
            Self::Parts(parts) => parts.serialize(out),
            Self::Rows(rows) => {
                let mut list = out.serialize_seq(None)?;
                for place in 0..rows.places {
                    for row in (rows.at)(place).map_err(S::Error::custom)? {
                        list.serialize_element(&row)?;
                    }
                }
                list.end()
            }
        }
    }
}

impl Parts {
    /// Adds a value.
    pub fn with(mut self, name: &'static str, value: impl Serialize) -> Self {
        self.0.push((name, Part::Whole(json!(value))));
        self
    }

    /// Adds a nested object.
    pub fn with_parts(mut self, name: &'static str, parts: Self) -> Self {
        self.0.push((name, Part::Parts(parts)));
        self
    }

    /// Adds an array with `value` of each row.
    pub fn with_rows<T: 'static>(
        mut self,
        name: &'static str,
        rows: &Rows<T>,
        value: impl Fn(&T) -> Value + 'static,
    ) -> Self {
        let (counts, at) = ([rows.places, rows.count], Rc::clone(&rows.at));
        let values = move |place| Ok(at(place)?.iter().map(&value).collect());
        self.0.push((name, Part::Rows(Rows::new(counts, values))));
        self
    }

    /// Appends the fields of another object.
    pub fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(
        count: usize,
        at: impl Fn(usize) -> Result<Vec<Value>, HarmonicError> + 'static,
    ) -> Parts {
        let rows = Rows::new([count; 2], at);
        Parts::default().with("before", [1]).with_rows("rows", &rows, Value::clone)
    }

    #[test]
    fn rows_are_written_as_an_array_of_them_all() {
        for count in [0, 1, 3] {
            // Item `n` has `n` rows.
            let at = |place: usize| (0..place).map(|k| json!({ "place": place, "k": k })).collect();
            let whole: Vec<Value> =
                (0..count).flat_map(|place| -> Vec<Value> { at(place) }).collect();
            let streamed = rows(count, move |place| Ok(at(place)));
            let whole = json!({ "before": [1], "rows": whole });
            let written = |value: &dyn Fn() -> serde_json::Result<String>| value().unwrap();
            assert_eq!(
                written(&|| serde_json::to_string_pretty(&streamed)),
                written(&|| serde_json::to_string_pretty(&whole))
            );
        }
    }

    #[test]
    fn a_row_that_fails_fails_the_whole() {
        let failing = rows(2, |place| match place {
            0 => Ok(vec![json!(0)]),
            _ => Err(HarmonicError::Unsettled { speed: 1.0 }),
        });
        let error = serde_json::to_string(&failing).unwrap_err().to_string();
        assert!(error.contains("speed = 1"), "{error}");
    }
}
