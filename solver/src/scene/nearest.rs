//! The nearest of known names to one that is unknown, for messages.

use strsim::normalized_damerau_levenshtein;

/// Least part of the letters of a name that was meant that is right.
const LIKE: f64 = 0.6;

/// Returns the known name with the fewest changes from an unknown one: letters added, left out,
/// replaced or swapped with the next; `None` if all names need many.
#[must_use]
pub fn nearest<'a>(unknown: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let likeness = |name: &&str| normalized_damerau_levenshtein(unknown, name);
    let like = known.into_iter().filter(|name| likeness(name) >= LIKE);
    like.max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
}
