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

use crate::tolerances::{MOST_PIVOTING, OPEN_ROW};
use nalgebra::{DMatrix, DVector};

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

/// The rows of one step.
pub struct Repeated<'a> {
    /// The groups, each with at least one row.
    pub groups: &'a [GroupReference],
    /// The rows.
    pub rows: &'a [Repeat],
    /// Casing displacement by a unit force in one step \[m/N\].
    pub casing: f64,
    /// Blade angle of one row by a unit torque on another in one step.
    pub blades: &'a dyn Fn(usize, usize) -> f64,
}

/// Multipliers of some closed rows, and what they do to the rest.
struct Closed {
    /// Of every row; zero where it is open \[N\].
    multipliers: Vec<f64>,
    /// `s` above \[m\].
    opening: (f64, f64),
    /// `e_G` of the groups with closed rows \[m\].
    remainders: Vec<Option<f64>>,
}

impl Repeated<'_> {
    /// Every row closed as an equality, Eq. (13a). `None` where the rows are
    /// dependent and contradict each other.
    #[must_use]
    pub fn all_closed(&self) -> Option<Vec<f64>> {
        let closed = self.close(&vec![true; self.rows.len()])?;
        Some(closed.multipliers)
    }

    /// The complementarity problem of these rows, by principal pivoting with
    /// the least index (Murty) from all penetrations closed, which is nearly
    /// always the answer. `None` where it does not end within its bound of work.
    #[must_use]
    pub fn complementary(&self) -> Option<Vec<f64>> {
        let count = self.rows.len();
        let closes = |row: &Repeat| self.groups[row.group].gap + row.gap < 0.0;
        let mut active: Vec<bool> = self.rows.iter().map(closes).collect();
        let mut work = 0;
        while work < MOST_PIVOTING {
            work += count * count + active.iter().filter(|&&active| active).count().pow(3);
            let closed = self.close(&active)?;
            let wrong = (0..count).find(|&row| {
                if active[row] { closed.multipliers[row] > 0.0 } else { self.is_shut(row, &closed) }
            });
            match wrong {
                None => return Some(closed.multipliers),
                Some(row) => active[row] = !active[row],
            }
        }
        None
    }

    /// `B_rs` \[m/N\].
    fn bend(&self, row: usize, other: usize) -> f64 {
        self.rows[row].moment_arm * self.rows[other].moment_arm * (self.blades)(row, other)
    }

    /// Whether an open row would be left penetrating.
    fn is_shut(&self, row: usize, closed: &Closed) -> bool {
        let Repeat { group, gap, turned, normal, .. } = self.rows[row];
        let multipliers = closed.multipliers.iter().enumerate();
        let bent: f64 = multipliers.map(|(other, lambda)| self.bend(row, other) * lambda).sum();
        let opening = closed.opening;
        let (left, shift) = match closed.remainders[group] {
            Some(remainder) => (remainder + gap, dot(turned, opening)),
            None => (self.groups[group].gap + gap, dot(normal, opening)),
        };
        let size = left.abs() + gap.abs() + shift.abs() + bent.abs();
        left - shift - bent < -OPEN_ROW * size
    }

    /// Solves the equations above for the active rows.
    fn close(&self, active: &[bool]) -> Option<Closed> {
        let chosen: Vec<usize> = (0..self.rows.len()).filter(|&row| active[row]).collect();
        let of = |row: usize| self.rows[row].group;
        let held: Vec<usize> = (0..self.groups.len())
            .filter(|&group| chosen.iter().any(|&row| of(row) == group))
            .collect();
        // Size of B in each group; blades without a moment arm share evenly.
        let scales: Vec<f64> = (0..self.groups.len())
            .map(|group| {
                let own = chosen.iter().filter(|&&row| of(row) == group);
                own.map(|&row| self.bend(row, row)).fold(0.0, f64::max)
            })
            .collect();
        let count = chosen.len();
        let size = count + held.len();
        let mut matrix = DMatrix::zeros(size, size);
        let mut right = DVector::zeros(size);
        for (i, &row) in chosen.iter().enumerate() {
            let Repeat { group, gap, turned, .. } = self.rows[row];
            let scale = scales[group];
            for (j, &other) in chosen.iter().enumerate() {
                matrix[(i, j)] = if scale > 0.0 {
                    let shift = self.casing * dot(turned, self.rows[other].normal);
                    (self.bend(row, other) + shift) / scale
                } else {
                    f64::from(u8::from(i == j))
                };
            }
            right[i] = if scale > 0.0 { gap / scale } else { 0.0 };
            let place = held.iter().position(|&held| held == group)?;
            matrix[(i, count + place)] = -1.0;
        }
        for (k, &group) in held.iter().enumerate() {
            let reference = self.groups[group];
            for (j, &other) in chosen.iter().enumerate() {
                matrix[(count + k, j)] = dot(reference.normal, self.rows[other].normal);
            }
            matrix[(count + k, count + k)] = scales[group] / self.casing;
            right[count + k] = reference.gap / self.casing;
        }
        let mut multipliers = vec![0.0; self.rows.len()];
        let mut opening = (0.0, 0.0);
        if chosen.is_empty() {
            return Some(Closed {
                multipliers,
                opening,
                remainders: vec![None; self.groups.len()],
            });
        }
        let solution = matrix.lu().solve(&right)?;
        for (i, &row) in chosen.iter().enumerate() {
            multipliers[row] = solution[i];
            opening.0 += self.casing * solution[i] * self.rows[row].normal.0;
            opening.1 += self.casing * solution[i] * self.rows[row].normal.1;
        }
        let mut remainders = vec![None; self.groups.len()];
        for (k, &group) in held.iter().enumerate() {
            remainders[group] = Some(scales[group] * solution[count + k]);
        }
        let finite = multipliers.iter().all(|lambda| lambda.is_finite());
        finite.then_some(Closed { multipliers, opening, remainders })
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
    fn corner(
        each: usize,
        soft: f64,
        apart: f64,
        gaps: [f64; 2],
    ) -> (Vec<GroupReference>, Vec<Repeat>) {
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
        (groups, rows)
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
                let (groups, rows) = corner(each, soft, 0.0, [-1e-6, -0.98e-6]);
                let repeated =
                    Repeated { groups: &groups, rows: &rows, casing: 1.0, blades: &blades(each) };
                let lambda = repeated.complementary().unwrap();
                let closed = repeated.all_closed().unwrap();
                // One row a side, with the mean of what its rows give.
                let own = soft * (1.0 + 0.1 * (each - 1) as f64) / each as f64;
                let cross = 0.2856_f64.cos() - 0.02 * soft;
                let w = [[1.0 + own, cross], [cross, 1.0 + own]];
                let sums = super::super::pair(w, [-1e-6, -0.98e-6]);
                for (row, (a, b)) in lambda.iter().zip(&closed).enumerate() {
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
            let (groups, rows) = corner(3, soft, apart, [-1e-6, -0.98e-6]);
            let repeated =
                Repeated { groups: &groups, rows: &rows, casing: 1.0, blades: &blades(3) };
            let lambda = repeated.all_closed().unwrap();
            // Differences within a side: (B lambda)_r - (B lambda)_0 + turned s = gap.
            let bent = |row: usize| -> f64 {
                (0..6).map(|other| repeated.bend(row, other) * lambda[other]).sum()
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
        let (groups, rows) = corner(3, 1e-6, 1e-6, [-1e-6, -0.98e-6]);
        let repeated = Repeated { groups: &groups, rows: &rows, casing: 1.0, blades: &blades(3) };
        let lambda = repeated.complementary().unwrap();
        assert!(lambda.iter().all(|&value| value <= 0.0));
        let pushing: Vec<bool> = lambda.iter().map(|&value| value < 0.0).collect();
        assert_eq!(pushing, [false, false, true, true, false, false], "{lambda:?}");
        let closed = repeated.close(&pushing);
        let closed = closed.unwrap();
        for row in 0..6 {
            assert!(lambda[row] < 0.0 || !repeated.is_shut(row, &closed), "{row}: {lambda:?}");
        }
    }
}
