//! One step of the scheme, section 4.2 of the paper (docs/theory.md, section 6), for the two rigid
//! laws of contact (docs/theory.md, section 2):
//!
//! 1. predict without contact, Eq. (10);
//! 2. gaps of the tips at the prediction, Eq. (14): those that penetrate are rows;
//! 3. multipliers of the rows, Eqs. (12)-(13a): `W lambda = g`, all rows closed as equalities, or
//!    `g - W lambda >= 0`, `lambda <= 0`, complementary, where contact only pushes;
//! 4. correct, Eq. (13b).
//!
//! `W = C A^-1 G^T` has the gap directions `C` and the push directions `G` (`row`). With
//! restitution the target of a row is `g[n+1] >= -e g[n-1]` (Paoli and Schatzman), which is the
//! paper's for `e = 0`. A lining pushes with the force of the beginning of the step instead
//! (`lining`).

use super::Explicit;
use super::angles::ANGLE_LOOK;
use super::row::{Row, Tip};
use crate::motion::failure::MOST_ROWS;
use crate::motion::lasting::mark;
use crate::motion::{ActiveSet, FailureReason, Plane, across, dot};
use crate::numeric::lcp;

/// Gaps up to this multiple of the deepest penetration are included, as a push may close them: with
/// two modes one push closes another gap by at most
/// `|T|/Re T`, `sqrt(1 + mu_c^2)` of its own depth where `kappa (kappa + mu) >= 0`.
/// Smaller: a neighbour is closed a step late. Larger: speed only.
pub(super) const NEIGHBOUR_DEPTHS: f64 = 4.0;

/// Part of a side that the casing may move in one step in contact. A
/// single longer step is an impact; see `MOST_LONG_STEPS`.
pub(super) const LONG_STEP: f64 = 0.25;

/// Number of consecutive longer steps after which the run fails: so fast a wave driven by friction is
/// an artefact of the step.
const MOST_LONG_STEPS: u32 = 2000;

/// Cosine of the angle between two sides from which on they count as turned onto each other; it is
/// -1 at rest. Larger: a step that penetrates between them is blamed instead.
const SIDES_TOGETHER: f64 = -0.5;

/// What is known of the tips around the casing.
struct Near {
    /// Tips that are less than this from their targets are rows \[m\].
    reach: f64,
    /// How far the deepest is beyond its target \[m\].
    deepest: f64,
    /// Bound on how far all tips without a row are from their targets \[m\].
    next: f64,
    /// Deepest penetration of tips without a row \[m\].
    dip: f64,
}

/// Displacement of a single tip, as a part of the clearance, after which all blade angles of a full
/// disk are evaluated. Speed only.
const TIP_SLACK: f64 = 0.02;

impl Explicit {
    /// Takes one step.
    pub(super) fn take_step(&mut self) -> Result<(), FailureReason> {
        let force = self.drive.force(self.n);
        if self.follows_speed() {
            self.follow_ramp()?;
        }
        self.predict(force);
        let met = self.touch();
        // Growth is what a failure is called, whatever it does to the contact.
        if let Some(angle_rad) = self.disk.watch() {
            return Err(FailureReason::BladeAngle { angle_rad });
        }
        met?;
        if self.ledger.counts {
            self.count_flows(force);
        }
        Ok(())
    }

    /// Step 1: predicts casing and blades, Eq. (10), under pulse, excitation and lining.
    #[inline]
    fn predict(&mut self, force: f64) {
        let push = self.lining_push();
        self.before = self.u.map(|at| at.increment);
        self.u =
            [self.casing.step(self.u[0], force + push.re), self.casing.step(self.u[1], push.im)];
        self.disk.predict(self.drive.driven(self.n));
        self.n += 1;
        if self.lining.is_some() {
            self.count_lining();
        }
    }

