//! The correction of one step, Eqs. (11)-(16): which rows penetrate, their
//! multipliers by the chosen law, and the displacements they change.
//! (docs/theory.md, section 6.)
//!
//! All of it happens in the frame of the blades, at `z = u exp(-i n_d theta)`,
//! where the sides stand still and only small blade angles turn them.

use nalgebra::DMatrix;

use super::{BladeModel, Explicit};
use crate::contact::{
    self,
    repeated::{GroupReference, Repeat},
};
use crate::motion::{ActiveSet, FailureReason};
use crate::tolerances::{MOST_ROWS, SAME_ANGLE, SMALL_PHASE};

/// One constraint of a step: a side or a blade with its predicted gap.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConstraintRow {
    pub index: u32,
    pub side: u32,
    /// Predicted gap `g*` \[m\].
    pub gap: f64,
    /// `n_d alpha` \[rad\].
    pub turn: f64,
    /// `exp(i (psi + n_d alpha))`: the gap is `g0 + Re[z conj(normal)]`.
    pub normal: (f64, f64),
    /// `A = dg/dalpha` \[m\].
    pub moment_arm: f64,
    /// Multiplier \[N\].
    pub lambda: f64,
}

impl<B: BladeModel> Explicit<B> {
    /// A predicted step outside the circle of the clearance: find what
    /// penetrates and correct it. Returns a bound on what that does to any blade
    /// angle \[rad\].
    pub(super) fn meet(&mut self, distance2: f64) -> Result<f64, FailureReason> {
        let radius_m = self.scene.casing.radius_m;
        if distance2.is_nan() || distance2 > radius_m * radius_m {
            let distance_m = distance2.sqrt();
            return Err(FailureReason::Displacement { distance_m, radius_m });
        }
        let (c, s) = self.drive.turn(self.n);
        let (u_c, u_s) = (self.u[0].x, self.u[1].x);
        let z = (u_c * c + u_s * s, u_s * c - u_c * s);
        let deepest = self.gather(z);
        if deepest <= 0.0 {
            self.open_gap();
            return Ok(0.0);
        }
        self.record.deepest_predicted = self.record.deepest_predicted.max(deepest);
        let clearance = self.machine.polygon.clearance;
        if deepest > clearance {
            let (depth_m, clearance_m) = (deepest, clearance);
            return Err(FailureReason::Penetration { depth_m, clearance_m });
        }
        self.solve()?;
        let ((dx, dy), change) = self.apply();
        let shift = [dx * c - dy * s, dx * s + dy * c];
        for (coordinate, shift) in self.u.iter_mut().zip(shift) {
            coordinate.x += shift;
            coordinate.increment += shift;
        }
        self.keep((z.0 + dx, z.1 + dy));
        Ok(change)
    }

    /// Fills `rows` with those that penetrate and, where pushing on one side
    /// may push its neighbour in, the neighbours; the deepest penetration.
    fn gather(&mut self, z: (f64, f64)) -> f64 {
        // A blade angle moves a gap by at most |z| n_d alpha.
        let reach = self.machine.nodal_diameters * self.watch.bound();
        self.look = reach * (z.0.abs() + z.1.abs());
        let near = self.follow(z);
        self.near = near;
        self.rows.clear();
        let mut deepest = self.add_side(near, z);
        // Not up to the first open side: beyond it, blades may be turned into the casing.
        let (mut end, mut matters) = (near, self.neighbours_matter);
        loop {
            let side = self.machine.polygon.next(end);
            if side == near || !(matters || self.is_close(side, z)) {
                break;
            }
            let depth = self.add_side(side, z);
            deepest = deepest.max(depth);
            matters = self.neighbours_matter && depth > 0.0;
            end = side;
        }
        let mut side = self.machine.polygon.previous(near);
        matters = self.neighbours_matter;
        while side != end && (matters || self.is_close(side, z)) {
            let depth = self.add_side(side, z);
            deepest = deepest.max(depth);
            matters = self.neighbours_matter && depth > 0.0;
            side = self.machine.polygon.previous(side);
        }
        deepest
    }

    /// Whether a blade of this side may penetrate, however it is turned.
    fn is_close(&self, side: u32, z: (f64, f64)) -> bool {
        self.machine.polygon.gap(side, z.0, z.1) < self.look
    }

