//! One step in contact: the gaps of all blades, the rows, their multipliers,
//! the corrections.

use rubscope_solver::scene::{ContactLaw, ModelSize, Scene};

use super::dd::{Dd, ZERO};
use super::disk::phase;
use super::{Plain, Why, law};

/// Part of the clearance below which a gap is evaluated to all digits.
const NEAR: f64 = 0.05;

/// Phase groups of the blades.
#[derive(Clone, Debug)]
pub struct ContactPolygon {
    clearance: f64,
    diameters: Dd,
    pub sides: u32,
    /// Blade (from 0) that stands for each row: its group's first, or itself.
    rows: Vec<usize>,
    side_of: Vec<u32>,
    /// `n_d Phi_i` within a turn.
    phases: Vec<Dd>,
    /// `sum_i p_s(i)^2` is zero: one mode alone.
    alone: bool,
}

impl ContactPolygon {
    pub fn new(scene: &Scene) -> Self {
        let blades = scene.bladed_disk.blades as usize;
        let n_d = u64::from(scene.operation.nodal_diameters);
        let turns = |blade: usize| (u128::from(n_d) * blade as u128 % blades as u128) as u32;
        let group = (0..blades).map(turns).filter(|&t| t > 0).min().unwrap_or(blades as u32);
        let side_of: Vec<u32> = (0..blades).map(|blade| turns(blade) / group).collect();
        let sides = blades as u32 / group;
        let first = |side: u32| side_of.iter().position(|&s| s == side);
        let rows = match scene.solver.model {
            ModelSize::Full => (0..blades).collect(),
            ModelSize::Rigid | ModelSize::Modal => (0..sides).filter_map(first).collect(),
        };
        Self {
            clearance: scene.casing.radius_m - scene.bladed_disk.blade_length_m,
            diameters: Dd::from(n_d),
            sides,
            rows,
            side_of,
            phases: (0..blades).map(|blade| phase(n_d, blade, blades)).collect(),
            alone: (2 * n_d).is_multiple_of(blades as u64),
        }
    }

    /// Least-squares fit of `alpha_c p_c(i) + alpha_s p_s(i)` to blade angles.
    pub fn project(&self, angles: &[f64]) -> [f64; 2] {
        let blades = angles.len() as f64;
        let sum = |shape: fn(f64) -> f64| -> f64 {
            angles.iter().zip(&self.phases).map(|(angle, p)| angle * shape(p.0)).sum()
        };
        if self.alone {
            return [sum(f64::cos) / blades, 0.0];
        }
        [2.0 * sum(f64::cos) / blades, 2.0 * sum(f64::sin) / blades]
    }
}

/// One constraint at the predicted step.
#[derive(Clone, Copy, Debug)]
struct Row {
    blade: usize,
    gap: Dd,
    cos: Dd,
    sin: Dd,
    /// `A = n_d (u_s cos beta - u_c sin beta)`.
    moment_arm: Dd,
}

impl Plain {
    /// Corrects the predicted step.
    pub(super) fn meet(&mut self) -> Result<(), Why> {
        let (x, y) = (self.u[0].x, self.u[1].x);
        let distance = x.0.hypot(y.0);
        if distance.is_nan() || distance > self.casing_radius {
            return Err(Why::Casing(distance));
        }
        // |u| < g0 leaves every gap open, whatever the angle.
        if distance < self.polygon.clearance * (1.0 - 1e-12) {
            return Ok(());
        }
        let turned = (self.polygon.diameters * self.angle_at(self.n)).reduced();
        let near: Vec<usize> = self.near(turned);
        let mut rows: Vec<Row> = near.into_iter().map(|blade| self.row(turned, blade)).collect();
        let deepest = rows.iter().fold(0.0_f64, |most, row| most.max(-row.gap.value()));
        if deepest <= 0.0 {
            return Ok(());
        }
        self.deepest_predicted = self.deepest_predicted.max(deepest);
        if deepest > self.polygon.clearance {
            return Err(Why::Penetration(deepest));
        }
        let lambda = match self.law {
            ContactLaw::Bilateral => {
                rows.retain(|row| row.gap < ZERO);
                let gaps: Vec<Dd> = rows.iter().map(|row| row.gap).collect();
                law::bilateral(&self.influences(&rows), &gaps).ok_or(Why::Rows(rows.len()))?
            }
            ContactLaw::Unilateral | ContactLaw::Smooth => self.complementary(turned, &mut rows)?,
        };
        if lambda.iter().any(|value| !value.is_finite()) {
            return Err(Why::Rows(rows.len()));
        }
        self.correct(&rows, &lambda);
        for (row, _) in rows.iter().zip(&lambda).filter(|(_, value)| **value != ZERO) {
            self.deepest = self.deepest.max(-self.row(turned, row.blade).gap.value());
        }
        self.record(&rows, &lambda);
        Ok(())
    }