    /// Looks for contact at the prediction.
    fn touch(&mut self) -> Result<(), FailureReason> {
        self.turn_friction();
        let distance2 = self.u[0].x * self.u[0].x + self.u[1].x * self.u[1].x;
        // |u| < g0: no tip can touch, whatever its angle.
        let rise = self.tips.rise.abs();
        let risen = if rise == 0.0 { 0.0 } else { rise * self.disk.bound() };
        let room = self.tips.least - risen - self.highest_target();
        if room > 0.0 && distance2 < room * room {
            if let Some(lining) = &mut self.lining {
                lining.release(&self.tips_of_rows, &mut self.record, self.n);
            }
            self.leave();
            return Ok(());
        }
        self.check_range(distance2)?;
        let turn = self.turn_now();
        let z = self.place(turn);
        if self.lining.is_some() {
            self.press(z, turn);
            return Ok(());
        }
        self.meet(z, turn)
    }

    /// Steps 2 to 4: finds the tips that penetrate at the prediction, and corrects it.
    fn meet(&mut self, z: Plane, turn: Plane) -> Result<(), FailureReason> {
        let mut near = self.gather(z, 0.0);
        if near.deepest <= 0.0 {
            self.leave();
            self.dips[0] = near.dip;
            self.record.deepest = self.record.deepest.max(near.dip);
            return Ok(());
        }
        self.record.deepest_predicted = self.record.deepest_predicted.max(near.deepest);
        if near.deepest > self.tips.clearance {
            return Err(self.too_deep(near.deepest, z));
        }
        if near.next < near.reach {
            near = self.gather(z, near.reach);
        }
        self.find_multipliers()?;
        self.correct(z, turn, near.dip);
        self.look_at_swing();
        self.check_length()
    }

    /// Returns why a tip is deeper than the clearance: of a polygon of two sides, which lie opposite
    /// each other at rest, blade angles may have turned the one toward the other.
    fn too_deep(&mut self, depth_m: f64, z: Plane) -> FailureReason {
        let (rows, clearance_m) = (self.tips_of_rows.rows.len(), self.tips.clearance);
        let [a, b] = [0, 1].map(|index| self.row(index.min(rows - 1), z).normal);
        if rows == 2 && (a * b.conj()).re > SIDES_TOGETHER {
            return FailureReason::TwoSides { angle_rad: self.disk.bound() };
        }
        FailureReason::Penetration { depth_m, clearance_m }
    }

    /// Step 2: makes rows of the tips that are less than `reach` from their targets, Eq. (14).
    /// Equalities are those of the tips that penetrate. Where contact only pushes, a push may close
    /// another gap, by as much as is asked of it: the reach grows with the deepest penetration.
    fn gather(&mut self, z: Plane, reach: f64) -> Near {
        self.rows.clear();
        let mut near = Near { reach, deepest: 0.0, next: f64::INFINITY, dip: 0.0 };
        // A blade angle turns a gap by at most |z| n_d alpha, beside its slope.
        let look = self.tips.diameters * self.disk.bound() * (z.re.abs() + z.im.abs());
        let least = self.tips.clearance - look - self.highest_target();
        if !self.tips_of_rows.sides.is_empty() && (self.tips.rise == 0.0 || self.disk.is_pair()) {
            self.gather_around(z, least, &mut near);
            return near;
        }
        for row in 0..self.tips_of_rows.rows.len() {
            let Tip { normal, longer, .. } = self.tips_of_rows.rows[row];
            let tip = least - longer - self.tips_of_rows.out_of_round;
            let apart = tip + dot(normal, z) - self.highest_rise(row);
            if apart < near.reach {
                self.add_row(row, z, &mut near);
            } else {
                near.next = near.next.min(apart);
            }
        }
        near
    }