    /// The side nearest to `z`, from the one found last: around the polygon the
    /// gap has a single minimum.
    fn follow(&self, z: (f64, f64)) -> u32 {
        let polygon = &self.machine.polygon;
        let gap = |side| polygon.gap(side, z.0, z.1);
        let here = gap(self.near);
        // On the far side of the polygon the gap has its maximum instead.
        if here < self.machine.polygon.clearance
            && here <= gap(polygon.previous(self.near))
            && here <= gap(polygon.next(self.near))
        {
            self.near
        } else {
            polygon.nearest_side(z.0, z.1)
        }
    }

    /// Appends the rows of a side that penetrate (or matter); its deepest
    /// penetration.
    fn add_side(&mut self, side: u32, z: (f64, f64)) -> f64 {
        let polygon = &self.machine.polygon;
        let diameters = self.machine.nodal_diameters;
        let (dir_c, dir_s) = polygon.direction(side);
        let mut deepest = 0.0_f64;
        for place in 0..self.blades.rows_of_side(side) {
            let index = self.blades.row(side, place);
            let turn = diameters * self.blades.angle(index);
            let normal = turned((dir_c, dir_s), turn);
            let gap = polygon.clearance + z.0 * normal.0 + z.1 * normal.1;
            deepest = deepest.max(-gap);
            if gap < 0.0 || self.neighbours_matter {
                let moment_arm = diameters * (z.1 * normal.0 - z.0 * normal.1);
                self.rows.push(ConstraintRow {
                    index,
                    side,
                    gap,
                    turn,
                    normal,
                    moment_arm,
                    lambda: 0.0,
                });
            }
        }
        deepest
    }

    /// Entry of `W = C^T [M/h^2 + D/2h]^-1 C` for two rows \[m/N\].
    fn influence(&self, a: &ConstraintRow, b: &ConstraintRow) -> f64 {
        let casing = a.normal.0 * b.normal.0 + a.normal.1 * b.normal.1;
        self.casing.compliance * casing
            + a.moment_arm * b.moment_arm * self.blades.compliance(a.index, b.index)
    }

    /// Multipliers of all rows by the chosen law.
    fn solve(&mut self) -> Result<(), FailureReason> {
        if self.law.pulls() {
            // Rows that would be pulled shut are those that penetrate, no others.
            self.rows.retain(|row| row.gap < 0.0);
        }
        let repeated = self.rows.windows(2).any(|pair| pair[0].side == pair[1].side);
        // The rows of one side each that may only push are closed one by one.
        if self.rows.len() > MOST_ROWS && (repeated || self.law.pulls()) {
            return Err(FailureReason::Rows { rows: self.rows.len() });
        }
        match self.rows.as_mut_slice() {
            [_] => {
                let row = &self.rows[0];
                self.rows[0].lambda = contact::single(self.influence(row, row), row.gap);
            }
            _ if repeated => self.solve_repeated()?,
            [_, _] => {
                let (a, b) = (&self.rows[0], &self.rows[1]);
                let cross = self.influence(a, b);
                let w = [[self.influence(a, a), cross], [cross, self.influence(b, b)]];
                let gap = [a.gap, b.gap];
                let lambda = self.law.pair(w, gap).ok_or(FailureReason::Singular { rows: 2 })?;
                self.rows[0].lambda = lambda[0];
                self.rows[1].lambda = lambda[1];
            }
            _ => self.solve_dense()?,
        }
        if self.rows.iter().all(|row| row.lambda.is_finite()) {
            Ok(())
        } else {
            Err(FailureReason::Singular { rows: self.rows.len() })
        }
    }

