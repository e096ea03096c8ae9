//! Linear complementarity: `g - W lambda >= 0`, `lambda <= 0`, complementary, or the same rows
//! closed as equalities `W lambda = g` (docs/theory.md, sections 2 and 6). A multiplier below zero
//! pushes.
//!
//! In an ordinary step one corner of the polygon touches, so a problem of two rows is solved by
//! cases. A larger one is solved by principal pivoting with the least index (Murty), which
//! terminates for every positive definite `W`; `MOST_PIVOTING` bounds its work. Relative error:
//! round-off times the condition number of `W`.

use super::elimination::eliminate;
use crate::numeric::rounding::ROUND_OFF;

/// Largest number of multiplications in one solution, about 0.1 s. Pivoting usually ends after one
/// or two tries, but its worst case is exponential.
const MOST_PIVOTING: usize = 100_000_000;

/// Penetration of a row, relative to the deepest one, that counts as round-off when two rows are
/// closed and three or more sides meet in one point.
const CLOSED_PART: f64 = 1e-9;

/// Residual of the closed rows, relative to their largest gap, above which the equations count as
/// singular.
const SINGULAR: f64 = 1e-3;

/// Pivoting starts with all penetrating rows closed if there are at most this many. Of more rows
/// only some push, and closing all of them first costs more than starting with none.
const FEW_ROWS: usize = 4;

/// Closes two rows as equalities; not finite where the rows are dependent.
#[inline]
pub(crate) fn equality_of_two(w: [[f64; 2]; 2], g: [f64; 2]) -> [f64; 2] {
    let over = 1.0 / (w[0][0] * w[1][1] - w[0][1] * w[1][0]);
    [(w[1][1] * g[0] - w[0][1] * g[1]) * over, (w[0][0] * g[1] - w[1][0] * g[0]) * over]
}

/// Solves the complementarity problem of two rows by cases: neither closed, the first, the second,
/// both. `None` if no case is a solution.
#[inline]
pub(crate) fn complementary_of_two(w: [[f64; 2]; 2], g: [f64; 2]) -> Option<[f64; 2]> {
    if g[0] >= 0.0 && g[1] >= 0.0 {
        return Some([0.0, 0.0]);
    }
    let first = g[0] / w[0][0];
    if first <= 0.0 && g[1] - w[1][0] * first >= 0.0 {
        return Some([first, 0.0]);
    }
    let second = g[1] / w[1][1];
    if second <= 0.0 && g[0] - w[0][1] * second >= 0.0 {
        return Some([0.0, second]);
    }
    let both = equality_of_two(w, g);
    (both[0] <= 0.0 && both[1] <= 0.0).then_some(both)
}

/// The rows of one problem. The buffers are reused from problem to problem.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lcp {
    /// `W`, row by row, and the gaps `g`.
    w: Vec<f64>,
    gaps: Vec<f64>,
    /// The rows that are closed.
    closed: Vec<bool>,
    chosen: Vec<usize>,
    /// Equations of the chosen rows, each followed by its right-hand side.
    equations: Vec<f64>,
    multipliers: Vec<f64>,
}

impl Lcp {
    /// Sets the gaps `g` and the matrix `W`: a unit multiplier of row `b` reduces the gap of row `a`
    /// by `entry(a, b)`.
    #[inline]
    pub fn fill(&mut self, gaps: impl Iterator<Item = f64>, entry: impl Fn(usize, usize) -> f64) {
        self.gaps.clear();
        self.gaps.extend(gaps);
        self.w.clear();
        for a in 0..self.gaps.len() {
            self.w.extend((0..self.gaps.len()).map(|b| entry(a, b)));
        }
    }

    /// Closes every row as an equality, Eq. (13a). `None` if `W` is numerically singular, which it
    /// is with more rows than coordinates.
    pub fn equality(&mut self) -> Option<&[f64]> {
        self.begin(|_| true);
        self.close(SINGULAR)?;
        Some(&self.multipliers)
    }

    /// Solves the complementarity problem. Up to [`FEW_ROWS`] penetrating rows start closed, which
    /// is nearly always the solution; if pivoting fails from there, and for more rows, all start
    /// open. If that fails, too, and the sides `may_meet` in one point, where `W` is singular, each
    /// row and each pair of rows is tried. `None` if no solution is found.
    pub fn complementary(&mut self, may_meet: bool) -> Option<&[f64]> {
        let few = self.gaps.iter().filter(|gap| **gap < 0.0).count() <= FEW_ROWS;
        let mut found = few && {
            self.begin(|gap| gap < 0.0);
            self.pivot(ROUND_OFF).is_some()
        };
        if !found {
            self.begin(|_| false);
            found = self.pivot(SINGULAR).is_some();
        }
        (found || (may_meet && self.try_pairs())).then_some(&self.multipliers[..])
    }

    /// Chooses the rows that start closed, by their gaps.
    fn begin(&mut self, is_closed: impl Fn(f64) -> bool) {
        self.closed.clear();
        self.closed.extend(self.gaps.iter().map(|&gap| is_closed(gap)));
    }

    /// Closes penetrated rows and opens pulling ones, the first wrong row at a time, until none is
    /// wrong. `None` if the equations become singular or the work exceeds its bound.
    fn pivot(&mut self, singular: f64) -> Option<()> {
        let rows = self.gaps.len();
        let round_off = ROUND_OFF * self.gaps.iter().fold(0.0_f64, |most, gap| most.max(gap.abs()));
        let mut work = 0;
        while work < MOST_PIVOTING {
            self.close(singular)?;
            work += rows * rows + self.chosen.len().pow(3);
            let is_wrong = |row: &usize| match self.closed[*row] {
                true => self.multipliers[*row] > 0.0,
                false => self.left(*row) < -round_off,
            };
            match (0..rows).find(is_wrong) {
                None => return Some(()),
                Some(row) => self.closed[row] = !self.closed[row],
            }
        }
        None
    }

