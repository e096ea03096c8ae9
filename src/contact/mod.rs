//! The two contact laws, as small dense problems on predicted gaps.
//!
//! One step predicts gaps `g*` and corrects the displacements by multipliers
//! `lambda`: the corrected gaps are `g = g* - W lambda`, with
//! `W = C^T [M/h^2 + D/2h]^-1 C`, Eqs. (12)-(13). A multiplier below zero
//! pushes. *Bilateral* is Eq. (13a): `g = 0` on every predicted penetration.
//! *Unilateral* is Signorini: `g >= 0`, `lambda <= 0`, `g lambda = 0`.
//!
//! At most one corner of the polygon touches in every ordinary step, so both
//! laws are solved by cases on two rows; larger sets (very compliant blades, a
//! step too long) go to a dense solve, and sets with several blades of one side
//! to `repeated`, which keeps the digits that such rows lose here.

pub mod repeated;

use nalgebra::{DMatrix, DVector};

/// Multiplier of one row alone: `lambda = g/W`.
#[must_use]
pub fn single(w: f64, gap: f64) -> f64 {
    gap / w
}

/// Multipliers of two rows closed as equalities; not finite where the rows
/// are dependent.
#[must_use]
pub fn pair(w: [[f64; 2]; 2], gap: [f64; 2]) -> [f64; 2] {
    let determinant = w[0][0] * w[1][1] - w[0][1] * w[1][0];
    [
        (w[1][1] * gap[0] - w[0][1] * gap[1]) / determinant,
        (w[0][0] * gap[1] - w[1][0] * gap[0]) / determinant,
    ]
}

/// The complementarity problem of two rows, by cases: neither, the first, the
/// second, both. `None` where no case holds (dependent rows).
#[must_use]
pub fn complementary_pair(w: [[f64; 2]; 2], gap: [f64; 2]) -> Option<[f64; 2]> {
    if gap[0] >= 0.0 && gap[1] >= 0.0 {
        return Some([0.0, 0.0]);
    }
    let first = single(w[0][0], gap[0]);
    if first <= 0.0 && gap[1] - w[1][0] * first >= 0.0 {
        return Some([first, 0.0]);
    }
    let second = single(w[1][1], gap[1]);
    if second <= 0.0 && gap[0] - w[0][1] * second >= 0.0 {
        return Some([0.0, second]);
    }
    let both = pair(w, gap);
    (both[0] <= 0.0 && both[1] <= 0.0).then_some(both)
}

/// Every row closed as an equality, Eq. (13a). `None` where `W` is singular, to
/// the digits it has: more rows than coordinates that could close them.
#[must_use]
pub fn all_closed(w: DMatrix<f64>, gap: &[f64]) -> Option<Vec<f64>> {
    let gap = DVector::from_column_slice(gap);
    let solution = w.clone().lu().solve(&gap)?;
    let left = (&w * &solution - &gap).amax();
    (left <= SINGULAR * gap.amax()).then(|| solution.as_slice().to_vec())
}

/// Part of the gaps that round-off may leave open before the equations count as
/// singular.
const SINGULAR: f64 = 1e-3;

/// The complementarity problem of any number of rows, by principal pivoting
/// with the least index (Murty), which ends for every positive definite `W`.
/// `None` where it does not end within its bound or a block is singular.
#[must_use]
pub fn complementary(w: &DMatrix<f64>, gap: &[f64]) -> Option<Vec<f64>> {
    let rows = gap.len();
    let scale = gap.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
    let round_off = 1e-14 * scale;
    let mut active = vec![false; rows];
    for _ in 0..(64 + 8 * rows * rows) {
        let chosen: Vec<usize> = (0..rows).filter(|&row| active[row]).collect();
        let block = DMatrix::from_fn(chosen.len(), chosen.len(), |i, j| w[(chosen[i], chosen[j])]);
        let closed: Vec<f64> = chosen.iter().map(|&row| gap[row]).collect();
        let part = if chosen.is_empty() { Vec::new() } else { all_closed(block, &closed)? };
        let mut lambda = vec![0.0; rows];
        for (&row, value) in chosen.iter().zip(part) {
            lambda[row] = value;
        }
        let wrong = (0..rows).find(|&row| {
            if active[row] {
                lambda[row] > 0.0
            } else {
                let left: f64 = (0..rows).map(|other| w[(row, other)] * lambda[other]).sum();
                gap[row] - left < -round_off
            }
        });
        match wrong {
            None => return Some(lambda),
            Some(row) => active[row] = !active[row],
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// `W` of two sides of the polygon, an angle `turn` apart.
    fn rows(turn: f64) -> [[f64; 2]; 2] {
        [[1.0, turn.cos()], [turn.cos(), 1.0]]
    }

    #[test]
    fn a_corner_closes_both_sides() {
        let w = rows(0.2856);
        let gap = [-1e-6, -0.9e-6];
        let lambda = pair(w, gap);
        for row in 0..2 {
            let left = gap[row] - w[row][0] * lambda[0] - w[row][1] * lambda[1];
            assert!(left.abs() < 1e-20, "{left}");
        }
    }

    #[test]
    fn equality_pulls_where_complementarity_lets_go() {
        let w = rows(0.2856);
        let gap = [-1e-6, -0.5e-6];
        assert!(pair(w, gap)[1] > 0.0);
        assert_eq!(complementary_pair(w, gap), Some([-1e-6, 0.0]));
    }

    #[test]
    fn dependent_rows_are_not_solved() {
        assert!(all_closed(DMatrix::from_element(2, 2, 1.0), &[-1.0, -1.0]).is_none());
    }

    proptest! {
        #[test]
        fn complementarity_holds_and_both_solvers_agree(
            turn in 0.05..3.0_f64, a in -1.0..1.0_f64, b in -1.0..1.0_f64,
        ) {
            let (w, gap) = (rows(turn), [a, b]);
            let lambda = complementary_pair(w, gap).unwrap();
            for row in 0..2 {
                let left = gap[row] - w[row][0] * lambda[0] - w[row][1] * lambda[1];
                prop_assert!(lambda[row] <= 0.0);
                prop_assert!(left >= -1e-13);
                prop_assert!((left * lambda[row]).abs() < 1e-11);
            }
            let dense = DMatrix::from_fn(2, 2, |i, j| w[i][j]);
            let general = complementary(&dense, &gap).unwrap();
            for row in 0..2 {
                // The condition number of W bounds what round-off may change.
                prop_assert!((general[row] - lambda[row]).abs() < 1e-11);
            }
        }
    }
}