    /// As `gather`, where each side of the polygon is one row. Around it, at
    /// `w = z - kappa l_b (alpha_c + i alpha_s)`, the gap has one minimum, from which on rows are made
    /// to both sides.
    #[inline(always)]
    fn gather_around(&mut self, z: Plane, least: f64, near: &mut Near) {
        let [c, s] = self.disk.pair_angles();
        let w = z - Plane::new(c, s) * self.tips.rise;
        let (nearest, [below, open, above]) = self.tips_of_rows.nearest(self.near, w);
        self.near = nearest;
        if least + open >= near.reach {
            near.next = least + open;
            return;
        }
        self.add_row(self.tips_of_rows.row_of(nearest), z, near);
        if least + below.min(above) >= near.reach {
            near.next = near.next.min(least + below.min(above));
            return;
        }
        let (sides, target) = (self.tips_of_rows.sides(), self.highest_target());
        let mut left = sides - 1;
        for way in [1, sides - 1] {
            let mut side = (nearest + way) % sides;
            while left > 0 {
                let apart = least + self.tips_of_rows.open(side, w);
                if apart >= near.reach {
                    near.next = near.next.min(apart);
                    break;
                }
                let row = self.tips_of_rows.row_of(side);
                let apart = self.least_gap(row, z) - target;
                if apart < near.reach {
                    self.add_row(row, z, near);
                } else {
                    near.next = near.next.min(apart);
                }
                (side, left) = ((side + way) % sides, left - 1);
            }
        }
    }

    /// Returns a bound on the gap of a row of a round casing, without the sine of its phase \[m\].
    #[inline(always)]
    fn least_gap(&self, row: usize, z: Plane) -> f64 {
        let (normal, angle) = (self.tips_of_rows.rows[row].normal, self.angle(row));
        let (x, y, phase) = (dot(normal, z), across(normal, z), self.tips.diameters * angle);
        let curved = phase * phase * (0.5 * x.abs() + (y * phase).abs() / 6.0);
        self.tips.clearance - self.tips.rise * angle + x + phase * y - curved
    }

    /// Returns a bound on the outward displacement of a row's tips by the blade angles \[m\].
    fn highest_rise(&mut self, row: usize) -> f64 {
        let rise = self.tips.rise;
        if rise == 0.0 {
            return 0.0;
        }
        if self.disk.is_pair() {
            return rise * self.angle(row);
        }
        let slack = TIP_SLACK * (self.tips.clearance / rise).abs();
        let (angles, slack) = self.disk.angles_within(slack);
        rise * angles[row] + rise.abs() * slack
    }

    /// Makes a row of a tip, if it is less than the reach from its target.
    #[inline(always)]
    fn add_row(&mut self, index: usize, z: Plane, near: &mut Near) {
        let mut row = self.row(index, z);
        if self.restitution != 0.0 {
            row.apart += self.restitution * self.gap_before(&row);
        }
        near.deepest = near.deepest.max(-row.apart);
        if !self.law.pulls() {
            near.reach = near.reach.max(NEIGHBOUR_DEPTHS * near.deepest);
        }
        if row.apart >= near.reach {
            (near.next, near.dip) = (near.next.min(row.apart), near.dip.max(-row.gap));
            return;
        }
        // Of the blades of a side that turn alike only the deepest can hold.
        let alone =
            self.tips_of_rows.sides.is_empty() && (self.tips.rise == 0.0 || self.disk.is_pair());
        let known = if alone { self.rows.iter_mut().find(|it| it.side == row.side) } else { None };
        match known {
            Some(known) if row.apart < known.apart => *known = row,
            Some(_) => {}
            None => self.rows.push(row),
        }
    }