    /// As `solve`, where a side has several rows: each is given by its difference
    /// from the first row of its side.
    fn solve_repeated(&mut self) -> Result<(), FailureReason> {
        let diameters = self.machine.nodal_diameters;
        let repeated = &mut self.repeated;
        repeated.begin(self.casing.compliance);
        let mut first = &self.rows[0];
        for row in &self.rows {
            if repeated.groups.is_empty() || row.side != first.side {
                first = row;
                repeated.groups.push(GroupReference { gap: row.gap, normal: row.normal });
            }
            let mut repeat = Repeat {
                group: repeated.groups.len() - 1,
                gap: 0.0,
                normal: first.normal,
                turned: (0.0, 0.0),
                moment_arm: first.moment_arm,
            };
            let apart = row.turn - first.turn;
            // Blades that stand alike to round-off are one.
            if apart.abs() > SAME_ANGLE * (row.turn.abs() + first.turn.abs()) {
                let half = (0.5 * apart).sin();
                let (cos, sin) = (-2.0 * half * half, apart.sin());
                let (c, s) = first.normal;
                let reach = first.gap - self.machine.polygon.clearance;
                repeat.gap = reach * cos + first.moment_arm / diameters * sin;
                repeat.normal = row.normal;
                repeat.turned = (c * cos - s * sin, s * cos + c * sin);
                repeat.moment_arm = row.moment_arm;
            }
            repeated.rows.push(repeat);
        }
        let compliance =
            |a: usize, b: usize| self.blades.compliance(self.rows[a].index, self.rows[b].index);
        repeated.bend_by(compliance);
        let rows = self.rows.len();
        let lambda = self.law.repeated(repeated).ok_or(FailureReason::Singular { rows })?;
        for (row, value) in self.rows.iter_mut().zip(lambda) {
            row.lambda = *value;
        }
        Ok(())
    }

    fn solve_dense(&mut self) -> Result<(), FailureReason> {
        let count = self.rows.len();
        let w = DMatrix::from_fn(count, count, |i, j| self.influence(&self.rows[i], &self.rows[j]));
        let gap: Vec<f64> = self.rows.iter().map(|row| row.gap).collect();
        let lambda = self.law.dense(w, &gap).ok_or(FailureReason::Singular { rows: count })?;
        for (row, value) in self.rows.iter_mut().zip(lambda) {
            row.lambda = value;
        }
        Ok(())
    }

    /// Corrects the blades, Eq. (13b); the shift of the casing in their frame,
    /// and a bound on the change of any blade angle.
    fn apply(&mut self) -> ((f64, f64), f64) {
        let (mut shift, mut change) = ((0.0, 0.0), 0.0);
        for row in &self.rows {
            if row.lambda != 0.0 {
                shift.0 -= self.casing.compliance * row.lambda * row.normal.0;
                shift.1 -= self.casing.compliance * row.lambda * row.normal.1;
                let torque = -row.moment_arm * row.lambda;
                self.blades.correct(row.index, torque);
                change += self.blades.compliance(row.index, row.index) * torque.abs();
            }
        }
        (shift, change)
    }

    /// Keeps what the step did: impulses, impacts, pulls, penetration left.
    fn keep(&mut self, z: (f64, f64)) {
        let n = self.n;
        let mut active_set = ActiveSet::Nothing;
        let mut pulls = false;
        for row in self.rows.iter().filter(|row| row.lambda != 0.0) {
            let bent = self.rows.iter().fold(0.0, |bent, other| {
                let torque = -other.moment_arm * other.lambda;
                bent + self.blades.compliance(row.index, other.index) * torque
            });
            let direction = self.machine.polygon.direction(row.side);
            let normal = turned(direction, row.turn + self.machine.nodal_diameters * bent);
            let gap = self.machine.polygon.clearance + z.0 * normal.0 + z.1 * normal.1;
            self.record.deepest = self.record.deepest.max(-gap);
            self.record.push(n, row.side, row.lambda);
            active_set = active_set.with(row.side);
            pulls |= row.lambda > 0.0;
        }
        let goes_on = self.record.last_touch + 1 == n && active_set == self.record.log.active_set;
        self.same_sides = if goes_on { self.same_sides + 1 } else { 1 };
        self.record.touch(n, active_set, pulls);
    }

    /// Whether pushing on one side can push another into the casing: fewer
    /// than four sides, or blades soft enough to couple them.
    pub(super) fn neighbours_matter(&self) -> bool {
        let polygon = &self.machine.polygon;
        let turn = (2.0 * polygon.delta).cos();
        let moment_arm = 2.0 * self.machine.nodal_diameters * polygon.clearance;
        let soft = moment_arm * moment_arm * self.blades.compliance(0, 0);
        turn * self.casing.compliance < 2.0 * soft
    }
}

/// A direction turned by a small blade phase, to round-off.
pub(super) fn turned((c, s): (f64, f64), angle: f64) -> (f64, f64) {
    let (sin, cos) = if angle.abs() < SMALL_PHASE {
        let square = angle * angle;
        (angle * (1.0 - square * (1.0 / 6.0)), 1.0 - 0.5 * square)
    } else {
        angle.sin_cos()
    };
    (c * cos - s * sin, s * cos + c * sin)
}
