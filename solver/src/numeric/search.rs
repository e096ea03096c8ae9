//! One-dimensional search: the change of a predicate by bisection, the maximum of a function by
//! golden section, and over a list of places the spans in which a condition is true and the zeros
//! of a function. Bisection and golden section need an interval that contains the result; if it
//! contains several, they return one of them. A span that lies between two neighbouring places of a
//! list is missed, so the caller chooses the density of its list.

use std::convert::Infallible;

/// Number of halvings that reduces any interval that occurs to adjacent floating-point numbers.
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

/// Returns the adjacent numbers between which `is_far` becomes true, the false one first. The ends
/// are not evaluated: `is_far` must be false at the first and true at the second.
pub(crate) fn bisected(ends: [f64; 2], is_far: impl FnMut(f64) -> bool) -> [f64; 2] {
    bisected_to(ends, 0.0, is_far)
}

/// Number of golden-section steps. Each leaves 0.618 of the interval; all of them leave 3e-13 of it.
/// The value of the maximum is accurate to round-off, its position to the square root of round-off.
const STEPS: usize = 60;

/// Returns the position of the maximum in the interval, and the value there. Costs [`STEPS`] + 2
/// evaluations.
pub(crate) fn highest([mut low, mut high]: [f64; 2], of: impl Fn(f64) -> f64) -> (f64, f64) {
    const PART: f64 = 0.381_966_011_250_105_1;
    let (mut a, mut b) = (low + PART * (high - low), high - PART * (high - low));
    let (mut at_a, mut at_b) = (of(a), of(b));
    for _ in 0..STEPS {
        if at_a >= at_b {
            (high, b, at_b) = (b, a, at_a);
            a = low + PART * (high - low);
            at_a = of(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = high - PART * (high - low);
            at_b = of(b);
        }
    }
    if at_a >= at_b { (a, at_a) } else { (b, at_b) }
}

/// Returns the position of the maximum over a list of places in increasing order, refined between the
/// neighbours of the highest inner place, and the value there.
pub(crate) fn highest_of(places: &[f64], of: impl Fn(f64) -> f64) -> Option<(f64, f64)> {
    let at = |three: &[f64]| of(three[1]);
    let around = places.windows(3).map(|three| ([three[0], three[2]], at(three)));
    let (ends, _) = around.max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(highest(ends, of))
}

/// Returns the spans of `places` (in increasing order) in which a condition is true. The condition
/// is true at both ends of a span. An end between two places is located to the last digit by
/// bisection.
pub(crate) fn spans(places: &[f64], is_true: impl Fn(f64) -> bool) -> Vec<[f64; 2]> {
    let mut found: Vec<[f64; 2]> = Vec::new();
    let mut last: Option<(f64, bool)> = None;
    for &place in places {
        let here = is_true(place);
        match (last, found.last_mut()) {
            (Some((_, true)), Some(span)) if here => span[1] = place,
            (Some((before, true)), Some(span)) => {
                span[1] = bisected([before, place], |x| !is_true(x))[0];
            }
            (before, _) if here => {
                let from =
                    before.map_or(place, |(before, _)| bisected([before, place], &is_true)[1]);
                found.push([from, place]);
            }
            _ => {}
        }
        last = Some((place, here));
    }
    found
}

/// Returns the zeros of a continuous function between the first and the last of `places` (in
/// increasing order). Where the function approaches zero and turns back, its extremum is refined, so
/// that two zeros between neighbouring places are found.
pub(crate) fn zeros(places: &[f64], of: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut known: Vec<(f64, f64)> = places.iter().map(|&place| (place, of(place))).collect();
    let extremes: Vec<(f64, f64)> = known
        .windows(3)
        .filter_map(|three| {
            let [(from, before), (_, here), (to, after)] = [three[0], three[1], three[2]];
            let sign = here.signum();
            let dips = sign * before > sign * here && sign * after >= sign * here && here != 0.0;
            let (place, _) = dips.then(|| highest([from, to], |x| -sign * of(x)))?;
            Some((place, of(place)))
        })
        .collect();
    known.extend(extremes);
    known.sort_by(|a, b| a.0.total_cmp(&b.0));
    let zero = |pair: &[(f64, f64)]| {
        let [(from, before), (to, after)] = [pair[0], pair[1]];
        if before == 0.0 {
            return Some(from);
        }
        let [low, high] = (before * after < 0.0)
            .then(|| bisected([from, to], |x| (of(x) > 0.0) != (before > 0.0)))?;
        Some(if of(low).abs() < of(high).abs() { low } else { high })
    };
    known.windows(2).filter_map(zero).collect()
}

/// Returns places from `from` to `to` (both positive) whose neighbours differ by `ratio` at most.
pub(crate) fn geometric([from, to]: [f64; 2], ratio: f64) -> impl Iterator<Item = f64> {
    let count = ((to / from).ln() / ratio.ln()).ceil().max(1.0);
    (0..=count as u32).map(move |k| from * (to / from).powf(f64::from(k) / count))
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

    #[test]
    fn the_top_is_found_where_it_is_inside_or_at_an_end() {
        let (place, value) = highest([-1.0, 3.0], |x| 2.0 - (x - 0.7) * (x - 0.7));
        // Near a maximum the position is accurate to the square root of round-off only.
        assert!((place - 0.7).abs() < 3e-8 && value == 2.0, "{place} {value}");
        for (ends, top) in [([0.0, 1.0], 1.0), ([-1.0, 0.0], 0.0)] {
            let (place, value) = highest(ends, |x| x);
            assert!((place - top).abs() < 1e-12 && (value - top).abs() < 1e-12, "{place}");
        }
    }

    #[test]
    fn spans_end_where_the_condition_changes() {
        let places: Vec<f64> = (0..=10).map(f64::from).collect();
        let found = spans(&places, |x| x < 2.5 || (4.25..7.0).contains(&x) || x > 9.5);
        assert_eq!(found[0][0], 0.0);
        assert_eq!(found[0][1].next_up(), 2.5);
        assert_eq!((found[1][0], found[1][1].next_up()), (4.25, 7.0));
        assert_eq!((found[2][0].next_down(), found[2][1]), (9.5, 10.0));
        assert_eq!(found.len(), 3);
        assert_eq!(spans(&places, |_| false), Vec::<[f64; 2]>::new());
    }

    #[test]
    fn zeros_closer_than_the_list_are_found() {
        let places: Vec<f64> = geometric([0.1, 10.0], 1.3).collect();
        for apart in [1.0, 1e-3, 1e-7] {
            let found = zeros(&places, |x| (x - 2.0) * (x - 2.0 - apart));
            assert_eq!(found.len(), 2, "{apart} {found:?}");
            assert!((found[0] - 2.0).abs() < 1e-15 / apart + 1e-15, "{found:?}");
        }
        assert_eq!(zeros(&places, |x| (x - 2.0) * (x - 2.0) + 1e-9), Vec::<f64>::new());
        assert!(geometric([0.1, 10.0], 1.3).last().is_some_and(|last| (last - 10.0).abs() < 1e-14));
    }
}