    /// Step 3: finds the multipliers of the rows, Eqs. (12)-(13a).
    fn find_multipliers(&mut self) -> Result<(), FailureReason> {
        let Self { rows, several, casing, disk, law, tips, .. } = self;
        let count = rows.len();
        // Rows that may only push are closed one by one.
        if count > MOST_ROWS && (law.pulls() || tips.rise != 0.0) {
            return Err(FailureReason::Rows { rows: count });
        }
        // How far a unit multiplier of `b` closes the gap of `a`, an entry of `W` in m/N.
        let entry = |a: &Row, b: &Row| {
            casing.compliance * dot(a.normal, tips.push_on_casing(b.normal))
                + (a.arm - tips.rise) * (b.arm - tips.pushed) * disk.compliance(a, b)
        };
        match &mut rows[..] {
            [row] => row.lambda = row.apart / entry(row, row),
            [a, b] => {
                let across = entry(a, b);
                // Without friction pushes act along the gaps, and `W` is symmetric.
                let back = if tips.friction == 0.0 { across } else { entry(b, a) };
                let (w, gaps) = ([[entry(a, a), across], [back, entry(b, b)]], [a.apart, b.apart]);
                let found = match law.pulls() {
                    true => Some(lcp::equality_of_two(w, gaps)),
                    false => lcp::complementary_of_two(w, gaps),
                };
                [a.lambda, b.lambda] = found.ok_or(FailureReason::Singular { rows: 2 })?;
            }
            rows => {
                let gaps = rows.iter().map(|row| row.apart);
                several.fill(gaps, |a, b| entry(&rows[a], &rows[b]));
                // Without a slope, three tips may meet in one place of the casing.
                let found = match law.pulls() {
                    true => several.equality(),
                    false => several.complementary(tips.rise == 0.0),
                };
                let found = found.ok_or(FailureReason::Singular { rows: count })?;
                rows.iter_mut().zip(found).for_each(|(row, lambda)| row.lambda = *lambda);
            }
        }
        // A single row that moves away from its own push has no answer either.
        let most = if law.pulls() { f64::MAX } else { 0.0 };
        if rows.iter().all(|row| (f64::MIN..=most).contains(&row.lambda)) {
            Ok(())
        } else {
            Err(FailureReason::Singular { rows: count })
        }
    }

    /// Step 4: corrects casing and blades by the multipliers, Eq. (13b), and records impulses,
    /// impacts and pulls of the rows. Tips that have no row penetrate by `dip`.
    fn correct(&mut self, z: Plane, turn: Plane, dip: f64) {
        let Self { rows, tips, casing, disk, record, n, .. } = self;
        let (mut shift, mut turned) = (Plane::default(), 0.0);
        let (mut sides, mut pulls) = (ActiveSet::Nothing, false);
        let (mut set, mut count) = (0_u64, 0);
        for row in rows.iter().filter(|row| row.lambda != 0.0) {
            let torque = row.torque(tips);
            shift -= tips.push_on_casing(row.normal) * (casing.compliance * row.lambda);
            disk.turn(row, torque);
            turned += torque.abs();
            record.push(*n, row.side, row.lambda);
            sides = sides.with(row.side);
            pulls |= row.lambda > 0.0;
            set = set.wrapping_add(mark(row.index));
            count += 1;
        }
        let moved = shift * turn;
        for (at, part) in self.u.iter_mut().zip([moved.re, moved.im]) {
            at.x += part;
            at.increment += part;
        }
        // A correction leaves terms of second order in its shift and in the blade phases it turns.
        let phase = self.tips.diameters * turned * self.disk.fixed.most_turned;
        let size = |at: Plane| at.re.abs() + at.im.abs();
        let left = (size(z) + size(shift)) * phase * phase + size(shift) * phase;
        if self.ledger.counts || self.restitution != 0.0 || left > self.record.deepest {
            self.look_at_left(z + shift, turn, dip);
        }
        if sides == ActiveSet::Nothing {
            return self.end_contact_after_pause();
        }
        self.keep_contact(sides, pulls, set, count == self.tips_of_rows.rows.len());
    }

    /// Records which rows touch at the latest step.
    pub(super) fn keep_contact(&mut self, sides: ActiveSet, pulls: bool, set: u64, all: bool) {
        self.record.touch(self.n, sides, pulls);
        let since = self.lasting.touch(self.drive.time_of(self.n), set, all);
        if sides == ActiveSet::Many {
            self.record.log.since = since;
        }
    }

    /// Records what the correction has left of the gaps, and where energy went; other tips penetrate
    /// by `dip`.
    fn look_at_left(&mut self, z: Plane, turn: Plane, mut dip: f64) {
        for place in 0..self.rows.len() {
            let row = self.rows[place];
            let gap = self.row(row.index, z).gap;
            dip = dip.max(-gap);
            if self.ledger.counts && row.lambda != 0.0 {
                let closed = 0.5 * (gap - self.gap_before(&row));
                let lost = 0.5 * row.lambda * self.lost_clearance();
                self.ledger.sums.impact_loss_j += row.lambda * closed;
                self.ledger.sums.growth_work_j -= lost;
                self.count_push(&row, turn);
            }
        }
        self.record.deepest = self.record.deepest.max(dip);
        self.dips = [dip, self.dips[0]];
    }

