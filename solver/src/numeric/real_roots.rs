//! All real roots of a polynomial that is a sum of products of quadratics, found reliably:
//! intervals are bisected until Descartes' rule of signs, applied to the Bernstein coefficients,
//! leaves at most one root in each (Vincent, Collins and Akritas).
//!
//! Simple roots are located to adjacent floating-point numbers, double roots to the square root of
//! round-off. Costs at most [`MOST_HALVINGS`] bisections to isolate a root, and as many to locate
//! it.
//!
//! On every interval the coefficients are computed anew from the quadratic factors, which preserves
//! their relative accuracy near lightly damped resonances, where the polynomial is tiny. Points are
//! homogeneous, `x = p/q`, so that an interval can end at infinity.

use super::bisection::MOST_HALVINGS;

/// Point `x = p/q` of the real line, `q >= 0`; infinite for `q = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    pub p: f64,
    pub q: f64,
}

impl Point {
    pub fn finite(x: f64) -> Self {
        Self { p: x, q: 1.0 }
    }

    fn middle(self, other: Self) -> Self {
        Self { p: 0.5 * (self.p + other.p), q: 0.5 * (self.q + other.q) }
    }

    fn value(self) -> f64 {
        self.p / self.q
    }
}

/// Number of coefficients of the largest polynomial, which has degree six.
const MOST: usize = 7;

/// Bernstein coefficients multiplied by the binomial coefficients, so that products of polynomials
/// are convolutions. Stored inline, because they are computed many thousand times a second.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coefficients {
    values: [f64; MOST],
    count: usize,
}

impl std::ops::Deref for Coefficients {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        self.values.get(..self.count).unwrap_or(&self.values)
    }
}

impl Coefficients {
    /// Creates the coefficients of a quadratic on an interval from its polar form.
    pub fn quadratic(from: Point, to: Point, of: impl Fn(Point, Point) -> f64) -> Self {
        Self::from([of(from, from), 2.0 * of(from, to), of(to, to)])
    }
}

/// Takes the three coefficients of a quadratic.
impl From<[f64; 3]> for Coefficients {
    fn from([first, middle, last]: [f64; 3]) -> Self {
        Self { values: [first, middle, last, 0.0, 0.0, 0.0, 0.0], count: 3 }
    }
}

/// Multiplies two polynomials given on the same interval.
pub(crate) fn product(a: &[f64], b: &[f64]) -> Coefficients {
    debug_assert!(a.len() + b.len() <= MOST + 1, "no room for the highest terms");
    let mut values = [0.0; MOST];
    for (i, x) in a.iter().enumerate() {
        for (slot, y) in values.iter_mut().skip(i).zip(b) {
            *slot += x * y;
        }
    }
    Coefficients { values, count: (a.len() + b.len()).saturating_sub(1) }
}

/// Returns `first a + second b` for two polynomials of the same degree.
pub(crate) fn sum(first: f64, a: &[f64], second: f64, b: &[f64]) -> Coefficients {
    let mut values = [0.0; MOST];
    for (slot, (x, y)) in values.iter_mut().zip(a.iter().zip(b)) {
        *slot = first * x + second * y;
    }
    Coefficients { values, count: a.len().min(b.len()) }
}

/// Returns the real roots of a polynomial in no particular order. `on` gives its coefficients on an
/// interval; `breaks` are finite points at which its scale may change. A pair of roots that
/// round-off cannot separate is not returned.
pub(crate) fn real_roots(on: &impl Fn(Point, Point) -> Coefficients, breaks: &[f64]) -> Vec<f64> {
    let mut finite: Vec<f64> = breaks.iter().copied().filter(|x| x.is_finite()).collect();
    finite.sort_by(f64::total_cmp);
    finite.dedup();
    let mut points = vec![Point { p: -1.0, q: 0.0 }];
    points.extend(finite.into_iter().map(Point::finite));
    points.push(Point { p: 1.0, q: 0.0 });
    let mut roots = Vec::new();
    let mut work: Vec<(Point, Point, usize)> = Vec::new();
    for pair in points.windows(2) {
        if let [from, to] = *pair {
            work.push((from, to, 0));
            vanishes(on, to, &mut roots);
        }
    }
    while let Some((from, to, halvings)) = work.pop() {
        let changes = sign_changes(&on(from, to));
        let middle = from.middle(to);
        let narrow = halvings == MOST_HALVINGS || middle == from || middle == to;
        match changes {
            0 => {}
            1 => roots.push(bisected(on, from, to).value()),
            odd if narrow => roots.extend((odd % 2 == 1).then(|| middle.value())),
            _ => {
                vanishes(on, middle, &mut roots);
                work.push((from, middle, halvings + 1));
                work.push((middle, to, halvings + 1));
            }
        }
    }
    roots.retain(|root| root.is_finite());
    roots
}

