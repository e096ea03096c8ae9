//! The correction of one step by rigid contact: which rows penetrate, the pushes that
//! bring them back by the chosen law, and what these do, all in the frame of the blades,
//! at `z = u exp(-i n_d theta)`, where the sides stand still and only small blade angles
//! turn them. First the paper's, Eqs. (11)-(16) (docs/theory.md, section 6), then that of
//! steps beyond it (section 10).
//!
//! Beyond it the target is `g[n+1] >= -e g[n-1]`, which gives back the part `e` of the
//! closing speed (Paoli and Schatzman); for `e = 0` it is the paper's.

use super::Explicit;
use super::disk::Disk;
use super::pushes::{push, solve};
use super::rows::{Row, TipLaw, turned};
use crate::motion::{ActiveSet, FailureReason, Plane};
use crate::tolerances::{
    LONG_STEP, MOST_LONG_STEPS, MOST_ROWS, NEIGHBOUR_DEPTHS, ROUND_OFF, TIP_MARGIN,
};

impl<B: Disk> Explicit<B> {
    /// Corrects a predicted step outside the circle of the clearance by the rows that penetrate.
    /// Returns a bound on the change of any blade angle \[rad\].
    pub(super) fn meet(&mut self, distance2: f64) -> Result<f64, FailureReason> {
        self.stays_in_range(distance2)?;
        let (z, turn) = self.in_blade_frame();
        if self.beyond.account.forgone {
            // The bound of angles that are not looked at grows with each step.
            let largest = self.watch.largest();
            self.watch.skipped(largest, self.blades.look(largest).1);
        }
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

    /// Fills `rows` with those that penetrate and, where a push on one side may close the gap of
    /// its neighbour, the neighbours. Returns the deepest penetration.
    fn gather(&mut self, z: Plane) -> f64 {
        // A blade angle moves a gap by at most |z| n_d alpha.
        let reach = self.machine.nodal_diameters * self.watch.bound();
        let look = reach * (z.re.abs() + z.im.abs());
        let matter = self.neighbours_matter;
        self.rows.clear();
        let mut deepest = 0.0_f64;
        self.walk(z, look, matter, |this, side| {
            let depth = this.add_side(side, z);
            deepest = deepest.max(depth);
            matter && depth > 0.0
        });
        deepest
    }

    /// Appends the row of a side if it penetrates or matters, and returns its penetration.
    fn add_side(&mut self, side: u32, z: Plane) -> f64 {
        let direction = self.machine.polygon.direction(side);
        // In the paper's model nothing tells the blades of a side apart.
        let index = self.blades.table().of_side(side)[0];
        let angle = self.blades.angle(index);
        let place = self.tips.place(direction, z, angle);
        if place.gap < 0.0 || self.neighbours_matter {
            self.rows.push(Row { index, side, angle, place, lambda: 0.0 });
        }
        -place.gap
    }

    /// Computes the multipliers of all rows by the contact law.
    fn solve(&mut self) -> Result<(), FailureReason> {
        if self.law.pulls() {
            // Rows that would be pulled shut are those that penetrate, no others.
            self.rows.retain(|row| row.place.gap < 0.0);
        }
        // Rows that may only push are closed one by one.
        if self.rows.len() > MOST_ROWS && self.law.pulls() {
            return Err(FailureReason::Rows { rows: self.rows.len() });
        }
        self.gaps.clear();
        self.gaps.extend(self.rows.iter().map(|row| row.place.gap));
        let Self { rows, gaps, several, tips, law, casing, blades, .. } = self;
        solve(tips, *law, casing.compliance, blades, rows, gaps, several)
    }

    /// Returns a bound on the gaps that are left by a step that shifts the casing from `z` and
    /// turns the blades by `change`: terms of second order, and round-off \[m\].
    fn most_left(&self, z: Plane, shift: Plane, change: f64) -> f64 {
        let size = |a: Plane| a.re.abs() + a.im.abs();
        let (z, shift, turned) = (size(z), size(shift), self.tips.diameters * change);
        let pushes: f64 = self.rows.iter().map(|row| row.lambda.abs()).sum();
        let rounded = self.tips.clearance + z + self.casing.compliance * pushes;
        (z + shift) * turned * turned + shift * turned + ROUND_OFF * rounded
    }

    /// Records the penetration that the step has left, with the casing at `z`.
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

    /// Records impulses, impacts and pulls of the step.
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

    /// Returns whether a push on one side can close the gap of another: with fewer than four sides,
    /// or with blades soft enough to couple them.
    pub(super) fn neighbours_matter(&self) -> bool {
        let polygon = &self.machine.polygon;
        let turn = (2.0 * polygon.delta).cos();
        let moment_arm = 2.0 * self.machine.nodal_diameters * polygon.clearance;
        let soft = moment_arm * moment_arm * self.blades.compliance(0, 0);
        turn * self.casing.compliance < 2.0 * soft
    }
}

impl<B: Disk> Explicit<B> {
    /// Corrects a predicted step that may touch. Returns whether to look at the blades.
    ///
    /// # Errors
    /// It went through more than the clearance, or its rows have no answer.
    pub(super) fn meet_target(&mut self, tips: &TipLaw, bound: f64) -> Result<bool, FailureReason> {
        let (z, turn) = self.in_blade_frame();
        let restitution = self.scene.contact.restitution;
        let highest = self.highest_target();
        // As deep as the step before, nothing has to be looked for twice.
        let likely = if self.law.pulls() { 0.0 } else { NEIGHBOUR_DEPTHS * self.beyond.depth };
        self.find_candidates(z, tips, bound, highest + likely, TIP_MARGIN);
        let deepest = self.gather_targets(z, tips, restitution, highest + 2.0 * likely);
        if deepest <= 0.0 {
            let dip = self.rows.iter().fold(0.0, |dip: f64, row| dip.max(-row.place.gap));
            self.rows.clear();
            self.part();
            self.beyond.dips[0] = dip;
            self.record.deepest = self.record.deepest.max(dip);
            return Ok(false);
        }
        self.is_shallow(deepest)?;
        // A push may close the gap beside it, by as much as is asked of it.
        let reach = NEIGHBOUR_DEPTHS * deepest;
        self.beyond.depth = deepest;
        if !self.law.pulls()
            && reach > likely
            && (self.find_candidates(z, tips, bound, reach + highest, TIP_MARGIN)
                || reach > 2.0 * likely)
        {
            self.gather_targets(z, tips, restitution, reach + highest);
        }
        let limit = if self.law.pulls() { 0.0 } else { reach };
        let kept = self.below_first(limit);
        if kept > MOST_ROWS {
            return Err(FailureReason::Rows { rows: kept });
        }
        let Self { blades, rows, gaps, several, casing, law, .. } = self;
        let touching = &mut rows[..kept];
        solve(tips, *law, casing.compliance, blades, touching, &gaps[..kept], several)?;
        let (shift, change) = push(rows, tips, casing.compliance, blades);
        self.shift_casing(shift, turn);
        self.settle(z + shift, turn, tips);
        self.keep_rows();
        self.look_at_swing();
        self.look_at_speed()?;
        Ok(self.watch.moved(change))
    }

