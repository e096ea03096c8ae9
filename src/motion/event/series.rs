//! Truncated power series in time, counted in units of a stretch: what the
//! motions without a closed form are made of.

use super::looks::Gap;
use crate::tolerances::SERIES_TAIL;

/// Terms kept: over a stretch of 0.8 rad of the fastest rate the first one
/// dropped is below `0.8^18/18!`, 3e-18.
pub(in crate::motion::event) const TERMS: usize = 18;
/// Length of a stretch in radians of the fastest rate.
pub(in crate::motion::event) const STRETCH: f64 = 0.8;

/// Coefficients of `x^n`, `0 <= x <= 1` over the stretch.
pub(in crate::motion::event) type Terms = [f64; TERMS];

/// Term `n` of a product; terms of both factors up to `n` must be known.
pub(in crate::motion::event) fn product(a: &Terms, b: &Terms, n: usize) -> f64 {
    // Two sums, from both ends: additions that do not wait for each other.
    let (mut low, mut high) = (0.0, 0.0);
    let half = n.div_ceil(2);
    for (k, (x, y)) in a.iter().zip(b).take(half).enumerate() {
        low += x * b[n - k];
        high += a[n - k] * y;
    }
    if n.is_multiple_of(2) { low + high + a[n / 2] * b[n / 2] } else { low + high }
}

/// Term `n` of a quotient whose earlier terms are known: `of/by`, where `of` is
/// the term of the numerator.
pub(in crate::motion::event) fn quotient(of: f64, by: &Terms, result: &Terms, n: usize) -> f64 {
    let known: f64 = by.iter().skip(1).zip(result.iter().take(n).rev()).map(|(a, b)| a * b).sum();
    (of - known) / by[0]
}

/// Term `n` of the derivative.
pub(in crate::motion::event) fn slope(terms: &Terms, n: usize) -> f64 {
    terms.get(n + 1).map_or(0.0, |term| (n as f64 + 1.0) * term)
}

/// Value, first and second derivative, by Horner.
pub(in crate::motion::event) fn values(terms: &Terms, x: f64) -> [f64; 3] {
    let (mut value, mut rate, mut bend) = (0.0, 0.0, 0.0);
    for &term in terms.iter().rev() {
        bend = bend * x + rate;
        rate = rate * x + value;
        value = value * x + term;
    }
    [value, rate, 2.0 * bend]
}

/// Value and three derivatives as those of a gap.
pub(in crate::motion::event) fn gap(terms: &Terms, x: f64) -> Gap {
    let (mut gap, mut rate, mut bend, mut twist) = (0.0, 0.0, 0.0, 0.0);
    for &term in terms.iter().rev() {
        twist = twist * x + bend;
        bend = bend * x + rate;
        rate = rate * x + gap;
        gap = gap * x + term;
    }
    Gap { gap, rate, bend: 2.0 * bend, twist: 6.0 * twist }
}

/// Bound on the fourth derivative over the stretch.
pub(in crate::motion::event) fn jounce(terms: &Terms) -> f64 {
    let factor = |n: f64| n * (n - 1.0) * (n - 2.0) * (n - 3.0);
    terms.iter().enumerate().skip(4).map(|(n, term)| factor(n as f64) * term.abs()).sum()
}

/// Whether the terms fall fast enough that those dropped are round-off. The last
/// two are not asked, as pushes do not have them: `x^14/14!` at 1e-12 of the
/// largest leaves 1e-17 at the first term dropped, a geometric fall 4e-16.
pub(in crate::motion::event) fn ended(terms: &Terms) -> bool {
    let largest = terms.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let last = terms.iter().rev().skip(2).take(2);
    last.into_iter().all(|term| term.abs() <= SERIES_TAIL * largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_quotients_and_values_of_exponentials() {
        let mut exp = [0.0; TERMS];
        exp[0] = 1.0;
        for n in 1..TERMS {
            exp[n] = exp[n - 1] / n as f64;
        }
        let mut square = [0.0; TERMS];
        let mut back = [0.0; TERMS];
        for n in 0..TERMS {
            square[n] = product(&exp, &exp, n);
            back[n] = quotient(square[n], &exp, &back, n);
        }
        for x in [0.0, 0.3, STRETCH] {
            let [value, rate, bend] = values(&exp, x);
            // The first missing term of the second derivative is 0.8^16/16!.
            assert!((value - x.exp()).abs() + (rate - x.exp()).abs() < 3e-15);
            assert!((bend - x.exp()).abs() < 5e-15);
            assert!((values(&square, 0.5 * x)[0] - x.exp()).abs() < 3e-15);
            assert!((values(&back, x)[0] - x.exp()).abs() < 1e-14);
        }
        let scaled: Terms = std::array::from_fn(|n| exp[n] * STRETCH.powi(n as i32));
        assert!(ended(&scaled) && !ended(&square) && !ended(&[1.0; TERMS]));
        assert!((jounce(&exp) - 1.0_f64.exp()).abs() < 1e-9);
        let Gap { gap, rate, bend, twist } = gap(&exp, 0.3);
        for derivative in [gap, rate, bend, twist] {
            assert!((derivative - 0.3_f64.exp()).abs() < 1e-13);
        }
    }
}
