//! Contact rows that nearly repeat each other: the blades of one side of the
//! polygon, whose gaps differ only as far as the blades bend apart.
//! (docs/theory.md, section 6.)
//!
//! With casing compliance `c`, normals `n_r` and `B_rs = A_r A_s` times the
//! blade compliance, the matrix of a step is `W = c n n^T + B`, and `B` is a
//! billionth of the first part or less: solved directly, two such rows lose
//! all digits. So each group of rows has one reference row, and what the
//! others differ in is given apart. With the casing's opening `s = c sum n_r
//! lambda_r` and the part `e_G` of the reference gap that the blades close,
//!
//! ```text
//! (B lambda)_r - e_G + (n_r - n_G) s = g_r - g_G        every closed row r of G
//! n_G s + e_G = g_G                                     every group G
//! ```
//!
//! where each equation is of one size. Rows that do not differ at all share
//! their group's push evenly.

use crate::numeric::elimination::eliminate;
use crate::tolerances::{AS_ZERO, MOST_PIVOTING};

/// One row, as its difference from the reference of its group.
#[derive(Clone, Copy, Debug)]
pub struct Repeat {
    /// Place of its group in the list of groups.
    pub group: usize,
    /// Gap less that of the reference \[m\].
    pub gap: f64,
    /// Normal.
    pub normal: (f64, f64),
    /// Normal less that of the reference.
    pub turned: (f64, f64),
    /// `A = dg/dalpha` \[m\].
    pub moment_arm: f64,
}

/// The reference of one group.
#[derive(Clone, Copy, Debug)]
pub struct GroupReference {
    /// Its predicted gap \[m\].
    pub gap: f64,
    /// Its normal.
    pub normal: (f64, f64),
}

/// The rows of one step. It is filled anew in each and keeps its memory, as the
/// steps are many and their rows few.
#[derive(Clone, Debug, Default)]
pub struct Repeated {
    /// The groups, each with at least one row.
    pub groups: Vec<GroupReference>,
    /// The rows.
    pub rows: Vec<Repeat>,
    /// Casing displacement by a unit force in one step \[m/N\].
    pub casing: f64,
    /// `B`, row by row \[m/N\].
    bends: Vec<f64>,
    /// The rows that are closed.
    active: Vec<bool>,
    chosen: Vec<usize>,
    /// The groups with closed rows.
    held: Vec<usize>,
    /// Size of `B` in each group.
    scales: Vec<f64>,
    /// The equations, and behind each its right side.
    equations: Vec<f64>,
    /// Of every row; zero where it is open \[N\].
    multipliers: Vec<f64>,
    /// `s` above \[m\].
    opening: (f64, f64),
    /// `e_G` of the groups with closed rows \[m\].
    remainders: Vec<Option<f64>>,
}

impl Repeated {
    /// Removes all rows, for a casing that a unit force displaces by `casing` in one step
    /// \[m/N\].
    pub fn begin(&mut self, casing: f64) {
        self.casing = casing;
        self.groups.clear();
        self.rows.clear();
    }

    /// Computes the compliance of the blades once all rows are there; `blades` is the angle of
    /// one row by a unit torque on another in one step.
    pub fn bend_by(&mut self, blades: impl Fn(usize, usize) -> f64) {
        self.bends.clear();
        for (i, row) in self.rows.iter().enumerate() {
            for (j, other) in self.rows.iter().enumerate() {
                self.bends.push(row.moment_arm * other.moment_arm * blades(i, j));
            }
        }
    }

    /// Closes every row as an equality, Eq. (13a). `None` where the rows are
    /// dependent and contradict each other.
    pub fn all_closed(&mut self) -> Option<&[f64]> {
        self.active.clear();
        self.active.resize(self.rows.len(), true);
        self.close()?;
        Some(&self.multipliers)
    }

    /// Solves the complementarity problem of these rows by principal pivoting with
    /// the least index (Murty) from all penetrations closed, which is nearly
    /// always the answer. Not `Several`: its one matrix `W` loses the digits in which these
    /// rows differ. `None` where it does not end within its bound of work.
    pub fn complementary(&mut self) -> Option<&[f64]> {
        let count = self.rows.len();
        let closes = |row: &Repeat| self.groups[row.group].gap + row.gap < 0.0;
        self.active.clear();
        self.active.extend(self.rows.iter().map(closes));
        let mut work = 0;
        while work < MOST_PIVOTING {
            self.close()?;
            work += count * count + self.chosen.len().pow(3);
            let wrong = (0..count).find(|&row| {
                if self.active[row] { self.multipliers[row] > 0.0 } else { self.is_shut(row) }
            });
            match wrong {
                None => return Some(&self.multipliers),
                Some(row) => self.active[row] = !self.active[row],
            }
        }
        None
    }

