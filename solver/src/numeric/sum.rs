//! Error-free sum of two numbers (Knuth's two-sum, six operations).

/// Returns the rounded sum, and the exact rounding error.
pub(crate) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let rest = sum - a;
    (sum, (a - (sum - rest)) + (b - rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_rounding_drops_is_kept_of_either_number() {
        for (a, b) in [(1.0, 1e-20), (1e-20, 1.0), (-1.0, 1e-20), (0.1, 0.2)] {
            let (sum, rest) = two_sum(a, b);
            assert_eq!((sum, sum + rest), (a + b, sum));
            // Sum and rest together equal the exact sum of both numbers.
            assert_eq!((sum - a.max(b)) + rest - a.min(b), 0.0, "{a} {b}");
        }
        assert_eq!(two_sum(1.0, 1e-20).1, 1e-20);
        assert_eq!(two_sum(1e-20, -1.0).1, 1e-20);
    }
}
