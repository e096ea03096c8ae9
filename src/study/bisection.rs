//! The place where a yes begins, by halving.

/// The least value that is enough, between one that is not and one that is, to
/// this part of itself or to the last bit.
pub(super) fn bisect(
    mut less: f64,
    mut enough: f64,
    part: f64,
    mut is_enough: impl FnMut(f64) -> bool,
) -> f64 {
    while enough - less > part * enough {
        let middle = 0.5 * (less + enough);
        if middle <= less || middle >= enough {
            break;
        }
        if is_enough(middle) { enough = middle } else { less = middle }
    }
    enough
}
