//! An elastic lining: a push `P(g)` on every tip that is pressed in, by the gaps at the beginning
//! of a step (docs/theory.md, sections 6 and 10).
//!
//! The rows are stored in groups of four, so that one vector instruction processes four; groups with
//! no row near the casing are skipped. One pass computes the pushes and all sums that the next step
//! needs; sets and sides are computed only if other rows press than before.

use super::Explicit;
use super::disk::Disk;
use super::record::Record;
use super::row::{Tip, TipLaw, Tips};
use super::shapes::{Four, total};
use crate::harmonic::Lining as RoundLining;
use crate::model::{Frame, LiningLaw};
use crate::motion::lasting::mark;
use crate::motion::plane::{SERIES_PHASE, SHORT_SERIES_PHASE, series, short_series};
use crate::motion::{ActiveSet, Plane, across};

/// Part of the fastest rate below which a wave about rest neither grows nor decays: round-off.
const RATE_ROUND_OFF: f64 = 1e-11;

/// State of the lining: its indentation and its pushes.
#[derive(Clone, Debug)]
pub(super) struct Lining {
    pub law: LiningLaw,
    fours: Vec<Rows>,
    /// Row of each place in `fours`.
    order: Vec<usize>,
    /// Torques of all rows in the latest step \[N m\].
    torques: Vec<f64>,
    /// Rotation of the blade frame at the pushes.
    turn: Plane,
    sums: Sums,
    /// Energy at the previous step, if it does not follow from the depths of that step \[J\].
    held_before: Option<f64>,
    /// Sides that press, the hash of the set of rows, and whether all rows press.
    sides: ActiveSet,
    set: u64,
    all: bool,
}

/// Four rows side by side; the last four are filled up with rows that are never near.
#[derive(Clone, Copy, Debug, Default)]
struct Rows {
    cosine: Four,
    sine: Four,
    longer: Four,
    blades: Four,
    /// Shapes of a pair of modes; of more modes zero, and the angles are given \[rad\].
    shape: [Four; 2],
    angle: Four,
    /// Indentation in the latest step and in the one before \[m\].
    depth: Four,
    before: Four,
    /// Sum of the pushes of the steps since it was given to the record \[N\].
    impulse: Four,
}

/// Sums over the rows of a step.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Pushes along the normals, without friction, their sizes \[N\], and the torques on all rows
    /// \[N m\].
    force: Plane,
    push: f64,
    torque: f64,
    /// Modal torques on a pair of modes \[N m\].
    felt: [f64; 2],
    deepest: f64,
    /// Whether other rows press than in the step before.
    changed: bool,
}

impl Lining {
    /// Creates a lining that nothing presses, over the rows of a disk.
    pub fn new(law: LiningLaw, tips: &Tips, disk: &Disk) -> Self {
        let (rows, per_row) = disk.rows();
        let never = Rows { longer: [f64::NEG_INFINITY; 4], ..Rows::default() };
        let mut fours = vec![never; rows.div_ceil(4)];
        let mut order: Vec<usize> = (0..rows).collect();
        if disk.is_pair() {
            // Rows that press together stand together. Those of single blades are in the order in
            // which the disk has their angles.
            order.sort_by_key(|row| tips.rows[*row].side);
        }
        for (place, &row) in order.iter().enumerate() {
            let (four, k) = (&mut fours[place / 4], place % 4);
            let Tip { normal, longer, shape, .. } = tips.rows[row];
            (four.cosine[k], four.sine[k]) = (normal.re, normal.im);
            (four.longer[k], four.blades[k]) = (longer, f64::from(per_row));
            [four.shape[0][k], four.shape[1][k]] = shape;
        }
        Self {
            law,
            torques: vec![0.0; 4 * fours.len()],
            fours,
            order,
            turn: Plane::default(),
            sums: Sums::default(),
            held_before: None,
            sides: ActiveSet::Nothing,
            set: 0,
            all: false,
        }
    }

