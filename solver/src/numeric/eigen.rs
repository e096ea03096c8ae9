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

    proptest! {
        #[test]
        fn random_matrices(
            n in 2..9_usize, entries in prop::collection::vec(-1.0..1.0_f64, 64),
            zeros in prop::collection::vec(any::<bool>(), 64), sparse: bool,
        ) {
            let entry = |k: usize| if sparse && zeros[k] { 0.0 } else { entries[k] };
            check(&DMatrix::from_fn(n, n, |i, j| entry(8 * i + j)))?;
        }

        /// Over thirty powers of ten; the roots have closed forms.
        #[test]
        fn turning_oscillators(
            power in -15.0..15.0_f64, blades in -15.0..15.0_f64,
            damping in prop_oneof![Just(0.0), 0.0..2.0_f64],
        ) {
            let (f, b) = (10_f64.powf(power), 10_f64.powf(blades));
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
                prop_assert!(near(of_blades, b * size, b * apart), "{of_blades} in {values:?}");
                let of_casing = root * sign - damping + Complex::new(0.0, f);
                prop_assert!(near(of_casing, size + f, apart), "{of_casing} in {values:?}");
            }
        }
    }
}
