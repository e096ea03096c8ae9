//! One step in contact: the gaps of all blades, the rows, their multipliers,
//! the corrections.

use rubscope_solver::scene::{ContactLaw, ModelSize, Scene};

use super::disk::phase;
use super::{BREAK_STEPS, Plain, Why, law};

/// Phase groups of the blades.
#[derive(Clone, Debug)]
pub struct Sides {
    clearance: f64,
    diameters: f64,
    pub count: u32,
    /// Blade (from 0) that stands for each row: its group's first, or itself.
    rows: Vec<usize>,
    side_of: Vec<u32>,
    /// `n_d Phi_i` within a turn.
    phases: Vec<f64>,
    /// `sum_i p_s(i)^2` is zero: one mode alone.
    alone: bool,
}

impl Sides {
    pub fn new(scene: &Scene) -> Self {
        let blades = scene.bladed_disk.blades as usize;
        let n_d = u64::from(scene.operation.nodal_diameters);
        let turns = |blade: usize| (n_d * blade as u64 % blades as u64) as u32;
        let group = (0..blades).map(turns).filter(|&t| t > 0).min().unwrap_or(blades as u32);
        let side_of: Vec<u32> = (0..blades).map(|blade| turns(blade) / group).collect();
        let count = blades as u32 / group;
        let first = |side: u32| side_of.iter().position(|&s| s == side);
        let rows = match scene.solver.model {
            ModelSize::Full => (0..blades).collect(),
            ModelSize::Rigid | ModelSize::Modal => (0..count).filter_map(first).collect(),
        };
        Self {
            clearance: scene.casing.radius_m - scene.bladed_disk.blade_length_m,
            diameters: n_d as f64,
            count,
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
            angles.iter().zip(&self.phases).map(|(angle, p)| angle * shape(*p)).sum()
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
    gap: f64,
    cos: f64,
    sin: f64,
    /// `A = n_d (u_s cos beta - u_c sin beta)`.
    moment_arm: f64,
}

impl Plain {
    /// Corrects the predicted step, with the blades at these angles.
    pub(super) fn meet(&mut self, angles: &[f64]) -> Result<(), Why> {
        let distance = self.u[0].x.hypot(self.u[1].x);
        if distance.is_nan() || distance > self.casing_radius {
            return Err(Why::Casing);
        }
        // |u| < g0 leaves every gap open, whatever the angle.
        if distance < self.sides.clearance * (1.0 - 1e-12) {
            return Ok(());
        }
        let mut rows = self.rows(angles);
        let deepest = rows.iter().fold(0.0_f64, |most, row| most.max(-row.gap));
        if deepest <= 0.0 {
            return Ok(());
        }
        if deepest > self.sides.clearance {
            return Err(Why::Penetration);
        }
        let bilateral = self.law == ContactLaw::Bilateral;
        rows.retain(|row| row.gap < if bilateral { 0.0 } else { 0.05 * self.sides.clearance });
        let w: law::Matrix =
            rows.iter().map(|a| rows.iter().map(|b| self.influence(a, b)).collect()).collect();
        let gaps: Vec<f64> = rows.iter().map(|row| row.gap).collect();
        let lambda = if bilateral { law::bilateral(&w, &gaps) } else { law::unilateral(&w, &gaps) };
        let lambda = lambda.ok_or(Why::Rows)?;
        self.correct(&rows, &lambda);
        self.record(&rows, &lambda);
        Ok(())
    }

    /// The rows of all blades or groups.
    fn rows(&self, angles: &[f64]) -> Vec<Row> {
        let (n_d, theta) = (self.sides.diameters, self.angle_at(self.n));
        let (x, y) = (self.u[0].x, self.u[1].x);
        let row = |&blade: &usize| {
            let beta = n_d * theta + self.sides.phases[blade] + n_d * angles[blade];
            let (sin, cos) = beta.sin_cos();
            let gap = self.sides.clearance + x * cos + y * sin;
            Row { blade, gap, cos, sin, moment_arm: n_d * (y * cos - x * sin) }
        };
        self.sides.rows.iter().map(row).collect()
    }

    /// Opening of one gap per unit pull on another: `C^T [M/h^2 + D/2h]^-1 C`.
    fn influence(&self, a: &Row, b: &Row) -> f64 {
        self.casing.compliance * (a.cos * b.cos + a.sin * b.sin)
            + a.moment_arm * b.moment_arm * self.disk.compliance(a.blade, b.blade)
    }

    /// Eq. (13b).
    fn correct(&mut self, rows: &[Row], lambda: &[f64]) {
        for (row, &value) in rows.iter().zip(lambda) {
            let shift = self.casing.compliance * value;
            for (coordinate, normal) in self.u.iter_mut().zip([row.cos, row.sin]) {
                coordinate.shift(-shift * normal);
            }
            self.disk.correct(row.blade, -(row.moment_arm * value));
        }
    }

    /// Group sums, impacts and pulls.
    fn record(&mut self, rows: &[Row], lambda: &[f64]) {
        self.last.clear();
        let mut pulled = false;
        for (row, &value) in rows.iter().zip(lambda).filter(|(_, value)| **value != 0.0) {
            let side = self.sides.side_of[row.blade];
            pulled |= value > 0.0;
            self.impulses[side as usize] += value * self.h;
            match self.last.iter_mut().find(|(s, _)| *s == side) {
                Some((_, sum)) => *sum += value,
                None => self.last.push((side, value)),
            }
        }
        self.last.sort_by_key(|&(side, _)| side);
        for &(side, _) in &self.last {
            let last = &mut self.touched[side as usize];
            if *last == 0 || self.n > *last + BREAK_STEPS {
                self.impacts.push((self.n, side));
            }
            *last = self.n;
        }
        self.tensile_steps += u64::from(pulled);
    }
}