    /// Returns `B_rs` of one row and all others \[m/N\].
    fn bends(&self, row: usize) -> &[f64] {
        let count = self.rows.len();
        &self.bends[row * count..(row + 1) * count]
    }

    /// Whether an open row would be left penetrating.
    fn is_shut(&self, row: usize) -> bool {
        let Repeat { group, gap, turned, normal, .. } = self.rows[row];
        let bends = self.bends(row).iter().zip(&self.multipliers);
        let bent: f64 = bends.map(|(bend, lambda)| bend * lambda).sum();
        let (left, shift) = match self.remainders[group] {
            Some(remainder) => (remainder + gap, dot(turned, self.opening)),
            None => (self.groups[group].gap + gap, dot(normal, self.opening)),
        };
        let size = left.abs() + gap.abs() + shift.abs() + bent.abs();
        left - shift - bent < -AS_ZERO * size
    }

    /// Solves the equations above for the active rows.
    fn close(&mut self) -> Option<()> {
        let of = |row: usize| self.rows[row].group;
        self.chosen.clear();
        self.chosen.extend((0..self.rows.len()).filter(|&row| self.active[row]));
        self.scales.clear();
        self.scales.resize(self.groups.len(), 0.0);
        self.held.clear();
        for &row in &self.chosen {
            let group = of(row);
            // Rows of a group stand together.
            if self.held.last() != Some(&group) {
                self.held.push(group);
            }
            // Blades without a moment arm share evenly.
            let own = self.bends[row * self.rows.len() + row];
            self.scales[group] = self.scales[group].max(own);
        }
        self.fill();
        let count = self.chosen.len();
        let size = count + self.held.len();
        eliminate(&mut self.equations, size)?;
        let solution = |place: usize| self.equations[place * (size + 1) + size];
        self.multipliers.clear();
        self.multipliers.resize(self.rows.len(), 0.0);
        self.opening = (0.0, 0.0);
        for (i, &row) in self.chosen.iter().enumerate() {
            let (lambda, normal) = (solution(i), self.rows[row].normal);
            self.multipliers[row] = lambda;
            self.opening.0 += self.casing * lambda * normal.0;
            self.opening.1 += self.casing * lambda * normal.1;
        }
        self.remainders.clear();
        self.remainders.resize(self.groups.len(), None);
        for (k, &group) in self.held.iter().enumerate() {
            self.remainders[group] = Some(self.scales[group] * solution(count + k));
        }
        self.multipliers.iter().all(|lambda| lambda.is_finite()).then_some(())
    }

    /// Writes the equations of the chosen rows, and of their groups.
    fn fill(&mut self) {
        let Self { rows, chosen, held, scales, equations, .. } = self;
        equations.clear();
        let count = rows.len();
        for (i, &row) in chosen.iter().enumerate() {
            let Repeat { group, gap, turned, .. } = rows[row];
            let scale = scales[group];
            for (j, &other) in chosen.iter().enumerate() {
                equations.push(if scale > 0.0 {
                    let shift = self.casing * dot(turned, rows[other].normal);
                    (self.bends[row * count + other] + shift) / scale
                } else {
                    f64::from(u8::from(i == j))
                });
            }
            equations.extend(held.iter().map(|&held| -f64::from(u8::from(held == group))));
            equations.push(if scale > 0.0 { gap / scale } else { 0.0 });
        }
        for &group in held.iter() {
            let reference = self.groups[group];
            let normals = chosen.iter().map(|&other| dot(reference.normal, rows[other].normal));
            equations.extend(normals);
            let own = scales[group] / self.casing;
            equations.extend(held.iter().map(|&held| if held == group { own } else { 0.0 }));
            equations.push(reference.gap / self.casing);
        }
    }
}