    pub fn presses(&self) -> bool {
        self.sides != ActiveSet::Nothing
    }

    /// Returns the rows with a number of each.
    fn rows(&self, value: impl Fn(&Rows) -> Four) -> impl Iterator<Item = (usize, f64)> {
        self.order.iter().copied().zip(self.fours.iter().flat_map(value))
    }

    /// Returns the multipliers of the rows that press, with their sides \[N\].
    pub fn multipliers(&self, tips: &Tips) -> Vec<(u32, f64)> {
        let each = self.fours.first().map_or(0.0, |four| four.blades[0]);
        let pressed = self.rows(|four| four.depth).filter(|(_, depth)| *depth > 0.0);
        pressed.map(|(row, depth)| (tips.rows[row].side, -each * self.law.push(-depth))).collect()
    }

    /// Passes the sums of the pushes so far to the record.
    pub fn give_impulses(&mut self, tips: &Tips, record: &mut Record) {
        for (row, impulse) in self.rows(|four| four.impulse).filter(|(_, sum)| *sum != 0.0) {
            record.impulse(tips.rows[row].side, -impulse);
        }
        self.fours.iter_mut().for_each(|four| four.impulse = [0.0; 4]);
    }

    /// Returns the energy stored between the last two steps \[J\].
    pub fn stored(&self) -> f64 {
        let before = self.held_before.unwrap_or_else(|| self.energy(|four| four.before));
        0.5 * (before + self.energy(|four| four.depth))
    }

    /// Returns the energy stored at these depths \[J\].
    fn energy(&self, depths: impl Fn(&Rows) -> Four) -> f64 {
        let of = |four: &Rows| {
            let depths = depths(four);
            (0..4).map(|k| four.blades[k] * self.law.energy(-depths[k])).sum::<f64>()
        };
        self.fours.iter().map(of).sum()
    }

    /// Records that no row presses at step `n`.
    pub fn release(&mut self, tips: &Tips, record: &mut Record, n: u64) {
        if !self.presses() {
            self.held_before = Some(0.0);
            return;
        }
        self.held_before = Some(self.energy(|four| four.depth));
        for (row, _) in self.rows(|four| four.depth).filter(|(_, depth)| *depth > 0.0) {
            record.keep_touching(n.saturating_sub(1), tips.rows[row].side);
        }
        for four in &mut self.fours {
            (four.depth, four.before) = Default::default();
        }
        self.torques.fill(0.0);
        (self.sums, self.sides, self.set, self.all) = Default::default();
    }

    /// Finds the depths of all rows with the casing at `z` and a pair of modes at `x`, and the pushes
    /// that they make; no angle is beyond `bound`.
    fn press(
        &mut self,
        z: Plane,
        x: [f64; 2],
        tips: &TipLaw,
        of_rows: &Tips,
        lobe_turn: Plane,
        bound: f64,
    ) {
        let phase = tips.diameters * bound;
        self.sums = if !of_rows.lobe.is_empty() {
            let order = std::mem::take(&mut self.order);
            let shape = |place: usize, angle| match order.get(place) {
                Some(row) => of_rows.shape(*row, angle, lobe_turn),
                None => [0.0; 2],
            };
            let out_of_round = of_rows.out_of_round;
            let sums = self.press_by(z, x, tips, phase, out_of_round, shape, f64::sin_cos);
            self.order = order;
            sums
        } else if phase < SHORT_SERIES_PHASE {
            self.press_by(z, x, tips, phase, 0.0, |_, _| [0.0; 2], short_series)
        } else if phase < SERIES_PHASE {
            self.press_by(z, x, tips, phase, 0.0, |_, _| [0.0; 2], series)
        } else {
            self.press_by(z, x, tips, phase, 0.0, |_, _| [0.0; 2], f64::sin_cos)
        };
    }

