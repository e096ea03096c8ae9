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
use super::lasting::mark;
use super::row::{Row, Tip, TipLaw};
use crate::motion::failure::MOST_ROWS;
use crate::motion::{ActiveSet, FailureReason, Plane, dot};
use crate::numeric::lcp;
use crate::numeric::rounding::ROUND_OFF;

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

impl Explicit {
    /// Takes one step.
    pub(super) fn take_step(&mut self) -> Result<(), FailureReason> {
        let force = self.drive.force(self.n);
        self.follow_speed()?;
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
        let tips = self.tips_now();
        let distance2 = self.u[0].x * self.u[0].x + self.u[1].x * self.u[1].x;
        // |u| < g0: no tip can touch, whatever its angle.
        let risen = if tips.rise == 0.0 { 0.0 } else { tips.rise.abs() * self.disk.bound() };
        let room = tips.least - risen - self.highest_target();
        if room > 0.0 && distance2 < room * room {
            self.release_lining();
            self.leave();
            return Ok(());
        }
        self.check_range(distance2, &tips)?;
        let turn = self.turn_now();
        let z = self.place(turn);
        if self.lining.is_some() {
            self.press(z, turn, &tips);
            return Ok(());
        }
        self.meet(z, turn, &tips)
    }

    /// Steps 2 to 4: finds the tips that penetrate at the prediction, and corrects it.
    fn meet(&mut self, z: Plane, turn: Plane, tips: &TipLaw) -> Result<(), FailureReason> {
        let highest = self.highest_target();
        let (deepest, next) = self.gather(z, tips, highest);
        if deepest <= 0.0 {
            let dip = self.rows.iter().fold(0.0, |dip: f64, row| dip.max(-row.gap));
            self.rows.clear();
            self.leave();
            self.dips[0] = dip;
            self.record.deepest = self.record.deepest.max(dip);
            return Ok(());
        }
        self.record.deepest_predicted = self.record.deepest_predicted.max(deepest);
        if deepest > tips.clearance {
            return Err(self.too_deep(deepest, z, tips));
        }
        // Equalities are those of the tips that penetrate. Where contact only pushes, a push may
        // close another gap, by as much as is asked of it.
        let reach = if self.law.pulls() { 0.0 } else { NEIGHBOUR_DEPTHS * deepest };
        if next < reach + highest {
            self.gather(z, tips, reach + highest);
        }
        let mut taking_part = 0;
        for place in 0..self.rows.len() {
            if self.rows[place].apart < reach {
                self.rows.swap(taking_part, place);
                taking_part += 1;
            }
        }
        self.find_multipliers(taking_part, tips)?;
        self.correct(z, turn, tips);
        self.keep_rows();
        self.look_at_swing();
        self.check_length()
    }

    /// Returns why a tip is deeper than the clearance: of a polygon of two sides, which lie opposite
    /// each other at rest, blade angles may have turned the one toward the other.
    fn too_deep(&mut self, depth_m: f64, z: Plane, tips: &TipLaw) -> FailureReason {
        let (rows, clearance_m) = (self.tips_of_rows.rows.len(), tips.clearance);
        let [a, b] = [0, 1].map(|index| self.row(index.min(rows - 1), z).normal);
        if rows == 2 && (a * b.conj()).re > SIDES_TOGETHER {
            return FailureReason::TwoSides { angle_rad: self.disk.bound() };
        }
        FailureReason::Penetration { depth_m, clearance_m }
    }

    /// Step 2: makes rows of the tips whose gaps may be below `reach`, Eq. (14). Returns how far the
    /// deepest is beyond its target, and a lower bound on the gaps of all other tips.
    fn gather(&mut self, z: Plane, tips: &TipLaw, reach: f64) -> (f64, f64) {
        self.rows.clear();
        // A blade angle turns a gap by at most |z| n_d alpha, beside its slope.
        let look = tips.diameters * self.disk.bound() * (z.re.abs() + z.im.abs());
        let (mut deepest, mut next) = (0.0_f64, f64::INFINITY);
        if !self.tips_of_rows.sides.is_empty() && (tips.rise == 0.0 || self.disk.is_pair()) {
            // Around the polygon at w = z - kappa l_b (alpha_c + i alpha_s) the gap has one minimum.
            let [c, s] = if tips.rise == 0.0 { [0.0; 2] } else { self.disk.modal() };
            let w = z - Plane::new(c, s) * tips.rise;
            let (near, least, [above, below]) = self.tips_of_rows.nearest(self.near, w);
            let reach = reach + look - tips.clearance;
            self.near = near;
            let mut next = f64::min(above, below);
            if least < reach {
                deepest = self.add_row(self.tips_of_rows.sides[near].row, z, tips);
                if next < reach {
                    (deepest, next) = self.add_neighbours(z, w, reach, deepest, tips);
                }
            } else {
                next = least;
            }
            return (deepest, next + tips.clearance - look);
        }
        for row in 0..self.tips_of_rows.rows.len() {
            let Tip { normal, longer, .. } = self.tips_of_rows.rows[row];
            let mut gap =
                tips.clearance - longer - self.tips_of_rows.out_of_round - look + dot(normal, z);
            if tips.rise != 0.0 {
                gap -= self.highest_rise(row, tips);
            }
            if gap < reach {
                deepest = deepest.max(self.add_row(row, z, tips));
            } else {
                next = next.min(gap);
            }
        }
        (deepest, next)
    }

