//! The inverse of a few rows, by Gauss and Jordan with partial pivoting: to round-off of
//! the size of the inverse.
//!
//! `n^3` products, nothing on the heap.

use crate::tolerances::ZERO_PIVOT;

/// A square matrix with room for `N` rows.
pub(crate) type Square<const N: usize> = [[f64; N]; N];

/// The inverse of the first `n` rows and columns; none where it is singular.
pub(crate) fn inverse<const N: usize>(matrix: &Square<N>, n: usize) -> Option<Square<N>> {
    let (mut left, mut right) = (*matrix, [[0.0; N]; N]);
    let largest = matrix.iter().flatten().fold(0.0_f64, |a, b| a.max(b.abs()));
    for (k, row) in right.iter_mut().enumerate() {
        row[k] = 1.0;
    }
    for column in 0..n {
        let pivot =
            (column..n).max_by(|&a, &b| left[a][column].abs().total_cmp(&left[b][column].abs()))?;
        let size = left[pivot][column].abs();
        if size.is_nan() || size <= ZERO_PIVOT * largest {
            return None;
        }
        left.swap(column, pivot);
        right.swap(column, pivot);
        let over = 1.0 / left[column][column];
        left[column].iter_mut().chain(&mut right[column]).for_each(|entry| *entry *= over);
        let (pivots, shares) = (left[column], right[column]);
        for row in (0..n).filter(|&row| row != column) {
            let factor = left[row][column];
            let both = left[row].iter_mut().zip(pivots).chain(right[row].iter_mut().zip(shares));
            both.for_each(|(entry, other)| *entry -= factor * other);
        }
    }
    // What lies beyond the first rows has no meaning.
    for (k, row) in right.iter_mut().enumerate() {
        for (l, entry) in row.iter_mut().enumerate() {
            if k >= n || l >= n {
                *entry = 0.0;
            }
        }
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_times_the_matrix_is_one_and_a_singular_matrix_has_none() {
        // The first pivot is zero; the last row and column are beyond the three.
        let matrix = [[0.0, 2.0, -1.0, 9.0], [3.0, 0.5, 0.0, 9.0], [1.0, -4.0, 7.0, 9.0], [9.0; 4]];
        let found = inverse(&matrix, 3).unwrap();
        for (row, line) in found.iter().enumerate() {
            for column in 0..4 {
                let product: f64 = (0..3).map(|k| line[k] * matrix[k][column]).sum();
                let one = f64::from(u8::from(row == column));
                assert!(row == 3 || column == 3 || (product - one).abs() < 1e-15);
            }
            assert!(line[3] == 0.0 && (row < 3 || *line == [0.0; 4]));
        }
        assert_eq!(inverse(&[[1.0, 2.0], [2.0, 4.0]], 2), None);
        assert_eq!(inverse(&[[1.0, f64::NAN], [2.0, 4.0]], 2), None);
        assert_eq!(inverse(&[[1.0, 2.0], [2.0, 4.0]], 1), Some([[1.0, 0.0], [0.0, 0.0]]));
    }
}
