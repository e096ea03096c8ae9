//! Truncated power series in time, counted in units of a stretch: what the
//! motions without a closed form are made of.

/// Terms kept: `1/22!` is 1e-21.
pub(super) const TERMS: usize = 22;

/// Coefficients of `x^n`, `0 <= x <= 1` over the stretch.
pub(super) type Terms = [f64; TERMS];

/// Term `n` of a product; terms of both factors up to `n` must be known.
pub(super) fn product(a: &Terms, b: &Terms, n: usize) -> f64 {
    a.iter().zip(b.iter().take(n + 1).rev()).map(|(a, b)| a * b).sum()
}

/// Term `n` of a quotient whose earlier terms are known: `of/by`, where `of` is
/// the term of the numerator.
pub(super) fn quotient(of: f64, by: &Terms, result: &Terms, n: usize) -> f64 {
    let known: f64 = by.iter().skip(1).zip(result.iter().take(n).rev()).map(|(a, b)| a * b).sum();
    (of - known) / by[0]
}

/// Term `n` of the derivative.
pub(super) fn slope(terms: &Terms, n: usize) -> f64 {
    terms.get(n + 1).map_or(0.0, |term| (n as f64 + 1.0) * term)
}

/// Value, first and second derivative, by Horner.
pub(super) fn values(terms: &Terms, x: f64) -> [f64; 3] {
    let (mut value, mut rate, mut bend) = (0.0, 0.0, 0.0);
    for &term in terms.iter().rev() {
        bend = bend * x + rate;
        rate = rate * x + value;
        value = value * x + term;
    }
    [value, rate, 2.0 * bend]
}

/// Bound on the third derivative over the stretch.
pub(super) fn jerk(terms: &Terms) -> f64 {
    let factor = |n: f64| n * (n - 1.0) * (n - 2.0);
    terms.iter().enumerate().skip(3).map(|(n, term)| factor(n as f64) * term.abs()).sum()
}

/// Whether the last terms are round-off of the largest.
pub(super) fn ended(terms: &Terms) -> bool {
    let largest = terms.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    terms.iter().skip(TERMS - 2).all(|term| term.abs() <= 1e-17 * largest)
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
        for x in [0.0, 0.3, 1.0] {
            let [value, rate, bend] = values(&exp, x);
            // The last missing term is below 1e-16 in the second derivative.
            assert!((value - x.exp()).abs() + (rate - x.exp()).abs() < 1e-15);
            assert!((bend - x.exp()).abs() < 1e-15);
            assert!((values(&square, 0.5 * x)[0] - x.exp()).abs() < 1e-15);
            assert!((values(&back, x)[0] - x.exp()).abs() < 1e-14);
        }
        assert!(ended(&exp) && !ended(&square));
        assert!((jerk(&exp) - 1.0_f64.exp()).abs() < 1e-14);
    }
}
