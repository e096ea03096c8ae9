//! Bisection: locates the point between two others at which the answer of a predicate changes, to
//! adjacent floating-point numbers or to a relative width.
//!
//! Costs at most [`MOST_HALVINGS`] evaluations. If the answer changes several times, one of the
//! changes is located.

use std::convert::Infallible;

/// Enough to reduce any interval that occurs to adjacent floating-point numbers, whatever the
/// scales of its ends.
pub(crate) const MOST_HALVINGS: usize = 200;

/// As [`bisected`], but stops at the relative width `part` of the far end, and with a predicate
/// that can fail.
///
/// # Errors
/// Returns the first error of the predicate.
pub(crate) fn try_bisected<E>(
    [mut near, mut far]: [f64; 2],
    part: f64,
    mut is_far: impl FnMut(f64) -> Result<bool, E>,
) -> Result<[f64; 2], E> {
    for _ in 0..MOST_HALVINGS {
        let middle = 0.5 * near + 0.5 * far;
        let close = (far - near).abs() <= part * far.abs();
        if close || middle == near || middle == far {
            break;
        }
        if is_far(middle)? { far = middle } else { near = middle }
    }
    Ok([near, far])
}

/// As [`bisected`], but stops at the relative width `part` of the far end.
pub(crate) fn bisected_to(
    ends: [f64; 2],
    part: f64,
    mut is_far: impl FnMut(f64) -> bool,
) -> [f64; 2] {
    let Ok(found) = try_bisected(ends, part, |x| Ok::<_, Infallible>(is_far(x)));
    found
}

/// Returns the adjacent numbers between which `is_far` becomes true, that on the near side first.
/// The ends are not evaluated: `is_far` must be false at the first and true at the second.
pub(crate) fn bisected(ends: [f64; 2], is_far: impl FnMut(f64) -> bool) -> [f64; 2] {
    bisected_to(ends, 0.0, is_far)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_ends_at_neighbours_from_either_side() {
        for edge in [0.3, 1e-12, 7.0 / 3.0] {
            let [near, far] = bisected([0.0, 5.0], |x| x >= edge);
            assert_eq!((far, near.next_up()), (edge, edge));
            let [near, far] = bisected([5.0, 0.0], |x| x < edge);
            assert_eq!((near, far.next_up()), (edge, edge));
        }
    }

    #[test]
    fn a_part_is_enough_and_work_is_bounded() {
        let mut asked = 0;
        let found = try_bisected([1.0, 2.0], 1e-3, |x| {
            asked += 1;
            Ok::<_, ()>(x > 1.5001)
        });
        let [near, far] = found.unwrap();
        assert!(near <= 1.5001 && far > 1.5001 && far - near <= 1e-3 * far && asked == 10);
        asked = 0;
        let _ = bisected([0.0, f64::MAX], |_| {
            asked += 1;
            true
        });
        assert_eq!(asked, MOST_HALVINGS);
        assert!(bisected([0.0, f64::NAN], |_| false)[1].is_nan());
        assert_eq!(try_bisected([0.0, 1.0], 0.0, Err::<bool, f64>), Err(0.5));
    }
}