    /// Multipliers over all rows: those near the casing first; rows that these
    /// close join them.
    fn complementary(&self, turned: Dd, rows: &mut Vec<Row>) -> Result<Vec<Dd>, Why> {
        loop {
            let gaps: Vec<Dd> = rows.iter().map(|row| row.gap).collect();
            let lambda =
                law::unilateral(&self.influences(rows), &gaps).ok_or(Why::Rows(rows.len()))?;
            if self.reach(rows, &lambda) < 0.9 * NEAR * self.polygon.clearance {
                return Ok(lambda);
            }
            let mut joined = false;
            for &blade in &self.polygon.rows {
                if rows.iter().any(|row| row.blade == blade) {
                    continue;
                }
                let new = self.row(turned, blade);
                let shift: Dd =
                    rows.iter().zip(&lambda).map(|(row, &l)| self.influence(&new, row) * l).sum();
                if new.gap - shift < ZERO {
                    rows.push(new);
                    joined = true;
                    break;
                }
            }
            if !joined {
                return Ok(lambda);
            }
        }
    }

    /// Bound on what these multipliers do to any gap \[m\].
    fn reach(&self, rows: &[Row], lambda: &[Dd]) -> f64 {
        let farthest = self.polygon.diameters.0 * self.u[0].x.0.hypot(self.u[1].x.0);
        let part = |(row, value): (&Row, &Dd)| {
            // A compliance between two blades is at most that of one with itself.
            let blade = self.disk.compliance(row.blade, row.blade).0;
            value.0.abs() * (self.casing.compliance.0 + farthest * row.moment_arm.0.abs() * blade)
        };
        rows.iter().zip(lambda).map(part).sum()
    }

    /// Rows whose gaps are small, by double precision.
    fn near(&self, turned: Dd) -> Vec<usize> {
        let (angles, n_d) = (self.disk.angles(), self.polygon.diameters.0);
        let (x, y) = (self.u[0].x.0, self.u[1].x.0);
        let is_near = |&blade: &usize| {
            let beta = turned.0 + self.polygon.phases[blade].0 + n_d * angles[blade];
            let (sin, cos) = beta.sin_cos();
            self.polygon.clearance + x * cos + y * sin < NEAR * self.polygon.clearance
        };
        self.polygon.rows.iter().copied().filter(is_near).collect()
    }

    /// The row of a blade, to all digits.
    fn row(&self, turned: Dd, blade: usize) -> Row {
        let n_d = self.polygon.diameters;
        let beta = turned + self.polygon.phases[blade] + n_d * self.disk.angle(blade);
        let (sin, cos) = beta.sin_cos();
        let (x, y) = (self.u[0].x, self.u[1].x);
        Row {
            blade,
            gap: Dd::from(self.polygon.clearance) + x * cos + y * sin,
            cos,
            sin,
            moment_arm: n_d * (y * cos - x * sin),
        }
    }

    /// Opening of one gap per unit pull on another: `C^T [M/h^2 + D/2h]^-1 C`.
    fn influence(&self, a: &Row, b: &Row) -> Dd {
        self.casing.compliance * (a.cos * b.cos + a.sin * b.sin)
            + a.moment_arm * b.moment_arm * self.disk.compliance(a.blade, b.blade)
    }

    fn influences(&self, rows: &[Row]) -> law::Matrix {
        rows.iter().map(|a| rows.iter().map(|b| self.influence(a, b)).collect()).collect()
    }

    /// Eq. (13b).
    fn correct(&mut self, rows: &[Row], lambda: &[Dd]) {
        for (row, &value) in rows.iter().zip(lambda) {
            let shift = self.casing.compliance * value;
            for (coordinate, normal) in self.u.iter_mut().zip([row.cos, row.sin]) {
                coordinate.x -= shift * normal;
                coordinate.increment -= shift * normal;
            }
            self.disk.correct(row.blade, -(row.moment_arm * value));
        }
    }

    /// Group sums, impacts, pulls, and the history.
    fn record(&mut self, rows: &[Row], lambda: &[Dd]) {
        self.last.clear();
        let mut sums: Vec<(u32, Dd)> = Vec::new();
        let mut pulled = false;
        for (row, &value) in rows.iter().zip(lambda).filter(|(_, value)| **value != ZERO) {
            let side = self.polygon.side_of[row.blade];
            pulled |= value > ZERO;
            self.impulse += value.0.abs() * self.h.0;
            self.impulses[side as usize] += value.0 * self.h.0;
            match sums.iter_mut().find(|(s, _)| *s == side) {
                Some((_, sum)) => *sum += value,
                None => sums.push((side, value)),
            }
        }
        sums.sort_by_key(|&(side, _)| side);
        let n = self.n;
        for &(side, _) in &sums {
            let last = &mut self.touched[side as usize];
            if *last == 0 || n > *last + super::BREAK_STEPS {
                self.impacts.push(((Dd::from(n) * self.h).value(), side));
            }
            *last = n;
        }
        self.last = sums.iter().map(|&(side, sum)| (side, sum.value())).collect();
        self.last_touch = n;
        self.tensile_steps += u64::from(pulled);
        self.history.touch(n, sums.into_iter().map(|(side, _)| side).collect(), pulled);
    }
}
