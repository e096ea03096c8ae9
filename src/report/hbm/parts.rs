//! A JSON object by its parts, in their order.

use serde::Serialize;
use serde_json::{Map, Value, json};

/// A JSON object.
#[derive(Debug, Default, Serialize)]
#[serde(transparent)]
pub struct Parts(Map<String, Value>);

impl Parts {
    /// Adds a value.
    pub fn with(mut self, name: &str, value: impl Serialize) -> Self {
        self.0.insert(name.to_string(), json!(value));
        self
    }

    /// Adds an array with what `value` makes of each row.
    pub fn with_rows<T>(self, name: &str, rows: &[T], value: impl Fn(&T) -> Value) -> Self {
        self.with(name, rows.iter().map(value).collect::<Value>())
    }

    /// Adds the parts of another object behind those of this one.
    pub fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }
}
