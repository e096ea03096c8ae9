//! The correction of one step, Eqs. (11)-(16): which rows penetrate, their
//! multipliers by the chosen law, and the displacements they change.
//! (docs/theory.md, section 6.)
//!
//! All of it happens in the frame of the blades, at `z = u exp(-i n_d theta)`,
//! where the sides stand still and only small blade angles turn them.

use super::Explicit;
use super::disk::Disk;
use super::pushes::{push, solve};
use super::rows::{Row, TipLaw, turned};
use crate::contact::repeated::{GroupReference, Repeat};
use crate::motion::{ActiveSet, FailureReason, Plane};
use crate::tolerances::{GAP_ROUND_OFF, MOST_ROWS, SAME_ANGLE};

impl<B: Disk> Explicit<B> {
    /// A predicted step outside the circle of the clearance: find what
    /// penetrates and correct it. Returns a bound on what that does to any blade
    /// angle \[rad\].
    pub(super) fn meet(&mut self, distance2: f64) -> Result<f64, FailureReason> {
        self.stays_in_range(distance2)?;
        let (z, turn) = self.in_blade_frame();
        let deepest = self.gather(z);
        if deepest <= 0.0 {
            self.open_gap();
            return Ok(0.0);
        }
        self.is_shallow(deepest)?;
        self.solve()?;
        let Self { rows, tips, casing, blades, .. } = self;
        let (shift, change) = push(rows, tips, casing.compliance, blades);
        self.shift_casing(shift, turn);
        if self.most_left(z, shift, change) > self.record.deepest {
            self.keep_depth(z + shift);
        }
        self.keep_rows();
        Ok(change)
    }