    /// As [`Self::press`], for a casing with lobes.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "one pass for every kind of tip and angle")]
    fn press_by(
        &mut self,
        z: Plane,
        [c, s]: [f64; 2],
        tips: &TipLaw,
        phase: f64,
        out_of_round: f64,
        shape: impl Fn(usize, f64) -> [f64; 2],
        sin_cos: impl Fn(f64) -> (f64, f64),
    ) -> Sums {
        let LiningLaw { stiffness_n_per_m: stiffness, smoothing_m: eps } = self.law;
        let by_depth = if eps > 0.0 { 0.5 / eps } else { 0.0 };
        let TipLaw { clearance, diameters, pushed, rise, .. } = *tips;
        let look = phase * (z.re.abs() + z.im.abs()) + out_of_round - clearance;
        let [mut x, mut y, mut felt_c, mut felt_s, mut deepest] = [[0.0_f64; 4]; 5];
        let [mut pushed_by, mut turned_by] = [[0.0; 4]; 2];
        let mut changed = [0_u64; 4];
        let presses = |depth: f64| if depth > 0.0 { u64::MAX } else { 0 };
        let torques = self.torques.as_chunks_mut::<4>().0.iter_mut();
        for (place, (four, torques)) in self.fours.iter_mut().zip(torques).enumerate() {
            let Rows { cosine, sine, longer, blades, shape: [p, q], depth: before, .. } = *four;
            let (mut angle, mut least) = ([0.0; 4], [0.0; 4]);
            for k in 0..4 {
                angle[k] = four.angle[k] + (p[k] * c + q[k] * s);
                least[k] = z.re * cosine[k] + z.im * sine[k] - longer[k] - rise * angle[k];
            }
            four.before = before;
            let far = least.map(|least| least > look);
            if far[0] & far[1] & far[2] & far[3] {
                if before != [0.0; 4] {
                    (four.depth, *torques, changed) = ([0.0; 4], [0.0; 4], [u64::MAX; 4]);
                }
                continue;
            }
            // No lane branches or looks at another: one vector instruction takes all.
            let (mut depth, mut torque, mut push) = ([0.0; 4], [0.0; 4], [0.0; 4]);
            for k in 0..4 {
                let (sin, cos) = sin_cos(diameters * angle[k]);
                let across = cosine[k] * cos - sine[k] * sin;
                let along = sine[k] * cos + cosine[k] * sin;
                let [shape, steep] = shape(4 * place + k, angle[k]);
                let arm = diameters * (across * z.im - along * z.re) + steep;
                let inward = across * z.re + along * z.im + shape;
                let deep = rise * angle[k] - (inward + clearance - longer[k]);
                let deep = if deep > 0.0 { deep } else { 0.0 };
                let parabola = if deep < eps { deep } else { eps };
                let smooth = parabola * parabola * by_depth + (deep - parabola);
                push[k] = smooth * (blades[k] * stiffness);
                torque[k] = push[k] * (arm - pushed);
                depth[k] = deep;
                x[k] += push[k] * across;
                y[k] += push[k] * along;
                deepest[k] = if deep > deepest[k] { deep } else { deepest[k] };
            }
            for k in 0..4 {
                four.impulse[k] += push[k];
                pushed_by[k] += push[k];
                turned_by[k] += torque[k];
                felt_c[k] += p[k] * torque[k];
                felt_s[k] += q[k] * torque[k];
                changed[k] |= presses(depth[k]) ^ presses(before[k]);
            }
            (four.depth, *torques) = (depth, torque);
        }
        Sums {
            force: Plane::new(total(x), total(y)),
            push: total(pushed_by),
            torque: total(turned_by),
            felt: [total(felt_c), total(felt_s)],
            deepest: deepest.into_iter().fold(0.0, f64::max),
            changed: changed != [0; 4],
        }
    }

