//! Eigenvalues of small dense matrices by the QR algorithm.
//!
//! Backward stable: the values are those of a matrix within about 1e-14 of the largest entry. Costs
//! at most [`STEPS`] QR steps for each eigenvalue or pair, of `n^2` products each; returns `None`
//! beyond that.
//!
//! The QR iteration of nalgebra has no exceptional shifts, and it compares a subdiagonal entry only
//! with its diagonal neighbours, which are zero for undamped motions, so that it never ends on some
//! matrices. This one follows LAPACK's `dlahqr`: Francis double shifts on a balanced Hessenberg
//! matrix, exceptional shifts if these stall, and a larger tolerance if rounding keeps a
//! subdiagonal entry from vanishing.

use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, Hessenberg};

/// Maximum number of QR steps for one eigenvalue or pair; three are usual.
const STEPS: usize = 60;

/// Every so many QR steps an exceptional shift is used, as in LAPACK.
const EXCEPTIONAL: usize = 10;

/// From this QR step on, a subdiagonal entry also counts as zero if it is round-off of the largest
/// entry of the matrix.
const LAST_RESORT: usize = 40;

/// Returns the eigenvalues of a square matrix in no particular order; `None` if an entry is not
/// finite or the iteration does not converge.
pub(crate) fn eigenvalues(mut matrix: DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let size = matrix.amax();
    // `amax` ignores NaN, because comparisons with it are false.
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    if size == 0.0 || matrix.nrows() < 2 {
        return Some(matrix.diagonal().iter().map(|&value| value.into()).collect());
    }
    // Balancing squares the entries; scaled to order one they cannot overflow.
    matrix /= size;
    balance_parlett_reinsch(&mut matrix);
    let mut iteration = Iteration { h: Hessenberg::new(matrix).unpack_h() };
    let values: Vec<_> = iteration.run()?.iter().map(|value| value * size).collect();
    values.iter().all(|value| value.re.is_finite() && value.im.is_finite()).then_some(values)
}

struct Iteration {
    /// Hessenberg matrix: zero below its first subdiagonal.
    h: DMatrix<f64>,
}

impl Iteration {
    fn run(&mut self) -> Option<Vec<Complex<f64>>> {
        let mut values = Vec::with_capacity(self.h.nrows());
        // Splits off one or two eigenvalues at a time, from the last row up.
        let mut rows = self.h.nrows();
        while rows > 0 {
            let first = self.deflate(rows - 1)?;
            if first + 1 == rows {
                values.push(self.h[(first, first)].into());
            } else {
                values.extend(self.pair(first));
            }
            rows = first;
        }
        Some(values)
    }

    /// Iterates until the last row, or the last two, are decoupled; returns the first of these
    /// rows.
    fn deflate(&mut self, last: usize) -> Option<usize> {
        for iteration in 0..STEPS {
            let whole = if iteration < LAST_RESORT { 0.0 } else { self.h.amax() };
            let first = (1..=last).rev().find(|&row| self.is_small(row, last, whole)).unwrap_or(0);
            if first > 0 {
                self.h[(first, first - 1)] = 0.0;
            }
            if first + 1 >= last {
                return Some(first);
            }
            let shift = self.shift(iteration, first, last);
            self.sweep(shift, first, last);
        }
        None
    }

    /// Returns whether the subdiagonal entry of a row is round-off.
    fn is_small(&self, row: usize, last: usize, whole: f64) -> bool {
        let h = &self.h;
        let coupling = h[(row, row - 1)].abs();
        let (above, here) = (h[(row - 1, row - 1)], h[(row, row)]);
        let mut neighbours = above.abs() + here.abs();
        if neighbours == 0.0 {
            neighbours += if row >= 2 { h[(row - 1, row - 2)].abs() } else { 0.0 };
            neighbours += if row < last { h[(row + 1, row)].abs() } else { 0.0 };
        }
        if coupling <= f64::MIN_POSITIVE / f64::EPSILON || coupling <= f64::EPSILON * whole {
            return true;
        }
        if coupling > f64::EPSILON * neighbours {
            return false;
        }
        // Test of Ahues and Tisseur, which is accurate for graded matrices.
        let back = h[(row - 1, row)].abs();
        let (large, small) = (coupling.max(back), coupling.min(back));
        let apart = (above - here).abs();
        let (most, least) = (here.abs().max(apart), here.abs().min(apart));
        let scale = large + most;
        small * (large / scale) <= f64::MIN_POSITIVE.max(f64::EPSILON * (least * (most / scale)))
    }

