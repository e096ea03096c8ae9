//! Real roots of polynomials that are sums of products, by Descartes' rule of signs on intervals that
//! are halved until each has at most one root.
//!
//! On an interval a polynomial of degree `n` is given by the list `c_0` to `c_n` of its coefficients
//! in `sum c_k t^k (1 - t)^(n - k)`, with `t` from 0 to 1. The list of a product is the convolution of
//! the lists of its factors, so a factor that vanishes at an end of the interval keeps its digits
//! there. The number of sign changes in the list is the number of roots inside, or exceeds it by an
//! even number.

use super::search::bisected;

/// Returns the list of a product; `C` is `A + B - 1`.
pub(crate) fn product<const A: usize, const B: usize, const C: usize>(
    one: [f64; A],
    other: [f64; B],
) -> [f64; C] {
    let mut found = [0.0; C];
    for (i, x) in one.into_iter().enumerate() {
        for (place, y) in found[i..].iter_mut().zip(other) {
            *place += x * y;
        }
    }
    found
}

/// Returns the roots between the first and the last of `ends`, which are in increasing order. `value`
/// evaluates the polynomial; `on` returns its list on an interval. Roots closer to each other than
/// `apart` may be missed.
pub(crate) fn real_roots<const N: usize>(
    ends: &[f64],
    apart: f64,
    value: impl Fn(f64) -> f64,
    on: impl Fn([f64; 2]) -> [f64; N],
) -> Vec<f64> {
    let root = |([from, to], rises): ([f64; 2], bool)| {
        let [low, high] = bisected([from, to], |x| (value(x) > 0.0) == rises);
        if value(low).abs() < value(high).abs() { low } else { high }
    };
    let mut found: Vec<f64> = isolated(ends, apart, on).into_iter().map(root).collect();
    found.sort_by(f64::total_cmp);
    found
}

/// Returns intervals that contain one root each, and whether the polynomial increases there.
fn isolated<const N: usize>(
    ends: &[f64],
    apart: f64,
    on: impl Fn([f64; 2]) -> [f64; N],
) -> Vec<([f64; 2], bool)> {
    let mut found = Vec::new();
    let mut left: Vec<[f64; 2]> = ends.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    while let Some([from, to]) = left.pop() {
        let list = on([from, to]);
        let mut signs = list.iter().filter(|x| **x != 0.0).map(|x| *x > 0.0);
        let Some(first) = signs.next() else { continue };
        let (last, changes) = signs
            .fold((first, 0), |(last, changes), sign| (sign, changes + u32::from(sign != last)));
        if list[0] == 0.0 {
            found.push(([from, from], first));
        }
        let middle = 0.5 * (from + to);
        // Adjacent floating-point numbers cannot be halved.
        let is_wide = to - from > apart && from < middle && middle < to;
        if changes == 1 {
            found.push(([from, to], last));
        } else if changes > 1 && is_wide {
            left.extend([[from, middle], [middle, to]]);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the list of `(x - root) (x - root - apart) (x - 5)`.
    fn cubic(root: f64, apart: f64) -> impl Fn([f64; 2]) -> [f64; 4] {
        move |[from, to]| {
            let factor = |root: f64| [from - root, to - root];
            let pair: [f64; 3] = product(factor(root), factor(root + apart));
            product(pair, factor(5.0))
        }
    }

    #[test]
    fn each_root_has_an_interval_of_its_own() {
        for apart in [1.0, 1e-3, 1e-7] {
            let mut found = isolated(&[-8.0, 0.0, 1e9], 1e-9, cubic(2.1, apart));
            found.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
            assert_eq!(found.len(), 3, "{apart} {found:?}");
            for (([from, to], rises), root) in found.iter().zip([2.1, 2.1 + apart, 5.0]) {
                assert!(*from <= root && root <= *to && *rises == (root != 2.1 + apart));
            }
        }
        assert_eq!(isolated(&[-8.0, 0.0, 1.0], 1e-9, cubic(2.1, 1.0)), Vec::new());
    }

    #[test]
    fn roots_have_all_digits_and_a_pair_of_neighbours_ends_the_search() {
        let value = |x: f64| (x - 2.1) * (x - 2.1 - 1e-3) * (x - 5.0);
        let found = real_roots(&[-8.0, 0.0, 1e9], 1e-9, value, cubic(2.1, 1e-3));
        assert_eq!(found, [2.1, 2.101, 5.0]);
        assert!(isolated(&[0.0, 1e9], 0.0, cubic(1e6 / 3.0, 1e-12)).len() < 4);
    }

    #[test]
    fn a_root_at_an_end_is_found_once_and_zero_has_none() {
        let found = isolated(&[0.0, 2.0, 3.0], 1e-9, cubic(2.0, 9.0));
        assert_eq!(found, [([2.0, 2.0], true)]);
        assert_eq!(isolated(&[0.0, 1.0], 1e-9, |_| [0.0; 4]), Vec::new());
    }
}
