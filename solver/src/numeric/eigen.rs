//! Eigenvalues of small matrices by nalgebra's Schur decomposition, with a bound on its iterations.

use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, ComplexField, DMatrix, DVector, Dyn, Schur};

/// Iterations after which the decomposition counts as stalled; some 3 per row are usual.
const MOST_ITERATIONS: usize = 1000;

/// Returns the eigenvalues of a real matrix; `None` if an entry or eigenvalue is not finite, or if the
/// iteration stalls.
pub(crate) fn eigenvalues(mut matrix: DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let size = matrix.amax();
    if !size.is_finite() || size == 0.0 {
        return (size == 0.0).then(|| vec![Complex::default(); matrix.nrows()]);
    }
    matrix /= size;
    balance_parlett_reinsch(&mut matrix);
    let (_, triangle) = decomposed(matrix)?.unpack();
    finite(of_blocks(&triangle).iter().map(|value| value * size).collect())
}

/// Returns the eigenvalues of a matrix of 1 x 1 and 2 x 2 blocks on the diagonal and zeros below.
fn of_blocks(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
    let mut values: Vec<_> = matrix.diagonal().iter().map(|x| Complex::new(*x, 0.0)).collect();
    for row in (1..values.len()).filter(|row| matrix[(*row, row - 1)] != 0.0) {
        // Of nearly equal real ones the square is positive; nalgebra takes every pair as complex.
        let half = 0.5 * (values[row - 1] - values[row]);
        let root = (half * half + matrix[(row, row - 1)] * matrix[(row - 1, row)]).sqrt();
        let mean = values[row] + half;
        (values[row - 1], values[row]) = (mean + root, mean - root);
    }
    values
}

/// As [`eigenvalues`], of a complex matrix.
pub(crate) fn complex_eigenvalues(matrix: DMatrix<Complex<f64>>) -> Option<Vec<Complex<f64>>> {
    finite(decomposed(matrix)?.eigenvalues()?.iter().copied().collect())
}

fn finite(values: Vec<Complex<f64>>) -> Option<Vec<Complex<f64>>> {
    values.iter().all(|value| value.re.is_finite() && value.im.is_finite()).then_some(values)
}

