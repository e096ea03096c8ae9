//! Contact of three or more sides at once, which occurs with very compliant blades or a step that
//! is too long.
//!
//! Relative error: round-off times the condition number of `W`. Cost: that of the eliminations
//! tried, at most `MOST_PIVOTING`.

use crate::numeric::elimination::eliminate;
use crate::tolerances::{FEW_ROWS, MOST_PIVOTING, ROUND_OFF, SINGULAR};

/// Rows of one step. The memory is reused from step to step.
#[derive(Clone, Debug, Default)]
pub struct Several {
    /// Matrix `W`, row by row \[m/N\].
    w: Vec<f64>,
    /// Predicted gaps \[m\].
    gaps: Vec<f64>,
    /// Whether each row is treated as closed.
    closed: Vec<bool>,
    chosen: Vec<usize>,
    /// Equations of the closed rows, each followed by its right-hand side.
    equations: Vec<f64>,
    /// Multiplier of every row; zero for open rows \[N\].
    multipliers: Vec<f64>,
}

impl Several {
    /// Sets the predicted gaps \[m\] and the matrix `W`: a unit multiplier of row `b` reduces the
    /// gap of row `a` by `entry(a, b)` \[m/N\].
    pub fn fill(&mut self, gaps: &[f64], entry: impl Fn(usize, usize) -> f64) {
        let rows = gaps.len();
        self.gaps.clear();
        self.gaps.extend_from_slice(gaps);
        self.w.clear();
        for a in 0..rows {
            self.w.extend((0..rows).map(|b| entry(a, b)));
        }
    }

    /// Closes every row as an equality, Eq. (13a). `None` if `W` is singular to working precision,
    /// which happens with more rows than coordinates to close them.
    pub fn all_closed(&mut self) -> Option<&[f64]> {
        self.begin(|_| true);
        self.close(SINGULAR)?;
        Some(&self.multipliers)
    }

    /// Solves the complementarity problem by principal pivoting with the least index (Murty), which
    /// terminates for every positive definite `W`.
    ///
    /// With few rows the search begins with all penetrations closed, which is nearly always the
    /// solution. If that fails, and with more rows, it begins with all rows open. `None` if the
    /// work limit is reached or a set of closed rows is singular.
    pub fn complementary(&mut self) -> Option<&[f64]> {
        let few = self.gaps.iter().filter(|gap| **gap < 0.0).count() <= FEW_ROWS;
        let found = few && {
            self.begin(|gap| gap < 0.0);
            self.pivot(ROUND_OFF).is_some()
        };
        if !found {
            self.begin(|_| false);
            self.pivot(SINGULAR)?;
        }
        Some(&self.multipliers)
    }

    /// Starts with the rows closed whose gap satisfies `is_closed`.
    fn begin(&mut self, is_closed: impl Fn(f64) -> bool) {
        self.closed.clear();
        self.closed.extend(self.gaps.iter().map(|&gap| is_closed(gap)));
    }

    /// Returns the largest magnitude of a predicted gap \[m\].
    fn scale(&self) -> f64 {
        self.gaps.iter().fold(0.0_f64, |most, gap| most.max(gap.abs()))
    }

    /// Opens and closes rows until every row satisfies its condition.
    fn pivot(&mut self, singular: f64) -> Option<()> {
        let rows = self.gaps.len();
        let round_off = ROUND_OFF * self.scale();
        let mut work = 0;
        while work < MOST_PIVOTING {
            self.close(singular)?;
            work += rows * rows + self.chosen.len().pow(3);
            let wrong = (0..rows).find(|&row| {
                if self.closed[row] {
                    self.multipliers[row] > 0.0
                } else {
                    self.left(row) < -round_off
                }
            });
            match wrong {
                None => return Some(()),
                Some(row) => self.closed[row] = !self.closed[row],
            }
        }
        None
    }

    /// Returns the gap of a row after the correction \[m\].
    fn left(&self, row: usize) -> f64 {
        let rows = self.gaps.len();
        let moved = self.w[row * rows..].iter().zip(&self.multipliers);
        self.gaps[row] - moved.map(|(w, lambda)| w * lambda).sum::<f64>()
    }

    /// Computes the multipliers that close the chosen rows. `None` if a residual gap exceeds
    /// `singular` times the largest gap.
    fn close(&mut self, singular: f64) -> Option<()> {
        let rows = self.gaps.len();
        self.chosen.clear();
        self.chosen.extend((0..rows).filter(|&row| self.closed[row]));
        self.equations.clear();
        for &row in &self.chosen {
            self.equations.extend(self.chosen.iter().map(|&by| self.w[row * rows + by]));
            self.equations.push(self.gaps[row]);
        }
        let size = self.chosen.len();
        eliminate(&mut self.equations, size)?;
        self.multipliers.clear();
        self.multipliers.resize(rows, 0.0);
        for (place, &row) in self.chosen.iter().enumerate() {
            self.multipliers[row] = self.equations[place * (size + 1) + size];
        }
        let most = singular * self.chosen.iter().fold(0.0_f64, |a, &b| a.max(self.gaps[b].abs()));
        self.chosen.iter().all(|&row| self.left(row).abs() <= most).then_some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(w: &[[f64; 3]; 3], gaps: [f64; 3]) -> Several {
        let mut several = Several::default();
        several.fill(&gaps, |a, b| w[a][b]);
        several
    }

    /// A matrix with which a push on the middle row opens its neighbours.
    const SOFT: [[f64; 3]; 3] = [[1.0, -0.6, 0.2], [-0.6, 1.0, -0.6], [0.2, -0.6, 1.0]];

    #[test]
    fn three_rows_are_closed_or_open_as_they_should() {
        for gaps in [[-1.0, -0.2, -1.0], [-1.0, 0.5, -1.0], [1.0, -1.0, 1.0], [0.1, 0.2, -0.3]] {
            let mut several = rows(&SOFT, gaps);
            let lambda = several.complementary().unwrap().to_vec();
            for row in 0..3 {
                let left = several.left(row);
                assert!(lambda[row] <= 0.0 && left > -1e-15, "{gaps:?} {lambda:?} {left}");
                assert!((lambda[row] * left).abs() < 1e-15, "{gaps:?} {lambda:?} {left}");
            }
            // Starting with open rows, as for larger sets, gives the same solution.
            several.begin(|_| false);
            several.pivot(SINGULAR).unwrap();
            for (a, b) in several.multipliers.iter().zip(&lambda) {
                assert!((a - b).abs() < 1e-14, "{gaps:?}");
            }
        }
    }

    #[test]
    fn three_rows_that_two_coordinates_carry_push_with_two() {
        let normals = [(1.0_f64, 0.0_f64), (0.96, 0.28), (0.8, 0.6)];
        let w = normals.map(|a| normals.map(|b| a.0 * b.0 + a.1 * b.1));
        let mut several = rows(&w, [-1.0, -0.9, -1.0]);
        let lambda = several.complementary().unwrap().to_vec();
        assert_eq!(lambda.iter().filter(|value| **value < 0.0).count(), 2, "{lambda:?}");
        assert!((0..3).all(|row| several.left(row) > -1e-14), "{lambda:?}");
        assert_eq!(rows(&w, [-1.0, 1.0, -1.0]).all_closed(), None);
    }

    #[test]
    fn rows_that_are_one_are_not_closed_together() {
        assert_eq!(rows(&[[1.0; 3]; 3], [-1.0, -1.0, -1.1]).all_closed(), None);
    }
}
