//! The known name that is nearest to an unknown one, for error messages.

use strsim::normalized_damerau_levenshtein;

/// Smallest similarity of the two names, from 0 to 1 (normalised Damerau-Levenshtein).
const LIKE: f64 = 0.6;

/// Returns the known name that differs least from an unknown one in letters added, left out,
/// replaced or swapped with the next; `None` if none is similar.
#[must_use]
pub fn nearest<'a>(unknown: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let likeness = |name: &&str| normalized_damerau_levenshtein(unknown, name);
    let like = known.into_iter().filter(|name| likeness(name) >= LIKE);
    like.max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
}
