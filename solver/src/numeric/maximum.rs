//! Maximum of a unimodal function by golden-section search.
//!
//! The position is accurate to the square root of round-off, the value to round-off. Costs
//! [`STEPS`] + 2 evaluations. If there are several local maxima, one of them is returned.

/// Each step leaves 0.618 of the interval; after all of them 3e-13 of it is left.
const STEPS: usize = 60;

/// Returns the position of the maximum in the interval, and the value there.
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

#[cfg(test)]
mod tests {
    use super::*;

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
}
