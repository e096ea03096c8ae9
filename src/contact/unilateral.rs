//! Signorini's law (docs/theory.md, section 2): `g >= 0`, `lambda <= 0`,
//! `g lambda = 0`. A multiplier only pushes, and only where the gap is closed.

use nalgebra::DMatrix;

use super::repeated::Repeated;
use super::{StepLaw, all_closed, pair, single};
use crate::tolerances::{MOST_PIVOTING, PIVOT_GAP};

/// A linear complementarity problem on the rows.
#[derive(Debug)]
pub(super) struct Unilateral;

impl StepLaw for Unilateral {
    fn pulls(&self) -> bool {
        false
    }
    fn pair(&self, w: [[f64; 2]; 2], gap: [f64; 2]) -> Option<[f64; 2]> {
        complementary_pair(w, gap)
    }
    fn dense(&self, w: DMatrix<f64>, gap: &[f64]) -> Option<Vec<f64>> {
        complementary(&w, gap)
    }
    fn repeated<'a>(&self, rows: &'a mut Repeated) -> Option<&'a [f64]> {
        rows.complementary()
    }
    /// It lasts while both sides push.
    fn hold(&self, [a, b]: [f64; 2], _: f64) -> f64 {
        (-a).min(-b)
    }
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

/// The complementarity problem of any number of rows, by principal pivoting
/// with the least index (Murty), which ends for every positive definite `W`.
/// `None` where it does not end within its bound or a block is singular.
#[must_use]
pub fn complementary(w: &DMatrix<f64>, gap: &[f64]) -> Option<Vec<f64>> {
    let rows = gap.len();
    let scale = gap.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
    let round_off = PIVOT_GAP * scale;
    let mut active = vec![false; rows];
    let mut work = 0;
    while work < MOST_PIVOTING {
        let chosen: Vec<usize> = (0..rows).filter(|&row| active[row]).collect();
        work += rows * rows + chosen.len().pow(3);
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