    /// Returns the highest target of a step, `-e g[n-1]` of the deepest row \[m\].
    fn highest_target(&self) -> f64 {
        self.restitution * self.dips[0].max(self.dips[1])
    }

    /// Returns the gap of a row two steps before \[m\].
    fn gap_before(&self, row: &Row) -> f64 {
        let [c, s] = self.moved();
        let (turn, lobe_turn) = self.drive.turns_before(self.n, 2);
        let z = Plane::new(self.u[0].x - c, self.u[1].x - s) * turn.conj();
        let angle = self.disk.angle_before(row.index);
        let gap = self.tips_of_rows.row(row.index, z, angle, lobe_turn, &self.tips).gap;
        gap + self.lost_clearance()
    }

    /// Returns the motion of the casing over the last two steps \[m\].
    pub(super) fn moved(&self) -> [f64; 2] {
        [0, 1].map(|k| self.u[k].increment + self.before[k])
    }

    /// Records a step without contact.
    pub(super) fn leave(&mut self) {
        self.end_contact_after_pause();
        self.dips = [0.0, self.dips[0]];
        self.look_at_swing();
    }

    fn end_contact_after_pause(&mut self) {
        if self.record.is_over(self.n) {
            self.end_contact();
        }
    }

    /// Records that contact ends now.
    pub(super) fn end_contact(&mut self) {
        self.record.end_contact(self.n);
        self.lasting.touch(self.drive.time_of(self.n), 0, false);
        self.rows.clear();
    }

    /// Records the swing of the tips, as often as needed.
    pub(super) fn look_at_swing(&mut self) {
        if self.n < self.next_look {
            return;
        }
        let turn = self.machine.omega_bd_max * self.drive.step;
        self.next_look = self.n + ((ANGLE_LOOK / turn) as u64).max(1);
        let swing = self.tip_swing();
        self.lasting.look(self.drive.time_of(self.n), Plane::default(), Plane::default(), swing);
    }

    /// Returns the outward swing of the tips by the blades \[m\].
    pub(super) fn tip_swing(&mut self) -> f64 {
        let rise = self.tips.rise.abs();
        if rise == 0.0 { 0.0 } else { rise * self.disk.swing() }
    }

    /// Checks that the casing is within its radius, and that its surface moves more slowly than
    /// the tips along it, as friction assumes.
    fn check_range(&self, distance2: f64) -> Result<(), FailureReason> {
        let radius_m = self.scene.casing.radius_m;
        if distance2.is_nan() || distance2 > radius_m * radius_m {
            return Err(FailureReason::Displacement { distance_m: distance2.sqrt(), radius_m });
        }
        if self.tips.casing_friction == 0.0 {
            return Ok(());
        }
        let [c, s] = self.u.map(|at| at.increment);
        let speed_m_s = self.machine.tangential_ratio * c.hypot(s) / self.drive.step;
        let tip_m_s = self.drive.speed(self.n).abs() * radius_m;
        if speed_m_s > tip_m_s {
            return Err(FailureReason::CasingSpeed { speed_m_s, tip_m_s });
        }
        Ok(())
    }

    /// Checks that the wave does not pass the blades too fast for the step, for many steps.
    fn check_length(&mut self) -> Result<(), FailureReason> {
        let [c, s] = self.u.map(|at| at.increment);
        let long = self.long_step;
        let is_long = c * c + s * s > long * long;
        self.long_steps = if is_long { self.long_steps + 1 } else { 0 };
        if self.long_steps > MOST_LONG_STEPS {
            let (moved_m, side_m) = (c.hypot(s), long / LONG_STEP);
            return Err(FailureReason::LongStep { moved_m, side_m });
        }
        Ok(())
    }
}
