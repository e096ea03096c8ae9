//! Search over a list of places: where a condition is true, and where a function vanishes. What
//! happens between two neighbouring places and ends before the second is not seen, so the caller
//! states the density of its list.

use super::bisection::bisected;
use super::maximum::highest;

/// Returns the spans of `places` (in increasing order) in which a condition is true. Both ends are
/// inside; each is a place of the list, or is found to the last digit by bisection between two.
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
/// increasing order). Every extremum towards zero is refined, so that two zeros between places are
/// found.
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
