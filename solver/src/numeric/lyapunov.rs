//! The quadratic size that falls along a stable linear motion.

use nalgebra::{DMatrix, DVector};

/// The solution of `M^T Q + Q M = -1`, with which `x^T Q x` falls along `x' = M x`; positive
/// where that is stable. None where it is singular.
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