    /// Returns the two shifts: a complex pair, or one real number twice.
    fn shift(&self, iteration: usize, first: usize, last: usize) -> [Complex<f64>; 2] {
        let h = &self.h;
        let [a, b, c, d] = if iteration > 0 && iteration.is_multiple_of(EXCEPTIONAL) {
            // Alternates between the first and the last rows.
            let even = (iteration / EXCEPTIONAL).is_multiple_of(2);
            let (row, at) = if even { (last - 1, last) } else { (first + 1, first) };
            let size = h[(row, row - 1)].abs() + h[(row + 1, row)].abs();
            let middle = 0.75 * size + h[(at, at)];
            [middle, -0.4375 * size, size, middle]
        } else {
            [h[(last - 1, last - 1)], h[(last - 1, last)], h[(last, last - 1)], h[(last, last)]]
        };
        let [one, other] = eigenvalues_2x2([a, b, c, d]);
        if one.im != 0.0 {
            return [one, other];
        }
        // Of two real shifts the one closer to the last entry is used twice.
        let nearer = if (one.re - d).abs() <= (other.re - d).abs() { one } else { other };
        [nearer, nearer]
    }

    /// Performs one double-shift QR step on the rows `first..=last`.
    fn sweep(&mut self, [one, other]: [Complex<f64>; 2], first: usize, last: usize) {
        let h = &mut self.h;
        // First column of (H - s1)(H - s2), which is real.
        let (top, next) = (h[(first, first)], h[(first + 1, first + 1)]);
        let below = h[(first + 1, first)];
        let size = (top - other.re).abs() + other.im.abs() + below.abs();
        let part = below / size;
        let mut v = [
            part * h[(first, first + 1)] + (top - one.re) * ((top - other.re) / size)
                - one.im * (other.im / size),
            part * (top + next - one.re - other.re),
            part * h[(first + 2, first + 1)],
        ];
        for k in first..last {
            let rows = if k + 2 <= last { 3 } else { 2 };
            if k > first {
                let third = if rows == 3 { h[(k + 2, k - 1)] } else { 0.0 };
                v = [h[(k, k - 1)], h[(k + 1, k - 1)], third];
            }
            let Some((u, beta)) = reflector(&v[..rows]) else { continue };
            if k > first {
                h[(k, k - 1)] = beta;
                for row in k + 1..k + rows {
                    h[(row, k - 1)] = 0.0;
                }
            }
            for column in k..=last {
                let sum: f64 = (0..rows).map(|i| u[i] * h[(k + i, column)]).sum();
                (0..rows).for_each(|i| h[(k + i, column)] -= sum * u[i]);
            }
            for row in first..=last.min(k + 3) {
                let sum: f64 = (0..rows).map(|i| u[i] * h[(row, k + i)]).sum();
                (0..rows).for_each(|i| h[(row, k + i)] -= sum * u[i]);
            }
        }
    }

    /// Returns the eigenvalues of the 2x2 block that begins at row `first`.
    fn pair(&self, first: usize) -> [Complex<f64>; 2] {
        let (i, j) = (first, first + 1);
        eigenvalues_2x2([self.h[(i, i)], self.h[(i, j)], self.h[(j, i)], self.h[(j, j)]])
    }
}

/// Returns `u` of the reflection `1 - u u^T`, `|u|^2 = 2`, that maps `v` to a multiple of the first
/// unit vector, and that multiple; `None` for a zero vector.
fn reflector(v: &[f64]) -> Option<([f64; 3], f64)> {
    let size = v.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
    if size == 0.0 {
        return None;
    }
    let norm = size * v.iter().map(|x| (x / size).powi(2)).sum::<f64>().sqrt();
    let beta = -norm.copysign(v[0]);
    // |v - beta e|^2 = 2 norm (norm + |v_0|).
    let scale = norm.sqrt() * (norm + v[0].abs()).sqrt();
    let mut u = [0.0; 3];
    for (u, x) in u.iter_mut().zip(v) {
        *u = x / scale;
    }
    u[0] = (v[0] - beta) / scale;
    Some((u, beta))
}

