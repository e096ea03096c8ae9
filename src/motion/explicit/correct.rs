//! The correction of one step, Eqs. (11)-(16): which rows penetrate, their
//! multipliers by the chosen law, and the displacements they change.

use nalgebra::DMatrix;

use super::{BREAK_STEPS, Blades, Explicit, LARGEST_ANGLE, Row, too_wide};
use crate::contact;
use crate::motion::Touching;
use crate::scene::ContactLaw;

impl<B: Blades> Explicit<B> {
    /// A predicted step outside the circle of the clearance: find what
    /// penetrates and correct it.
    pub(super) fn meet(&mut self, distance: f64) -> Result<(), String> {
        if distance.is_nan() || distance > self.casing_radius {
            return Err(format!(
                "the casing displacement {distance:e} m is beyond the casing radius {} m",
                self.casing_radius
            ));
        }
        let phase = self.phasor.at(self.n, &self.rotor, self.machine.nodal_diameters, self.step);
        self.gather(phase);
        let deepest = self.rows.iter().fold(0.0_f64, |deepest, row| deepest.max(-row.gap));
        if deepest == 0.0 {
            return self.open_gap();
        }
        self.deepest_predicted = self.deepest_predicted.max(deepest);
        let clearance = self.machine.rim.clearance;
        if deepest > clearance {
            return Err(format!(
                "a predicted penetration of {deepest:e} m is deeper than the clearance \
                 {clearance:e} m; a smaller step or a weaker pulse is needed"
            ));
        }
        self.solve()?;
        self.apply();
        self.record(phase)
    }

    /// Fills `rows` with the sides that penetrate and, under the unilateral
    /// law, the next one on either hand, which a correction may push in.
    fn gather(&mut self, phase: (f64, f64)) {
        let (c, s) = phase;
        let (u_c, u_s) = (self.u[0].x, self.u[1].x);
        // The point in the frame of the blades, z = u exp(-i n_d theta).
        let z = (u_c * c + u_s * s, u_s * c - u_c * s);
        let near = self.follow(z);
        self.near = near;
        self.rows.clear();
        if !self.add_side(near, z, phase) {
            return;
        }
        let mut right = self.machine.rim.next(near);
        while right != near && self.add_side(right, z, phase) {
            right = self.machine.rim.next(right);
        }
        let mut left = self.machine.rim.previous(near);
        while left != near && left != right && self.add_side(left, z, phase) {
            left = self.machine.rim.previous(left);
        }
    }

    /// The side nearest to `z`, from the one found last: around the rim the
    /// gap has a single minimum.
    fn follow(&self, z: (f64, f64)) -> u32 {
        let rim = &self.machine.rim;
        let gap = |side| rim.gap(side, z.0, z.1);
        let (here, left, right) = (self.near, rim.previous(self.near), rim.next(self.near));
        if gap(here) < rim.clearance && gap(here) <= gap(left) && gap(here) <= gap(right) {
            here
        } else {
            rim.nearest_side(z.0, z.1)
        }
    }

    /// Appends the rows of a side; whether any of them penetrates.
    fn add_side(&mut self, side: u32, z: (f64, f64), phase: (f64, f64)) -> bool {
        let rim = &self.machine.rim;
        let diameters = self.machine.nodal_diameters;
        let first = self.rows.len();
        let mut indices = std::mem::take(&mut self.indices);
        indices.clear();
        self.blades.rows_of_side(side, &mut indices);
        for &index in &indices {
            // exp(i(psi + n_d alpha)) and from it exp(i beta).
            let (dir_c, dir_s) = rim.direction(side);
            let (sin, cos) = small_sin_cos(diameters * self.blades.angle(index));
            let turned = (dir_c * cos - dir_s * sin, dir_s * cos + dir_c * sin);
            self.rows.push(Row {
                index,
                side,
                gap: rim.clearance + z.0 * turned.0 + z.1 * turned.1,
                normal: (
                    turned.0 * phase.0 - turned.1 * phase.1,
                    turned.1 * phase.0 + turned.0 * phase.1,
                ),
                lever: diameters * (z.1 * turned.0 - z.0 * turned.1),
                lambda: 0.0,
            });
        }
        self.indices = indices;
        let penetrates = self.rows[first..].iter().any(|row| row.gap < 0.0);
        if self.law == ContactLaw::Bilateral {
            self.rows.retain(|row| row.gap < 0.0);
        }
        penetrates
    }

    /// Entry of `W = C^T [M/h^2 + D/2h]^-1 C` for two rows \[m/N\].
    fn influence(&self, a: &Row, b: &Row) -> f64 {
        let casing = a.normal.0 * b.normal.0 + a.normal.1 * b.normal.1;
        self.casing.compliance * casing
            + a.lever * b.lever * self.blades.compliance(a.index, b.index)
    }

    /// Multipliers of all rows by the chosen law.
    fn solve(&mut self) -> Result<(), String> {
        match self.law {
            ContactLaw::Bilateral => self.solve_equalities(),
            ContactLaw::Unilateral => {
                if self.solve_by_cases() {
                    Ok(())
                } else {
                    self.solve_dense(|w, gap| contact::complementary(&w, gap))
                }
            }
        }
    }

    fn solve_equalities(&mut self) -> Result<(), String> {
        match self.rows.len() {
            1 => {
                self.rows[0].lambda =
                    contact::single(self.influence(&self.rows[0], &self.rows[0]), self.rows[0].gap);
            }
            2 => {
                let lambda = self.close_pair(0, 1);
                self.rows[0].lambda = lambda[0];
                self.rows[1].lambda = lambda[1];
            }
            _ => return self.solve_dense(contact::all_closed),
        }
        if self.rows.iter().all(|row| row.lambda.is_finite()) {
            Ok(())
        } else {
            Err(dependent(self.rows.len()))
        }
    }