fn dot(a: (f64, f64), b: (f64, f64)) -> f64 {
    a.0 * b.0 + a.1 * b.1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two sides a corner apart with `each` rows, casing compliance one, blades
    /// `soft` of it with little coupling; rows of a side `apart` in angle.
    fn corner(each: usize, soft: f64, apart: f64, gaps: [f64; 2]) -> Repeated {
        let groups: Vec<GroupReference> = [(0.0, gaps[0]), (0.2856, gaps[1])]
            .map(|(phase, gap): (f64, f64)| GroupReference {
                gap,
                normal: (phase.cos(), phase.sin()),
            })
            .to_vec();
        let mut rows = Vec::new();
        for (group, sign) in [(0, -1.0), (1, 1.0)] {
            let (c, s) = groups[group].normal;
            for place in 0..each {
                let angle = apart * place as f64;
                let half = (0.5 * angle).sin();
                let (cos, sin) = (-2.0 * half * half, angle.sin());
                let turned = (c * cos - s * sin, s * cos + c * sin);
                let moment_arm = sign * soft.sqrt();
                let gap = moment_arm * angle;
                let normal = (c + turned.0, s + turned.1);
                rows.push(Repeat { group, gap, normal, turned, moment_arm });
            }
        }
        let mut repeated = Repeated { groups, rows, casing: 1.0, ..Repeated::default() };
        repeated.bend_by(blades(each));
        repeated
    }

    fn blades(each: usize) -> impl Fn(usize, usize) -> f64 {
        move |a: usize, b: usize| match (a == b, a / each == b / each) {
            (true, _) => 1.0,
            (_, true) => 0.1,
            _ => 0.02,
        }
    }

    #[test]
    fn rows_that_repeat_each_other_share_the_push_of_one() {
        for each in [2, 3, 8] {
            for soft in [0.0, 1e-30, 1e-16, 1e-9, 1e-2] {
                let mut repeated = corner(each, soft, 0.0, [-1e-6, -0.98e-6]);
                let lambda = repeated.complementary().unwrap().to_vec();
                let closed = repeated.all_closed().unwrap();
                // One row a side, with the mean of what its rows give.
                let own = soft * (1.0 + 0.1 * (each - 1) as f64) / each as f64;
                let cross = 0.2856_f64.cos() - 0.02 * soft;
                let w = [[1.0 + own, cross], [cross, 1.0 + own]];
                let sums = super::super::pair(w, [-1e-6, -0.98e-6]);
                for (row, (a, b)) in lambda.iter().zip(closed).enumerate() {
                    let expected = sums[row / each] / each as f64;
                    assert!((a / expected - 1.0).abs() < 1e-13, "{each} {soft}: {a} {expected}");
                    assert_eq!(a, b);
                }
            }
        }
    }

    #[test]
    fn rows_that_differ_are_solved_to_the_last_digits() {
        for (soft, apart) in [(1e-6, 1e-9), (1e-9, 1e-12), (1e-12, 1e-16), (1e-4, 1e-3)] {
            let mut repeated = corner(3, soft, apart, [-1e-6, -0.98e-6]);
            let lambda = repeated.all_closed().unwrap().to_vec();
            let rows = repeated.rows.clone();
            // Differences within a side: (B lambda)_r - (B lambda)_0 + turned s = gap.
            let bent = |row: usize| -> f64 {
                (0..6).map(|other| repeated.bends(row)[other] * lambda[other]).sum()
            };
            let s = lambda.iter().zip(&rows).fold((0.0, 0.0), |sum, (lambda, row)| {
                (sum.0 + lambda * row.normal.0, sum.1 + lambda * row.normal.1)
            });
            for row in [1, 2, 4, 5] {
                let first = 3 * (row / 3);
                let left = bent(row) - bent(first) + dot(rows[row].turned, s) - rows[row].gap;
                let size = bent(row).abs() + rows[row].gap.abs();
                assert!(left.abs() < 1e-12 * size, "{soft} {apart} {row}: {left} of {size}");
            }
        }
    }

    #[test]
    fn a_row_that_a_push_beside_it_opens_is_left_alone() {
        // The third row of the first side stands deepest, the first of the second.
        let mut repeated = corner(3, 1e-6, 1e-6, [-1e-6, -0.98e-6]);
        let lambda = repeated.complementary().unwrap().to_vec();
        assert!(lambda.iter().all(|&value| value <= 0.0));
        let pushing: Vec<bool> = lambda.iter().map(|&value| value < 0.0).collect();
        assert_eq!(pushing, [false, false, true, true, false, false], "{lambda:?}");
        for row in 0..6 {
            assert!(lambda[row] < 0.0 || !repeated.is_shut(row), "{row}: {lambda:?}");
        }
    }

    #[test]
    fn a_row_stays_open_where_the_blade_of_a_closed_one_gives_way() {
        // The first row bends by 1e-12, its neighbour by a tenth of that, and
        // stands 0.95e-12 back.
        let mut repeated = corner(2, 1e-6, 0.0, [-1e-6, 1e-6]);
        repeated.rows[1].gap = 0.95e-12;
        let alone = -1e-6 / (1.0 + 1e-6);
        let lambda = repeated.complementary().unwrap();
        assert!((lambda[0] / alone - 1.0).abs() < 1e-14, "{lambda:?}");
        assert_eq!(lambda[1..], [0.0; 3]);
        // A little less, and both are closed.
        repeated.rows[1].gap = 0.85e-12;
        let lambda = repeated.complementary().unwrap();
        assert!(lambda[0] < lambda[1] && lambda[1] < 0.0, "{lambda:?}");
        let bent = 1e-6 * (1.0 - 0.1) * (lambda[0] - lambda[1]);
        assert!((bent / -0.85e-12 - 1.0).abs() < 1e-12, "{bent:e}");
    }
}
