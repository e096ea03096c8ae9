//! The real roots of a function that is smooth beside narrow resonances: by a scan that is
//! dense towards each of them, and bisection to neighbouring numbers. Where the function comes
//! near zero without a change of sign, its extremum is searched, so that two close roots are
//! both found.
//!
//! About 110 values for each resonance, and some 60 for each root and each extremum.

use super::bisection::bisected;
use super::maximum::highest;

/// Powers of ten of the distances from a resonance: the least and the largest.
const DISTANCES: [i32; 2] = [-7, 4];
/// Places of the scan for each of them, on either side.
const PER_DECADE: i32 = 5;

/// The real roots in no order, up to 1e4 from the resonances, in units in which these are of
/// order one. Of two roots that round-off does not tell apart none is found.
pub(crate) fn real_roots(of: impl Fn(f64) -> f64, resonances: &[f64]) -> Vec<f64> {
    let [least, largest] = DISTANCES.map(|power| power * PER_DECADE);
    let powers = (least..=largest).map(|k| 10_f64.powf(f64::from(k) / f64::from(PER_DECADE)));
    let mut places: Vec<f64> = resonances.to_vec();
    places.extend(powers.flat_map(|far| resonances.iter().flat_map(move |x| [x - far, x + far])));
    places.retain(|place| place.is_finite());
    places.sort_by(f64::total_cmp);
    places.dedup();
    let scan: Vec<(f64, f64)> = places.into_iter().map(|x| (x, of(x))).collect();
    let between = |from: f64, to: f64, rises: bool| {
        let [near, far] = bisected([from, to], |x| (of(x) > 0.0) == rises);
        0.5 * near + 0.5 * far
    };
    let zeros = scan.iter().filter(|(_, value)| *value == 0.0).map(|(x, _)| *x);
    let mut roots: Vec<f64> = zeros.collect();
    for pair in scan.windows(2) {
        if let [(a, left), (b, right)] = *pair
            && ((left < 0.0 && right > 0.0) || (left > 0.0 && right < 0.0))
        {
            roots.push(between(a, b, right > 0.0));
        }
    }
    for three in scan.windows(3) {
        let [(a, left), (_, middle), (c, right)] = *three else { continue };
        let sign = middle.signum();
        let is_nearest = middle.abs() < left.abs() && middle.abs() <= right.abs();
        if is_nearest && sign * left > 0.0 && sign * right > 0.0 {
            let (top, value) = highest([a, c], |x| -sign * of(x));
            if value > 0.0 {
                roots.extend([between(a, top, sign < 0.0), between(top, c, sign > 0.0)]);
            }
        }
    }
    roots
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_far_away_close_together_and_at_resonances() {
        for (a, b) in [(1.0, 2.0), (-3.0, 1e4), (1.0, 1.0 + 1e-6), (0.0, 5.0), (-1e-6, 1e-6)] {
            let mut found = real_roots(|x| (x - a) * (x - b), &[0.0, 1.0, 2.0]);
            found.sort_by(f64::total_cmp);
            assert_eq!(found.len(), 2, "{a} {b}: {found:?}");
            for (root, expected) in found.iter().zip([a, b]) {
                let error = (root - expected).abs();
                assert!(error <= 1e-15 * (1.0 + expected.abs()), "{root} is not {expected}");
            }
        }
    }

    #[test]
    fn what_has_no_real_root_gives_none() {
        // x^2 + e^2 with decreasing e.
        for e in [1.0, 1e-4, 1e-8, 1e-12] {
            assert_eq!(real_roots(|x| x * x + e * e, &[-0.3, 1.0]), Vec::<f64>::new());
        }
    }
}