    /// Tries each row and each pair of rows; returns whether one pushes and leaves every other row
    /// open, up to [`CLOSED_PART`].
    fn try_pairs(&mut self) -> bool {
        let rows = self.gaps.len();
        let deepest = self.gaps.iter().fold(0.0_f64, |deepest, gap| deepest.max(-gap));
        for b in 0..rows {
            for a in 0..=b {
                self.begin(|_| false);
                (self.closed[a], self.closed[b]) = (true, true);
                let closes = self.close(SINGULAR).is_some()
                    && self.multipliers.iter().all(|lambda| *lambda <= 0.0)
                    && (0..rows).all(|row| self.left(row) >= -CLOSED_PART * deepest);
                if closes {
                    return true;
                }
            }
        }
        false
    }

    /// Returns the gap of a row under the multipliers.
    fn left(&self, row: usize) -> f64 {
        let rows = self.gaps.len();
        let moved = self.w[row * rows..].iter().zip(&self.multipliers);
        self.gaps[row] - moved.map(|(w, lambda)| w * lambda).sum::<f64>()
    }

    /// Computes the multipliers that close the chosen rows. `None` if the matrix is singular or a
    /// residual exceeds `singular` times the largest gap of these rows.
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

    fn filled<const N: usize>(w: &[[f64; N]; N], gaps: [f64; N]) -> Lcp {
        let mut rows = Lcp::default();
        rows.fill(gaps.into_iter(), |a, b| w[a][b]);
        rows
    }

    /// `W` of two sides of the polygon, an angle `turn` apart.
    fn corner(turn: f64) -> [[f64; 2]; 2] {
        [[1.0, turn.cos()], [turn.cos(), 1.0]]
    }

    #[test]
    fn equality_pulls_where_complementarity_lets_go() {
        let (w, gaps) = (corner(0.2856), [-1e-6, -0.5e-6]);
        let lambda = equality_of_two(w, gaps);
        assert!(lambda[1] > 0.0);
        for row in 0..2 {
            let left = gaps[row] - w[row][0] * lambda[0] - w[row][1] * lambda[1];
            assert!(left.abs() < 1e-20, "{left}");
        }
        assert_eq!(complementary_of_two(w, gaps), Some([-1e-6, 0.0]));
    }

    /// A matrix in which the push on the middle row opens its neighbours.
    const SOFT: [[f64; 3]; 3] = [[1.0, -0.6, 0.2], [-0.6, 1.0, -0.6], [0.2, -0.6, 1.0]];

    #[test]
    fn three_rows_are_closed_or_open_as_they_should() {
        for gaps in [[-1.0, -0.2, -1.0], [-1.0, 0.5, -1.0], [1.0, -1.0, 1.0], [0.1, 0.2, -0.3]] {
            let mut rows = filled(&SOFT, gaps);
            let lambda = rows.complementary(false).unwrap().to_vec();
            for row in 0..3 {
                let left = rows.left(row);
                assert!(lambda[row] <= 0.0 && left > -1e-15, "{gaps:?} {lambda:?} {left}");
                assert!((lambda[row] * left).abs() < 1e-15, "{gaps:?} {lambda:?} {left}");
            }
            // From open rows, as many rows begin.
            rows.begin(|_| false);
            rows.pivot(SINGULAR).unwrap();
            for (a, b) in rows.multipliers.iter().zip(&lambda) {
                assert!((a - b).abs() < 1e-14, "{gaps:?}");
            }
        }
    }

    #[test]
    fn three_rows_that_two_coordinates_carry_push_with_two() {
        let normals = [(1.0_f64, 0.0_f64), (0.96, 0.28), (0.8, 0.6)];
        let w = normals.map(|a| normals.map(|b| a.0 * b.0 + a.1 * b.1));
        let mut rows = filled(&w, [-1.0, -0.9, -1.0]);
        let lambda = rows.complementary(true).unwrap().to_vec();
        assert_eq!(lambda.iter().filter(|value| **value < 0.0).count(), 2, "{lambda:?}");
        assert!((0..3).all(|row| rows.left(row) > -1e-14), "{lambda:?}");
        assert_eq!(filled(&w, [-1.0, 1.0, -1.0]).equality(), None);
        assert_eq!(filled(&[[1.0; 3]; 3], [-1.0, -1.0, -1.1]).equality(), None);
    }

    #[test]
    fn two_rows_by_cases_agree_with_pivoting() {
        let mut random = fastrand::Rng::with_seed(2);
        for _ in 0..256 {
            let w = corner(0.05 + 2.95 * random.f64());
            let gaps = [(); 2].map(|()| 2.0 * random.f64() - 1.0);
            let mut rows = filled(&w, gaps);
            let lambda = complementary_of_two(w, gaps).unwrap();
            for (row, gap) in gaps.into_iter().enumerate() {
                let left = gap - w[row][0] * lambda[0] - w[row][1] * lambda[1];
                assert!(lambda[row] <= 0.0 && left >= -1e-13, "{gaps:?} {lambda:?} {left}");
                assert!((left * lambda[row]).abs() < 1e-11, "{gaps:?} {lambda:?} {left}");
            }
            rows.begin(|_| false);
            rows.pivot(SINGULAR).unwrap();
            for (general, lambda) in rows.multipliers.iter().zip(lambda) {
                // The condition number of W bounds what round-off may change.
                assert!((general - lambda).abs() < 1e-11, "{gaps:?} {general} {lambda}");
            }
        }
    }
}
