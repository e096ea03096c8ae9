//! Small systems of linear equations, and inverses of small matrices, by Gaussian elimination with
//! partial pivoting.
//!
//! Relative error: round-off times the condition number. Cost: `n^3/3` products for a system, `n^3`
//! for an inverse. No heap allocation.

use crate::numeric::rounding::AS_ZERO;

/// Solves `size` equations in place. Each row is followed by its right-hand side, which is
/// overwritten with the solution. Returns `None` if the matrix is singular.
pub(crate) fn eliminate(equations: &mut [f64], size: usize) -> Option<()> {
    let width = size + 1;
    for k in 0..size {
        let entry = |row: usize| equations[row * width + k].abs();
        let pivot = (k..size).max_by(|&a, &b| entry(a).total_cmp(&entry(b)))?;
        if pivot != k {
            let (above, below) = equations.split_at_mut(pivot * width);
            above[k * width..(k + 1) * width].swap_with_slice(&mut below[..width]);
        }
        let (above, below) = equations.split_at_mut((k + 1) * width);
        let row = &above[k * width..];
        if row[k] == 0.0 {
            return None;
        }
        for other in below.chunks_exact_mut(width) {
            let factor = other[k] / row[k];
            for (value, above) in other[k..].iter_mut().zip(&row[k..]) {
                *value -= factor * above;
            }
        }
    }
    for k in (0..size).rev() {
        let (above, below) = equations.split_at_mut((k + 1) * width);
        let row = &mut above[k * width..];
        let later = row[k + 1..size].iter().zip(below.chunks_exact(width));
        let known: f64 = later.map(|(factor, other)| factor * other[size]).sum();
        row[size] = (row[size] - known) / row[k];
    }
    Some(())
}

/// Square matrix with room for `N` rows.
pub(crate) type Square<const N: usize> = [[f64; N]; N];

/// Inverts the leading `n` by `n` block; `None` if it is singular to working precision.
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
        if size.is_nan() || size <= AS_ZERO * largest {
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
    // Entries outside the block are set to zero.
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
    fn equations_are_solved_and_singular_ones_are_not() {
        let solved = |mut equations: Vec<f64>, size: usize| {
            eliminate(&mut equations, size)?;
            Some((0..size).map(|k| equations[k * (size + 1) + size]).collect::<Vec<f64>>())
        };
        assert_eq!(solved(Vec::new(), 0), Some(Vec::new()));
        // One pivot is zero, another one small compared with the other entries.
        let equations = vec![0.0, 2.0, 1.0, 7.0, 1e-20, 1.0, 1.0, 5.0, 4.0, 1.0, -1.0, 3.0];
        assert_eq!(solved(equations, 3), Some(vec![1.0, 2.0, 3.0]));
        assert_eq!(solved(vec![1.0, 2.0, 3.0, 2.0, 4.0, 6.0], 2), None);
    }

    #[test]
    fn the_inverse_times_the_matrix_is_one_and_a_singular_matrix_has_none() {
        // The first pivot is zero; the fourth row and column are not used.
        let matrix = [[0.0, 2.0, -1.0, 9.0], [3.0, 0.5, 0.0, 9.0], [1.0, -4.0, 7.0, 9.0], [9.0; 4]];
        let found = inverse(&matrix, 3).unwrap();
        for (row, line) in found.iter().take(3).enumerate() {
            for column in 0..3 {
                let product: f64 = line.iter().zip(&matrix).map(|(a, b)| a * b[column]).sum();
                let one = f64::from(u8::from(row == column));
                assert!((product - one).abs() < 1e-15);
            }
            assert_eq!(line[3], 0.0);
        }
        assert_eq!(found[3], [0.0; 4]);
        assert_eq!(inverse(&[[1.0, 2.0], [2.0, 4.0]], 2), None);
        assert_eq!(inverse(&[[1.0, f64::NAN], [2.0, 4.0]], 2), None);
        assert_eq!(inverse(&[[1.0, 2.0], [2.0, 4.0]], 1), Some([[1.0, 0.0], [0.0, 0.0]]));
    }
}