    fn close_pair(&self, a: usize, b: usize) -> [f64; 2] {
        let (a, b) = (&self.rows[a], &self.rows[b]);
        let cross = self.influence(a, b);
        let w = [[self.influence(a, a), cross], [cross, self.influence(b, b)]];
        contact::pair(w, [a.gap, b.gap])
    }

    /// Complementarity by cases: the deepest row alone, then with each other
    /// row, then each other row alone. False where none of them holds.
    fn solve_by_cases(&mut self) -> bool {
        let count = self.rows.len();
        let deepest =
            (0..count).fold(0, |a, b| if self.rows[b].gap < self.rows[a].gap { b } else { a });
        let alone = |solver: &Self, row: usize| {
            let row = &solver.rows[row];
            contact::single(solver.influence(row, row), row.gap)
        };
        let first = alone(self, deepest);
        if self.holds(&[(deepest, first)]) {
            self.rows[deepest].lambda = first;
            return true;
        }
        for other in (0..count).filter(|&other| other != deepest) {
            let lambda = self.close_pair(deepest, other);
            if self.holds(&[(deepest, lambda[0]), (other, lambda[1])]) {
                self.rows[deepest].lambda = lambda[0];
                self.rows[other].lambda = lambda[1];
                return true;
            }
        }
        for other in (0..count).filter(|&other| other != deepest) {
            let lambda = alone(self, other);
            if self.holds(&[(other, lambda)]) {
                self.rows[other].lambda = lambda;
                return true;
            }
        }
        false
    }

    /// Whether these multipliers push and leave every other row open.
    fn holds(&self, chosen: &[(usize, f64)]) -> bool {
        chosen.iter().all(|&(_, lambda)| lambda <= 0.0)
            && self.rows.iter().enumerate().all(|(index, row)| {
                chosen.iter().any(|&(active, _)| active == index)
                    || row.gap
                        >= chosen
                            .iter()
                            .map(|&(active, lambda)| {
                                self.influence(row, &self.rows[active]) * lambda
                            })
                            .sum::<f64>()
            })
    }

    fn solve_dense(
        &mut self,
        law: impl Fn(DMatrix<f64>, &[f64]) -> Option<Vec<f64>>,
    ) -> Result<(), String> {
        let count = self.rows.len();
        let w = DMatrix::from_fn(count, count, |i, j| self.influence(&self.rows[i], &self.rows[j]));
        let gap: Vec<f64> = self.rows.iter().map(|row| row.gap).collect();
        let lambda = law(w, &gap).filter(|lambda| lambda.iter().all(|value| value.is_finite()));
        let lambda = lambda.ok_or_else(|| dependent(count))?;
        for (row, value) in self.rows.iter_mut().zip(lambda) {
            row.lambda = value;
        }
        Ok(())
    }

    /// Corrects the predicted displacements, Eq. (13b).
    fn apply(&mut self) {
        self.rows.retain(|row| row.lambda != 0.0);
        for row in &self.rows {
            let shift = -self.casing.compliance * row.lambda;
            for (coordinate, normal) in self.u.iter_mut().zip([row.normal.0, row.normal.1]) {
                coordinate.x += shift * normal;
                coordinate.increment += shift * normal;
            }
            self.blades.correct(row.index, -row.lever * row.lambda);
        }
    }

    /// Keeps what the step did: impulses, impacts, pulls, penetration left.
    fn record(&mut self, phase: (f64, f64)) -> Result<(), String> {
        let (n, t) = (self.n, self.time_of(self.n));
        let diameters = self.machine.nodal_diameters;
        let mut touching = Touching::Nothing;
        let mut pulls = false;
        for row in &self.rows {
            let angle = self.blades.angle(row.index);
            let (sin, cos) = small_sin_cos(diameters * angle);
            let (dir_c, dir_s) = self.machine.rim.direction(row.side);
            let turned = (dir_c * cos - dir_s * sin, dir_s * cos + dir_c * sin);
            let normal =
                (turned.0 * phase.0 - turned.1 * phase.1, turned.1 * phase.0 + turned.0 * phase.1);
            let gap = self.machine.rim.clearance + self.u[0].x * normal.0 + self.u[1].x * normal.1;
            self.deepest = self.deepest.max(-gap);
            self.widest = self.widest.max(angle.abs());
            if angle.abs() > LARGEST_ANGLE || angle.is_nan() {
                return Err(too_wide(angle));
            }
            let last = &mut self.touched[row.side as usize];
            if *last == 0 || n > *last + BREAK_STEPS {
                self.log.impact(t, row.side);
            }
            *last = n;
            self.impulses[row.side as usize] += row.lambda * self.step;
            touching = touching.with(row.side);
            pulls |= row.lambda > 0.0;
        }
        self.last_touch = n;
        self.log.touch(t, touching);
        if pulls {
            self.log.tensile(t);
        }
        Ok(())
    }
}

fn dependent(rows: usize) -> String {
    format!("the multipliers of {rows} penetrating rows cannot be told apart (singular equations)")
}

/// Sine and cosine of a blade's small phase, to round-off.
fn small_sin_cos(angle: f64) -> (f64, f64) {
    if angle.abs() < 1e-4 {
        let square = angle * angle;
        (angle * (1.0 - square / 6.0), 1.0 - 0.5 * square)
    } else {
        angle.sin_cos()
    }
}
