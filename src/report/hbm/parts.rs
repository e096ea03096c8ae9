//! A JSON object by its parts. Long arrays are made as they are written, row by row.

use std::rc::Rc;

use serde::Serialize;
use serde::ser::{Error, SerializeMap, SerializeSeq, Serializer};
use serde_json::{Value, json};

use rubscope_solver::harmonic::HarmonicError;

/// Parts by name.
#[derive(Default)]
pub struct Parts(Vec<(&'static str, Part)>);

/// What is under one name.
pub enum Part {
    /// A value that is there.
    Whole(Value),
    /// An array that is made as it is written, from so many places on: all its elements at
    /// once take a hundred times the memory of the numbers.
    Rows(usize, RowsAt),
    /// Parts below this one.
    Parts(Parts),
}

/// The elements of an array that are made at one of its places.
pub type RowsAt = Box<dyn Fn(usize) -> Result<Vec<Value>, HarmonicError>>;

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
            Self::Rows(places, rows) => {
                let mut list = out.serialize_seq(None)?;
                for place in 0..*places {
                    for row in rows(place).map_err(S::Error::custom)? {
                        list.serialize_element(&row)?;
                    }
                }
                list.end()
            }
        }
    }
}

impl Parts {
    /// Adds a part, or replaces it in its place.
    #[must_use]
    pub fn with(mut self, name: &'static str, part: Part) -> Self {
        match self.0.iter_mut().find(|(known, _)| *known == name) {
            Some((_, known)) => *known = part,
            None => self.0.push((name, part)),
        }
        self
    }

    /// As `with`, of a value that is there.
    #[must_use]
    pub fn with_whole(self, name: &'static str, value: impl Serialize) -> Self {
        self.with(name, Part::Whole(json!(value)))
    }

    /// As `with`, of an array with an element for each item.
    #[must_use]
    pub fn with_rows<T: 'static>(
        self,
        name: &'static str,
        items: &Rc<Vec<T>>,
        of: impl Fn(&T) -> Value + 'static,
    ) -> Self {
        let (count, items) = (items.len(), Rc::clone(items));
        let row = move |place: usize| Ok(items.get(place).map(&of).into_iter().collect());
        self.with(name, Part::Rows(count, Box::new(row)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(
        count: usize,
        at: impl Fn(usize) -> Result<Vec<Value>, HarmonicError> + 'static,
    ) -> Parts {
        let rows = Part::Rows(count, Box::new(at));
        Parts::default().with_whole("before", [1]).with("rows", rows)
    }

    #[test]
    fn rows_are_written_as_an_array_of_them_all() {
        for count in [0, 1, 3] {
            // Of each place none, one or two.
            let at = |place: usize| (0..place).map(|k| json!({ "place": place, "k": k })).collect();
            let whole: Vec<Value> =
                (0..count).flat_map(|place| -> Vec<Value> { at(place) }).collect();
            let streamed = rows(count, move |place| Ok(at(place)));
            let whole = json!({ "before": [1], "rows": whole });
            let told = |value: &dyn Fn() -> serde_json::Result<String>| value().unwrap();
            assert_eq!(
                told(&|| serde_json::to_string_pretty(&streamed)),
                told(&|| serde_json::to_string_pretty(&whole))
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