    /// Checks that the wave does not pass the blades too fast for the step for many steps.
    ///
    /// # Errors
    /// It does.
    fn look_at_speed(&mut self) -> Result<(), FailureReason> {
        let [c, s] = self.u.map(|coordinate| coordinate.increment);
        let (moved2, long) = (c * c + s * s, self.beyond.long);
        let steps = &mut self.beyond.long_steps;
        *steps = if moved2 > long * long { *steps + 1 } else { 0 };
        if *steps > MOST_LONG_STEPS {
            let (moved_m, side_m) = (moved2.sqrt(), long / LONG_STEP);
            return Err(FailureReason::LongStep { moved_m, side_m });
        }
        Ok(())
    }

    /// Makes rows of the candidates whose gaps may be below `reach`, with their distances to the
    /// target. Returns how far the deepest one is beyond its target.
    pub(super) fn gather_targets(&mut self, z: Plane, tips: &TipLaw, e: f64, reach: f64) -> f64 {
        self.rows.clear();
        self.gaps.clear();
        let mut deepest = 0.0_f64;
        // Of blades that turn alike only the deepest of a side can hold.
        let alone = self.blades.table().rows_per_side() > 1
            && (self.tips.rise == 0.0 || self.blades.wave().is_some());
        for place in 0..self.beyond.candidates.len() {
            let index = self.beyond.candidates[place];
            let Some(row) = self.row_at(index, z, tips, reach) else { continue };
            let mut gap = row.place.gap;
            if e != 0.0 {
                gap += e * self.gap_before(&row, tips);
            }
            deepest = deepest.max(-gap);
            let same = |known: &Row| known.side == row.side;
            if let Some(known) = alone.then(|| self.rows.iter().position(same)).flatten() {
                if gap < self.gaps[known] {
                    (self.rows[known], self.gaps[known]) = (row, gap);
                }
                continue;
            }
            self.rows.push(row);
            self.gaps.push(gap);
        }
        deepest
    }

