//! Lyapunov function of a stable linear system.

use nalgebra::{DMatrix, DVector};

/// Solves `M^T Q + Q M = -1`. `x^T Q x` then decreases along `x' = M x`, and `Q` is positive
/// definite if the system is stable. `None` if the equation is singular. Solved as one linear
/// system of size `n^2`.
pub(crate) fn lyapunov(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = matrix.nrows();
    let one = DMatrix::<f64>::identity(n, n);
    let transposed = matrix.transpose();
    let sum = one.kronecker(&transposed) + transposed.kronecker(&one);
    let right = DVector::from_iterator(n * n, one.iter().map(|entry| -entry));
    let found = sum.lu().solve(&right)?;
    let bound = DMatrix::from_iterator(n, n, found.iter().copied());
    let symmetric = (&bound + bound.transpose()) * 0.5;
    symmetric.iter().all(|entry| entry.is_finite()).then_some(symmetric)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_falls_along_every_stable_motion() {
        let matrix = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -3.0, -0.2]);
        let bound = lyapunov(&matrix).unwrap();
        let falls = matrix.transpose() * &bound + &bound * &matrix;
        assert!((falls + DMatrix::identity(2, 2)).norm() < 1e-13);
        assert!(bound.clone().cholesky().is_some());
        let growing = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -3.0, 0.2]);
        assert!(lyapunov(&growing).unwrap().cholesky().is_none());
    }
}