    /// Makes rows of the sides on either side of the nearest one, as long as the polygon at `w` is
    /// below `reach` there. Returns as `gather`, but for the clearance.
    #[inline]
    fn add_neighbours(
        &mut self,
        z: Plane,
        w: Plane,
        reach: f64,
        mut deepest: f64,
        tips: &TipLaw,
    ) -> (f64, f64) {
        let (sides, mut next) = (self.tips_of_rows.sides.len(), f64::INFINITY);
        let mut left = sides - 1;
        for forward in [true, false] {
            let mut side = self.tips_of_rows.beside(self.near, forward);
            while left > 0 {
                let open = self.tips_of_rows.open(side, w);
                if open >= reach {
                    next = next.min(open);
                    break;
                }
                deepest = deepest.max(self.add_row(self.tips_of_rows.sides[side].row, z, tips));
                side = self.tips_of_rows.beside(side, forward);
                left -= 1;
            }
        }
        (deepest, next)
    }

    /// Returns a bound on the outward displacement of a row's tips by the blade angles \[m\].
    fn highest_rise(&mut self, row: usize, tips: &TipLaw) -> f64 {
        if self.disk.is_pair() {
            return tips.rise * self.disk.angle(row);
        }
        let (angles, slack) = self.disk.seen();
        tips.rise * angles[row % angles.len()] + tips.rise.abs() * slack
    }

    /// Makes a row of a tip. Returns how far it is beyond its target.
    #[inline(always)]
    fn add_row(&mut self, index: usize, z: Plane, tips: &TipLaw) -> f64 {
        let mut row = self.row(index, z);
        if self.restitution != 0.0 {
            row.apart += self.restitution * self.gap_before(&row, tips);
        }
        let depth = -row.apart;
        // Of the blades of a side that turn alike only the deepest can hold.
        let alone = self.tips_of_rows.sides.is_empty() && (tips.rise == 0.0 || self.disk.is_pair());
        match self.rows.iter_mut().find(|known| alone && known.side == row.side) {
            Some(known) if row.apart < known.apart => *known = row,
            Some(_) => {}
            None => self.rows.push(row),
        }
        depth
    }