    /// Records which rows press at step `n`, where these are others than before.
    fn keep_change(&mut self, tips: &Tips, record: &mut Record, n: u64) {
        (self.sides, self.set) = (ActiveSet::Nothing, 0);
        let mut count = 0;
        for (row, before) in self.rows(|four| four.before) {
            if before > 0.0 {
                record.keep_touching(n.saturating_sub(1), tips.rows[row].side);
            }
        }
        let pressed = self.fours.iter().flat_map(|four| four.depth.into_iter().zip(four.before));
        let rows = self.order.iter().copied().zip(pressed);
        for (row, (_, before)) in rows.filter(|(_, (now, _))| *now > 0.0) {
            self.sides = self.sides.with(tips.rows[row].side);
            self.set = self.set.wrapping_add(mark(row));
            count += 1;
            if before <= 0.0 {
                record.meet(n, tips.rows[row].side);
            }
        }
        self.all = count == tips.rows.len();
    }
}

impl Explicit {
    /// Returns the push of the lining on the casing, of the beginning of a step \[N\].
    #[inline]
    pub(super) fn lining_push(&self) -> Plane {
        let push = |lining: &Lining| self.tips.push_on_casing(lining.sums.force) * lining.turn;
        self.lining.as_ref().map_or_else(Plane::default, push)
    }

    /// Finds the pushes of the lining at the latest step.
    pub(super) fn press(&mut self, z: Plane, turn: Plane) {
        self.find_pressed(z, turn);
        if !self.keep_pressed() {
            return self.leave();
        }
        let [c, s] = self.disk.modal();
        let (rise, swing) = (Plane::new(c, s) * self.tips.rise, self.tip_swing());
        self.lasting.look(self.drive.time_of(self.n), z, rise, swing);
    }

    fn find_pressed(&mut self, z: Plane, turn: Plane) {
        let bound = self.disk.bound();
        let Self { lining: Some(lining), disk, record, tips_of_rows, tips, .. } = self else {
            return;
        };
        (lining.turn, lining.held_before) = (turn, None);
        let rows = tips_of_rows.rows.len();
        let mut x = disk.pair_angles();
        if !disk.is_pair() {
            x = [0.0; 2];
            disk.all_angles(|row, angle| lining.fours[row / 4].angle[row % 4] = angle);
        }
        lining.press(z, x, tips, tips_of_rows, self.lobe_turn, bound);
        if disk.is_pair() {
            disk.feel_pair(lining.sums.felt);
        } else if lining.sums.deepest > 0.0 {
            disk.feel(&lining.torques[..rows]);
        }
        if lining.sums.changed {
            lining.keep_change(tips_of_rows, record, self.n);
        }
        record.deepest = record.deepest.max(lining.sums.deepest);
    }

    /// Records the pushes of the lining at the latest step. Returns whether there are any.
    fn keep_pressed(&mut self) -> bool {
        let Some(lining) = self.lining.as_ref().filter(|lining| lining.presses()) else {
            return false;
        };
        self.keep_contact(lining.sides, false, lining.set, lining.all);
        true
    }

    /// Adds the work of the rotor and the heat of the pushes over the last two half steps.
    pub(super) fn count_lining(&mut self) {
        let Some(lining) = self.lining.as_ref().filter(|l| self.ledger.counts && l.presses())
        else {
            return;
        };
        let (tips, Sums { force, push, torque, .. }) = (&self.tips, lining.sums);
        let turned = self.drive.speed(self.n - 1) * self.drive.step;
        self.ledger.sums.growth_work_j += 0.5 * push * self.lost_clearance();
        self.ledger.sums.rotor_work_j -= (torque + tips.pushed * push) * turned;
        if tips.friction == 0.0 {
            return;
        }
        let [c, s] = self.moved();
        let moved = Plane::new(0.5 * c, 0.5 * s) * lining.turn.conj();
        let along = across(force, moved);
        let each = f64::from(self.disk.rows().1);
        let rows = lining.rows(|four| four.depth).filter(|(_, depth)| *depth > 0.0);
        let bent: f64 = rows
            .map(|(row, depth)| {
                let turned = self.angle(row) - self.disk.angle_before(row);
                0.5 * each * lining.law.push(-depth) * turned
            })
            .sum();
        let slid = push * self.scene.casing.radius_m * turned;
        self.ledger.sums.rotor_work_j += tips.friction * slid;
        self.ledger.sums.friction_heat_j += tips.friction
            * (slid + self.machine.blade_length * bent)
            - tips.casing_friction * along;
    }

