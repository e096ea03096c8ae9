//! Pushes of a few rows that touch: no push pulls, nothing closes, and what opens
//! has no push. With friction the matrix is not symmetric. Few rows ever touch
//! together, so every choice of pushing rows is tried, larger ones first: where a
//! choice is a tie, more rows hold.

use crate::numeric::elimination::inverse;
use crate::tolerances::{MOST_HELD, MOST_JOINED};

/// The solution `p >= 0` of `W p + opening >= 0`, `p (W p + opening) = 0`, where sizes
/// up to `noise` count as zero; none where there is none, or too many rows.
pub(super) fn pushes(
    joint: impl Fn(usize, usize) -> f64,
    opening: &[f64],
    noise: f64,
) -> Option<Vec<f64>> {
    let n = opening.len();
    if n > MOST_JOINED {
        return None;
    }
    let matrix: Vec<Vec<f64>> =
        (0..n).map(|row| (0..n).map(|by| joint(row, by)).collect()).collect();
    (0..=n.min(MOST_HELD)).rev().find_map(|size| {
        (0_u32..1 << n)
            .filter(|choice| choice.count_ones() as usize == size)
            .find_map(|choice| try_choice(&matrix, opening, noise, choice))
    })
}

/// The pushes of the rows of one choice, if nothing is wrong with them.
fn try_choice(matrix: &[Vec<f64>], opening: &[f64], noise: f64, choice: u32) -> Option<Vec<f64>> {
    let chosen: Vec<usize> = (0..opening.len()).filter(|row| (choice >> row) & 1 == 1).collect();
    let mut square = [[0.0; MOST_HELD]; MOST_HELD];
    let mut right = [0.0; MOST_HELD];
    for (k, &row) in chosen.iter().enumerate() {
        right[k] = -opening[row];
        for (l, &by) in chosen.iter().enumerate() {
            square[k][l] = matrix[row][by];
        }
    }
    let inverse = inverse(&square, chosen.len())?;
    let mut pushes = vec![0.0; opening.len()];
    for (k, &row) in chosen.iter().enumerate() {
        let push: f64 = inverse[k].iter().zip(&right).map(|(a, b)| a * b).sum();
        let least: f64 = inverse[k].iter().map(|entry| entry.abs()).sum();
        if push.is_nan() || push < -noise * least {
            return None;
        }
        pushes[row] = push.max(0.0);
    }
    let open = |row: usize| {
        let lifted: f64 = matrix[row].iter().zip(&pushes).map(|(a, b)| a * b).sum();
        (choice >> row) & 1 == 1 || opening[row] + lifted >= -noise
    };
    (0..opening.len()).all(open).then_some(pushes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_rows_by_cases() {
        let matrix = [[1.0, 0.9], [0.7, 1.2]];
        let joint = |row: usize, by: usize| matrix[row][by];
        for opening in [[-1.0, -1.0], [-1.0, 0.5], [0.5, -1.0], [1.0, 1.0], [-1.0, 0.0]] {
            let found = pushes(joint, &opening, 1e-14).unwrap();
            for row in 0..2 {
                let rate = opening[row] + matrix[row][0] * found[0] + matrix[row][1] * found[1];
                assert!(found[row] >= 0.0 && rate > -1e-14 && (rate * found[row]).abs() < 1e-13);
            }
        }
        assert_eq!(pushes(joint, &[1.0, 1.0], 1e-14).unwrap(), [0.0, 0.0]);
        assert_eq!(pushes(joint, &[-1.0, 1.0], 1e-14).unwrap(), [1.0, 0.0]);
    }

    #[test]
    fn equal_rows_share_a_push_somehow_and_no_push_is_made_up() {
        let found = pushes(|_, _| 2.0, &[-1.0, -1.0, -1.0], 1e-14).unwrap();
        assert!((found.iter().sum::<f64>() - 0.5).abs() < 1e-15);
        assert_eq!(pushes(|_, _| -1.0, &[-1.0], 1e-14), None);
        assert_eq!(pushes(|_, _| 1.0, &[-1.0; MOST_JOINED + 1], 1e-14), None);
    }
}