fn decomposed<T: ComplexField<RealField = f64>>(matrix: DMatrix<T>) -> Option<Schur<T, Dyn>> {
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let own = Schur::try_new(matrix.clone(), f64::EPSILON, MOST_ITERATIONS);
    own.or_else(|| {
        // The iteration can cycle. A similar matrix, reflected along a generic vector, breaks the
        // cycle.
        let entry = |k: usize, _| T::from_real(1.0 + (k as f64).sqrt());
        let generic = DVector::from_fn(matrix.nrows(), entry);
        let half = (&generic * generic.transpose()).unscale(0.5 * generic.norm_squared());
        let reflection = DMatrix::identity(matrix.nrows(), matrix.nrows()) - half;
        Schur::try_new(&reflection * matrix * &reflection, f64::EPSILON, MOST_ITERATIONS)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::elimination::eliminate;

    fn norm(x: &[f64]) -> f64 {
        x.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    /// Returns a bound on the smallest singular value of `A - value`, as an eigenvalue of real and
    /// imaginary parts: `|b|/|x|` of any solution of `(A - value) x = b`, here of inverse iteration.
    fn least_singular(matrix: &DMatrix<f64>, value: Complex<f64>) -> f64 {
        let n = matrix.nrows();
        let entry = |row: usize, column: usize| {
            let (i, j) = (row % n, column % n);
            let shift = |part: f64| if i == j { part } else { 0.0 };
            match (row < n, column < n) {
                (true, false) => shift(value.im),
                (false, true) => shift(-value.im),
                _ => matrix[(i, j)] - shift(value.re),
            }
        };
        let mut x: Vec<f64> = (0..2 * n).map(|k| (k as f64 + 1.0).sqrt()).collect();
        let mut bound = f64::INFINITY;
        for _ in 0..3 {
            let row = |row: usize| (0..2 * n).map(move |column| entry(row, column)).chain([x[row]]);
            let mut equations: Vec<f64> = (0..2 * n).flat_map(row).collect();
            let before = norm(&x);
            if eliminate(&mut equations, 2 * n).is_none() {
                return 0.0;
            }
            x = equations.chunks(2 * n + 1).map(|row| row[2 * n]).collect();
            bound = bound.min(before / norm(&x));
        }
        bound
    }

    /// Checks that every value is an eigenvalue up to rounding, and that sums of powers equal the
    /// traces.
    fn check(matrix: &DMatrix<f64>) {
        let values = eigenvalues(matrix.clone()).unwrap();
        assert_eq!(values.len(), matrix.nrows());
        let size = matrix.norm();
        for value in &values {
            let left = least_singular(matrix, *value);
            assert!(left <= 1e-13 * size, "{value}: {left:e} of {size:e} in {matrix:?}");
        }
        let sum: Complex<f64> = values.iter().sum();
        assert!((sum - matrix.trace()).norm() <= 1e-13 * size, "{sum}");
        let square: Complex<f64> = values.iter().map(|value| value * value).sum();
        let trace = matrix.dot(&matrix.transpose());
        assert!((square - trace).norm() <= 1e-12 * size * size);
    }

    #[test]
    fn matrices_that_stall_the_plain_iteration() {
        for n in 2..=8 {
            // Without exceptional shifts this cycle never converges: its ordinary shifts are all
            // zero.
            let cycle = DMatrix::from_fn(n, n, |i, j| f64::from(u8::from(i == (j + 1) % n)));
            check(&cycle);
            check(&DMatrix::zeros(n, n));
            check(&DMatrix::identity(n, n));
            check(&DMatrix::from_fn(n, n, |i, j| f64::from(u8::from(i + 1 == j))));
        }
    }

    /// Of these real pairs a block keeps two, whose square is positive by round-off.
    #[test]
    fn nearly_equal_real_roots_are_numbers() {
        for (f, b, damping) in [
            (4.440867924601436, 571613.4175983061, 1.8285390730456919),
            (3.1227382214113354e-9, 346633.6475070158, 1.883442421995522),
        ] {
            assert!(eigenvalues(turning(f, b, damping)).is_some(), "{f} {b} {damping}");
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

    /// Returns the matrix of a casing in the frame of a rotor at `f` times its frequency, and of blades
    /// of `b` times its frequency.
    fn turning(f: f64, b: f64, damping: f64) -> DMatrix<f64> {
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
        matrix
    }

    #[test]
    fn random_matrices() {
        let mut random = fastrand::Rng::with_seed(8);
        for case in 0..256 {
            let n = random.usize(2..9);
            let sparse = case % 2 == 0;
            check(&DMatrix::from_fn(n, n, |_, _| {
                if sparse && random.bool() { 0.0 } else { 2.0 * random.f64() - 1.0 }
            }));
        }
    }

    /// Over thirty powers of ten; the roots have closed forms.
    #[test]
    fn turning_oscillators() {
        let mut random = fastrand::Rng::with_seed(30);
        for case in 0..256 {
            let [f, b] = [(); 2].map(|()| 10_f64.powf(30.0 * random.f64() - 15.0));
            let damping = if case % 2 == 0 { 0.0 } else { 2.0 * random.f64() };
            let values = eigenvalues(turning(f, b, damping)).unwrap();
            // The values are those of a matrix that differs by `off`, some units of round-off of its
            // largest entries. Of a block of the size `size` this moves two roots that are `apart` by
            // `off size/apart`, and a double root by `sqrt(off size)`.
            let off = 1e-14 * ((1.0 + damping) * (1.0 + b) + f);
            let near = |expected: Complex<f64>, size: f64, apart: f64| {
                let error = off + 4.0 * off * size / (apart + (off * size).sqrt());
                values.iter().any(|value| (value - expected).norm() <= error)
            };
            let root = Complex::new(damping * damping - 1.0, 0.0).sqrt();
            for sign in [1.0, -1.0] {
                let (of_blades, apart) = ((root * sign - damping) * b, 2.0 * root.norm());
                let size = 1.0 + damping;
                assert!(near(of_blades, b * size, b * apart), "{of_blades} in {values:?}");
                let of_casing = root * sign - damping + Complex::new(0.0, f);
                assert!(near(of_casing, size + f, apart), "{of_casing} in {values:?}");
            }
        }
    }
}