    /// Presses the lining at the start; the step before it must know its pushes.
    pub(super) fn press_start(&mut self) {
        if self.lining.is_none() {
            return;
        }
        let turn = self.turn_now();
        self.find_pressed(self.place(turn), turn);
        let push = self.lining_push();
        self.disk.begin();
        for (at, force) in self.u.iter_mut().zip([push.re, push.im]) {
            at.increment -= self.casing.start_shift(force);
        }
        // What the same rows held in the step before.
        let (turn, lobe_turn) = self.drive.turns_before(self.n, 1);
        let [x, y] = self.u.map(|at| at.x - at.increment);
        let z = Plane::new(x, y) * turn.conj();
        let Self { lining: Some(lining), disk, tips_of_rows, tips, .. } = self else { return };
        let each = f64::from(disk.rows().1);
        let pressed = lining.rows(|four| four.depth).filter(|(_, depth)| *depth > 0.0);
        let held = pressed.map(|(row, _)| {
            let angle = disk.angle_before(row);
            let gap = tips_of_rows.row(row, z, angle, lobe_turn, tips).gap + self.closed[0];
            each * lining.law.energy(gap)
        });
        lining.held_before = Some(held.sum());
        self.keep_pressed();
    }

    /// Presses a lining with other parameters, as if it had been that one for the half step
    /// before, too.
    pub(super) fn press_again(&mut self, old_tips: &Tips) {
        let part = self.lining.take().map_or(1.0, |mut old| {
            old.give_impulses(old_tips, &mut self.record);
            let held = old.energy(|four| four.depth);
            let before = 2.0 * old.stored() - held;
            old.release(old_tips, &mut self.record, self.n + 1);
            if held > 0.0 { before / held } else { 1.0 }
        });
        let Some(law) = self.scene.lining() else { return };
        self.lining = Some(Lining::new(law, &self.tips_of_rows, &self.disk));
        let turn = self.turn_now();
        self.disk.forget_felt();
        self.find_pressed(self.place(turn), turn);
        let Some(lining) = &mut self.lining else { return };
        lining.held_before = Some(part * lining.energy(|four| four.depth));
        // The record has the pushes of this step.
        lining.fours.iter_mut().for_each(|four| four.impulse = [0.0; 4]);
    }

    /// Returns the decay rate of the slowest wave that indents the lining, where all blades press it at
    /// constant speed and none has lifted lately; negative for growth, 0 for neither \[1/s\].
    pub(super) fn decay_about_rest(&self) -> Option<f64> {
        let (machine, now) = (&self.machine, self.drive.time_of(self.n));
        let presses = self.lining.is_some() && self.lasting.is_pressed(now);
        let is_linear = self.drive.is_steady(self.n) && !machine.is_uneven() && self.disk.is_pair();
        if !presses || !is_linear {
            return None;
        }
        let speed = self.drive.speed(self.n);
        let lining = RoundLining::of(machine, &self.scene.contact).ok()?;
        let (frame, stiffness) = (Frame::at(machine, speed), lining.stiffness_at_rest());
        // Rigid blades, and those with radial tips, do not indent the lining.
        let waves = if self.tips.rise == 0.0 || self.disk.coordinates() == 0 {
            frame.casing.on_spring(self.tips.push_on_casing(stiffness.into())).to_vec()
        } else {
            frame.round(stiffness)?
        };
        let fastest = waves.iter().map(|wave| wave.norm()).fold(0.0, f64::max);
        let growth = waves.iter().map(|wave| wave.re).fold(f64::NEG_INFINITY, f64::max);
        Some(if growth.abs() > RATE_ROUND_OFF * fastest { -growth } else { 0.0 })
    }
}