/// Records `at` if the polynomial vanishes at this finite point.
fn vanishes(on: &impl Fn(Point, Point) -> Coefficients, at: Point, roots: &mut Vec<f64>) {
    if at.q > 0.0 && end(on, at) == 0.0 {
        roots.push(at.value());
    }
}

/// Evaluates the polynomial at a point, with the same rounding as the coefficients of any interval
/// that ends there.
fn end(on: &impl Fn(Point, Point) -> Coefficients, at: Point) -> f64 {
    on(at, at).first().copied().unwrap_or(0.0)
}

/// Counts the sign changes among the nonzero coefficients.
fn sign_changes(coefficients: &[f64]) -> usize {
    let mut signs = coefficients.iter().filter(|value| **value != 0.0).map(|value| *value > 0.0);
    let Some(mut last) = signs.next() else { return 0 };
    let mut changes = 0;
    for sign in signs {
        changes += usize::from(sign != last);
        last = sign;
    }
    changes
}

/// Locates the single root inside an interval.
fn bisected(on: &impl Fn(Point, Point) -> Coefficients, from: Point, to: Point) -> Point {
    // Sign just inside the first end, where the value itself may be zero.
    let first = on(from, to).iter().copied().find(|value| *value != 0.0).unwrap_or(0.0) > 0.0;
    let (mut low, mut high) = (from, to);
    for _ in 0..MOST_HALVINGS {
        let middle = low.middle(high);
        if middle == low || middle == high {
            break;
        }
        let value = end(on, middle);
        if value == 0.0 {
            return middle;
        }
        if (value > 0.0) == first { low = middle } else { high = middle }
    }
    low.middle(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the coefficients of `(x - a)(x - b)` on an interval.
    fn pair(a: f64, b: f64) -> impl Fn(Point, Point) -> Coefficients {
        move |from, to| {
            let at = |u: Point, v: Point| {
                0.5 * ((u.p - a * u.q) * (v.p - b * v.q) + (v.p - a * v.q) * (u.p - b * u.q))
            };
            Coefficients::quadratic(from, to, at)
        }
    }

    #[test]
    #[cfg(debug_assertions)]
    #[should_panic(expected = "no room for the highest terms")]
    fn a_product_of_too_high_a_degree_is_not_cut() {
        let quadratic = product(&[1.0, 2.0], &[3.0, 4.0]);
        assert_eq!(quadratic[..], [3.0, 10.0, 8.0]);
        assert_eq!(product(&quadratic, &[1.0; MOST - 2]).len(), MOST);
        product(&quadratic, &[1.0; MOST - 1]);
    }

    #[test]
    fn roots_far_away_close_together_and_at_breaks() {
        for (a, b) in [(1.0, 2.0), (-3.0, 1e9), (1.0, 1.0 + 1e-12), (0.0, 5.0), (-1e-9, 1e-9)] {
            let mut found = real_roots(&pair(a, b), &[0.0, 1.0, 2.0]);
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
            let on = |u: Point, v: Point| {
                let at = |u: Point, v: Point| u.p * v.p + e * e * u.q * v.q;
                Coefficients::quadratic(u, v, at)
            };
            assert_eq!(real_roots(&on, &[-0.3, 1.0]), Vec::<f64>::new());
        }
    }
}