    /// Returns the highest target of a step, `-e g[n-1]` of the deepest row \[m\].
    pub(super) fn highest_target(&self) -> f64 {
        self.scene.contact.restitution * self.beyond.dips[0].max(self.beyond.dips[1])
    }

    /// Moves the rows whose distance to the target is below a limit before the others, and returns
    /// their number.
    fn below_first(&mut self, limit: f64) -> usize {
        let mut kept = 0;
        for place in 0..self.rows.len() {
            if self.gaps[place] < limit {
                self.rows.swap(kept, place);
                self.gaps.swap(kept, place);
                kept += 1;
            }
        }
        kept
    }

    /// Returns the gap of a row two steps before.
    fn gap_before(&mut self, row: &Row, tips: &TipLaw) -> f64 {
        let [c, s] = self.moved();
        let u = Plane::new(self.u[0].x - c, self.u[1].x - s);
        let z = u * self.turn_before().conj();
        let angle = self.blades.angle_before(row.index);
        let gap = self.place_of((row.index, row.side), z, tips, angle, 2).gap;
        gap + self.lost_clearance()
    }

    /// Returns the turn of the frame of the blades two steps before.
    fn turn_before(&self) -> Plane {
        let (c, s) = match self.n.checked_sub(2) {
            Some(n) => self.drive.look_at_turn(n),
            None => {
                let diameters = self.machine.nodal_diameters;
                let (sin, cos) = (diameters * self.drive.rotor.angle(-self.drive.step)).sin_cos();
                (cos, sin)
            }
        };
        Plane::new(c, s)
    }

    /// Records the penetration that is left and the energy flows of the pushes.
    fn settle(&mut self, z: Plane, turn: Plane, tips: &TipLaw) {
        let mut dip = 0.0_f64;
        for place in 0..self.rows.len() {
            let row = self.rows[place];
            let angle = self.blades.angle(row.index);
            let gap = self.place_of((row.index, row.side), z, tips, angle, 0).gap;
            dip = dip.max(-gap);
            if row.lambda != 0.0 && !self.beyond.account.forgone {
                let closed = 0.5 * (gap - self.gap_before(&row, tips));
                self.beyond.account.sums.impact_loss_j += row.lambda * closed;
                let lost = self.lost_clearance();
                self.beyond.account.sums.growth_work_j -= 0.5 * row.lambda * lost;
                self.count_push(&row, turn, tips);
            }
        }
        self.record.deepest = self.record.deepest.max(dip);
        self.beyond.dips = [dip, self.beyond.dips[0]];
    }

    /// Work of the rotor and heat of one push over the last two half steps.
    pub(super) fn count_push(&mut self, row: &Row, turn: Plane, tips: &TipLaw) {
        let (push, normal) = (-row.lambda, row.place.normal);
        let rotor =
            self.drive.rotor.speed(self.time_of(self.n) - self.drive.step) * self.drive.step;
        self.beyond.account.sums.rotor_work_j -= push * row.place.moment_arm * rotor;
        if tips.friction == 0.0 {
            return;
        }
        let [c, s] = self.moved();
        let moved = Plane::new(0.5 * c, 0.5 * s) * turn.conj();
        let along = moved.im * normal.re - moved.re * normal.im;
        let turned = 0.5 * (self.blades.angle(row.index) - self.blades.angle_before(row.index));
        let radius = self.scene.casing.radius_m;
        let bent = self.machine.blade_length * turned;
        let sums = &mut self.beyond.account.sums;
        sums.rotor_work_j += push * tips.friction * radius * rotor;
        sums.friction_heat_j +=
            push * (tips.friction * (radius * rotor + bent) - tips.casing_friction * along);
    }
}

#[cfg(test)]
mod tests {
    use super::MOST_LONG_STEPS;
    use crate::motion::explicit::rows::{Place, Row};
    use crate::motion::explicit::{Explicit, RigidBlades};
    use crate::motion::{Plane, Solver};
    use crate::scene::{ModelSize, Scene};