    /// Step 3: finds the multipliers of the first `count` rows, Eqs. (12)-(13a).
    fn find_multipliers(&mut self, count: usize, tips: &TipLaw) -> Result<(), FailureReason> {
        // Rows that may only push are closed one by one.
        if count > MOST_ROWS && (self.law.pulls() || tips.rise != 0.0) {
            return Err(FailureReason::Rows { rows: count });
        }
        let Self { rows, several, casing, disk, law, .. } = self;
        let rows = &mut rows[..count];
        // How far a unit multiplier of `b` closes the gap of `a`.
        let entry = |a: &Row, b: &Row| {
            let push = tips.push_on_casing(b.normal);
            casing.compliance * dot(a.normal, push)
                + (a.arm - tips.rise) * (b.arm - tips.pushed) * disk.compliance(a.index, b.index)
        };
        match rows {
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
            _ => {
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
        let good = |row: &Row| row.lambda.is_finite() && (law.pulls() || row.lambda <= 0.0);
        if rows.iter().all(good) { Ok(()) } else { Err(FailureReason::Singular { rows: count }) }
    }

    /// Step 4: corrects casing and blades by the multipliers, Eq. (13b), and records what is left of
    /// the gaps and where energy went.
    fn correct(&mut self, z: Plane, turn: Plane, tips: &TipLaw) {
        let mut shift = Plane::default();
        for row in self.rows.iter().filter(|row| row.lambda != 0.0) {
            shift -= tips.push_on_casing(row.normal) * (self.casing.compliance * row.lambda);
            self.disk.turn(row.index, row.torque(tips));
        }
        let moved = shift * turn;
        for (at, part) in self.u.iter_mut().zip([moved.re, moved.im]) {
            at.x += part;
            at.increment += part;
        }
        let asked = self.ledger.counts || self.restitution != 0.0;
        if !asked && self.most_left(z, shift, tips) <= self.record.deepest {
            return;
        }
        let mut dip = 0.0_f64;
        for place in 0..self.rows.len() {
            let row = self.rows[place];
            let gap = self.row(row.index, z + shift).gap;
            dip = dip.max(-gap);
            if self.ledger.counts && row.lambda != 0.0 {
                let closed = 0.5 * (gap - self.gap_before(&row, tips));
                let lost = 0.5 * row.lambda * self.lost_clearance();
                self.ledger.sums.impact_loss_j += row.lambda * closed;
                self.ledger.sums.growth_work_j -= lost;
                self.count_push(&row, turn, tips);
            }
        }
        self.record.deepest = self.record.deepest.max(dip);
        self.dips = [dip, self.dips[0]];
    }

    /// Returns a bound on the gaps that a correction leaves, by terms of second order in its shift
    /// and in the blade phases that it turns, and by round-off \[m\].
    fn most_left(&self, z: Plane, shift: Plane, tips: &TipLaw) -> f64 {
        let size = |at: Plane| at.re.abs() + at.im.abs();
        let (mut turned, mut pushes) = (0.0, 0.0);
        for row in &self.rows {
            turned += row.torque(tips).abs() * self.disk.most_turned();
            pushes += row.lambda.abs();
        }
        let (z, shift, phase) = (size(z), size(shift), tips.diameters * turned);
        let rounded = tips.clearance + z + self.casing.compliance * pushes;
        (z + shift) * phase * phase + shift * phase + ROUND_OFF * rounded
    }

    /// Returns the highest target of a step, `-e g[n-1]` of the deepest row \[m\].
    fn highest_target(&self) -> f64 {
        self.restitution * self.dips[0].max(self.dips[1])
    }

    /// Returns the gap of a row two steps before \[m\].
    fn gap_before(&self, row: &Row, tips: &TipLaw) -> f64 {
        let [c, s] = self.moved();
        let (turn, lobe_turn) = self.drive.turns_before(self.n, 2);
        let z = Plane::new(self.u[0].x - c, self.u[1].x - s) * turn.conj();
        let angle = self.disk.angle_before(row.index);
        let gap = self.tips_of_rows.row(row.index, z, angle, lobe_turn, tips).gap;
        gap + self.lost_clearance()
    }

    /// Returns the motion of the casing over the last two steps \[m\].
    pub(super) fn moved(&self) -> [f64; 2] {
        [0, 1].map(|k| self.u[k].increment + self.before[k])
    }

    /// Records impulses, impacts and pulls of the rows, and since when they are the same.
    fn keep_rows(&mut self) {
        let (mut sides, mut pulls) = (ActiveSet::Nothing, false);
        let (mut set, mut count) = (0_u64, 0);
        for row in self.rows.iter().filter(|row| row.lambda != 0.0) {
            self.record.push(self.n, row.side, row.lambda);
            sides = sides.with(row.side);
            pulls |= row.lambda > 0.0;
            set = set.wrapping_add(mark(row.index));
            count += 1;
        }
        if sides == ActiveSet::Nothing {
            return self.end_contact_after_pause();
        }
        self.record.touch(self.n, sides, pulls);
        let all = count == self.tips_of_rows.rows.len();
        let since = self.lasting.touch(self.drive.time_of(self.n), set, all);
        if sides == ActiveSet::Many {
            self.record.log.since = since;
        }
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
        self.next_look = self.n + self.steps_unseen;
        let rise = self.tips.rise.abs();
        let swing = if rise == 0.0 { 0.0 } else { rise * self.disk.swing() };
        self.lasting.look(self.drive.time_of(self.n), Plane::default(), Plane::default(), swing);
    }

    /// Checks that the casing is within its radius, and that its surface moves more slowly than
    /// the tips along it, as friction assumes.
    fn check_range(&self, distance2: f64, tips: &TipLaw) -> Result<(), FailureReason> {
        let radius_m = self.scene.casing.radius_m;
        if distance2.is_nan() || distance2 > radius_m * radius_m {
            return Err(FailureReason::Displacement { distance_m: distance2.sqrt(), radius_m });
        }
        if tips.casing_friction == 0.0 {
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