    /// Fills `rows` with those that penetrate and, where pushing on one side
    /// may push its neighbour in, the neighbours; the deepest penetration.
    fn gather(&mut self, z: Plane) -> f64 {
        // A blade angle moves a gap by at most |z| n_d alpha.
        let reach = self.machine.nodal_diameters * self.watch.bound();
        self.look = reach * (z.re.abs() + z.im.abs());
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
    fn is_close(&self, side: u32, z: Plane) -> bool {
        self.machine.polygon.gap(side, z.re, z.im) < self.look
    }

    /// The side nearest to `z`, from the one found last: around the polygon the
    /// gap has a single minimum.
    pub(super) fn follow(&self, z: Plane) -> u32 {
        let polygon = &self.machine.polygon;
        let gap = |side| polygon.gap(side, z.re, z.im);
        let here = gap(self.near);
        // On the far side of the polygon the gap has its maximum instead.
        if here < self.machine.polygon.clearance
            && here <= gap(polygon.previous(self.near))
            && here <= gap(polygon.next(self.near))
        {
            self.near
        } else {
            polygon.nearest_side(z.re, z.im)
        }
    }

    /// Appends the rows of a side that penetrate (or matter); its deepest
    /// penetration.
    fn add_side(&mut self, side: u32, z: Plane) -> f64 {
        let direction = self.machine.polygon.direction(side);
        let mut deepest = 0.0_f64;
        for place in 0..self.blades.table().rows_per_side() {
            let index = self.blades.table().of_side(side)[place];
            let angle = self.blades.angle(index);
            let place = self.tips.place(direction, z, angle);
            deepest = deepest.max(-place.gap);
            if place.gap < 0.0 || self.neighbours_matter {
                self.rows.push(Row { index, side, angle, place, lambda: 0.0 });
            }
        }
        deepest
    }

    /// Multipliers of all rows by the chosen law.
    fn solve(&mut self) -> Result<(), FailureReason> {
        if self.law.pulls() {
            // Rows that would be pulled shut are those that penetrate, no others.
            self.rows.retain(|row| row.place.gap < 0.0);
        }
        let repeated = self.rows.windows(2).any(|pair| pair[0].side == pair[1].side);
        // The rows of one side each that may only push are closed one by one.
        if self.rows.len() > MOST_ROWS && (repeated || self.law.pulls()) {
            return Err(FailureReason::Rows { rows: self.rows.len() });
        }
        if repeated {
            return self.solve_repeated();
        }
        self.gaps.clear();
        self.gaps.extend(self.rows.iter().map(|row| row.place.gap));
        let Self { rows, gaps, several, tips, law, casing, blades, .. } = self;
        solve(tips, *law, casing.compliance, blades, rows, gaps, several)
    }

    /// As `solve`, where a side has several rows: each is given by its difference
    /// from the first row of its side.
    fn solve_repeated(&mut self) -> Result<(), FailureReason> {
        let diameters = self.machine.nodal_diameters;
        let repeated = &mut self.repeated;
        repeated.begin(self.casing.compliance);
        let mut first = &self.rows[0];
        for row in &self.rows {
            let normal = parts(row.place.normal);
            if repeated.groups.is_empty() || row.side != first.side {
                first = row;
                repeated.groups.push(GroupReference { gap: row.place.gap, normal });
            }
            let (c, s) = parts(first.place.normal);
            let mut repeat = Repeat {
                group: repeated.groups.len() - 1,
                gap: 0.0,
                normal: (c, s),
                turned: (0.0, 0.0),
                moment_arm: first.place.moment_arm,
            };
            let turns = [row, first].map(|row| diameters * row.angle);
            let apart = turns[0] - turns[1];
            // Blades that stand alike to round-off are one.
            if apart.abs() > SAME_ANGLE * (turns[0].abs() + turns[1].abs()) {
                let half = (0.5 * apart).sin();
                let (cos, sin) = (-2.0 * half * half, apart.sin());
                let reach = first.place.gap - self.machine.polygon.clearance;
                repeat.gap = reach * cos + first.place.moment_arm / diameters * sin;
                repeat.normal = normal;
                repeat.turned = (c * cos - s * sin, s * cos + c * sin);
                repeat.moment_arm = row.place.moment_arm;
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
        let finite = self.rows.iter().all(|row| row.lambda.is_finite());
        if finite { Ok(()) } else { Err(FailureReason::Singular { rows }) }
    }

    /// What a step can leave at most of the gaps that it closes, for a casing that it
    /// shifts from `z` and blades that it turns by `change`: parts of second order, and
    /// round-off \[m\].
    fn most_left(&self, z: Plane, shift: Plane, change: f64) -> f64 {
        let size = |a: Plane| a.re.abs() + a.im.abs();
        let (z, shift, turned) = (size(z), size(shift), self.tips.diameters * change);
        let pushes: f64 = self.rows.iter().map(|row| row.lambda.abs()).sum();
        let rounded = self.tips.clearance + z + self.casing.compliance * pushes;
        (z + shift) * turned * turned + shift * turned + GAP_ROUND_OFF * rounded
    }

    /// Keeps the penetration that the step has left, with the casing at `z`.
    fn keep_depth(&mut self, z: Plane) {
        let TipLaw { diameters, clearance, .. } = self.tips;
        for row in self.rows.iter().filter(|row| row.lambda != 0.0) {
            let bent = self.rows.iter().fold(0.0, |bent, other| {
                let torque = -other.place.moment_arm * other.lambda;
                bent + self.blades.compliance(row.index, other.index) * torque
            });
            let direction = self.machine.polygon.direction(row.side);
            let normal = turned(direction, diameters * row.angle + diameters * bent);
            let gap = clearance + z.re * normal.re + z.im * normal.im;
            self.record.deepest = self.record.deepest.max(-gap);
        }
    }

    /// Keeps what the step did: impulses, impacts, pulls.
    pub(super) fn keep_rows(&mut self) {
        let n = self.n;
        let (mut active_set, mut pulls) = (ActiveSet::Nothing, false);
        for row in self.rows.iter().filter(|row| row.lambda != 0.0) {
            self.record.push(n, row.side, row.lambda);
            active_set = active_set.with(row.side);
            pulls |= row.lambda > 0.0;
        }
        if active_set == ActiveSet::Nothing {
            self.open_gap();
            return;
        }
        let goes_on = self.record.last_touch + 1 == n && active_set == self.record.log.active_set;
        self.leaps.same_sides = if goes_on { self.leaps.same_sides + 1 } else { 1 };
        self.record.touch(n, active_set, pulls);
        if self.goes_beyond {
            self.keep_lasting();
        }
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

fn parts(direction: Plane) -> (f64, f64) {
    (direction.re, direction.im)
}