    #[test]
    fn a_push_takes_its_torque_times_the_angle_turned_from_the_rotor() {
        let mut scene = Scene::base();
        scene.operation.speed_ramp_rad_s2 = -2e5;
        let mut motion = Explicit::<RigidBlades>::new(&scene.checked().unwrap());
        let place = Place { moment_arm: 1e-3, ..Place::default() };
        let row = Row { lambda: -1e4, place, ..Row::default() };
        for n in [2, 10, 900] {
            motion.n = n;
            let before = motion.beyond.account.sums.rotor_work_j;
            motion.count_push(&row, Plane::new(1.0, 0.0), &Default::default());
            let work = motion.beyond.account.sums.rotor_work_j - before;
            let angle = |n: u64| motion.drive.rotor.angle(motion.drive.time_of(n));
            let turned = 0.5 * (angle(n) - angle(n - 2));
            assert!((work / (-10.0 * turned) - 1.0).abs() < 1e-9, "{n}: {work} {turned}");
        }
    }

    #[test]
    fn long_steps_fail_where_more_than_the_most_follow_each_other() {
        let mut motion = Explicit::<RigidBlades>::new(&Scene::base().checked().unwrap());
        motion.u[1].increment = 1.01 * motion.beyond.long;
        for _ in 0..MOST_LONG_STEPS {
            assert_eq!(motion.look_at_speed(), Ok(()));
        }
        assert!(motion.look_at_speed().is_err());
        motion.u[1].increment = 0.0;
        assert_eq!(motion.look_at_speed(), Ok(()));
        motion.u[0].increment = -1.01 * motion.beyond.long;
        assert_eq!(motion.look_at_speed(), Ok(()));
    }

    #[test]
    fn the_frame_two_steps_before_turns_back_to_before_the_start() {
        let mut motion = Explicit::<RigidBlades>::new(&Scene::base().checked().unwrap());
        let turn = motion.machine.nu(motion.drive.speed(0)) * motion.drive.step;
        for n in 1..4 {
            motion.n = n;
            let apart = motion.turn_before() - Plane::cis(turn * (n as f64 - 2.0));
            assert!(apart.norm() < 1e-15, "{n}: {apart}");
        }
    }

    /// Rigid tips and a frictionless casing: pushes move gaps in proportion.
    #[test]
    fn no_blade_is_beyond_its_target_after_a_step() {
        let mut scene = Scene::base();
        scene.solver.model = ModelSize::Rigid;
        (scene.contact.restitution, scene.solver.step_s) = (0.9, 4e-6);
        (scene.bladed_disk.blades, scene.operation.speed_rad_s) = (40, 60.0);
        let mut motion = Explicit::<RigidBlades>::new(&scene.checked().unwrap());
        let (mut dips, mut both) = (0, 0);
        let mut last = [motion.blade_gaps(), motion.blade_gaps()];
        for step in 1..5000_u32 {
            motion.advance(f64::from(step) * 4e-6 + 1e-9).unwrap();
            let gaps = motion.blade_gaps();
            for (now, before) in gaps.iter().zip(&last[0]) {
                assert!(now + 0.9 * before > -1e-15, "{step}: {now:e} {before:e}");
            }
            let deep = gaps.iter().filter(|gap| **gap < -1e-15).count();
            (dips, both) = (dips + deep.min(1), both + usize::from(deep > 1));
            let deepest = gaps.iter().fold(0.0_f64, |most, gap| most.max(-gap));
            assert!(motion.checks().max_penetration_m >= deepest - 1e-18, "{step}: {deepest:e}");
            last = [last[1].clone(), gaps];
        }
        assert!(dips > 20 && both > 0, "{dips} {both}");
    }
}