/// Returns the eigenvalues of the matrix `[[a, b], [c, d]]`.
fn eigenvalues_2x2([a, b, c, d]: [f64; 4]) -> [Complex<f64>; 2] {
    let half = 0.5 * (a - d);
    let product = b * c;
    let discriminant = half * half + product;
    if discriminant < 0.0 {
        let (re, im) = (d + half, (-discriminant).sqrt());
        return [Complex::new(re, im), Complex::new(re, -im)];
    }
    // The larger root first; the other from the product of both, which avoids cancellation.
    let root = half + discriminant.sqrt().copysign(half);
    let other = if root == 0.0 { 0.0 } else { -product / root };
    [(d + root).into(), (d + other).into()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Checks that every value is an eigenvalue up to rounding, by the smallest singular value of
    /// `A - lambda`, and that sums of powers equal the traces.
    fn check(matrix: &DMatrix<f64>) -> Result<(), TestCaseError> {
        let values = eigenvalues(matrix.clone()).unwrap();
        let n = matrix.nrows();
        prop_assert_eq!(values.len(), n);
        let size = matrix.norm();
        let complex = matrix.map(|x| Complex::new(x, 0.0));
        for value in &values {
            let shifted = &complex - DMatrix::identity(n, n) * *value;
            let left = shifted.singular_values().min();
            prop_assert!(left <= 1e-13 * size, "{value}: {left:e} of {size:e} in {matrix}");
        }
        let sum: Complex<f64> = values.iter().sum();
        prop_assert!((sum - matrix.trace()).norm() <= 1e-13 * size, "{sum}");
        let square: Complex<f64> = values.iter().map(|value| value * value).sum();
        prop_assert!((square - (matrix * matrix).trace()).norm() <= 1e-12 * size * size);
        Ok(())
    }

    #[test]
    fn matrices_that_stall_the_plain_iteration() {
        for n in 2..=8 {
            // Without exceptional shifts this cycle never converges: its ordinary shifts are all
            // zero.
            let cycle = DMatrix::from_fn(n, n, |i, j| f64::from(u8::from(i == (j + 1) % n)));
            check(&cycle).unwrap();
            check(&DMatrix::zeros(n, n)).unwrap();
            check(&DMatrix::identity(n, n)).unwrap();
            check(&DMatrix::from_fn(n, n, |i, j| f64::from(u8::from(i + 1 == j)))).unwrap();
        }
    }

    #[test]
    fn what_is_no_number_has_no_eigenvalues() {
        for bad in [f64::NAN, f64::INFINITY] {
            assert_eq!(eigenvalues(DMatrix::from_element(4, 4, bad)), None);
            let mut one = DMatrix::identity(4, 4);
            one[(2, 1)] = bad;
            assert_eq!(eigenvalues(one), None);
        }
        let huge = eigenvalues(DMatrix::from_diagonal_element(3, 3, 1e300)).unwrap();
        assert!(huge.iter().all(|value| *value == Complex::new(1e300, 0.0)));
    }

    proptest! {
        #[test]
        fn random_matrices(
            n in 2..9_usize, entries in prop::collection::vec(-1.0..1.0_f64, 64),
            zeros in prop::collection::vec(any::<bool>(), 64), sparse: bool,
        ) {
            let entry = |k: usize| if sparse && zeros[k] { 0.0 } else { entries[k] };
            check(&DMatrix::from_fn(n, n, |i, j| entry(8 * i + j)))?;
        }

        /// A casing in the frame of a rotor at `f` times its frequency, and blades of `b` times its
        /// frequency, over thirty powers of ten; the roots have closed forms.
        #[test]
        fn turning_oscillators(
            power in -15.0..15.0_f64, blades in -15.0..15.0_f64,
            damping in prop_oneof![Just(0.0), 0.0..2.0_f64],
        ) {
            let (f, b) = (10_f64.powf(power), 10_f64.powf(blades));
            let mut matrix = DMatrix::zeros(8, 8);
            for i in 0..4 {
                matrix[(i, 4 + i)] = 1.0;
            }
            for i in 0..2 {
                matrix[(4 + i, i)] = -(1.0 - f) * (1.0 + f);
                matrix[(4 + i, 4 + i)] = -2.0 * damping;
                matrix[(6 + i, 2 + i)] = -b * b;
                matrix[(6 + i, 6 + i)] = -2.0 * damping * b;
            }
            let (turn, drag) = (2.0 * f, 2.0 * damping * f);
            (matrix[(4, 5)], matrix[(5, 4)]) = (turn, -turn);
            (matrix[(4, 1)], matrix[(5, 0)]) = (drag, -drag);
            let values = eigenvalues(matrix).unwrap();
            // Nearly equal roots are accurate to half the digits.
            let fast = 1.0 + f + (1.0 + damping) * b;
            let near = |expected: Complex<f64>, scale: f64| {
                let error = 1e-7 * scale + 1e-13 * fast;
                values.iter().any(|value| (value - expected).norm() <= error)
            };
            let root = Complex::new(damping * damping - 1.0, 0.0).sqrt();
            for sign in [1.0, -1.0] {
                let of_blades = (root * sign - damping) * b;
                prop_assert!(near(of_blades, b * (1.0 + damping)), "{of_blades} in {values:?}");
                let of_casing = root * sign - damping + Complex::new(0.0, f);
                prop_assert!(near(of_casing, 1.0 + f), "{of_casing} in {values:?}");
            }
        }
    }
}
